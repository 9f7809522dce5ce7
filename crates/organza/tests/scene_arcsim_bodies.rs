//! Scenes of ARCSim with dressed characters (motion files, numbered obstacles) and moving walls
//! (obstacles and handles that come and go).

use mesh_core::World3;
use organza::build::build;
use organza::scene::{IssueKind, LoadOptions, Loaded, SceneErrors, Source, from_sources, parse};
use organza::world::World;

const MATERIAL: &str = "{\"density\": 0.1, \"stretching\": [[9,1,9,3],[9,1,9,3],[9,1,9,3],[9,1,9,3],\
    [9,1,9,3],[9,1,9,3]], \"bending\": [[1,1,1,1,1],[1,1,1,1,1],[1,1,1,1,1]]}";
const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
/// Two bodies over three frames: the first goes along x, the second turns about z.
const MOTION: &str = "NumFrames: 3\nbody[0] position\n0 0 0\n1 0 0\n2 0 0\n\nbody[0] orientation\n\
    1 0 0 0\n1 0 0 0\n1 0 0 0\n\nbody[1] position\n0 0 5\n0 0 5\n0 0 5\n\nbody[1] orientation\n\
    1 0 0 0\n-0.70710678118654752 0 0 -0.70710678118654752\n0 0 0 1\n";

fn attached() -> Vec<Source> {
    let bodies = [0, 1, 2].map(|k| format!("body/part{k:03}.obj"));
    let mut files = vec![("a.obj", TRIANGLE), ("m.json", MATERIAL), ("walk.mot", MOTION)];
    files.extend(bodies.iter().map(|name| (name.as_str(), TRIANGLE)));
    // A gap: this one is not reached.
    files.push(("body/part004.obj", "no mesh"));
    files
        .into_iter()
        .map(|(name, text)| Source { name: name.to_owned(), bytes: text.as_bytes().to_vec() })
        .collect()
}

fn read(more: &str) -> Result<Loaded, SceneErrors> {
    let text = format!(
        "{{\"frame_time\": 0.1, \"end_time\": 1,\n{more}\n\"cloths\": [{{\"mesh\": \"a.obj\", \
         \"transform\": {{\"translate\": [0, 0, 9]}}, \"materials\": [{{\"data\": \"m.json\"}}]}}]}}"
    );
    parse(text, "c/s.json", &LoadOptions::default(), &from_sources(&attached()))
}

#[track_caller]
fn complains(more: &str, expected: &[&str]) {
    let errors = read(more).map(|loaded| loaded.scene).unwrap_err();
    let got: Vec<String> = errors.issues().iter().map(ToString::to_string).collect();
    assert_eq!(got, expected, "{more}");
}

const WALK: &str = r#""obstacles": "body/part%03d.obj",
"motions": {"motfile": "walk.mot", "fps": 2, "transform": {"scale": 2, "rotate": [90, 0, 0, 1], "translate": [0, 0, 1]}},
"handles": [{"nodes": [1], "motion": 0, "start_time": 0.5}],"#;

#[test]
fn bodies_follow_their_motions() {
    let loaded = read(WALK).unwrap_or_else(|errors| panic!("{errors}"));
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    // What a recording attaches makes the same scene again.
    let names: Vec<&str> = loaded.sources[1..].iter().map(|s| s.name.as_str()).collect();
    let bodies = ["body/part000.obj", "body/part001.obj", "body/part002.obj"];
    assert_eq!(names, ["walk.mot", bodies[0], bodies[1], bodies[2], "m.json", "a.obj"]);
    let scene = &loaded.sources[0];
    let options = LoadOptions::default();
    let again = parse(&scene.bytes, "c/s.json", &options, &from_sources(&loaded.sources));
    assert_eq!(again.unwrap().scene, loaded.scene);

    let built = build(&loaded).unwrap();
    let [walker, turner, still] = &built.obstacles[..] else { panic!() };
    // All is doubled, turned a quarter about z, and lifted by one: x goes to y.
    let near = |got: &[World3], expected: [[f64; 3]; 3]| {
        for (got, expected) in got.iter().zip(expected) {
            assert!((got - World3::from(expected)).norm() < 1e-12, "{got} {expected:?}");
        }
    };
    let lifted = |x: f64| [[0.0, x, 1.0], [0.0, x + 2.0, 1.0], [-2.0, x, 1.0]];
    near(&walker.positions(0.0), lifted(0.0));
    near(&walker.positions(0.5), lifted(2.0));
    near(&walker.positions(1.0), lifted(4.0));
    near(&walker.positions(9.0), lifted(4.0));
    // A quaternion and its negative are one turn: a quarter in the middle, and on the way there
    // less.
    near(&turner.positions(0.5), [[0.0, 0.0, 11.0], [-2.0, 0.0, 11.0], [0.0, -2.0, 11.0]]);
    let middle = turner.positions(0.25)[1];
    assert!(middle.x < -0.2 && middle.y > 0.2, "{middle}");
    // It has no motion.
    assert!(!still.is_moving() && still.positions(0.7)[1] == World3::x());
    let handle = &loaded.scene.handles[0];
    let moved = handle.motion.as_ref().unwrap();
    let way = moved.at(1.0) * moved.at(0.5).inverse() * nalgebra::Point3::origin();
    assert!((way.coords - World3::new(0.0, 2.0, 0.0)).norm() < 1e-12, "{way}");
}

#[test]
fn bad_bodies_are_complained_of_at_their_place() {
    complains(
        r#""obstacles": "body/part%s.obj", "motions": {"motfile": "none.mot", "fps": 30},"#,
        &[
            "c/s.json:2:14: obstacles: `body/part%s.obj` is no name with a number: a `%` is followed by \
             something else than `d`, as in `%04d`",
            "c/s.json:2:56: motions.motfile: there is no file `none.mot` among those attached",
        ],
    );
    complains(
        r#""obstacles": "part%d.obj", "motions": {"motfile": "a.obj", "fps": 30},"#,
        &[
            "c/s.json:2:14: obstacles: there is no file `part0.obj` among those attached",
            "c/s.json:2:51: motions.motfile: `a.obj`: line 1: expected `NumFrames:` and a number",
        ],
    );
    complains(
        r#""motions": {"motfile": "walk.mot", "fps": 0},"#,
        &["c/s.json:2:43: motions.fps: must lie between 1/1e6 and 1e6 frames a second, got 0"],
    );
    complains(
        r#""motions": {"motfile": "walk.mot"},"#,
        &["c/s.json:2:12: motions: key `fps` is missing"],
    );
    complains(
        r#""motions": {"motfile": "walk.mot", "fps": 1, "transfrom": {}},"#,
        &["c/s.json:2:46: motions.transfrom: unknown key `transfrom`, did you mean `transform`?"],
    );
    complains(
        r#""motions": {"motfile": "walk.mot", "fps": 1, "transform": {"scale": 0}},"#,
        &["c/s.json:2:69: motions.transform.scale: must lie between 1/1e6 and 1e6, got 0"],
    );
    complains(
        r#""motions": 7, "obstacles": {"mesh": "a.obj"},"#,
        &[
            "c/s.json:2:12: motions: expected a list of motions or an object with `motfile`, got `7`",
            "c/s.json:2:28: obstacles: expected a list of obstacles or a pattern for the names of their files, got an object",
        ],
    );
    complains(
        r#""motions": {"motfile": "walk.mot", "fps": 1}, "handles": [{"nodes": [0], "motion": 2}],"#,
        &["c/s.json:2:84: handles[0].motion: there is no such motion, the scene has 2"],
    );
    let mut sources = attached();
    sources.iter_mut().filter(|s| s.name == "body/part001.obj").for_each(|s| {
        s.bytes = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n".to_vec();
    });
    let text = String::from_utf8(read(WALK).unwrap().sources[0].bytes.clone()).unwrap();
    let options = LoadOptions::default();
    let loaded = parse(text, "c/s.json", &options, &from_sources(&sources)).unwrap();
    let error = organza::record::place(&loaded, &build(&loaded).unwrap_err()).to_string();
    let expected = "c/s.json:2:14: obstacles: body/part001.obj: line 4: a corner refers to `v` number 4, \
                    but there are 3";
    assert_eq!(error, expected);
}

/// The pieces of a shirt between walls: velocities at keyframes, points that meet, a lid that comes
/// and goes, and plasticity, of which there is only a note.
#[test]
fn walls_close_and_handles_gather() {
    let loaded = read(
        r#""motions": [[{"time": 0.5}, {"time": 0.9, "transform": {"translate": [0, 0, 4], "scale": 0}}],
[{"time": 0.2, "transform": {"translate": [0, 0, 0]}}, {"time": 0.6, "transform": {"translate": [0, 0.4, 0]},
"velocity": {"translate": [0, 3, 0]}}, {"time": 1}]],
"obstacles": [{"mesh": "a.obj", "motion": 1}, {"mesh": "a.obj", "start_time": 0.2, "end_time": 0.6}],
"handles": [{"nodes": [0], "end_time": 0.3, "fade_time": 0.2}, {"nodes": [0], "motion": 0, "start_time": 0.5}],"#,
    )
    .unwrap_or_else(|errors| panic!("{errors}"));
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    let built = build(&loaded).unwrap();
    let [wall, lid] = &built.obstacles[..] else { panic!() };
    let speed = (wall.positions(0.6 + 1e-6)[0].y - wall.positions(0.6 - 1e-6)[0].y) / 2e-6;
    assert!((speed - 3.0).abs() < 1e-4, "{speed}");
    assert_eq!(lid.times(), [0.2, 0.6]);
    let there = [0.1, 0.2, 0.3, 0.6, 0.7].map(|time| lid.is_there(time));
    assert_eq!(there, [false, false, true, true, false]);
    let [fading, gathered] = &loaded.scene.handles[..] else { panic!() };
    assert_eq!((fading.end_s, fading.fade_s, gathered.start_s), (0.3, 0.2, 0.5));

    // The springs draw the vertex to where all points meet.
    let mut world = World::new(&loaded).unwrap();
    for _ in 0..10 {
        world.advance().unwrap();
    }
    let gap = (world.cloth.x[0] - World3::new(0.0, 0.0, 4.0)).norm();
    assert!(gap < 0.1, "{gap}");

    let text = "\"disable\": [],";
    let source = read(text).unwrap().sources[0].clone();
    let text = String::from_utf8(source.bytes).unwrap();
    let text = text.replace("\"m.json\"", "\"m.json\", \"yield_curv\": 200");
    let loaded = parse(&text, "c/s.json", &LoadOptions::default(), &from_sources(&attached()));
    let warnings = loaded.unwrap().warnings;
    assert_eq!(warnings.len(), 1);
    assert_eq!(warnings[0].kind, IssueKind::Notice);
    assert_eq!(warnings[0].message, "plasticity is not simulated: the cloth keeps no creases");
}

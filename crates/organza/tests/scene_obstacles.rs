//! Obstacles and contact in scene files: what they mean, and what is complained of.

mod scene_help;

use mesh_core::World3;
use organza::build::{Built, build};
use organza::record::place;
use organza::scene::{LoadOptions, from_sources, parse};
use scene_help::{attached, complains, scene_complains, with};

fn built(scene: &str) -> Built {
    let text = with(scene, "");
    let loaded = parse(&text, "s.json5", &LoadOptions::default(), &from_sources(&attached()));
    build(&loaded.unwrap_or_else(|errors| panic!("{errors}"))).unwrap_or_else(|e| panic!("{e}"))
}

/// The box around an obstacle at a time: its lower corner and its size (m).
fn extent(positions: &[World3]) -> [World3; 2] {
    let low = positions.iter().fold(World3::repeat(f64::INFINITY), |a, b| a.inf(b));
    let high = positions.iter().fold(World3::repeat(f64::NEG_INFINITY), |a, b| a.sup(b));
    [low, high - low]
}

#[test]
fn every_kind_of_mesh() {
    let built = built(
        "obstacles: [
          {mesh: {sphere: {radius_m: 2, detail: 1}}},
          {mesh: {box: {size_m: [1, 2, 3]}}, friction: 0},
          {mesh: {plane: {size_m: [4, 6]}}, name: 'floor'},
          {mesh: {capsule: {radius_m: 1, length_m: 3, segments: 8}}},
          {mesh: {obj: 'a.obj'}, transform: {scale: 2, translate: [0, 0, 5]}},
          {mesh: {torus: {radius_m: 2, tube_radius_m: 0.5, segments: [8, 4]}}},
        ],",
    );
    let expected = [
        ("obstacle0", 80, [4.0, 4.0, 4.0]),
        ("obstacle1", 12, [1.0, 2.0, 3.0]),
        ("floor", 2, [4.0, 6.0, 0.0]),
        ("obstacle3", 64, [2.0, 2.0, 5.0]),
        ("obstacle4", 1, [2.0, 2.0, 0.0]),
        ("obstacle5", 64, [5.0, 5.0, 1.0]),
    ];
    for (obstacle, (name, n_triangles, size)) in built.obstacles.iter().zip(expected) {
        assert_eq!((obstacle.name.as_str(), obstacle.triangles.len()), (name, n_triangles));
        assert!(!obstacle.is_moving());
        let positions = obstacle.positions(1.0);
        assert_eq!(
            (positions.len(), &positions),
            (obstacle.n_vertices(), &obstacle.positions(0.0))
        );
        let [low, got] = extent(&positions);
        // An icosahedron that was quartered once reaches its radius along z alone.
        let slack = if name == "obstacle0" { 0.4 } else { 1e-12 };
        assert!((got - World3::from(size)).amax() < slack, "{name}: {got}");
        let middle = if name == "obstacle4" { [1.0, 1.0, 5.0] } else { [0.0; 3] };
        assert!((low + got * 0.5 - World3::from(middle)).amax() < 0.1, "{name}: {low}");
    }
    assert_eq!(
        built.obstacles.iter().map(|o| o.friction).collect::<Vec<_>>(),
        [0.3, 0.0, 0.3, 0.3, 0.3, 0.3]
    );
    // The rectangle faces up.
    let floor = &built.obstacles[2];
    let x = floor.positions(0.0);
    let [a, b, c] = floor.triangles[0].map(|v| x[v as usize]);
    assert!((b - a).cross(&(c - a)).z > 0.0);
}

#[test]
fn motions_come_after_the_placement() {
    let built = built(
        "obstacles: [{mesh: {box: {size_m: [1, 1, 1]}}, transform: {translate: [3, 0, 0]},
          motion: {keyframes: [
            {time_s: 1}, {time_s: 2, transform: {scale: 2, rotate: {axis: [0, 0, 1], degrees: 90}}},
          ]}},
         {mesh: {plane: {size_m: [1, 1]}},
          motion: {keyframes: [{time_s: 1, transform: {translate: [0, 0, 7]}}]}}],",
    );
    let [moving, still] = &built.obstacles[..] else { panic!() };
    assert!(moving.is_moving() && !still.is_moving());
    let middle = |time| {
        let [low, size] = extent(&moving.positions(time));
        (low + size * 0.5, size.x)
    };
    for (time, x, size) in [
        (0.0, [3.0, 0.0, 0.0], 1.0),
        (1.0, [3.0, 0.0, 0.0], 1.0),
        (2.0, [0.0, 6.0, 0.0], 2.0),
        (9.0, [0.0, 6.0, 0.0], 2.0),
    ] {
        let (got, got_size) = middle(time);
        assert!((got - World3::from(x)).norm() < 1e-12, "{time}: {got}");
        assert!((got_size - size).abs() < 1e-12, "{time}: {got_size}");
    }
    assert!(still.positions(0.0).iter().all(|x| x.z == 7.0));
    // Nothing depends on what was asked before.
    assert_eq!(moving.positions(1.3), moving.positions(1.3));
}

#[test]
fn contact_is_there_where_something_can_touch() {
    assert_eq!(built("").contact, None);
    let contact =
        built("obstacles: [{mesh: {sphere: {radius_m: 1, detail: 0}}}],").contact.unwrap();
    assert_eq!((contact.thickness, contact.friction), (0.005, 0.3));
    assert!(!contact.self_contact);
    let contact = built("contact: {thickness_m: 0.01},").contact.unwrap();
    assert_eq!((contact.thickness, contact.self_contact), (0.01, true));
}

#[test]
fn bad_obstacles_are_complained_of_at_their_place() {
    let obstacle = |text: &str, expected: &str| {
        scene_complains(&format!("obstacles: [\n{{{text}}}],"), expected);
    };
    obstacle("name: 'a'", "s.json5:2:1: obstacles[0]: key `mesh` is missing");
    obstacle(
        "mesh: {sphere: {radius_m: 0}}",
        "s.json5:2:28: obstacles[0].mesh.sphere.radius_m: must be positive and finite, got 0",
    );
    obstacle(
        "mesh: {sphere: {radius_m: 1e7, detail: 9}}",
        "s.json5:2:28: obstacles[0].mesh.sphere.radius_m: 1e7 m is beyond the limit of 1e6 m\n\
         s.json5:2:41: obstacles[0].mesh.sphere.detail: 5.24288e6 triangles is beyond the limit of 4e6 triangles",
    );
    obstacle(
        "mesh: {sphere: {radius_m: 1, detial: 2}}",
        "s.json5:2:31: obstacles[0].mesh.sphere.detial: unknown key `detial`, did you mean `detail`?",
    );
    obstacle(
        "mesh: {box: {size_m: [1, -1, 1]}}",
        "s.json5:2:27: obstacles[0].mesh.box.size_m[1]: must be positive and finite, got -1",
    );
    obstacle(
        "mesh: {plane: {size_m: [1, 1e-9]}}",
        "s.json5:2:29: obstacles[0].mesh.plane.size_m[1]: 1e-9 m is below the limit of 1e-6 m",
    );
    obstacle(
        "mesh: {capsule: {radius_m: 1, length_m: 1, segments: 3}}",
        "s.json5:2:55: obstacles[0].mesh.capsule.segments: must be at least 4, got 3",
    );
    obstacle(
        "mesh: {capsule: {radius_m: 1, length_m: 1, segments: 3000}}",
        "s.json5:2:55: obstacles[0].mesh.capsule.segments: 9e6 triangles is beyond the limit of 4e6 triangles",
    );
    obstacle(
        "mesh: {torus: {radius_m: 1, tube_radius_m: 1, segments: [2, 3]}}",
        "s.json5:2:45: obstacles[0].mesh.torus.tube_radius_m: 1 m leaves no hole in a ring of 1 m\n\
         s.json5:2:59: obstacles[0].mesh.torus.segments[0]: must be at least 3, got 2",
    );
    obstacle(
        "mesh: {}",
        "s.json5:2:8: obstacles[0].mesh: must have exactly one of obj, obj_sequence, gltf, character, sphere, box, plane, capsule, torus; has 0",
    );
    obstacle(
        "mesh: {obj: 'b.obj'}",
        "s.json5:2:14: obstacles[0].mesh.obj: there is no file `b.obj` among those attached",
    );
    obstacle(
        "mesh: {obj: 'a.obj'}, friction: -0.1",
        "s.json5:2:34: obstacles[0].friction: must be zero or more and finite, got -0.1",
    );
    obstacle(
        "mesh: {obj: 'a.obj'}, motion: {keyframes: [{time_s: 2}, {time_s: 1}]}",
        "s.json5:2:67: obstacles[0].motion.keyframes[1].time_s: 1 s is not after the keyframe before, 2 s",
    );
    obstacle(
        "mesh: {sphere: {radius_m: 1e5}}, transform: {scale: 100}",
        "s.json5:2:54: obstacles[0].transform.scale: the obstacle as scaled: 1e7 m is beyond the limit of 1e6 m",
    );
    obstacle(
        "mesh: {obj: 'a.obj'}, name: 'a'}, {mesh: {obj: 'a.obj'}, name: 'a'",
        "s.json5:2:65: obstacles[1].name: `a` is the name of obstacles[0] already",
    );
    complains(
        &with("obstacle: [],", ""),
        &[],
        &["s.json5:1:13: obstacle: unknown key `obstacle`, did you mean `obstacles`?"],
    );
    // Numbers that are not finite never come so far.
    obstacle(
        "mesh: {sphere: {radius_m: NaN}}",
        "s.json5:2:28: obstacles[0].mesh.sphere.radius_m: must be a finite number, got NaN",
    );
}

#[test]
fn bad_contact_is_complained_of_at_its_place() {
    scene_complains(
        "contact: {thickness_m: 0, friction: 1e3},",
        "s.json5:1:36: contact.thickness_m: must be positive and finite, got 0\n\
         s.json5:1:49: contact.friction: 1e3 is beyond the limit of 1e2",
    );
    scene_complains(
        "contact: {thickness_m: 2},",
        "s.json5:1:36: contact.thickness_m: 2e0 m is beyond the limit of 1e0 m",
    );
    scene_complains(
        "contact: {thickness: 0.01},",
        "s.json5:1:23: contact.thickness: unknown key `thickness`, did you mean `thickness_m`?",
    );
}

/// Files that are read and cannot be used: the place in the scene, and the line in the file.
#[test]
fn bad_obstacle_files() {
    let error = |obj: &str| {
        let text = "{frames: 1, cloths: [{mesh: {obj: 'a.obj'}, fabric: 'swim'}],\n\
                    obstacles: [{mesh: {sphere: {radius_m: 1}}}, {mesh: {obj: 'o.obj'}}]}";
        let mut sources = attached();
        sources.push(organza::scene::Source { name: "o.obj".into(), bytes: obj.into() });
        let options = LoadOptions::default();
        let loaded = parse(text, "s.json5", &options, &from_sources(&sources)).unwrap();
        place(&loaded, &build(&loaded).unwrap_err()).to_string()
    };
    for (obj, expected) in [
        ("", "o.obj: the OBJ file has no vertices"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\n", "o.obj: the OBJ file has no faces"),
        (
            "v 0 0 0\nv 1 0 nan\nv 0 1 0\nf 1 2 3\n",
            "o.obj: line 2: a coordinate of this `v` is NaN",
        ),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 2\n", "o.obj: line 4: a face uses a vertex twice"),
        (
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n",
            "o.obj: line 4: a corner refers to `v` number 4, but there are 3",
        ),
    ] {
        let expected = format!("s.json5:2:53: obstacles[1].mesh: {expected}");
        assert_eq!(error(obj), expected);
    }
}

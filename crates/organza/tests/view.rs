//! Scenes whose meshes depend on what a camera sees.

use organza::report::FrameReport;
use organza::scene::{LoadOptions, Loaded, from_sources, parse};
use organza::world::World;

/// A sheet of a square metre in the plane z = 0 that is meshed at 40 mm where nothing else is wanted.
fn scene(extra: &str) -> Result<Loaded, String> {
    let text = format!(
        "{{frames: 10, frames_per_second: 25, substeps: 1, gravity: [0, 0, 0], {extra}
          cloths: [{{fabric: 'denim', mesh: {{grid: {{size_m: [1, 1], cells: [8, 8]}}}},
                     remeshing: {{size_m: {{min: 0.01, max: 0.04}}}}}}]}}"
    );
    parse(text, "s", &LoadOptions::default(), &from_sources(&[])).map_err(|e| e.to_string())
}

fn run(extra: &str, frames: usize) -> (World, Vec<FrameReport>) {
    let mut world = World::new(&scene(extra).unwrap()).unwrap();
    let reports = (0..frames).map(|_| world.advance().unwrap()).collect();
    (world, reports)
}

/// Looks down at the middle of the sheet, from 1.5 m.
const OVER: &str = "camera: {position: [0.5, 0.5, 1.5], target: [0.5, 0.5, 0], up: [0, 1, 0]},";
/// The same place, but looks up.
const AWAY: &str = "camera: {position: [0.5, 0.5, 1.5], target: [0.5, 0.5, 9], up: [0, 1, 0]},";

#[test]
fn a_camera_alone_changes_nothing() {
    let (plain, _) = run("", 2);
    let (seen, reports) = run(AWAY, 2);
    assert_eq!(plain.cloth, seen.cloth);
    assert!(reports[1].view.is_none());
    assert_eq!(reports[1].seconds.view, 0.0);
    assert!(reports[1].skipped.iter().any(|s| s.starts_with("view")));
}

#[test]
fn cloth_is_fine_where_the_camera_looks() {
    let (plain, _) = run("", 3);
    let (over, reports) = run(&format!("{OVER} view: {{}},"), 3);
    let view = reports[2].view.unwrap();
    // 40° show 1.09 m of it upright and more across: all.
    assert_eq!((view.visible, view.mean_factor), (reports[2].faces, 1.0));
    assert_eq!(over.cloth, plain.cloth);

    let (away, reports) = run(&format!("{AWAY} view: {{}},"), 3);
    let view = reports[2].view.unwrap();
    assert!(view.visible == 0 && (view.mean_factor - 0.01).abs() < 1e-12);
    assert!(away.cloth.mesh.n_vertices() * 20 < plain.cloth.mesh.n_vertices());
    assert!(reports[2].skipped.iter().all(|s| !s.starts_with("view")));

    // With an upper bound of 0.2 m for edges there are at least 5 along every side.
    let (bounded, _) = run(&format!("{AWAY} view: {{size_max_m: 0.2}},"), 3);
    let n = bounded.cloth.mesh.n_vertices();
    assert!(n >= 36 && n > away.cloth.mesh.n_vertices(), "{n}");
}

/// A cut at 0.3 s, in the frames 7 and 8: the mesh grows before it.
#[test]
fn cloth_is_refined_before_a_cut_shows_it() {
    let extra = format!(
        "{AWAY} view: {{window_frames: 4}}, shots: [
           {{keyframes: [{{time_s: 0, position: [0.5, 0.5, 1.5], target: [0.5, 0.5, 9]}}]}},
           {{start_s: 0.3, keyframes: [
             {{time_s: 0.3, position: [0.5, 0.5, 1.5], target: [0.5, 0.5, 0]}}]}}],"
    );
    let (_, reports) = run(&extra, 10);
    let factor = |frame: usize| reports[frame - 1].view.unwrap().mean_factor;
    for (frame, expected) in [(3, 0.01), (4, 0.125), (5, 0.375), (6, 0.625), (7, 0.875), (8, 1.0)] {
        assert!((factor(frame) - expected).abs() < 1e-9, "{} in frame {frame}", factor(frame));
    }
    let faces: Vec<usize> = reports.iter().map(|r| r.faces).collect();
    assert!(faces[6] > 10 * faces[2] && faces[6] * 10 > 7 * faces[8], "{faces:?}");
    let longest = |world: &World| {
        let mesh = &world.cloth.mesh;
        mesh.edges().map(|h| mesh.material_edge(h).norm()).fold(0.0, f64::max)
    };
    assert!(longest(&run(&extra, 7).0) > 0.04);
    for frames in [8, 10] {
        let longest = longest(&run(&extra, frames).0);
        assert!(longest < 0.04 * (1.0 + 1e-9), "{longest} m in frame {frames}");
    }
}

#[test]
fn mistakes_are_named_with_their_place() {
    for (extra, words) in [
        ("view: {},", "no `camera` to look through"),
        ("shots: [{keyframes: []}],", "no `camera`, which sets the resolution"),
        (&*format!("{OVER} view: {{v_back: 2}},"), "v_back is 2"),
        (&*format!("{OVER} view: {{v_out: 0.5}},"), "v_out is 0.5"),
        (&*format!("{OVER} view: {{widow_frames: 4}},"), "widow_frames"),
        (&*format!("{OVER} shots: [{{keyframes: []}}],"), "exactly one of keyframes, gltf"),
        (
            &*format!(
                "{OVER} shots: [{{keyframes: [{{time_s: 0, position: [0, 0, 0], target: [0, 0, 0]}}]}}],"
            ),
            "is where the camera stands",
        ),
        (
            &*format!(
                "{OVER} shots: [{{keyframes: [
                  {{time_s: 1, position: [0, 0, 2], target: [0, 1, 0]}},
                  {{time_s: 1, position: [0, 0, 3], target: [0, 1, 0]}}]}}],"
            ),
            "comes after",
        ),
    ] {
        let error = scene(extra).map(|_| ()).unwrap_err();
        assert!(error.contains(words), "`{words}` is not in: {error}");
    }
}

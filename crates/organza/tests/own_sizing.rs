//! A sizing field of one's own: in the place of the scene's, on top of it, and in recordings.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use mesh_core::TriangleId;
use organza::build::BuildError;
use organza::record::{Resumed, Run, RunOptions, resume, resume_with};
use organza::scene::{self, LoadOptions, Loaded};
use organza::world::{NothingRemeshed, World};
use remesh::{MaxOf, Metric, SizingContext, SizingField, Uniform};

/// Two sheets side by side; the second is fixed.
const SCENE: &str = r#"{
  frames: 4, substeps: 1, recording: { checkpoint_every_frames: 2 },
  cloths: [
    { mesh: { grid: { size_m: [1, 1], cells: [6, 6] } }, fabric: "woven-light",
      remeshing: { size_m: { min: 0.05, max: 0.3 }, refine_angle: 0.3 } },
    { mesh: { grid: { size_m: [1, 1], cells: [4, 4] } }, fabric: "denim",
      transform: { translate: [2, 0, 0] } },
  ],
  handles: [{ select: { sides: ["left"] } }],
}"#;

fn loaded(text: &str) -> Loaded {
    scene::parse(text, "own.json5", &LoadOptions::default(), &scene::from_sources(&[])).unwrap()
}

/// Leaves every triangle to the other field, and counts how often it was asked.
struct Count(Arc<AtomicUsize>);

impl SizingField for Count {
    fn metric(&self, context: &SizingContext<'_>, at: TriangleId) -> Metric {
        assert_eq!(context.cloth.mesh.panels()[at.index()], 0, "fixed cloth is not asked about");
        self.0.fetch_add(1, Ordering::Relaxed);
        Metric::ZERO
    }
}

#[test]
fn a_field_without_wishes_on_top_changes_no_bit() {
    let loaded = loaded(SCENE);
    let (mut plain, mut counted) = (World::new(&loaded).unwrap(), World::new(&loaded).unwrap());
    let count = Arc::new(AtomicUsize::new(0));
    counted.set_sizing(|scene| MaxOf(Count(count.clone()), scene)).unwrap();
    for _ in 0..4 {
        let faces = counted.cloth.mesh.panels().iter().filter(|&&p| p == 0).count();
        plain.advance().unwrap();
        counted.advance().unwrap();
        assert_eq!(count.swap(0, Ordering::Relaxed), faces);
        assert_eq!(plain.cloth, counted.cloth);
    }
}

#[test]
fn a_field_in_the_place_of_the_scene_s_decides_alone() {
    let mut world = World::new(&loaded(SCENE)).unwrap();
    world.set_sizing(|_| Uniform { size: 0.1 }).unwrap();
    world.advance().unwrap();
    let mesh = &world.cloth.mesh;
    for h in mesh.edges() {
        let fixed = mesh.panels()[h.triangle().index()] == 1;
        assert!(fixed || mesh.material_edge(h).norm() <= 0.1 + 1e-12);
    }
    let fixed = mesh.panels().iter().filter(|&&p| p == 1).count();
    assert_eq!(fixed, 2 * 4 * 4);
}

#[test]
fn a_scene_without_remeshing_has_nothing_to_size() {
    let text = r#"{ frames: 1, cloths: [{ mesh: { grid: { size_m: [1, 1], cells: [1, 1] } },
      fabric: "denim" }] }"#;
    let mut world = World::new(&loaded(text)).unwrap();
    assert_eq!(world.set_sizing(|_| Uniform { size: 0.1 }), Err(NothingRemeshed));
    assert!(world.advance().unwrap().remesh.is_none());
}

/// The world of a scene, meshed evenly.
fn even(loaded: &Loaded) -> Result<World, BuildError> {
    let mut world = World::new(loaded)?;
    world.set_sizing(|_| Uniform { size: 0.12 }).unwrap();
    Ok(world)
}

#[test]
fn its_recording_is_continued_by_the_same_program_alone() {
    let loaded = loaded(SCENE);
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let [whole, part] = ["own-whole.mcap", "own-part.mcap"].map(|name| folder.join(name));
    let start = |path: &Path, frames| {
        let options = RunOptions { frames: Some(frames), checkpoint_every: None, overwrite: true };
        Run::start_with(&loaded, &LoadOptions::default(), path, &options, even).unwrap()
    };
    let end = |mut run: Run| {
        while run.next_frame().unwrap().is_some() {}
        run.finish().unwrap()
    };
    let expected = end(start(&whole, 4));
    end(start(&part, 3));

    let error = resume(&part, Some(4)).unwrap_err().to_string();
    assert!(
        error.contains("own-part.mcap: its world was built by a program of its own"),
        "{error}"
    );
    let Resumed::Continues { from: 2, run, .. } = resume_with(&part, Some(4), even).unwrap() else {
        panic!("frames 3 and 4 are to be made");
    };
    let got = end(*run);
    assert_eq!((got.frame, got.cloth.mesh.triangles()), (4, expected.cloth.mesh.triangles()));
    assert_eq!((&got.cloth.x, &got.cloth.v), (&expected.cloth.x, &expected.cloth.v));
}

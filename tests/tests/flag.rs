//! The adaptive flag: the same bits at one and two threads, a valid mesh in every frame.

use mesh_core::par;
use organza::scene::{self, LoadOptions};
use organza::world::World;
use std::path::Path;

/// Runs the flag for 50 frames, coarser and with fewer steps than the scene has it so that it takes
/// seconds, and returns the state of every frame.
fn run(threads: usize) -> Vec<mesh_core::ClothState> {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/flag.json5");
    let sets = ["cloths[0].remeshing.size_m.min=0.1".to_owned(), "substeps=4".to_owned()];
    let options = LoadOptions { sets: sets.to_vec(), allow_unsupported: false };
    let loaded = scene::load(&scene, &options).unwrap();
    par::with_threads(threads, || {
        let mut world = World::new(&loaded).unwrap();
        (0..50)
            .map(|_| {
                world.advance().unwrap();
                world.cloth.mesh.validate().unwrap();
                world.cloth.clone()
            })
            .collect()
    })
    .unwrap()
}

#[test]
fn same_bits_at_one_and_two_threads() {
    let (one, two) = (run(1), run(2));
    let faces: Vec<usize> = one.iter().map(|c| c.mesh.n_triangles()).collect();
    println!("faces {faces:?}");
    // Enough that the loops do run in parallel, and that the mesh does adapt.
    assert!(faces[49] > 600 && faces[49] != faces[0], "{faces:?}");
    for (frame, (a, b)) in one.iter().zip(&two).enumerate() {
        assert_eq!(a.mesh.triangles(), b.mesh.triangles(), "frame {frame}");
        for (x, y) in a.x.iter().chain(&a.v).zip(b.x.iter().chain(&b.v)) {
            let bits = |p: &mesh_core::World3| [p.x.to_bits(), p.y.to_bits(), p.z.to_bits()];
            assert_eq!(bits(x), bits(y), "frame {frame}");
        }
    }
    let mass = one[0].total_mass();
    assert!(one.iter().all(|c| (c.total_mass() / mass - 1.0).abs() < 1e-12));
    assert!(one.iter().all(|c| (c.mesh.total_area() / 6.0 - 1.0).abs() < 1e-12));
}

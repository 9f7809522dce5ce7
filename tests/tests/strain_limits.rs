//! The adaptive flag stays within its strain limits, in what a frame ends with: after its steps and
//! after remeshing.

use mesh_core::ClothState;
use mesh_core::geometry::{gradient, inverse_edges};
use organza::scene::{self, LoadOptions};
use organza::world::World;
use std::path::Path;

/// Of `scenes/flag.json5`.
const LIMITS: [f64; 2] = [0.95, 1.05];
const TOLERANCE: f64 = 1e-3;

/// Extreme singular values of F over all triangles, from material corners and positions alone.
fn stretches(cloth: &ClothState) -> [f64; 2] {
    let mesh = &cloth.mesh;
    mesh.triangle_ids().fold([f64::INFINITY, 0.0], |[low, high], t| {
        let inverse = inverse_edges(mesh.material()[t.index()]);
        let sigma = gradient(cloth.corners(t), &inverse).singular_values();
        [low.min(sigma.min()), high.max(sigma.max())]
    })
}

/// Runs the flag for 20 frames, coarser than the scene has it so that it takes seconds.
fn run(max_iterations: u32) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/flag.json5");
    let sets = vec![
        "cloths[0].remeshing.size_m.min=0.06".to_owned(),
        format!("newton.max_iterations={max_iterations}"),
    ];
    let loaded = scene::load(&path, &LoadOptions { sets, allow_unsupported: false }).unwrap();
    assert_eq!(loaded.scene.cloths[0].strain_limits, Some(LIMITS));
    let mut world = World::new(&loaded).unwrap();
    let (mut faces, mut collapses, mut flips) = (0, 0, 0);
    let mut widest = [1.0f64, 1.0];
    for frame in 1..=20 {
        let report = world.advance().unwrap();
        let remesh = report.remesh.expect("the flag is remeshed");
        faces = report.faces;
        collapses += remesh.collapses;
        flips += remesh.flips;
        let solved = report.stretch.expect("measured");
        for [min, max] in [[solved.min, solved.max], stretches(&world.cloth)] {
            assert!(min >= LIMITS[0] - TOLERANCE, "frame {frame}: {min}");
            assert!(max <= LIMITS[1] + TOLERANCE, "frame {frame}: {max}");
            widest = [widest[0].min(min), widest[1].max(max)];
        }
    }
    println!("{widest:?}, {faces} faces, {collapses} collapses, {flips} flips");
    // The limits were needed, and so was the remesher.
    assert!(widest[0] < 0.96 && widest[1] > 1.04, "{widest:?}");
    assert!(faces > 1000 && collapses > 100 && flips > 100, "{faces} {collapses} {flips}");
}

/// What remeshing does to the strain.
#[test]
fn every_frame_of_the_flag_is_within_its_limits() {
    run(4);
}

/// With the fast setting, it is the projection that keeps the limits.
#[test]
fn so_it_is_with_one_iteration_a_step() {
    run(1);
}

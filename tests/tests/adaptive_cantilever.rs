//! The heavy elastica on an adaptive mesh: irregular triangles bend as they should.

use cloth_dynamics::law::{Bending, Membrane, Quadratic};
use cloth_dynamics::solver::{LinearSettings, SparseCholesky};
use cloth_dynamics::*;
use mesh_core::generate::{Diagonal, grid};
use mesh_core::{ClothState, World3};
use remesh::{PhysicalSizing, RemeshSettings, remesh};
use std::sync::Arc;

/// Drop and reach (over the length) of a strip clamped level, with Γ = σ g L³/B = 10.
const GAMMA: f64 = 10.0;
const DROP: f64 = 0.70019971551;
const REACH: f64 = 0.65635376124;

/// Bends a strip with remeshing by curvature until it rests, and compares its tip.
#[test]
fn tip_of_the_master_curve_within_three_per_cent() {
    let (length, clamp, density, g) = (0.1, 0.002, 0.2, 9.81);
    let sheet = grid([clamp + length, 0.04], [51, 20], Diagonal::One).unwrap();
    let mut cloth = ClothState::at_rest(sheet.mesh, sheet.positions, vec![density]).unwrap();
    // A mesh bends between the middles of its cells, so the free length begins in the clamped one,
    // which is thin, so that its later refinement hardly matters.
    let free = length + 0.5 * clamp;
    let rigidity = density * g * free.powi(3) / GAMMA;
    let fabric = Fabric {
        density,
        membrane: Membrane::Orthotropic(Quadratic::isotropic(2e4, 0.0).unwrap()),
        bending: Some(Bending::Orthotropic(Quadratic::isotropic(rigidity, 0.0).unwrap())),
        bending_model: BendingModel::ShapeOperator,
        tension_field: false,
        strain_limits: None,
        damping: Damping::default(),
    };
    let environment = Environment { gravity: World3::new(0.0, 0.0, -g), wind: None };
    let sizing = PhysicalSizing {
        refine_angle: 0.06,
        size_min: 0.002,
        size_max: 0.01,
        ..PhysicalSizing::default()
    };
    let held: Vec<u64> = (0..cloth.mesh.n_vertices() as u64)
        .filter(|&i| cloth.x[i as usize].x < clamp + 1e-9)
        .collect();
    let settings = NewtonSettings { max_iterations: 100, tolerance: 1e-7 };
    let mut solver = SparseCholesky::new(LinearSettings::default());
    for round in 0..6 {
        let mut system =
            System::new(&cloth, &Arc::new(vec![fabric.clone()]), &environment, 1.0).unwrap();
        // Whatever the remesher put between the clamped vertices is clamped as well.
        let in_clamp: Vec<u32> = (0..cloth.mesh.n_triangles())
            .flat_map(|t| {
                let corners = cloth.mesh.triangles()[t].iter().zip(&cloth.mesh.material()[t]);
                corners.filter(|(_, u)| u.x < clamp + 1e-9).map(|(i, _)| *i).collect::<Vec<_>>()
            })
            .collect();
        let fixed: Vec<(u32, World3)> =
            in_clamp.iter().map(|&i| (i, cloth.x[i as usize])).collect();
        let constraints = |_| Constraints { fixed: fixed.clone(), springs: Vec::new() };
        for k in 0..1000 {
            let step = Step { time: k as f64 * 0.05, h: 0.05 };
            ImplicitEuler
                .advance(&mut cloth, &mut system, &mut solver, &constraints, &settings, step)
                .unwrap();
            if cloth.v.iter().all(|v| v.norm() < 1e-6) {
                break;
            }
            // Inertia is not wanted: every step starts from rest.
            cloth.v.fill(World3::zeros());
        }
        if round < 5 {
            let keep = RemeshSettings { keep: &held, ..RemeshSettings::default() };
            remesh(&mut cloth, &sizing, &keep).unwrap();
        }
    }
    let end = |i: u32, t: usize| {
        let corners = cloth.mesh.triangles()[t].iter().zip(&cloth.mesh.material()[t]);
        corners.clone().any(|(j, u)| *j == i && u.x > clamp + length - 1e-9)
    };
    let tip: Vec<World3> = (0..cloth.mesh.n_triangles())
        .flat_map(|t| cloth.mesh.triangles()[t].map(|i| (i, t)))
        .filter(|&(i, t)| end(i, t))
        .map(|(i, _)| cloth.x[i as usize])
        .collect();
    let tip = tip.iter().sum::<World3>() / tip.len() as f64;
    let (drop, reach) = (-tip.z / free, (tip.x - 0.5 * clamp) / free);
    println!(
        "{} faces: H/L {drop:.4} ({DROP:.4}), W/L {reach:.4} ({REACH:.4})",
        cloth.mesh.n_triangles()
    );
    assert!(cloth.mesh.n_triangles() < 1500, "the mesh has adapted");
    assert!((drop / DROP - 1.0).abs() < 0.03, "drop {drop}, exact {DROP}");
    assert!((reach / REACH - 1.0).abs() < 0.03, "reach {reach}, exact {REACH}");
}

//! Static shapes against closed-form and computed truth.

mod common;

use cloth_dynamics::law::{Membrane, Quadratic};
use cloth_dynamics::{
    BendingModel, Constraints, ElementModel, Fabric, HingeModel, MembraneModel, RestTriangle,
};
use common::{G, Run, fabric, gravity, hold, sheet};
use mesh_core::World3;
use mesh_core::generate::Diagonal;
use nalgebra::Vector2;
use std::sync::Arc;

/// Drop and reach of a heavy elastica, clamped level: (Γ = σ g L³/B, H/L, W/L).
const CANTILEVER: [(f64, f64, f64); 4] = [
    (1.0, 0.12347140198, 0.99124639535),
    (10.0, 0.70019971551, 0.65635376124),
    (100.0, 0.9375239354, 0.15922338263),
    (1000.0, 0.98114126927, 0.045986454757),
];

/// Drop and reach over the length of a strip with `n` cells along it.
fn cantilever(gamma: f64, n: usize, diagonal: Diagonal) -> (f64, f64) {
    let (length, density) = (0.1, 0.2);
    // One more cell is clamped. A mesh bends between the middles of its cells, so the free length
    // begins in the middle of the clamped one.
    let cell = length / (n as f64 + 0.5);
    let rigidity = density * G * f64::powi(length, 3) / gamma;
    let cloth = sheet([(n + 1) as f64 * cell, 2.0 * cell], [n + 1, 2], diagonal, density);
    let held = hold(&cloth, |x| x.x < 1.5 * cell);
    // Nearly inextensible: the weight stretches it by 1e-6.
    let stretch = density * G * length / 1e-6;
    let mut run = Run::new(cloth, fabric(stretch, rigidity, density), &gravity());
    run.rest(&held, 0.05);
    let end = run.cloth.x.iter().zip(run.cloth.mesh.vertices());
    let tip: Vec<World3> =
        end.filter(|(_, v)| v.index() % (n + 2) == n + 1).map(|(x, _)| *x).collect();
    let tip: World3 = tip.iter().sum::<World3>() / tip.len() as f64;
    (-tip.z / length, (tip.x - 0.5 * cell) / length)
}

/// Within 1 % of the length with elements of half a boundary layer, L/(2√Γ), or finer.
#[test]
fn cantilever_follows_the_master_curve() {
    for (gamma, drop, reach) in CANTILEVER {
        let n = ((2.0 * gamma.sqrt()).ceil() as usize).max(10);
        for diagonal in [Diagonal::One, Diagonal::Alternating] {
            let (h, w) = cantilever(gamma, n, diagonal);
            println!(
                "Γ {gamma}: n {n} {diagonal:?}: H/L {h:.5} ({drop:.5}), W/L {w:.5} ({reach:.5})"
            );
            assert!((h - drop).abs() < 0.01, "Γ {gamma}: H/L {h}, exact {drop}");
            assert!((w - reach).abs() < 0.01, "Γ {gamma}: W/L {w}, exact {reach}");
        }
    }
}

/// Second order: half the element, a quarter of the error.
#[test]
fn cantilever_converges() {
    let (gamma, drop, _) = CANTILEVER[1];
    let errors = [8, 16].map(|n| (cantilever(gamma, n, Diagonal::Alternating).0 - drop).abs());
    println!("errors {errors:?}");
    assert!(errors[1] < 0.35 * errors[0], "{errors:?}");
}

/// (distance of the ends over the length, sag over the length) of an inextensible chain.
#[test]
fn hanging_strip_is_a_catenary() {
    for (span, sag) in [(0.6, 0.36278218524), (0.8, 0.26543750914), (0.95, 0.13589750481)] {
        let n = 64;
        let cloth = sheet([1.0, 0.02], [n, 1], Diagonal::Alternating, 0.2);
        let ends = Constraints {
            fixed: (0..2 * (n as u32 + 1))
                .filter(|i| i % (n as u32 + 1) == 0 || i % (n as u32 + 1) == n as u32)
                .map(|i| {
                    let x = cloth.x[i as usize];
                    (i, World3::new(if x.x > 0.5 { span } else { 0.0 }, x.y, 0.0))
                })
                .collect(),
            springs: Vec::new(),
        };
        let mut run = Run::new(cloth, fabric(1e5, 0.0, 0.2), &gravity());
        // Start from a sagging arc, so that nothing has to buckle.
        for x in &mut run.cloth.x {
            let s = x.x;
            *x = World3::new(span * s, x.y, -4.0 * sag * s * (1.0 - s));
        }
        run.rest(&ends, 0.05);
        let low = run.cloth.x.iter().map(|x| x.z).fold(0.0, f64::min);
        println!("span {span}: sag {:.6}, exact {sag:.6}", -low);
        // The polygon of 64 links is 1.8e-4 low (reference), the stretch 1e-5.
        assert!((-low / sag - 1.0).abs() < 1e-3, "span {span}: sag {low}, exact {sag}");
    }
}

/// Extension of a strip under its own weight, St. Venant–Kirchhoff: (w L / E h, extension / L).
#[test]
fn hanging_strip_stretches_as_stvk() {
    for (load, extension) in [
        (0.001, 0.00049950099738),
        (0.05, 0.023860738),
        (0.2, 0.085350730528),
        (1.0, 0.30535930664),
    ] {
        let n = 64;
        let mut cloth = sheet([0.05, 1.0], [1, n], Diagonal::One, 0.2);
        for x in &mut cloth.x {
            *x = World3::new(x.x, 0.0, -x.y);
        }
        let held = hold(&cloth, |x| x.z > -1e-9);
        let mut run = Run::new(cloth, fabric(0.2 * G / load, 0.0, 0.2), &gravity());
        run.rest(&held, 0.05);
        // The two lower corners carry different shares of the last cell: their mean.
        let [.., a, b] = run.cloth.x[..] else { panic!("a strip has lower corners") };
        let found = -0.5 * (a.z + b.z) - 1.0;
        println!("load {load}: extension {found:.8}, exact {extension:.8}");
        // Lumped masses at 8 elements are off by up to 1.4e-3 (reference), at 64 by 64 times less.
        assert!((found / extension - 1.0).abs() < 5e-4, "load {load}: {found}, exact {extension}");
    }
}

/// Stretched and left free across: (constants, stretch, free stretch, force per width, energy).
#[test]
fn uniaxial_stretch() {
    for (c, along, across, force, energy) in [
        ([100.0, 30.0, 100.0, 35.0], 1.5, 0.79056941504, 85.3125, 17.7734375),
        ([1000.0, 40.0, 200.0, 60.0], 1.05, 0.98969692331, 53.382, 1.302775),
        ([1000.0, 40.0, 200.0, 60.0], 2.0, 0.63245553203, 2976.0, 1116.0),
    ] {
        let cloth = sheet([0.3, 0.2], [3, 2], Diagonal::Alternating, 0.2);
        let law = Quadratic::orthotropic(c[0], c[1], c[2], c[3]).unwrap();
        let fabric = Fabric { membrane: Membrane::Orthotropic(law), ..fabric(1.0, 0.0, 0.2) };
        let rest = Arc::new(RestTriangle::all(&cloth));
        let model = MembraneModel::new(cloth.mesh.triangles(), rest, Arc::new(vec![fabric]));
        let x: Vec<World3> =
            cloth.x.iter().map(|x| World3::new(along * x.x, across * x.y, 0.0)).collect();
        let (mut total, mut pull, mut side) = (0.0, 0.0, 0.0f64);
        for e in 0..model.stencils().len() {
            let corners = model.stencils()[e].map(|i| x[i as usize]);
            total += model.energy(e, &corners);
            for (i, g) in model.stencils()[e].iter().zip(model.gradient(e, &corners)) {
                if cloth.x[*i as usize].x > 0.3 - 1e-9 {
                    pull += g.x;
                }
                if cloth.x[*i as usize].y > 0.2 - 1e-9 {
                    side += g.y;
                }
            }
        }
        assert!((total / 0.06 / energy - 1.0).abs() < 1e-9, "energy {}", total / 0.06);
        assert!((pull / 0.2 / force - 1.0).abs() < 1e-9, "force {}", pull / 0.2);
        assert!(side.abs() < 1e-8 * pull, "the free side pulls by {side}");
    }
}

/// The plain hinge has the pattern-dependent rigidity of the reference table, in units of its
/// constant k = 4 B: equal diagonals, bent at 0°, 45° and 90° to the grid.
#[test]
fn hinge_has_the_known_effective_rigidity() {
    let n = 40;
    let cloth = sheet([1.0, 1.0], [n, n], Diagonal::One, 0.2);
    let fabric = Fabric { bending_model: BendingModel::Hinge, ..fabric(1.0, 0.25, 0.2) };
    let model = HingeModel::new(&cloth.mesh, &Arc::new(vec![fabric])).unwrap();
    for (degrees, expected) in [(0.0f64, 0.252907), (45.0, 0.75), (90.0, 0.252907)] {
        let direction = Vector2::new(degrees.to_radians().cos(), degrees.to_radians().sin());
        let radius = 200.0;
        let bent: Vec<World3> = cloth
            .x
            .iter()
            .map(|x| {
                let (s, t) = (x.xy().dot(&direction), x.xy().perp(&direction));
                World3::new(radius * (s / radius).sin(), t, radius * (s / radius).cos())
            })
            .collect();
        // Away from the border: per cell, by the share of hinges whose edge lies well inside.
        let inside = |x: &World3| (0.2..0.8).contains(&x.x) && (0.2..0.8).contains(&x.y);
        let energy: f64 = (0..model.stencils().len())
            .filter(|&e| {
                let [a, b, ..] = model.stencils()[e].map(|i| cloth.x[i as usize]);
                inside(&((a + b) * 0.5))
            })
            .map(|e| model.energy(e, &model.stencils()[e].map(|i| bent[i as usize])))
            .sum();
        let rigidity = energy / 0.36 * 2.0 * radius * radius;
        println!("{degrees}°: {rigidity:.6} ({expected})");
        // The reference rolled a finite strip, which is 1.2 % off the exact 0.25 at 0° and 90°.
        assert!((rigidity / expected - 1.0).abs() < 0.02, "{degrees}°: {rigidity}, {expected}");
    }
}

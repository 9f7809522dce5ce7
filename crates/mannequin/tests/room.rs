//! Room for cloth: however it moves, no parts of the skin close on each other, and skirts and trousers
//! do not slide down to where they tie the legs together.

use mannequin::{Action, Garment, Mannequin, Motion};
use mesh_core::{Material2, VertexId, World3};
use std::f64::consts::TAU;

const ACTIONS: [Action; 4] = [Action::Walk, Action::Turn, Action::Kick, Action::Dance];
/// Cosine of the angle between normals from which on parts of the skin face each other: a fold is then
/// sharper than 60°.
const FACING: f64 = -0.5;

fn normals(triangles: &[[u32; 3]], x: &[World3]) -> Vec<World3> {
    let mut normals = vec![World3::zeros(); x.len()];
    for t in triangles {
        let [a, b, c] = t.map(|v| x[v as usize]);
        let normal = (b - a).cross(&(c - a));
        t.iter().for_each(|&v| normals[v as usize] += normal);
    }
    normals.iter().map(World3::normalize).collect()
}

/// The smallest distance below `reach` (m) of two vertices that face each other, and which they are.
/// Nothing of the body is as thin as that, so what is behind the skin does not count.
fn narrowest(triangles: &[[u32; 3]], x: &[World3], reach: f64) -> (f64, [usize; 2]) {
    let normals = normals(triangles, x);
    let mut order: Vec<usize> = (0..x.len()).collect();
    order.sort_by(|&a, &b| x[a].z.total_cmp(&x[b].z));
    let mut least = (reach, [0; 2]);
    for (k, &p) in order.iter().enumerate() {
        for &q in order[k + 1..].iter().take_while(|&&q| x[q].z - x[p].z < reach) {
            let distance = (x[q] - x[p]).norm();
            if distance < least.0 && normals[p].dot(&normals[q]) < FACING {
                least = (distance, [p, q]);
            }
        }
    }
    least
}

#[test]
fn no_parts_of_the_skin_close_on_each_other() {
    let reach = 2.0 * Mannequin::ROOM;
    for cell in [0.015, 0.02, 0.04] {
        let standing = Mannequin::new(cell, Motion::STAND).unwrap();
        let rest = standing.positions(0.0);
        for action in ACTIONS {
            let mut least = (reach, String::new());
            for seed in 0..if cell < 0.02 { 4 } else { 9 } {
                // A whole cycle in full, and the way there from level arms.
                let phase = 0.37 * seed as f64;
                for (ease, n) in [(0.0, 24), (1.5, 8)] {
                    let motion = Motion { action, phase, seed, start: 0.0, ease };
                    let body = standing.moving(motion).unwrap();
                    let last = if ease > 0.0 { ease } else { motion.period() };
                    for k in 1..=n {
                        let t = last * f64::from(k) / f64::from(n);
                        let (d, pair) = narrowest(body.triangles(), &body.positions(t), reach);
                        if d < least.0 {
                            let [p, q] = pair.map(|v| rest[v]);
                            least = (d, format!("seed {seed}, {t} s: {p} {q}"));
                        }
                    }
                }
            }
            println!("{action:?}, edges of {cell} m: {:.4} m", least.0);
            assert!(least.0 > Mannequin::ROOM, "{action:?}, edges of {cell} m: {least:?}");
        }
    }
}

/// Length of a string around points, seen from above (m): the integral of how far they reach (Cauchy).
fn string_around(points: &[World3]) -> f64 {
    let n = 360;
    let reach = |k: i32| {
        let (sine, cosine) = (TAU * f64::from(k) / f64::from(n)).sin_cos();
        points.iter().map(|x| x.x * cosine + x.y * sine).fold(f64::NEG_INFINITY, f64::max)
    };
    (0..n).map(reach).sum::<f64>() * TAU / f64::from(n)
}

/// Length of a border in the pattern (m).
fn border_length(garment: Garment, cell: f64, name: &str) -> f64 {
    let sheet = garment.sheet(cell).unwrap();
    let border = sheet.borders.iter().find(|b| b.name == name).unwrap();
    let on_border = |v: u32| border.vertices.contains(&VertexId(v));
    let side = |t: usize, k: usize| {
        let corners = sheet.mesh.triangles()[t];
        let [a, b] = [corners[k], corners[(k + 1) % 3]];
        let pattern: [Material2; 3] = sheet.mesh.material()[t];
        let length = (pattern[k] - pattern[(k + 1) % 3]).norm();
        (on_border(a) && on_border(b)).then_some(length)
    };
    (0..sheet.mesh.n_triangles()).flat_map(|t| (0..3).filter_map(move |k| side(t, k))).sum()
}

#[test]
fn waists_stay_above_the_hips() {
    // Once over the hips, trousers hang lower at every kick, until their crotch ties the legs together;
    // skirts fall.
    let stretch = 1.1;
    let waist = [Garment::Skirt, Garment::Trousers]
        .into_iter()
        .flat_map(|garment| [0.02, 0.03, 0.045, 0.06].map(|cell| (garment, cell)))
        .map(|(garment, cell)| border_length(garment, cell, "waist"))
        .fold(0.0, f64::max);
    for cell in [0.015, 0.04] {
        let standing = Mannequin::new(cell, Motion::STAND).unwrap();
        let rest = standing.positions(0.0);
        let hips: Vec<usize> =
            (0..rest.len()).filter(|&v| (0.9..0.96).contains(&rest[v].z)).collect();
        for action in ACTIONS {
            let mut least = f64::INFINITY;
            for seed in 0..4 {
                let motion = Motion { action, phase: 0.0, seed, start: 0.0, ease: 0.0 };
                let body = standing.moving(motion).unwrap();
                for k in 0..24 {
                    let x = body.positions(motion.period() * f64::from(k) / 24.0);
                    let around: Vec<World3> = hips.iter().map(|&v| x[v]).collect();
                    least = least.min(string_around(&around));
                }
            }
            println!("{action:?}, edges of {cell} m: hips {least:.3} m, waist {waist:.3} m");
            assert!(stretch * waist < least, "{action:?}: hips {least} m, waist {waist} m");
        }
    }
}

#[test]
fn folds_are_found() {
    // Two sheets, 1 cm apart: face to face, and one behind the other.
    let sheet = |z: f64| [[0.0, 0.0, z], [0.1, 0.0, z], [0.0, 0.1, z]].map(World3::from);
    let x = [sheet(0.0), sheet(0.01)].concat();
    let (d, _) = narrowest(&[[0, 1, 2], [3, 5, 4]], &x, 0.04);
    assert!((d - 0.01).abs() < 1e-12, "{d}");
    assert_eq!(narrowest(&[[0, 1, 2], [3, 4, 5]], &x, 0.04).0, 0.04);
}

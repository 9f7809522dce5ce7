//! The skin: closed, smooth, of the size that was asked for, moved as it should be.

use mannequin::{Action, Mannequin, Motion};
use mesh_core::World3;
use std::collections::HashMap;

const ACTIONS: [Action; 4] = [Action::Walk, Action::Turn, Action::Kick, Action::Dance];

fn moving(action: Action, seed: u64) -> Motion {
    Motion { action, seed, phase: 0.3, ..Motion::STAND }
}

fn volume(triangles: &[[u32; 3]], x: &[World3]) -> f64 {
    let signed = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|v| x[v as usize]);
        a.dot(&b.cross(&c)) / 6.0
    };
    triangles.iter().map(signed).sum()
}

#[test]
fn it_is_closed_at_any_resolution() {
    let mut volumes = Vec::new();
    for k in 0..24 {
        let cell = 0.017 + 0.001 * f64::from(k);
        let body = Mannequin::new(cell.min(0.04), Motion::STAND).unwrap_or_else(|e| panic!("{e}"));
        let mut edges: HashMap<(u32, u32), i32> = HashMap::new();
        for &[a, b, c] in body.triangles() {
            for (p, q) in [(a, b), (b, c), (c, a)] {
                *edges.entry((p.min(q), p.max(q))).or_default() += if p < q { 1 } else { -1 };
                assert_ne!(p, q);
            }
        }
        assert!(edges.values().all(|n| *n == 0), "{cell}");
        // A sphere.
        let euler = body.n_vertices() as i64 - edges.len() as i64 + body.triangles().len() as i64;
        assert_eq!(euler, 2, "{cell}");
        volumes.push(volume(body.triangles(), &body.positions(0.0)));
    }
    println!("{volumes:?}");
    // As the edges get shorter, the volume goes to that of the body, from below.
    let finest = volumes[0];
    assert!((0.03..0.09).contains(&finest), "{finest}");
    assert!(volumes.iter().all(|v| (v / finest - 1.0).abs() < 0.06), "{volumes:?}");
}

#[test]
fn edges_are_as_long_as_wanted() {
    for cell in [0.02, 0.03, 0.04] {
        let body = Mannequin::new(cell, Motion::STAND).unwrap();
        let x = body.positions(0.0);
        let lengths = body.triangles().iter().flat_map(|&[a, b, c]| {
            [(a, b), (b, c), (c, a)].map(|(p, q)| (x[p as usize] - x[q as usize]).norm())
        });
        let lengths: Vec<f64> = lengths.collect();
        let mean = lengths.iter().sum::<f64>() / lengths.len() as f64;
        assert!((0.75..1.2).contains(&(mean / cell)), "{cell}: {mean}");
        let longest = lengths.into_iter().fold(0.0, f64::max);
        assert!(longest < 2.2 * cell, "{cell}: {longest}");
        for x in &x {
            assert!(mannequin::body::distance(x).abs() < 2e-3, "{x}");
        }
    }
}

#[test]
fn it_starts_at_rest_and_moves_smoothly() {
    for action in ACTIONS {
        let motion = Motion { start: 0.4, ..moving(action, 7) };
        let body = Mannequin::new(0.04, motion).unwrap();
        let rest = Mannequin::new(0.04, Motion::STAND).unwrap().positions(3.0);
        assert_eq!(body.positions(0.0), body.positions(0.4));
        let off = |a: &[World3], b: &[World3]| {
            a.iter().zip(b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
        };
        assert!(off(&body.positions(0.4), &rest) < 1e-12);
        // No speed beyond that of a fast limb, no acceleration that a jump would give: over a thousand
        // frames.
        let h = 0.002;
        let (mut fastest, mut hardest) = (0.0f64, 0.0f64);
        for k in 0..3000 {
            let t = 0.02 * f64::from(k);
            let x = [t - h, t, t + h].map(|t| body.positions(t));
            for v in (0..rest.len()).step_by(7) {
                fastest = fastest.max((x[2][v] - x[1][v]).norm() / h);
                hardest = hardest.max((x[2][v] - 2.0 * x[1][v] + x[0][v]).norm() / (h * h));
            }
        }
        println!("{action:?}: {fastest} m/s, {hardest} m/s²");
        assert!(fastest < 8.0, "{action:?}: {fastest}");
        assert!(hardest < 80.0, "{action:?}: {hardest}");
    }
}

#[test]
fn joints_repeat_themselves() {
    // Distances between points of the body do not know where it has gone.
    for action in ACTIONS {
        let motion = moving(action, 3);
        let body = Mannequin::new(0.04, motion).unwrap();
        let (a, b) = (body.positions(2.0), body.positions(2.0 + 1000.0 * motion.period()));
        for v in (0..a.len()).step_by(13) {
            let [p, q] = [&a, &b].map(|x| (x[v] - x[0]).norm());
            assert!((p - q).abs() < 1e-6, "{action:?}: {p} {q}");
        }
    }
}

#[test]
fn feet_stay_on_the_floor_and_the_skin_whole() {
    for action in ACTIONS {
        for seed in [0, 1, 2] {
            let body = Mannequin::new(0.03, moving(action, seed)).unwrap();
            let rest = volume(body.triangles(), &body.positions(0.0));
            for k in 0..120 {
                let x = body.positions(0.15 * f64::from(k));
                let lowest = x.iter().map(|x| x.z).fold(f64::INFINITY, f64::min);
                assert!(lowest.abs() < 0.03, "{action:?} {k}: {lowest}");
                let whole = volume(body.triangles(), &x);
                assert!((whole / rest - 1.0).abs() < 0.06, "{action:?} {k}: {whole} {rest}");
            }
        }
    }
}

#[test]
fn seeds_and_phases_make_a_difference() {
    let at = |motion: Motion| Mannequin::new(0.04, motion).unwrap().positions(3.0);
    let plain = moving(Action::Dance, 1);
    assert_eq!(at(plain), at(plain));
    assert_ne!(at(plain), at(moving(Action::Dance, 2)));
    assert_ne!(at(plain), at(Motion { phase: 0.6, ..plain }));
}

#[test]
fn bad_numbers_are_refused() {
    let bad = [
        (0.0, Motion::STAND),
        (0.05, Motion::STAND),
        (f64::NAN, Motion::STAND),
        (0.04, Motion { phase: f64::NAN, ..Motion::STAND }),
        (0.04, Motion { start: f64::INFINITY, ..Motion::STAND }),
        (0.04, Motion { ease: -1.0, ..Motion::STAND }),
    ];
    for (cell, motion) in bad {
        assert!(Mannequin::new(cell, motion).is_err(), "{cell} {motion:?}");
    }
    assert!(Mannequin::new(0.04, Motion { ease: 0.0, ..moving(Action::Kick, 0) }).is_ok());
}

//! Characters: their skin crosses itself nowhere where clothes lie, at rest and in motion.

use collision::intersect::within;
use collision::{Aabb, Bvh, Surface};
use mannequin::{Action, Mannequin, Motion};
use mesh_core::World3;

/// Crossings of the skin with itself at a time (s), by where they are in the body at rest.
fn crossings(body: &Mannequin, surface: &Surface, rest: &[World3], time: f64) -> Vec<World3> {
    let x = body.positions(time);
    let tree = Bvh::build(body.triangles().len(), |t| Aabb::around(&surface.corners(&x, t)));
    within(surface, &x, &tree)
        .iter()
        .map(|found| surface.corners(rest, found.triangle)[0])
        .collect()
}

#[test]
fn skins_do_not_cross_themselves() {
    for action in [Action::Walk, Action::Turn, Action::Kick, Action::Dance] {
        for seed in [0, 1, 5] {
            let motion = Motion { action, seed, ..Motion::STAND };
            let body = Mannequin::new(0.036, motion).unwrap();
            let surface = Surface::new(body.n_vertices(), body.triangles()).unwrap();
            let rest = body.positions(0.0);
            assert!(crossings(&body, &surface, &rest, 0.0).is_empty());
            // A cycle and the time to ease in, at 25 frames a second.
            let n = (25.0 * (motion.period() + motion.ease)).ceil() as u32;
            for k in 1..=n {
                let found = crossings(&body, &surface, &rest, 0.04 * f64::from(k));
                assert!(found.is_empty(), "{action:?} {seed} {k}: {found:.3?}");
            }
        }
    }
}

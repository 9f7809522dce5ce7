//! Ways that run into something, looked at one stage at a time.

use cloth_dynamics::Stage;
use cloth_dynamics::contact::{Blocked, Contact};
use collision::{Body, Surface, swept};
use mesh_core::generate::{self, Diagonal};
use mesh_core::{ClothState, World3};
use organza::contact::{ContactSettings, Obstacles, SurfaceContact};
use std::sync::Arc;

/// Step of the stage (s), and how far the strip comes down in it (m): so little that what is near is
/// still known when the strip has given way.
const H: f64 = 0.01;
const WAY: f64 = 5e-5;

/// A strip of four squares of 0.1 m along the first axis.
fn strip() -> ClothState {
    let sheet = generate::grid([0.4, 0.1], [4, 1], Diagonal::Alternating).unwrap();
    ClothState::at_rest(sheet.mesh, sheet.positions, vec![0.15]).unwrap()
}

/// Triangles at rest that the strip reaches, each below a place of it, after some share of its way.
fn anvils(anvils: &[(f64, f64)]) -> Obstacles {
    let sides = [World3::new(-0.01, -0.02, 0.0), World3::new(0.02, 0.0, 0.0), World3::y() * 0.02];
    let corners = |&(place, share): &(f64, f64)| {
        sides.map(|side| side + World3::new(place, 0.05, -share * WAY))
    };
    let x: Vec<World3> = anvils.iter().flat_map(corners).collect();
    let triangles: Vec<[u32; 3]> =
        (0..anvils.len() as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    Obstacles {
        surface: Surface::new(x.len(), &triangles).unwrap(),
        moves: false,
        friction: vec![0.0; x.len()],
        thickness: vec![None; x.len()],
        motion: Arc::new(move |_| x.clone()),
    }
}

/// What becomes of a strip that comes down on anvils, and how many hits are left; its end from 0.25 m on
/// goes its way whatever is in it.
fn stage(places: &[(f64, f64)]) -> (Result<usize, Blocked>, usize) {
    let (cloth, anvils) = (strip(), anvils(places));
    let settings = ContactSettings { thickness: 0.002, friction: 0.0, self_contact: true };
    let mut contact = SurfaceContact::new(&cloth, Some(&anvils), settings).unwrap();
    let stage = Stage { x_t0: &cloth.x, base: &cloth.x, h: H };
    let target: Vec<World3> = cloth.x.iter().map(|x| x - World3::z() * WAY).collect();
    contact.begin(stage, [0.0, H], &cloth.m, &target);
    let fixed: Vec<bool> = cloth.x.iter().map(|x| x.x >= 0.25).collect();
    let mut x = target.clone();
    let secured = contact.secure(&mut x, &fixed);
    assert!((0..x.len()).all(|i| !fixed[i] || x[i] == target[i]), "held vertices have moved");
    let surface = Surface::new(x.len(), cloth.mesh.triangles()).unwrap();
    let y = (anvils.motion)(H);
    let own = Body::moving(&surface, &cloth.x, &x, &|_| 0.0);
    let other = Body::still(&anvils.surface, &y, &|_| 0.0);
    (secured, swept::impacts_between((own, &own.tree()), (other, &other.tree())).len())
}

/// Under the end that gives way, reached just at the end of the way; and under the held end.
const SOFT: (f64, f64) = (0.05, 1.0);
const HARD: (f64, f64) = (0.35, 0.5);

#[test]
fn what_can_give_way_does() {
    for share in [0.5, 1.0] {
        let (secured, n_hits) = stage(&[(0.05, share)]);
        assert!(secured.unwrap() > 0);
        assert_eq!(n_hits, 0);
    }
}

#[test]
fn what_cannot_give_way_is_an_error() {
    let (secured, n_hits) = stage(&[HARD]);
    assert!(secured.is_err() && n_hits > 0);
}

/// One end gives way, so that there is something to look at again; the other end must not be forgotten
/// over it.
#[test]
fn a_hit_that_nothing_is_done_about_is_not_forgotten() {
    for places in [[SOFT, HARD], [HARD, SOFT]] {
        let (secured, n_hits) = stage(&places);
        let Err(Blocked { place }) = secured else { panic!("{n_hits} hits are left") };
        assert!(place.x > 0.2, "{place}");
    }
}

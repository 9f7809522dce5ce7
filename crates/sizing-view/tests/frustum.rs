//! Distances to the frustum, against plain searches.

mod common;

use common::{camera, look, point};
use mesh_core::World3;
use nalgebra::{DMatrix, DVector, Vector3};
use proptest::prelude::*;
use sizing_view::{Camera, Frustum, Place};

/// Half-spaces n · p ≥ o of a camera's picture in the world.
fn half_spaces(camera: &Camera) -> Vec<(World3, f64)> {
    let axes = camera.world_from_camera();
    let slope = camera.resolution().map(|side| 0.5 * f64::from(side) / camera.focal_px());
    let sides = [(1.0, 0.0, slope[0]), (-1.0, 0.0, slope[0]), (0.0, 1.0, slope[1])];
    let sides = sides.into_iter().chain([(0.0, -1.0, slope[1])]);
    let planes = sides.map(|(x, y, z)| (Vector3::new(x, y, z).normalize(), 0.0));
    let planes = planes.chain([(Vector3::z(), camera.near())]);
    planes.map(|(n, o)| (axes * n, o + (axes * n).dot(&camera.position()))).collect()
}

/// Distance of a point to an intersection of half-spaces: the nearest of its projections to all
/// intersections of up to three planes that lies in all half-spaces.
fn by_enumeration(planes: &[(World3, f64)], p: World3) -> f64 {
    let mut least = f64::INFINITY;
    for chosen in 0u32..1 << planes.len() {
        let active: Vec<_> =
            (0..planes.len()).filter(|i| chosen >> i & 1 == 1).map(|i| planes[i]).collect();
        if active.len() > 3 {
            continue;
        }
        if active.is_empty() {
            if planes.iter().all(|(n, o)| n.dot(&p) >= *o) {
                return 0.0;
            }
            continue;
        }
        let a = DMatrix::from_fn(active.len(), 3, |i, k| active[i].0[k]);
        let b = DVector::from_fn(active.len(), |i, _| active[i].1 - active[i].0.dot(&p));
        let Some(lambda) = (&a * a.transpose()).lu().solve(&b) else { continue };
        let foot = p + Vector3::from_iterator((a.transpose() * lambda).iter().copied());
        if planes.iter().all(|(n, o)| n.dot(&foot) - o >= -1e-9) {
            least = least.min((foot - p).norm());
        }
    }
    least
}

proptest! {
    #[test]
    fn points(camera in camera(), p in point(4.0)) {
        let got = Frustum::new(&camera).distance(&[p; 3]);
        let expected = by_enumeration(&half_spaces(&camera), p);
        prop_assert!((got - expected).abs() < 1e-8, "{got} for {expected}");
    }

    /// The distance of a triangle is the least of its points.
    #[test]
    fn triangles(camera in camera(), corners in prop::array::uniform3(point(4.0))) {
        let frustum = Frustum::new(&camera);
        let distance = frustum.distance(&corners);
        let [a, b, c] = corners;
        const N: usize = 40;
        let mut least = f64::INFINITY;
        for i in 0..=N {
            for k in 0..=N - i {
                let (s, t) = (i as f64 / N as f64, k as f64 / N as f64);
                least = least.min(frustum.distance(&[a + (b - a) * s + (c - a) * t; 3]));
            }
        }
        let step = (b - a).norm().max((c - a).norm()).max((c - b).norm()) / N as f64;
        prop_assert!(distance <= least + 1e-12, "{distance} > {least}");
        prop_assert!(distance >= least - step, "{distance} < {least} - {step}");
    }

    /// What is told of a ball holds for every triangle in it.
    #[test]
    fn balls(
        camera in camera(), centre in point(4.0), radius in 0.0..2.0f64, away in 0.0..1.0f64,
        within in prop::array::uniform3(point(0.57)),
    ) {
        let frustum = Frustum::new(&camera);
        let distance = frustum.distance(&within.map(|p| centre + p * radius));
        match frustum.place_of_ball(centre, radius, away) {
            Place::Inside => prop_assert!(distance == 0.0),
            Place::Away => prop_assert!(distance >= away),
            Place::Between => {}
        }
    }
}

#[test]
fn places_of_which_the_distance_is_known() {
    // 90° from side to side of a square picture, from the origin along +y, with z up.
    let camera = Camera::looking_at(
        World3::zeros(),
        World3::y(),
        World3::z(),
        std::f64::consts::FRAC_PI_2,
        [100, 100],
    );
    let frustum = Frustum::new(&camera.unwrap().with_near(0.5).unwrap());
    let at = |p: [f64; 3]| frustum.distance(&[p.into(); 3]);
    let diagonal = 0.5f64.sqrt();
    for (p, expected) in [
        ([0.0, 2.0, 0.0], 0.0),
        ([2.0, 2.0, -2.0], 0.0),
        ([3.0, 2.0, 0.0], diagonal),
        ([0.0, 2.0, -3.0], diagonal),
        ([0.0, 0.0, 0.0], 0.5),
        ([0.0, -1.5, 0.0], 2.0),
        ([0.5, -1.5, 0.5], 2.0),
        ([1.5, 0.5, 0.0], diagonal),
        // Straight out from the edge (1, 1, 1), and from a corner of the near face.
        ([4.0, 2.0, 4.0], (2.0f64 / 3.0 * 4.0).sqrt()),
        ([1.5, -0.5, 0.5], 2.0f64.sqrt()),
    ] {
        let got = at(p);
        assert!((got - expected).abs() < 1e-12, "{got} at {p:?}, not {expected}");
    }
    // A triangle around the whole frustum, with all corners outside.
    let around = [[-9.0, 2.0, -9.0], [9.0, 2.0, -9.0], [0.0, 2.0, 20.0]].map(World3::from);
    assert_eq!(frustum.distance(&around), 0.0);
    // Behind the camera.
    assert!((frustum.distance(&around.map(|p| p - World3::y() * 3.0)) - 1.5).abs() < 1e-12);
    // A triangle that passes by an edge at the middle of one of its own.
    let by = [[4.0, 2.0, 0.0], [0.0, 2.0, 4.0 - 1e-9], [9.0, 2.0, 9.0]].map(World3::from);
    assert_eq!(frustum.distance(&by), 0.0);
    let past = by.map(|p| p + World3::new(1.0, 0.0, 1.0));
    // The edge's middle (3, 2, 3) against the ray (1, 1, 1) t: t = 8/3.
    assert!((frustum.distance(&past) - (2.0f64 / 3.0).sqrt()).abs() < 1e-8);
}

#[test]
fn no_numbers_count_as_inside() {
    let frustum = Frustum::new(&look([0.0; 3], [0.0, 1.0, 0.0], 1.0));
    let broken = World3::new(f64::NAN, -5.0, 0.0);
    assert_eq!(frustum.distance(&[broken, World3::zeros(), broken]), 0.0);
}

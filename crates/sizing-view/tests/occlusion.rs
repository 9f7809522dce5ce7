//! Cloth behind something else.

mod common;

use common::{crowd, look, point, raw, sheet};
use mesh_core::{ClothState, World3};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;
use sizing_view::{Camera, DepthBuffer, Frustum, Sample, ViewFactors};

/// A wall in the plane y = `y`, from x = −1 to `right` and z = −1 to 1.
fn wall(y: f64, right: f64) -> [[World3; 3]; 2] {
    let [a, b, c, d] =
        [(-1.0, -1.0), (right, -1.0), (right, 1.0), (-1.0, 1.0)].map(|(x, z)| World3::new(x, y, z));
    [[a, b, c], [a, c, d]]
}

/// A sheet that stands in the plane y = `y` and faces −y.
fn standing(size: f64, cells: usize, y: f64) -> ClothState {
    let mut cloth = sheet(size, cells);
    for x in &mut cloth.x {
        *x = World3::new(x.x, y, x.y);
    }
    cloth
}

fn buffer<'a>(camera: &Camera, drawn: impl IntoIterator<Item = &'a [World3; 3]>) -> DepthBuffer {
    let mut depth = DepthBuffer::new(camera, 200, 0.02).unwrap();
    drawn.into_iter().for_each(|corners| depth.draw(corners));
    depth
}

fn triangles(cloth: &ClothState) -> Vec<[World3; 3]> {
    cloth.mesh.triangle_ids().map(|t| cloth.corners(t)).collect()
}

#[test]
fn a_wall_hides_what_is_behind_it() {
    let camera = look([0.0, -3.0, 0.0], [0.0; 3], 1.0);
    let cloth = standing(1.0, 8, 2.0);
    let factors = |drawn: &[[World3; 3]]| {
        let sample = Sample { depth: Some(buffer(&camera, drawn)), ..Sample::new(camera) };
        ViewFactors::evaluate(&cloth, &[sample], &raw()).unwrap().values().to_vec()
    };
    assert_eq!(factors(&[]), vec![1.0; 128]);
    assert_eq!(factors(&wall(1.0, 1.0)), vec![0.2; 128]);
    // Behind the cloth, and from either side of the wall.
    assert_eq!(factors(&wall(2.5, 1.0)), vec![1.0; 128]);
    assert_eq!(factors(&wall(1.0, 1.0).map(|[a, b, c]| [c, b, a])), vec![0.2; 128]);
    // A wall that ends in the middle: the eye sees past its edge x = 0 from x = 0 on.
    let half = factors(&wall(1.0, 0.0));
    for t in cloth.mesh.triangle_ids() {
        let right = cloth.corners(t).iter().map(|x| x.x).fold(-1.0, f64::max);
        let expected = if right < -0.05 { 0.2 } else { 1.0 };
        assert_eq!(half[t.index()], expected, "{right}");
    }
}

/// Hidden from one camera but not from the other is visible.
#[test]
fn all_cameras_must_be_blocked() {
    let front = look([0.0, -3.0, 0.0], [0.0; 3], 1.0);
    let above = look([0.0, 1.0, 2.5], [0.0, 2.0, 0.0], 1.0);
    let cloth = standing(0.5, 4, 2.0);
    let sample = |camera, wall: &[[World3; 3]]| Sample {
        depth: Some(buffer(&camera, wall)),
        ..Sample::new(camera)
    };
    let wall = wall(1.0, 1.0);
    let of = |samples: &[Sample]| {
        ViewFactors::evaluate(&cloth, samples, &raw()).unwrap().values().to_vec()
    };
    assert_eq!(of(&[sample(front, &wall)]), vec![0.2; 32]);
    assert_eq!(of(&[sample(front, &wall), sample(above, &wall)]), vec![1.0; 32]);
}

/// A surface that is drawn does not hide itself, nor a layer within the thickness.
#[test]
fn nothing_hides_itself() {
    let cloth = standing(1.0, 8, 0.0);
    let layer = standing(1.0, 8, 0.015);
    for position in [[0.0, -3.0, 0.0], [2.0, -2.0, 0.5], [0.2, -0.5, 0.1]] {
        let camera = look(position, [0.0; 3], 1.0);
        let depth = buffer(&camera, &triangles(&cloth));
        assert!(triangles(&cloth).iter().all(|c| !depth.hides(c)));
        assert!(triangles(&layer).iter().all(|c| !depth.hides(c)));
    }
}

#[test]
fn what_is_outside_or_too_near_is_not_hidden() {
    let camera = look([0.0, -3.0, 0.0], [0.0; 3], 1.0);
    let depth = buffer(&camera, &wall(-2.0, 1.0));
    let at = |x: f64, y: f64| [[x, y, 0.0], [x + 0.1, y, 0.0], [x, y, 0.1]].map(World3::from);
    assert!(depth.hides(&at(0.0, 1.0)));
    assert!(!depth.hides(&at(20.0, 1.0)));
    assert!(!depth.hides(&at(0.0, -4.0)));
    assert!(!depth.hides(&[[0.0, -4.0, 0.0], [0.0, 2.0, 0.0], [1.0, 2.0, 0.0]].map(World3::from)));
    assert!(!depth.hides(&at(f64::NAN, 1.0)));
    assert!(DepthBuffer::new(&camera, 0, 0.0).is_err());
    assert!(DepthBuffer::new(&camera, 2048, 0.0).is_err(), "too many columns");
    assert!(DepthBuffer::new(&camera, 64, -1.0).is_err());
}

/// What is hidden is so in its middle: the ray to it meets a drawn triangle.
#[test]
fn hidden_is_hidden() {
    let crowd = triangles(&crowd(4, 6, 1.0));
    let mut runner = TestRunner::deterministic();
    let mut n_hidden = 0;
    for _ in 0..60 {
        let place = (point(3.0), point(1.0)).new_tree(&mut runner).unwrap().current();
        let camera = look(place.0.into(), place.1.into(), 1.0);
        let depth = buffer(&camera, &crowd);
        for _ in 0..100 {
            let (at, size) = (point(4.0), prop::array::uniform3(point(0.05)))
                .new_tree(&mut runner)
                .unwrap()
                .current();
            if !depth.hides(&size.map(|p| at + p)) {
                continue;
            }
            let middle = at + (size[0] + size[1] + size[2]) / 3.0;
            // Only where the middle is in the picture can the buffer tell.
            if Frustum::new(&camera).distance(&[middle; 3]) > 0.0 {
                continue;
            }
            n_hidden += 1;
            let ray = middle - camera.position();
            let met = crowd.iter().any(|t| {
                let [p, q, r] = t.map(|x| x - camera.position());
                let sides = [p.cross(&q), q.cross(&r), r.cross(&p)].map(|n| n.dot(&ray));
                let n = (q - p).cross(&(r - p));
                let along = n.dot(&p) / n.dot(&ray);
                let same = sides.iter().all(|&s| s >= 0.0) || sides.iter().all(|&s| s <= 0.0);
                same && along > 0.0 && along < 1.0
            });
            assert!(met, "nothing before {middle:?} for {camera:?}");
        }
    }
    assert!(n_hidden > 100, "only {n_hidden} were hidden");
}

//! The way out of a tangle.
//!
//! Where a contour cuts a part off one of its surfaces, a plug, that comes out along some direction
//! after the longest of the ways from its points to the surface it goes through. And where the contour
//! gets shorter as the one side moves against the other as a whole, it is gone after its length over
//! the slope (the global scheme of Volino2006). The shorter of these ways is taken. The first knows what
//! to do where lengths do not change, as with a strip that hangs through a slit; the second where
//! nothing is cut off, as with two strips in each other's slits.

use super::region::{Regions, Traces};
use collision::contour::Push;
use collision::{Aabb, Surface};
use mesh_core::World3;
use std::collections::HashSet;

/// Points of a plug that are looked at.
const MAX_SAMPLES: usize = 24;
/// The least slope of a length that counts (1).
const MIN_SLOPE: f64 = 0.3;

/// How a contour is to be undone.
pub(super) struct Exit {
    /// Where the first side of the contour goes against the second; `None` where each crossing is on its
    /// own.
    pub(super) direction: Option<World3>,
    /// Vertices that may go through `wall`.
    pub(super) plug: Vec<u32>,
    pub(super) wall: Vec<u32>,
}

impl Exit {
    /// Of a contour of some length (m), on which things go no further than `way` in the stage (m).
    pub(super) fn find(
        surface: &Surface,
        x: &[World3],
        regions: &mut Regions,
        traces: &Traces,
        own: &[(&Push, f64)],
        length: f64,
        way: f64,
    ) -> Exit {
        let corners = |side: usize| -> Vec<u32> {
            let t = traces.triangles[side].iter();
            sorted(t.flat_map(|&t| surface.triangles()[t as usize]).collect())
        };
        let sides = [corners(0), corners(1)];
        let near = |vertices: &[u32], room: f64| {
            Aabb::around(&vertices.iter().map(|&v| x[v as usize]).collect::<Vec<_>>()).grown(room)
        };
        let mut exit = Exit {
            direction: None,
            plug: sides[0].clone(),
            wall: around(surface, x, &traces.triangles[1], &near(&sides[0], 2.0 * way), &sides[0])
                .1,
        };
        let slope: World3 = own.iter().map(|(push, sign)| push.gradient * *sign).sum();
        let mut best = f64::INFINITY;
        if slope.norm() > MIN_SLOPE {
            best = length / slope.norm();
            exit.direction = Some(-slope / slope.norm());
        }
        for side in 0..2 {
            let ends = traces.edges[side].iter().flat_map(|&e| surface.edges()[e as usize]);
            let cut_off: Vec<u32> = sorted(ends.map(|v| regions.of(v)).collect());
            // A slit cuts nothing off.
            if cut_off.len() < 2 {
                continue;
            }
            for region in cut_off {
                if !regions.is_minor(region) {
                    continue;
                }
                let plug = regions.vertices(region);
                let extent = near(plug, 0.0);
                let size = extent.extent();
                let with_ring = sorted([plug, &sides[side]].concat());
                let beyond = extent.grown(size + 2.0 * way);
                let (triangles, _) =
                    around(surface, x, &traces.triangles[1 - side], &beyond, &with_ring);
                let beside = near(&with_ring, 2.0 * way);
                let wall = triangles
                    .iter()
                    .filter(|&&t| surface.triangle_box(x, t).overlaps(&beside))
                    .flat_map(|&t| surface.triangles()[t as usize]);
                let wall = sorted(wall.collect());
                let mean_normal: World3 =
                    traces.triangles[1 - side].iter().map(|&t| normal(surface, x, t)).sum();
                let found = shortest(surface, x, plug, &triangles, [size, best], mean_normal);
                if let Some((distance, direction)) = found {
                    best = distance;
                    let sign = if side == 0 { 1.0 } else { -1.0 };
                    exit.direction = Some(direction * sign);
                    (exit.plug, exit.wall) = (with_ring, wall);
                }
            }
        }
        exit
    }
}

fn sorted(mut list: Vec<u32>) -> Vec<u32> {
    list.sort_unstable();
    list.dedup();
    list
}

fn normal(surface: &Surface, x: &[World3], t: u32) -> World3 {
    let [a, b, c] = surface.corners(x, t);
    (b - a).cross(&(c - a))
}

/// Triangles that hang together with some, come into a box, and have no vertex among `others`; and
/// their vertices.
fn around(
    surface: &Surface,
    x: &[World3],
    from: &[u32],
    room: &Aabb,
    others: &[u32],
) -> (Vec<u32>, Vec<u32>) {
    let (mut seen, mut list) = (HashSet::new(), Vec::new());
    for &t in from {
        if seen.insert(t) {
            list.push(t);
        }
    }
    let mut next = 0;
    while next < list.len() {
        for e in surface.edges_of(list[next]) {
            for &t in surface.triangles_at(e) {
                let corners = surface.triangles()[t as usize];
                if !seen.contains(&t)
                    && surface.triangle_box(x, t).overlaps(room)
                    && corners.iter().all(|v| others.binary_search(v).is_err())
                {
                    seen.insert(t);
                    list.push(t);
                }
            }
        }
        next += 1;
    }
    let vertices = sorted(list.iter().flat_map(|&t| surface.triangles()[t as usize]).collect());
    (list, vertices)
}

/// The direction in which all points of a plug are soonest through some triangles, and how far that
/// is (m); `None` if it is no less than `limit`. Points that never are count as twice the size of the plug.
fn shortest(
    surface: &Surface,
    x: &[World3],
    plug: &[u32],
    triangles: &[u32],
    [size, limit]: [f64; 2],
    mean_normal: World3,
) -> Option<(f64, World3)> {
    let stride = plug.len().div_ceil(MAX_SAMPLES);
    let samples: Vec<World3> = plug.iter().step_by(stride).map(|&v| x[v as usize]).collect();
    let mut directions = Vec::new();
    for i in -1..=1 {
        for j in -1..=1 {
            for k in -1..=1 {
                directions.push(World3::new(f64::from(i), f64::from(j), f64::from(k)));
            }
        }
    }
    directions.extend([mean_normal, -mean_normal]);
    // The sheets of what is passed through say more about the way than any fixed directions do.
    let mut best = (limit, None);
    for direction in directions {
        let Some(direction) = direction.try_normalize(0.0) else { continue };
        let (mut longest, mut missed) = (0.0f64, 0);
        let cost = |longest: f64, missed: usize| {
            longest + 2.0 * size * missed as f64 / samples.len() as f64
        };
        for from in &samples {
            let hits =
                triangles.iter().filter_map(|&t| hit(from, &direction, &surface.corners(x, t)));
            let nearest = hits.fold(f64::INFINITY, f64::min);
            if nearest.is_finite() {
                longest = longest.max(nearest);
            } else {
                missed += 1;
            }
            if cost(longest, missed) >= best.0 {
                break;
            }
        }
        if 2 * missed <= samples.len() && cost(longest, missed) < best.0 {
            best = (cost(longest, missed), Some(direction));
        }
    }
    best.1.map(|direction| (best.0, direction))
}

/// How far a point is from a triangle along a direction (m).
fn hit(from: &World3, direction: &World3, [a, b, c]: &[World3; 3]) -> Option<f64> {
    let (ab, ac, to) = (b - a, c - a, from - a);
    let p = direction.cross(&ac);
    let volume = ab.dot(&p);
    let q = to.cross(&ab);
    let (u, v) = (to.dot(&p) / volume, direction.dot(&q) / volume);
    let t = ac.dot(&q) / volume;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0).then_some(t)
}

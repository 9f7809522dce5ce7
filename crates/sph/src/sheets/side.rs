//! No particle comes to the other side of a surface.
//!
//! The distance of a point from a triangle changes no faster than the point moves relative to the
//! fastest corner. So a particle goes on for as long as that cannot use up its distance from any
//! triangle, looks again, and so on to the end of the step (conservative advancement, Mirtich1996): the
//! distance is never zero on the way. Where it has become small the particle stops coming closer, which
//! is an inelastic impact.

use super::{FARTHEST, Sheets, triangle};
use crate::grid::Point;
use crate::motion::Moved;
use crate::place::squared_distance;
use crate::settings::Bounds;
use crate::state::State;
use nalgebra::Vector3;

/// Distance from a surface at which a particle stops coming closer, in spacings (1).
pub(super) const FLOOR: f64 = 0.1;
/// How often a path is looked at again. Each time at most half of the distance is used up.
const ROUNDS: usize = 64;

/// A triangle on its way through a step.
#[derive(Clone, Copy, Debug)]
struct Moving {
    name: u32,
    from: [Vector3<f64>; 3],
    /// Where its corners go in the step (m).
    ways: [Vector3<f64>; 3],
}

/// An impact: on which triangle and where, from which side (1), and where that point goes (m).
#[derive(Clone, Copy, Debug)]
struct Impact {
    name: u32,
    weights: [f64; 3],
    normal: Vector3<f64>,
    way: Vector3<f64>,
}

/// Where a particle ends, and what it met.
#[derive(Debug)]
struct Path {
    end: Vector3<f64>,
    impacts: Vec<Impact>,
    /// Surfaces left it no room, and it was carried along with the nearest of them.
    is_squeezed: bool,
}

/// How many particles were kept from coming closer, and how many had no room.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Kept {
    pub(crate) stopped: u64,
    pub(crate) squeezed: u64,
    /// The longest way of a particle that was kept (m).
    pub(crate) longest_way: f64,
}

impl Sheets {
    /// Keeps particles on their sides in a step of `dt` (s), between [`Sheets::begin_step`] and
    /// [`Sheets::end_step`], where `moved` has their motion. Particles have this `mass` (kg).
    pub(crate) fn keep_sides(
        &mut self,
        state: &mut State,
        moved: &mut Moved,
        (listed, domain): (&[Point], &Bounds),
        (mass, dt): (f64, f64),
        is_restrained: bool,
    ) -> Kept {
        let floor = FLOOR * self.spacing;
        let surface_way = self.longest_way * (dt / self.duration);
        let n_movers = moved.movers.len();
        let (mut kept, mut at, mut near) = (Kept::default(), 0, Vec::new());
        for k in 0..self.near.who.len() {
            let i = self.near.who[k] as usize;
            let slot = if is_restrained {
                while at < n_movers && (moved.movers[at] as usize) < i {
                    at += 1;
                }
                (at < n_movers && moved.movers[at] as usize == i).then_some(at)
            } else {
                Some(i)
            };
            let before = &state.x[i].clone();
            let after = slot.map_or(before, |slot| &moved.x[slot]);
            let start = Vector3::new(before[0], before[1], before[2]);
            let way = Vector3::new(after[0], after[1], after[2]) - start;
            if way.norm_squared() == 0.0 && surface_way == 0.0 {
                continue;
            }
            let longest = way.norm() + 2.0 * (surface_way + floor);
            let reach = FARTHEST * self.spacing + longest + surface_way;
            if self.near.nearest[k] > reach * reach {
                continue;
            }
            self.triangles_near(k, before, reach, &mut near);
            let Some(path) = path(start, way, &near, floor, longest) else { continue };
            let u = &moved.u[i];
            let mut u = Vector3::new(u[0], u[1], u[2]);
            let w = slot.map_or(&[0.0; 4], |slot| &moved.w[slot]);
            let mut w = Vector3::new(w[0], w[1], w[2]);
            for impact in &path.impacts {
                let v = impact.way / dt;
                let approach = (u - v).dot(&impact.normal).min(0.0);
                u -= impact.normal * approach;
                w -= impact.normal * (w - v).dot(&impact.normal).min(0.0);
                let impulse = impact.normal * (mass * approach);
                self.hit(impact.name, &impact.weights, &impulse);
                (0..3).for_each(|c| state.given[i][c] += impulse[c]);
            }
            kept.stopped += u64::from(!path.impacts.is_empty());
            kept.squeezed += u64::from(path.is_squeezed);
            kept.longest_way = kept.longest_way.max((path.end - start).norm());
            let now = (slot, [path.end, u, w]);
            moved.correct(i, now, state, listed, domain);
        }
        kept
    }

    /// The triangles with a part whose middle is within `reach` (m) of the `k`th particle, at `p`.
    fn triangles_near(&self, k: usize, p: &Point, reach: f64, near: &mut Vec<Moving>) {
        near.clear();
        for &s in self.near.samples(k) {
            if squared_distance(p, &self.places[s as usize]) > reach * reach {
                continue;
            }
            let name = self.samples[s as usize].triangle;
            if near.iter().rev().all(|moving| moving.name != name) {
                let corners = self.triangles[name as usize];
                let from = corners.map(|c| self.x[c as usize]);
                let ways = corners.map(|c| self.next[c as usize] - self.x[c as usize]);
                near.push(Moving { name, from, ways });
            }
        }
    }
}

/// The path of a point that would go a `way` (m) if there were no triangles; `None` if it can go it, and
/// stays `floor` (m) off. It goes no farther than `longest` (m).
fn path(
    start: Vector3<f64>,
    mut way: Vector3<f64>,
    triangles: &[Moving],
    floor: f64,
    longest: f64,
) -> Option<Path> {
    let (mut x, mut time, mut gone) = (start, 0.0, 0.0);
    let mut impacts: Vec<Impact> = Vec::new();
    let mut nearest = None;
    for round in 0..ROUNDS {
        // What is left of the step that is surely without a crossing.
        let mut ahead: f64 = 1.0 - time;
        let mut is_free = true;
        let here: Vec<_> = triangles.iter().map(|moving| moving.look(&x, time)).collect();
        for (moving, (weights, normal, distance)) in triangles.iter().zip(&here) {
            let surface = triangle::at(weights, &moving.ways);
            let opening = (way - surface).dot(normal);
            // What has come too close goes back.
            let wanted = floor - distance;
            if *distance <= floor && opening < wanted {
                way += normal * (wanted - opening);
                is_free = false;
                if opening < 0.0 {
                    impacts.retain(|impact| impact.name != moving.name);
                    let (name, weights, normal) = (moving.name, *weights, *normal);
                    impacts.push(Impact { name, weights, normal, way: surface });
                }
            }
        }
        for (k, (moving, (_, _, distance))) in triangles.iter().zip(&here).enumerate() {
            let speed = moving.ways.iter().map(|of| (way - of).norm()).fold(0.0, f64::max);
            let room = distance - 0.5 * floor.min(*distance);
            if speed * ahead > room {
                ahead = room / speed;
                nearest = Some(k);
            }
        }
        if round == 0 && is_free && ahead == 1.0 {
            return None;
        }
        gone += way.norm() * ahead;
        if gone > longest {
            break;
        }
        x += way * ahead;
        time += ahead;
        if time >= 1.0 {
            return Some(Path { end: x, impacts, is_squeezed: false });
        }
    }
    let end = match nearest.map(|k: usize| &triangles[k]) {
        Some(moving) => x + triangle::at(&moving.look(&x, time).0, &moving.ways) * (1.0 - time),
        None => x,
    };
    Some(Path { end, impacts, is_squeezed: true })
}

impl Moving {
    /// Its point closest to `x` at a time of the step (1), the direction from there to `x`, and the
    /// distance (m).
    fn look(&self, x: &Vector3<f64>, time: f64) -> ([f64; 3], Vector3<f64>, f64) {
        let corners = [0, 1, 2].map(|c| self.from[c] + self.ways[c] * time);
        let weights = triangle::closest(x, &corners);
        let off = x - triangle::at(&weights, &corners);
        let distance = off.norm();
        let normal = if distance > 0.0 { off / distance } else { Vector3::zeros() };
        (weights, normal, distance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// How far the point stays off (m).
    const FLOOR: f64 = 0.05;

    /// Signed volume of the tetrahedron of a point and a triangle: its sign is the side.
    fn side(x: &Vector3<f64>, [a, b, c]: &[Vector3<f64>; 3]) -> f64 {
        (b - a).cross(&(c - a)).dot(&(x - a))
    }

    proptest! {
        /// Two large triangles that move at random: a point between them stays between them.
        #[test]
        fn points_stay_on_their_sides(
            height in 1.1 * FLOOR..0.3f64,
            gap in 1.1 * FLOOR..0.3f64,
            ways in prop::collection::vec(-0.2..0.2f64, 9),
        ) {
            let far = 20.0;
            let plane = |z: f64| {
                [[-far, -far, z], [far, -far, z], [0.0, far, z]].map(Vector3::from)
            };
            let up = |z: f64| Vector3::new(0.0, 0.0, z);
            // The upper one leaves room on both sides of the point.
            let lower = [ways[0], ways[1], ways[2]];
            let upper = [0, 1, 2].map(|k| lower[k] + ways[k + 3].max(2.1 * FLOOR - height - gap));
            let triangles = [
                Moving { name: 0, from: plane(0.0), ways: lower.map(up) },
                Moving { name: 1, from: plane(height + gap), ways: upper.map(up) },
            ];
            let start = up(height);
            let way = Vector3::new(ways[6], ways[7], 5.0 * ways[8]);
            let found = path(start, way, &triangles, FLOOR, 10.0);
            let end = found.map_or(start + way, |path| {
                assert!(!path.is_squeezed, "{path:?}");
                path.end
            });
            let after = triangles.map(|m| [0, 1, 2].map(|c| m.from[c] + m.ways[c]));
            prop_assert!(side(&end, &after[0]) > 0.0, "below: {:?}", end);
            prop_assert!(side(&end, &after[1]) < 0.0, "above: {:?}", end);
        }
    }

    #[test]
    fn a_point_without_room_is_told() {
        let plane = |z: f64| [[-9.0, -9.0, z], [9.0, -9.0, z], [0.0, 9.0, z]].map(Vector3::from);
        let way = |z: f64| [Vector3::new(0.0, 0.0, z); 3];
        let triangles = [
            Moving { name: 0, from: plane(0.0), ways: way(0.2) },
            Moving { name: 1, from: plane(0.2), ways: way(-0.2) },
        ];
        let path = path(Vector3::new(0.0, 0.0, 0.1), Vector3::zeros(), &triangles, 0.05, 10.0);
        assert!(path.is_some_and(|path| path.is_squeezed));
    }
}

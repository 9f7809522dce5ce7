//! What leads a crossing out: a spring that is at rest at the end of the stage if the edge has gone the
//! wanted way against the triangle, and what lets a plug follow. Both work between things, so that they
//! conserve the momentum of cloth; both are quadratic and bounded, so that a stage stays convex.

use super::Start;
use cloth_dynamics::solver::BlockMatrix;
use collision::contour::Push;
use mesh_core::World3;
use nalgebra::Matrix3;

/// Stiffness in units of the mass of what moves over h².
const STIFFNESS: f64 = 20.0;
/// The same across the way: things that cross do not slide about freely.
const GRIP: f64 = 1.0;
/// The same between neighbours in a plug.
const TOGETHER: f64 = 20.0;

/// One crossing on its way.
pub(in crate::contact) struct Drive {
    /// Vertices of the cloth, with the weights that give the edge's point less the triangle's.
    parts: Vec<(u32, f64)>,
    /// Less the offset at the start of the stage, and what obstacles do to it (m).
    offset: World3,
    /// The wanted way (m).
    want: World3,
    stiffness: Matrix3<f64>,
}

impl Drive {
    /// `None` if nothing moves.
    pub(super) fn new(
        push: &Push,
        want: World3,
        start: &Start<'_>,
        n_cloth: usize,
    ) -> Option<Drive> {
        let (mut parts, mut offset) = (Vec::with_capacity(5), World3::zeros());
        let mut mobility = 0.0;
        for (&v, &weight) in push.vertices.iter().zip(&push.weights) {
            let i = v as usize;
            if i < n_cloth {
                parts.push((v, weight));
                offset -= start.x[i] * weight;
                mobility += weight * weight / start.inertia[i];
            } else {
                let [now, then] = start.obstacles.map(|y| y[i - n_cloth]);
                offset += (then - now) * weight;
            }
        }
        let direction = want.try_normalize(0.0)?;
        let along = direction * direction.transpose();
        let stiffness = along * STIFFNESS + (Matrix3::identity() - along) * GRIP;
        (mobility > 0.0).then(|| Drive { parts, offset, want, stiffness: stiffness / mobility })
    }

    /// What keeps two vertices of a plug together: it follows its crossings without being left behind
    /// or thrown about.
    pub(super) fn together(edge: [u32; 2], start: &Start<'_>) -> Drive {
        let [i, j] = edge.map(|v| v as usize);
        let mobility = 1.0 / start.inertia[i] + 1.0 / start.inertia[j];
        Drive {
            parts: vec![(edge[0], 1.0), (edge[1], -1.0)],
            offset: start.x[j] - start.x[i],
            want: World3::zeros(),
            stiffness: Matrix3::identity() * (TOGETHER / mobility),
        }
    }

    /// How far the crossing is off its way (m).
    fn off(&self, x: &[World3]) -> World3 {
        let of_cloth: World3 = self.parts.iter().map(|&(v, w)| x[v as usize] * w).sum();
        of_cloth + self.offset - self.want
    }

    /// Pairs of vertices that it couples.
    pub(in crate::contact) fn couples(&self) -> impl Iterator<Item = [u32; 2]> + '_ {
        let with = |(a, &(i, _)): (usize, &(u32, f64))| {
            self.parts[..a].iter().map(move |&(j, _)| [i, j]).collect::<Vec<_>>()
        };
        self.parts.iter().enumerate().flat_map(with)
    }

    pub(in crate::contact) fn energy(&self, x: &[World3]) -> f64 {
        let off = self.off(x);
        0.5 * off.dot(&(self.stiffness * off))
    }

    pub(in crate::contact) fn add_gradient(&self, x: &[World3], gradient: &mut [World3]) {
        let force = self.stiffness * self.off(x);
        for &(i, weight) in &self.parts {
            gradient[i as usize] += force * weight;
        }
    }

    pub(in crate::contact) fn add_stiffness(&self, to: &mut BlockMatrix) {
        for (a, &(i, weight)) in self.parts.iter().enumerate() {
            for &(j, other) in &self.parts[..=a] {
                let (row, column) = (i.max(j) as usize, i.min(j) as usize);
                let slot = to.pattern().slot(row, column).expect("there is room for contact");
                to.add(slot, &(self.stiffness * (weight * other)));
            }
        }
    }
}

//! Momenta at the end of a stage.

use super::Resting;
use super::local::WholeStage;
use crate::integrator::StageStart;
use crate::solve_report::RestReport;
use mesh_core::World3;

/// Excess of a momentum over that up to which its vertex rests that is no more than what stages are solved
/// to (1).
const OVER: f64 = 2e-4;
/// Share of the momentum up to which a vertex rests that more is cut to where it should be less: rounding
/// must not take it out again.
const INSIDE: f64 = 1.0 - 1e-12;

impl Resting {
    /// Momenta over mass at the end of the stage (m/s); velocities where momentum bleeds.
    pub(super) fn momenta(
        &self,
        whole: &WholeStage<'_>,
        x: &[World3],
        gradient: &[World3],
        is_solved: bool,
        report: &mut RestReport,
    ) -> Vec<World3> {
        let &StageStart { base, h, time, .. } = whole.start;
        let mut v = whole.start.velocity.to_vec();
        if whole.stands.is_some() {
            for i in (0..v.len()).filter(|&i| self.active[i]) {
                v[i] = (x[i] - base[i]) / h;
            }
            return v;
        }
        self.settle(&mut v, &whole.cloth.m, time);
        for (i, v) in v.iter_mut().enumerate().filter(|(i, _)| self.active[*i]) {
            let d = x[i] - base[i];
            if whole.fixed[i] || d != World3::zeros() {
                let held = &whole.held[i];
                *v = d / h;
                if !whole.fixed[i] && !held.is_free() {
                    let conjugate = held.conjugate().expect("it was convex before the stage");
                    let by_force = whole.p[i] - gradient[i] * h;
                    let p = if is_solved && conjugate.is_vague(&by_force, &d, h) {
                        by_force
                    } else {
                        conjugate.momentum(v)
                    };
                    *v = p / whole.cloth.m[i];
                }
                continue;
            }
            let mut p = whole.p[i] - gradient[i] * h;
            let (norm, most) = (p.norm(), whole.held[i].p_r());
            if norm > (1.0 + OVER) * most {
                // Left over by a stage that did not converge, it would be energy from nowhere.
                report.cut += 1;
                p *= INSIDE * most / norm;
            }
            *v = p / whole.cloth.m[i];
        }
        v
    }
}

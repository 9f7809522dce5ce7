//! Strain limits: principal stretches are kept in bounds by a stiff spring that acts in a band
//! before each bound.
//!
//! Each singular value σ of F pays for entering the last fifth of its way from rest to a bound. The
//! stiffness rises smoothly at the start of this band and is constant from there on, also beyond the
//! bound, which is reached at the load [`STRENGTH`]. A barrier that is infinite at the bound would
//! need a feasible start, which remeshing, moved handles and scenes cannot promise, and takes
//! Newton's method three times as many iterations.

use crate::element::{ElementModel, ElementSystem, Stiffness, chosen};
use crate::fabric::{Fabric, StrainLimits};
use crate::force::Stage;
use crate::rest::RestTriangle;
use mesh_core::World3;
use nalgebra::{Matrix2, Matrix3, Matrix3x2};
use std::sync::Arc;

/// Line load (N/m) at which a principal stretch reaches its bound, of the order of what tears a light
/// woven fabric: cloth that does not tear stays within its limits.
pub const STRENGTH: f64 = 5e3;
/// The band next to the bound in which the limit acts, as a share of its distance from rest.
const BAND: f64 = 0.2;
/// The part of the band over which the stiffness rises from zero to its full value.
const RISE: f64 = 0.25;

/// Energy density (J/m²) of one principal stretch and its first two derivatives.
fn penalty(limits: &StrainLimits, sigma: f64) -> [f64; 3] {
    let mut total = [0.0; 3];
    // Distance to the bound, the sign of an outward stretch, and the bound's distance from rest.
    for (gap, sign, reach) in
        [(limits.max - sigma, 1.0, limits.max - 1.0), (sigma - limits.min, -1.0, 1.0 - limits.min)]
    {
        let delta = BAND * reach;
        let t = 1.0 - gap / delta;
        if t > 0.0 {
            // The load is STRENGTH at t = 1.
            let k = STRENGTH / (delta * (1.0 - 0.5 * RISE));
            let [energy, load, stiffness] = if t < RISE {
                [t * t * t / (6.0 * RISE), t * t / (2.0 * RISE), t / RISE]
            } else {
                let s = t - 0.5 * RISE;
                [0.5 * s * s + RISE * RISE / 24.0, s, 1.0]
            };
            total[0] += k * delta * delta * energy;
            total[1] += sign * k * delta * load;
            total[2] += k * stiffness;
        }
    }
    total
}

/// Singular values σ₁ ≥ σ₂ ≥ 0 of F and its right singular vectors as columns.
pub fn principal_stretches(f: &Matrix3x2<f64>) -> ([f64; 2], Matrix2<f64>) {
    let c = f.tr_mul(f);
    let half = 0.5 * (c[(0, 0)] - c[(1, 1)]);
    let radius = (half * half + c[(0, 1)] * c[(0, 1)]).sqrt();
    let mean = 0.5 * (c[(0, 0)] + c[(1, 1)]);
    // The smaller one from the area, which does not cancel.
    let high = (mean + radius).max(0.0).sqrt();
    let area = f.column(0).cross(&f.column(1)).norm();
    let low = if high > 0.0 { area / high } else { 0.0 };
    // Half-angle of (half, c₀₁): the direction of the larger stretch.
    let (x, y) = if radius == 0.0 {
        (1.0, 0.0)
    } else if half >= 0.0 {
        (half + radius, c[(0, 1)])
    } else {
        (c[(0, 1)].abs(), (radius - half).copysign(c[(0, 1)]))
    };
    let n = (x * x + y * y).sqrt();
    let (x, y) = (x / n, y / n);
    ([high, low], Matrix2::new(x, -y, y, x))
}

/// The triangles whose fabric has limits.
#[derive(Clone, Debug)]
pub(crate) struct Limited {
    pub(crate) stencils: Vec<[u32; 3]>,
    triangles: Vec<u32>,
    rest: Arc<Vec<RestTriangle>>,
    fabrics: Arc<Vec<Fabric>>,
}

impl Limited {
    /// Those among the given triangles; `None` if there are none.
    pub(crate) fn new(
        triangles: &[[u32; 3]],
        rest: Arc<Vec<RestTriangle>>,
        fabrics: Arc<Vec<Fabric>>,
    ) -> Option<Self> {
        let limited: Vec<u32> = (0..rest.len() as u32)
            .filter(|&t| fabrics[rest[t as usize].panel as usize].strain_limits.is_some())
            .collect();
        let stencils = limited.iter().map(|&t| triangles[t as usize]).collect();
        (!limited.is_empty()).then_some(Limited { stencils, triangles: limited, rest, fabrics })
    }

    /// Some of them, whose corners have new numbers.
    pub(crate) fn part(&self, elements: &[u32], stencils: Vec<[u32; 3]>) -> Limited {
        let (rest, fabrics) = (self.rest.clone(), self.fabrics.clone());
        Limited { stencils, triangles: chosen(&self.triangles, elements), rest, fabrics }
    }

    pub(crate) fn element(&self, e: usize) -> (&RestTriangle, &StrainLimits) {
        let rest = &self.rest[self.triangles[e] as usize];
        let limits = self.fabrics[rest.panel as usize].strain_limits.as_ref();
        (rest, limits.expect("only limited triangles are listed"))
    }
}

/// Strain limits of all triangles whose fabric has them.
#[derive(Debug)]
pub struct StrainLimitModel {
    limited: Limited,
    /// The last step (m) and where it began, from which follow the predicted stretches for the
    /// geometric part of the projected stiffness; see [`MembraneModel`](crate::MembraneModel).
    from: Vec<World3>,
    step: Vec<World3>,
}

impl StrainLimitModel {
    /// Limits over the given triangles; `None` if no fabric has any.
    pub fn new(
        triangles: &[[u32; 3]],
        rest: Arc<Vec<RestTriangle>>,
        fabrics: Arc<Vec<Fabric>>,
    ) -> Option<Self> {
        let limited = Limited::new(triangles, rest, fabrics)?;
        Some(StrainLimitModel { limited, from: Vec::new(), step: Vec::new() })
    }
}

impl StrainLimitModel {
    /// Principal stretches by the linear prediction of the last step (1).
    fn predicted(&self, e: usize) -> [f64; 2] {
        let (rest, stencil) = (self.limited.element(e).0, self.limited.stencils[e]);
        let f = rest.deformation_gradient(&stencil.map(|i| self.from[i as usize]));
        let df = rest.deformation_gradient(&stencil.map(|i| self.step[i as usize]));
        let (sigma, v) = principal_stretches(&f);
        let (fv, dfv) = (f * v, df * v);
        // dσ = uᵀ dF v with u = F v/σ.
        [0, 1].map(|k| {
            let s = sigma[k].max(1e-9);
            (sigma[k] + fv.column(k).dot(&dfv.column(k)) / s).max(0.0)
        })
    }
}

/// Cheap test on FᵀF whether both stretches are in the free range.
pub(crate) fn is_free(limits: &StrainLimits, f: &Matrix3x2<f64>) -> bool {
    let c = f.tr_mul(f);
    let mean = 0.5 * (c[(0, 0)] + c[(1, 1)]);
    let half = 0.5 * (c[(0, 0)] - c[(1, 1)]);
    let radius = (half * half + c[(0, 1)] * c[(0, 1)]).sqrt();
    let high = limits.max - BAND * (limits.max - 1.0);
    let low = limits.min + BAND * (1.0 - limits.min);
    mean + radius <= high * high && mean - radius >= low * low
}

impl ElementModel<3> for StrainLimitModel {
    fn name(&self) -> &'static str {
        "strain limits"
    }

    fn stencils(&self) -> &[[u32; 3]] {
        &self.limited.stencils
    }

    fn begin(&mut self, stage: Stage<'_>) {
        self.from.clear();
        self.from.extend_from_slice(stage.x_t0);
        self.step.clear();
        self.step.resize(stage.x_t0.len(), World3::zeros());
    }

    fn predict(&mut self, x: &[World3], step: &[World3]) {
        self.from.copy_from_slice(x);
        self.step.copy_from_slice(step);
    }

    fn energy(&self, e: usize, x: &[World3; 3]) -> f64 {
        let (rest, limits) = self.limited.element(e);
        let f = rest.deformation_gradient(x);
        if is_free(limits, &f) {
            return 0.0;
        }
        let (sigma, _) = principal_stretches(&f);
        rest.area * sigma.iter().map(|&s| penalty(limits, s)[0]).sum::<f64>()
    }

    fn gradient(&self, e: usize, x: &[World3; 3]) -> [World3; 3] {
        let mut out = ElementSystem::zero();
        self.system(e, x, Stiffness::Projected, &mut out);
        out.gradient
    }

    /// The eigenvectors of the Hessian of an isotropic energy are known (Smith2019): the two
    /// stretches, a twist and a flip in the plane, and the two tilts out of it.
    fn system(&self, e: usize, x: &[World3; 3], kind: Stiffness, out: &mut ElementSystem<3>) {
        let (rest, limits) = self.limited.element(e);
        let f = rest.deformation_gradient(x);
        out.active = !is_free(limits, &f);
        if !out.active {
            *out = ElementSystem::zero();
            return;
        }
        let (sigma, v) = principal_stretches(&f);
        let [p1, p2] = sigma.map(|s| penalty(limits, s));
        let frame = orthonormal(&(f * v), sigma);
        let [u1, u2, n] = frame;
        let (v1, v2) = (v.column(0).into_owned(), v.column(1).into_owned());

        // The loads of the geometric part: here, or where the last step was predicted to lead.
        let geometric = match kind {
            Stiffness::Exact => sigma,
            Stiffness::Projected => self.predicted(e),
        };
        let [g1, g2] = geometric.map(|s| penalty(limits, s));
        // A floor keeps the quotients finite on collapsed triangles.
        let [s1, s2] = geometric.map(|s| s.max(1e-9));
        let apart = s1 - s2;
        let flip = if apart.abs() > 1e-7 { (g1[1] - g2[1]) / apart } else { 0.5 * (g1[2] + g2[2]) };
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let modes = [
            (p1[2], u1 * v1.transpose()),
            (p2[2], u2 * v2.transpose()),
            ((g1[1] + g2[1]) / (s1 + s2), (u1 * v2.transpose() - u2 * v1.transpose()) * half),
            (flip, (u1 * v2.transpose() + u2 * v1.transpose()) * half),
            (g1[1] / s1, n * v1.transpose()),
            (g2[1] / s2, n * v2.transpose()),
        ];
        let piola = (u1 * v1.transpose()) * p1[1] + (u2 * v2.transpose()) * p2[1];
        out.gradient = rest.b.map(|b| piola * b * rest.area);
        out.stiffness = [[Matrix3::zeros(); 3]; 3];
        for (lambda, mode) in modes {
            if lambda <= 0.0 && (kind == Stiffness::Projected || lambda == 0.0) {
                continue;
            }
            let m = rest.b.map(|b| mode * b);
            for i in 0..3 {
                for j in 0..=i {
                    out.stiffness[i][j] += m[i] * m[j].transpose() * (lambda * rest.area);
                }
            }
        }
    }

    fn part(&self, elements: &[u32], stencils: Vec<[u32; 3]>) -> Self {
        let limited = self.limited.part(elements, stencils);
        StrainLimitModel { limited, from: Vec::new(), step: Vec::new() }
    }
}

/// Left singular vectors and the normal, completed where F is degenerate.
pub(crate) fn orthonormal(fv: &Matrix3x2<f64>, [s1, s2]: [f64; 2]) -> [World3; 3] {
    let u1 = if s1 > 1e-12 { fv.column(0).normalize() } else { World3::x() };
    let rest = fv.column(1) - u1 * u1.dot(&fv.column(1));
    let u2 = if s2 > 1e-9 * s1 && rest.norm() > 0.0 {
        rest.normalize()
    } else {
        // Any perpendicular direction: start from the axis least aligned with u1.
        let axis = World3::ith(u1.iamin(), 1.0);
        (axis - u1 * u1.dot(&axis)).normalize()
    };
    [u1, u2, u1.cross(&u2)]
}

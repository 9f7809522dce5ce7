//! Reference implementation, for comparison only: the implicit scheme of the paper.
//!
//! It takes R at the beginning of the step, so a particle that rests there is integrated explicitly
//! however stiff its neighbours are, and with the paper's law R is indefinite. Either can make it
//! explode; `examples/stress_grid` counts. Use [`Implicit`](crate::Implicit).

use crate::blocks::{Blocks, SparseBlocks};
use crate::error::StepError;
use crate::explicit::check_time;
use crate::restraint::Restraint;
use crate::{Matrix3, Particles, Vector3};
use nalgebra::{DMatrix, DVector};

/// Algorithm 1 of Manteaux2013, a step of h (s): (I + h γ M⁻¹ R − h² K R M⁻¹) Δp = h (f + h K M⁻¹ s +
/// f_d) with K = −L, then x ← x + h M⁻¹ (R Δp + s), Eq. (9) to (13), with R as corrected in
/// [`Held::r_matrix`](crate::Held::r_matrix). γ is the coefficient of the damping f_d = −γ q̇ (kg/s).
///
/// The hybrid of implicit and explicit parts: the unsymmetric system, solved by a dense LU
/// factorisation, holds the particles that move at the beginning of the step and their neighbours;
/// all others get h f. Returns how many it holds. `evaluate` is as in
/// [`Implicit::step`](crate::Implicit::step).
///
/// # Errors
/// A step that is not positive and finite, a pattern of another size, a singular system, or a result that is not finite. The
/// particles are then as they were.
pub fn algorithm_1(
    particles: &mut Particles,
    restraint: &impl Restraint,
    stiffness: &mut SparseBlocks,
    h: f64,
    gamma: f64,
    evaluate: impl FnOnce(&[Vector3], &mut [Vector3], &mut SparseBlocks) -> f64,
) -> Result<usize, StepError> {
    check_time("the step", h)?;
    let n = particles.len();
    if stiffness.n_rows() != n {
        return Err(StepError::Pattern { rows: stiffness.n_rows(), particles: n });
    }
    let m = particles.masses();
    let mut f = vec![Vector3::zeros(); n];
    stiffness.clear();
    evaluate(&particles.x, &mut f, stiffness);
    let held: Vec<_> = (0..n).map(|i| restraint.at(&particles.particle(i))).collect();
    let r: Vec<Matrix3> = held.iter().zip(&particles.p).map(|(held, p)| held.r_matrix(p)).collect();
    let s: Vec<Vector3> = held.iter().zip(&particles.p).map(|(held, p)| held.s(p)).collect();
    let v: Vec<Vector3> = s.iter().zip(m).map(|(s, m)| s / *m).collect();

    let moves = |i: usize| r[i] != Matrix3::zeros();
    let in_system = |&i: &usize| {
        let mut near = moves(i);
        stiffness.visit_row(i, |j, block| near |= moves(j) && *block != Matrix3::zeros());
        near
    };
    let active: Vec<usize> = (0..n).filter(in_system).collect();
    let mut place = vec![usize::MAX; n];
    for (a, &i) in active.iter().enumerate() {
        place[i] = a;
    }
    let b = |i: usize| h * (f[i] - h * stiffness.row_times(i, &v) - gamma * v[i]);
    let mut dp: Vec<Vector3> =
        (0..n).map(|i| if place[i] == usize::MAX { h * f[i] } else { b(i) }).collect();
    let mut matrix = DMatrix::identity(3 * active.len(), 3 * active.len());
    let mut rhs = DVector::zeros(3 * active.len());
    for (a, &i) in active.iter().enumerate() {
        let own = h * h * stiffness.diagonal(i) + Matrix3::from_diagonal_element(h * gamma);
        let mut diagonal = matrix.fixed_view_mut::<3, 3>(3 * a, 3 * a);
        diagonal += own * r[i] / m[i];
        stiffness.visit_row(i, |j, block| {
            if place[j] != usize::MAX {
                let entry = h * h * block * r[j] / m[j];
                matrix.fixed_view_mut::<3, 3>(3 * a, 3 * place[j]).copy_from(&entry);
            }
        });
        rhs.fixed_rows_mut::<3>(3 * a).copy_from(&dp[i]);
    }
    let unknowns = active.len();
    // nalgebra does not solve systems without unknowns.
    let solution = if unknowns == 0 { Some(rhs) } else { matrix.lu().solve(&rhs) };
    let solution = solution.ok_or(StepError::Singular { unknowns })?;
    for (a, &i) in active.iter().enumerate() {
        dp[i] = solution.fixed_rows::<3>(3 * a).into_owned();
    }
    let x: Vec<Vector3> =
        (0..n).map(|i| particles.x[i] + h / m[i] * (r[i] * dp[i] + s[i])).collect();
    let p: Vec<Vector3> = particles.p.iter().zip(&dp).map(|(p, dp)| p + dp).collect();
    let finite = |i: &usize| x[*i].iter().chain(p[*i].iter()).all(|c| c.is_finite());
    if let Some(particle) = (0..n).find(|i| !finite(i)) {
        return Err(StepError::NotFinite { particle });
    }
    (particles.x, particles.p) = (x, p);
    particles.time += h;
    Ok(unknowns)
}

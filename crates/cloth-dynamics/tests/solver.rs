//! The linear solvers against dense linear algebra, against each other, and against bad input.

use std::sync::Arc;

use cloth_dynamics::solver::{
    BlockMatrix, LinearError, LinearReport, LinearSettings, LinearSolver, Method, PatternBuilder,
    Precision, SolverKind, StencilSlots, clear_fixed,
};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

const KINDS: [SolverKind; 4] = [
    SolverKind::BlockJacobiCg,
    SolverKind::SparseCholesky,
    SolverKind::StaleFactorCg,
    SolverKind::Auto,
];

/// Numbers that look random (splitmix64).
struct Random(u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }
    fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }
    /// In −1..1.
    fn real(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
    fn vector(&mut self) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.real())
    }
    fn vectors(&mut self, n: usize) -> Vec<Vector3<f64>> {
        (0..n).map(|_| self.vector()).collect()
    }
}

type Element<const N: usize> = [[Matrix3<f64>; N]; N];

/// A symmetric positive semi-definite element matrix `G Gᵀ`.
fn random_element<const N: usize>(random: &mut Random) -> Element<N> {
    let g: [Matrix3<f64>; N] = std::array::from_fn(|_| Matrix3::from_fn(|_, _| random.real()));
    std::array::from_fn(|a| std::array::from_fn(|b| g[a] * g[b].transpose()))
}

fn assemble<const N: usize>(
    matrix: &mut BlockMatrix,
    stencils: &[[u32; N]],
    mut element: impl FnMut(usize) -> Element<N>,
) {
    let slots = StencilSlots::new(matrix.pattern(), stencils).expect("all pairs are there");
    assert_eq!(slots.len(), stencils.len());
    for e in 0..stencils.len() {
        slots.scatter(e, &element(e), matrix);
    }
}

fn empty_matrix<const N: usize>(n: usize, stencils: &[[u32; N]]) -> BlockMatrix {
    let mut builder = PatternBuilder::new(n);
    builder.add(stencils).unwrap();
    BlockMatrix::new(Arc::new(builder.build().unwrap()))
}

fn dense(matrix: &BlockMatrix) -> DMatrix<f64> {
    let n = matrix.n_vertices();
    let mut full = DMatrix::zeros(3 * n, 3 * n);
    for i in 0..n {
        for j in 0..=i {
            if let Some(slot) = matrix.pattern().slot(i, j) {
                let block = matrix.blocks()[slot];
                full.fixed_view_mut::<3, 3>(3 * i, 3 * j).copy_from(&block);
                full.fixed_view_mut::<3, 3>(3 * j, 3 * i).copy_from(&block.transpose());
            }
        }
    }
    full
}

fn flat(vectors: &[Vector3<f64>]) -> DVector<f64> {
    DVector::from_iterator(3 * vectors.len(), vectors.iter().flatten().copied())
}

/// The residual by a plain loop over the blocks, so that the solver's own product is not trusted.
fn residual(matrix: &BlockMatrix, b: &[Vector3<f64>], x: &[Vector3<f64>]) -> f64 {
    let mut r = b.to_vec();
    for j in 0..b.len() {
        for i in j..b.len().min(j + 200) {
            if let Some(slot) = matrix.pattern().slot(i, j) {
                r[i] -= matrix.blocks()[slot] * x[j];
                if i != j {
                    r[j] -= matrix.blocks()[slot].transpose() * x[i];
                }
            }
        }
    }
    flat(&r).norm() / flat(b).norm()
}

fn tight() -> LinearSettings {
    LinearSettings { tolerance: 1e-12, ..LinearSettings::default() }
}

fn solve(
    solver: &mut dyn LinearSolver,
    matrix: &BlockMatrix,
    b: &[Vector3<f64>],
) -> (Vec<Vector3<f64>>, LinearReport) {
    let mut x = vec![Vector3::zeros(); b.len()];
    let report = solver.solve(matrix, b, &mut x).unwrap();
    (x, report)
}

/// A cloth-like matrix on a grid: unit masses, springs of the given stiffness along edges and cell
/// diagonals in three dimensions, so that the condition is about 10 times the stiffness.
fn cloth(side: usize, stiffness: f64, wave: f64) -> BlockMatrix {
    let id = |i: usize, j: usize| (j * side + i) as u32;
    let mut springs = vec![];
    for j in 0..side {
        for i in 0..side {
            for (di, dj) in [(1, 0), (0, 1), (1, 1)] {
                if i + di < side && j + dj < side {
                    springs.push([id(i, j), id(i + di, j + dj)]);
                }
            }
        }
    }
    let mut matrix = empty_matrix(side * side, &springs);
    for i in 0..side * side {
        *matrix.diagonal_mut(i) += Matrix3::identity();
    }
    let x = |v: u32| {
        let (i, j) = ((v as usize % side) as f64, (v as usize / side) as f64);
        Vector3::new(i, j, wave * (0.9 * i + 0.4 * j).sin())
    };
    let spring = |e: usize| {
        let d = (x(springs[e][1]) - x(springs[e][0])).normalize();
        let k = d * d.transpose() * stiffness;
        [[k, -k], [-k, k]]
    };
    assemble(&mut matrix, &springs, spring);
    matrix
}

#[test]
fn random_systems_agree_with_dense_cholesky() {
    let mut random = Random(3);
    for n in [1, 2, 3, 5, 17, 60] {
        for kind in KINDS {
            // Sparse enough to leave vertices alone and components apart.
            let stencils: Vec<[u32; 4]> =
                (0..n / 2).map(|_| [(); 4].map(|()| random.below(n) as u32)).collect();
            let mut matrix = empty_matrix(n, &stencils);
            for i in 0..n {
                *matrix.diagonal_mut(i) += Matrix3::identity() * (0.1 + random.real().abs());
            }
            assemble(&mut matrix, &stencils, |_| random_element(&mut random));
            let b = random.vectors(n);
            let (x, report) = solve(&mut *kind.build(tight()), &matrix, &b);
            let expected = dense(&matrix).cholesky().unwrap().solve(&flat(&b));
            // The condition is below 1e3, the residual below 1e-12.
            let error = (flat(&x) - &expected).norm() / expected.norm();
            assert!(error < 1e-9, "{kind:?}, n = {n}: {error:e} ({report:?})");
            assert!(report.shift == 0.0);
        }
    }
}

#[test]
fn any_stiffness_is_solved_to_the_tolerance() {
    let mut random = Random(4);
    let b = random.vectors(15 * 15);
    for stiffness in [0.0, 1.0, 1e3, 1e6, 1e9] {
        let matrix = cloth(15, stiffness, 0.3);
        let eigenvalues = dense(&matrix).symmetric_eigenvalues();
        let condition = eigenvalues.max() / eigenvalues.min();
        assert!(condition >= 5.0 * stiffness, "{condition:e}");
        for kind in KINDS {
            for precision in [Precision::Double, Precision::Mixed] {
                let settings = LinearSettings { tolerance: 1e-8, precision, ..tight() };
                let (x, report) = solve(&mut *kind.build(settings), &matrix, &b);
                let what = format!("{kind:?}, {precision:?}, {stiffness:e}: {report:?}");
                assert!(report.relative_residual <= 1e-8 || report.rounding_limited, "{what}");
                // Rounding of A x: 2e-16 · condition for a solution along the softest direction.
                let rounding = 1e-15 * condition;
                assert!(residual(&matrix, &b, &x) <= 1e-8 + rounding, "{what}");
                assert_eq!(report.shift, 0.0, "{what}");
            }
        }
    }
}

#[test]
fn the_solution_of_a_stiff_system_is_right() {
    let mut random = Random(5);
    let expected = random.vectors(12 * 12);
    let matrix = cloth(12, 1e9, 0.3);
    let mut b = vec![Vector3::zeros(); expected.len()];
    matrix.multiply(&expected, &mut b);
    let (x, _) = solve(&mut *SolverKind::SparseCholesky.build(tight()), &matrix, &b);
    // Condition 1e10 times the rounding 1e-16, and some room.
    let error = (flat(&x) - flat(&expected)).norm() / flat(&expected).norm();
    assert!(error < 1e-5, "{error:e}");
}

#[test]
fn fixed_vertices_stay_and_the_others_see_the_reduced_system() {
    let mut random = Random(6);
    let full = cloth(6, 50.0, 0.3);
    let n = full.n_vertices();
    let fixed: Vec<bool> = (0..n).map(|i| i % 5 == 0 || i == 1).collect();
    let free: Vec<usize> = (0..3 * n).filter(|k| !fixed[k / 3]).collect();
    let mut b = random.vectors(n);
    let reduced = dense(&full).select_rows(&free).select_columns(&free);
    let expected = reduced.cholesky().unwrap().solve(&flat(&b).select_rows(&free));
    let mut matrix = full.clone();
    matrix.eliminate(&fixed);
    clear_fixed(&mut b, &fixed);
    for kind in KINDS {
        let (x, _) = solve(&mut *kind.build(tight()), &matrix, &b);
        for i in 0..n {
            assert!(!fixed[i] || x[i] == Vector3::zeros(), "{kind:?}: vertex {i} at {}", x[i]);
        }
        let error = (flat(&x).select_rows(&free) - &expected).norm() / expected.norm();
        assert!(error < 1e-9, "{kind:?}: {error:e}");
    }
}

#[test]
fn an_indefinite_matrix_is_an_error_or_a_reported_shift() {
    let mut random = Random(7);
    // Positive definite blocks on the diagonal, and yet indefinite: eigenvalues 1 ± 2 between the
    // first two vertices; the third is well.
    let mut matrix = empty_matrix(3, &[[0, 1]]);
    for i in 0..3 {
        *matrix.diagonal_mut(i) = Matrix3::identity();
    }
    let slot = matrix.pattern().slot(1, 0).unwrap();
    matrix.add(slot, &(Matrix3::identity() * 2.0));
    let b = random.vectors(3);
    let mut x = vec![Vector3::zeros(); 3];
    for kind in [SolverKind::SparseCholesky, SolverKind::StaleFactorCg, SolverKind::Auto] {
        let strict = LinearSettings { regularisation: None, ..tight() };
        let error = kind.build(strict).solve(&matrix, &b, &mut x).unwrap_err();
        let LinearError::NotPositiveDefinite { vertex, shift } = error else { panic!("{error}") };
        assert!(vertex < 2 && shift == 0.0, "{error}");
        x.fill(Vector3::zeros());

        let mut solver = kind.build(tight());
        let (x, report) = solve(&mut *solver, &matrix, &b);
        // Row sums are 3, so a shift of 1/3 is just enough; the next power of four may be taken.
        assert!(report.shift > 1.0 / 3.0 && report.shift < 4.0 / 3.0 + 1e-9, "{report:?}");
        let mut shifted = matrix.clone();
        for i in 0..3 {
            let sum = if i < 2 { 3.0 } else { 1.0 };
            *shifted.diagonal_mut(i) += Matrix3::identity() * (report.shift * sum);
        }
        assert!(residual(&shifted, &b, &x) < 1e-11, "{report:?}");
        assert!(flat(&x).dot(&flat(&b)) > 0.0, "not a descent direction");

        // Sound again: no shift.
        let (_, report) = solve(&mut *solver, &cloth(2, 1.0, 0.3), &random.vectors(4));
        assert_eq!(report.shift, 0.0);
    }
    let error = SolverKind::BlockJacobiCg.build(tight()).solve(&matrix, &b, &mut x).unwrap_err();
    assert!(matches!(error, LinearError::NegativeCurvature { .. }), "{error}");
    *matrix.diagonal_mut(2) = -Matrix3::identity();
    let error = SolverKind::BlockJacobiCg.build(tight()).solve(&matrix, &b, &mut x).unwrap_err();
    assert_eq!(error, LinearError::NotPositiveDefinite { vertex: 2, shift: 0.0 });
}

#[test]
fn bad_numbers_are_named() {
    let b = vec![Vector3::x(); 9];
    for kind in KINDS {
        let mut solver = kind.build(tight());
        let mut x = vec![Vector3::zeros(); 9];
        for bad in [f64::NAN, f64::INFINITY] {
            let mut matrix = cloth(3, 1.0, 0.3);
            matrix.diagonal_mut(4)[(1, 0)] = bad;
            let error = solver.solve(&matrix, &b, &mut x).unwrap_err();
            assert_eq!(error, LinearError::NotFinite { what: "the matrix", vertex: 4 }, "{kind:?}");
            x.fill(Vector3::zeros());

            let mut rhs = b.clone();
            rhs[7].y = bad;
            let error = solver.solve(&cloth(3, 1.0, 0.3), &rhs, &mut x).unwrap_err();
            assert_eq!(error, LinearError::NotFinite { what: "the right-hand side", vertex: 7 });
        }
        let error = solver.solve(&cloth(3, 1.0, 0.3), &b[1..], &mut x).unwrap_err();
        assert_eq!(error, LinearError::Shape { n_vertices: 9, rhs: 8, x: 9 });
        // Still fit for work.
        assert!(solve(&mut *solver, &cloth(3, 1.0, 0.3), &b).1.relative_residual < 1e-12);
    }
}

#[test]
fn running_out_of_iterations_is_an_error_with_the_residual() {
    let b = Random(8).vectors(100);
    let settings = LinearSettings { max_iterations: 3, ..tight() };
    let (matrix, mut x) = (cloth(10, 1e4, 0.3), vec![Vector3::zeros(); 100]);
    let error = SolverKind::BlockJacobiCg.build(settings).solve(&matrix, &b, &mut x).unwrap_err();
    let LinearError::NoConvergence { iterations, relative_residual, tolerance } = error else {
        panic!("{error}")
    };
    assert_eq!((iterations, tolerance), (3, 1e-12));
    assert!((residual(&matrix, &b, &x) - relative_residual).abs() < 1e-9, "x is the last iterate");
}

#[test]
fn a_guess_may_help_and_does_no_harm() {
    let b = Random(15).vectors(1600);
    let matrix = cloth(40, 100.0, 0.3);
    for kind in KINDS {
        let (solution, cold) = solve(&mut *kind.build(tight()), &matrix, &b);
        assert!(residual(&matrix, &b, &solution) < 1.1e-12, "{kind:?}");
        let mut x: Vec<_> = solution.iter().map(|v| v * (1.0 + 1e-9)).collect();
        let warm = kind.build(tight()).solve(&matrix, &b, &mut x).unwrap();
        assert!(residual(&matrix, &b, &x) < 1.1e-12, "{kind:?}");
        assert!(warm.iterations <= cold.iterations);
        if kind == SolverKind::BlockJacobiCg {
            assert!(2 * warm.iterations < cold.iterations, "{warm:?}, {cold:?}");
        }
        let mut x = vec![Vector3::repeat(1e9); b.len()];
        let wild = kind.build(tight()).solve(&matrix, &b, &mut x).unwrap();
        assert_eq!((wild, x), (cold, solution), "{kind:?}: a guess worse than zero is dropped");
    }
}

#[test]
fn nothing_to_solve() {
    for kind in KINDS {
        let mut solver = kind.build(tight());
        let none = BlockMatrix::new(Arc::new(PatternBuilder::new(0).build().unwrap()));
        assert_eq!(solver.solve(&none, &[], &mut []).unwrap().method, Method::Trivial);
        for tiny in [0.0, 1e-200] {
            let b = vec![Vector3::new(0.0, tiny, 0.0); 4];
            let mut x = vec![Vector3::x(); 4];
            let report = solver.solve(&cloth(2, 1.0, 0.3), &b, &mut x).unwrap();
            assert_eq!((report.method, x), (Method::Trivial, vec![Vector3::zeros(); 4]));
        }
        let mut one = BlockMatrix::new(Arc::new(PatternBuilder::new(1).build().unwrap()));
        *one.diagonal_mut(0) = Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 4.0));
        let (x, _) = solve(&mut *solver, &one, &[Vector3::new(1.0, 1.0, 1.0)]);
        assert!((x[0] - Vector3::new(1.0, 0.5, 0.25)).norm() < 1e-12, "{kind:?}: {}", x[0]);
    }
}

#[test]
fn the_scale_of_the_numbers_does_not_matter() {
    let b = Random(9).vectors(36);
    for kind in KINDS {
        let (x, _) = solve(&mut *kind.build(tight()), &cloth(6, 1e3, 0.3), &b);
        for scale in [1e-60, 1e-30, 1e30, 1e60] {
            let mut matrix = cloth(6, 1e3, 0.3);
            matrix.blocks_mut().iter_mut().for_each(|block| *block *= scale);
            let (y, report) = solve(&mut *kind.build(tight()), &matrix, &b);
            let error = (flat(&y) * scale - flat(&x)).norm() / flat(&x).norm();
            assert!(error < 1e-8, "{kind:?}, {scale:e}: {error:e} ({report:?})");
        }
    }
}

#[test]
fn a_stale_factor_serves_small_changes_and_is_replaced_after_big_ones() {
    let b = Random(10).vectors(900);
    for precision in [Precision::Double, Precision::Mixed] {
        let settings = LinearSettings { tolerance: 1e-8, precision, ..tight() };
        let mut solver = SolverKind::StaleFactorCg.build(settings);
        let matrix = cloth(30, 1e3, 0.3);
        let (_, report) = solve(&mut *solver, &matrix, &b);
        assert_eq!((report.method, report.refactored), (Method::Cholesky, true));
        assert!(report.analysed);

        let near = matrix_like(&matrix, &cloth(30, 1.001e3, 0.3001));
        let (x, report) = solve(&mut *solver, &near, &b);
        assert_eq!((report.method, report.refactored), (Method::StaleFactorCg, false));
        assert!(!report.analysed && (1..=6).contains(&report.iterations), "{report:?}");
        assert!(residual(&near, &b, &x) < 1.01e-8);

        let far = matrix_like(&matrix, &cloth(30, 1e5, 1.0));
        let (x, report) = solve(&mut *solver, &far, &b);
        assert_eq!((report.method, report.refactored), (Method::Cholesky, true), "{report:?}");
        assert!(!report.analysed, "the pattern is the same");
        assert!(residual(&far, &b, &x) < 1.01e-8);

        let (_, report) = solve(&mut *solver, &far, &b);
        assert_eq!(report.method, Method::StaleFactorCg, "the new factor is kept");
        assert!(report.iterations <= 6, "{report:?}");
    }
}

/// The numbers of `numbers` in the very pattern of `pattern`.
fn matrix_like(pattern: &BlockMatrix, numbers: &BlockMatrix) -> BlockMatrix {
    let mut matrix = pattern.clone();
    matrix.set_zero();
    assert!(matrix.blocks().iter().all(|block| *block == Matrix3::zeros()));
    for (slot, block) in numbers.blocks().iter().enumerate() {
        matrix.add(slot, block);
    }
    matrix
}

#[test]
fn a_pattern_is_analysed_once() {
    let b = Random(11).vectors(64);
    for kind in [SolverKind::SparseCholesky, SolverKind::StaleFactorCg] {
        let mut solver = kind.build(tight());
        let mut analysed = |matrix: &BlockMatrix| solve(&mut *solver, matrix, &b).1.analysed;
        let first = cloth(8, 1e2, 0.3);
        assert!(analysed(&first));
        assert!(!analysed(&matrix_like(&first, &cloth(8, 3e2, 0.3))));
        assert!(!analysed(&cloth(8, 1e2, 0.3)), "equal, though not the same in memory");
        let mut other = empty_matrix(64, &[[0, 63]]);
        (0..64).for_each(|i| *other.diagonal_mut(i) = Matrix3::identity());
        assert!(analysed(&other));
        assert!(analysed(&first), "only the last analysis is kept");
        solver.reset();
        assert!(solve(&mut *solver, &first, &b).1.analysed);
    }
}

#[test]
fn two_runs_and_a_reset_one_have_the_same_bits() {
    let b = Random(12).vectors(2500);
    let matrices: Vec<_> =
        (0..6).map(|k| cloth(50, 300.0 * (1.0 + k as f64), 0.3 + 0.01 * k as f64)).collect();
    for kind in KINDS {
        let run = |solver: &mut dyn LinearSolver| -> Vec<_> {
            matrices.iter().map(|matrix| solve(solver, matrix, &b)).collect()
        };
        let mut solver = kind.build(LinearSettings::default());
        let first = run(&mut *solver);
        solver.reset();
        assert_eq!(run(&mut *solver), first, "{kind:?}: after a reset");
        assert_eq!(run(&mut *kind.build(LinearSettings::default())), first, "{kind:?}: new solver");
    }
}

#[test]
fn auto_takes_iterations_for_soft_and_factors_for_stiff_cloth() {
    let b = Random(13).vectors(1600);
    let methods = |stiffness: f64| -> Vec<Method> {
        let mut solver = SolverKind::Auto.build(LinearSettings::default());
        let matrix = |k: usize| cloth(40, stiffness, 0.3 + 1e-4 * k as f64);
        (0..50).map(|k| solve(&mut *solver, &matrix(k), &b).1.method).collect()
    };
    assert_eq!(methods(0.1), vec![Method::BlockJacobiCg; 50]);
    let stiff = methods(1e4);
    assert_eq!(stiff[0], Method::Cholesky, "the first attempt of iterations is given up");
    assert!(!stiff.contains(&Method::BlockJacobiCg), "{stiff:?}");
    assert!(stiff.contains(&Method::StaleFactorCg), "{stiff:?}");
}

#[test]
fn a_stale_factor_that_never_helps_is_tried_less_and_less() {
    let b = Random(14).vectors(400);
    let mut solver = SolverKind::StaleFactorCg.build(LinearSettings::default());
    let wasted = |k: usize| {
        // Turned springs of high stiffness: no factor is of use for the next matrix.
        let matrix = cloth(20, 1e6, 0.3 + 0.05 * (k % 7) as f64);
        solve(&mut *solver, &matrix, &b).1.iterations > 5
    };
    let wasted: Vec<bool> = (0..40).map(wasted).collect();
    let count = wasted.iter().filter(|&&w| w).count();
    assert!((1..=8).contains(&count), "{wasted:?}");
}

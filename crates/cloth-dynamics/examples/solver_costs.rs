//! Measures what the linear solvers cost on cloth matrices, and prints a table: CPU seconds, and the
//! constants of the cost model that `Auto` chooses by.
//!
//! `cargo run --release -p cloth-dynamics --example solver_costs -- [vertices along a side]…`

use std::sync::Arc;
use std::time::Instant;

use cloth_dynamics::solver::{
    BlockJacobiCg, BlockMatrix, BlockPattern, LinearSettings, LinearSolver, PatternBuilder,
    Precision, SolverKind, SparseCholesky, StencilSlots,
};
use nalgebra::{Matrix3, Vector3};

/// A square sheet of 1 m, gently wavy, on a grid with one diagonal per cell.
#[derive(Clone)]
struct Sheet {
    positions: Vec<Vector3<f64>>,
    edges: Vec<[u32; 2]>,
    /// The two ends of an edge, then the corners opposite to it.
    hinges: Vec<[u32; 4]>,
    /// Three vertices in a row.
    lines: Vec<[u32; 3]>,
    side: usize,
    pattern: Arc<BlockPattern>,
}

impl Sheet {
    /// With 7 blocks per row (edges), 13 (and hinges) or 19 (and lines).
    fn new(side: usize, blocks_per_row: usize) -> Self {
        let id = |(i, j): (usize, usize)| (j * side + i) as u32;
        let inside = |i: usize, j: usize, v: [i64; 2]| {
            let (i, j) = (i as i64 + v[0], j as i64 + v[1]);
            let range = 0..side as i64;
            (range.contains(&i) && range.contains(&j)).then_some((i as usize, j as usize))
        };
        let (mut edges, mut hinges, mut lines) = (vec![], vec![], vec![]);
        let mut positions = vec![];
        let directions = [[1, 0], [0, 1], [1, 1]];
        let opposite = [[[1, 1], [0, -1]], [[1, 1], [-1, 0]], [[1, 0], [0, 1]]];
        for j in 0..side {
            for i in 0..side {
                let (u, v) = (i as f64 / (side - 1) as f64, j as f64 / (side - 1) as f64);
                positions.push(Vector3::new(u, v, 0.05 * (9.0 * u).sin() * (7.0 * v).cos()));
                for (direction, opposite) in directions.into_iter().zip(opposite) {
                    let Some(end) = inside(i, j, direction) else { continue };
                    edges.push([id((i, j)), id(end)]);
                    if let [Some(c), Some(d)] = opposite.map(|v| inside(i, j, v)) {
                        hinges.push([id((i, j)), id(end), id(c), id(d)]);
                    }
                    if let Some(far) = inside(i, j, direction.map(|v| 2 * v)) {
                        lines.push([id((i, j)), id(end), id(far)]);
                    }
                }
            }
        }
        if blocks_per_row < 13 {
            hinges.clear();
        }
        if blocks_per_row < 19 {
            lines.clear();
        }
        let mut builder = PatternBuilder::new(positions.len());
        builder.add(&edges).expect("vertices exist");
        builder.add(&hinges).expect("vertices exist");
        builder.add(&lines).expect("vertices exist");
        let pattern = Arc::new(builder.build().expect("small enough"));
        Self { positions, edges, hinges, lines, side, pattern }
    }

    /// The same with a block between two opposite corners, in which there is nothing.
    fn joined(&self) -> Self {
        let mut builder = PatternBuilder::new(self.positions.len());
        builder.add(&self.edges).expect("vertices exist");
        builder.add(&self.hinges).expect("vertices exist");
        builder.add(&self.lines).expect("vertices exist");
        builder.add(&[[0, self.positions.len() as u32 - 1]]).expect("vertices exist");
        Self { pattern: Arc::new(builder.build().expect("small enough")), ..self.clone() }
    }

    /// `M + h² K` for 0.2 kg/m², springs of `stiffness` (N/m) and bending of 1e-5 N m, with the sheet
    /// waved by `wave` more (m).
    fn matrix(&self, step: f64, stiffness: f64, wave: f64) -> BlockMatrix {
        let mut matrix = BlockMatrix::new(self.pattern.clone());
        let mass = 0.2 / self.positions.len() as f64;
        for i in 0..self.positions.len() {
            *matrix.diagonal_mut(i) += Matrix3::identity() * mass;
        }
        let x = |i: u32| {
            let p = self.positions[i as usize];
            p + Vector3::z() * (wave * (11.0 * p.x + 5.0 * p.y).sin())
        };
        let slots = StencilSlots::new(&self.pattern, &self.edges).expect("in the pattern");
        for (e, &[a, b]) in self.edges.iter().enumerate() {
            let d = (x(b) - x(a)).normalize();
            let k = d * d.transpose() * (step * step * stiffness);
            slots.scatter(e, &[[k, -k], [-k, k]], &mut matrix);
        }
        let bending = step * step * 1e-5 * ((self.side - 1) as f64).powi(2);
        let slots = StencilSlots::new(&self.pattern, &self.hinges).expect("in the pattern");
        for e in 0..self.hinges.len() {
            slots.scatter(e, &rank_one([1.0, 1.0, -1.0, -1.0], bending), &mut matrix);
        }
        let slots = StencilSlots::new(&self.pattern, &self.lines).expect("in the pattern");
        for e in 0..self.lines.len() {
            slots.scatter(e, &rank_one([1.0, -2.0, 1.0], bending), &mut matrix);
        }
        matrix
    }
}

/// The element matrix `k w wᵀ`, the same in x, y and z.
fn rank_one<const N: usize>(w: [f64; N], k: f64) -> [[Matrix3<f64>; N]; N] {
    std::array::from_fn(|a| std::array::from_fn(|b| Matrix3::identity() * (k * w[a] * w[b])))
}

/// CPU seconds of this thread; wall seconds where the system does not tell.
fn cpu_seconds(origin: Instant) -> f64 {
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = told.and_then(|text| text.split(' ').next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| origin.elapsed().as_secs_f64(), |ns| ns * 1e-9)
}

/// CPU seconds of a run: the least of four means, each over as many runs as fill a twentieth of a
/// second (the clock may tick in steps of 4 ms, and other programs disturb).
fn seconds(mut run: impl FnMut()) -> f64 {
    let origin = Instant::now();
    let mut mean = || {
        let start = cpu_seconds(origin);
        let mut n = 0.0;
        loop {
            run();
            n += 1.0;
            let spent = cpu_seconds(origin) - start;
            if spent >= 0.05 {
                return spent / n;
            }
        }
    };
    let first = mean();
    // Long runs are disturbed less, and there is no time for four of them.
    let more = if first > 1.0 { 0 } else { 3 };
    (0..more).map(|_| mean()).fold(first, f64::min)
}

fn main() {
    let asked: Vec<usize> = std::env::args().skip(1).filter_map(|a| a.parse().ok()).collect();
    let sides = if asked.is_empty() { vec![30, 71, 141, 245] } else { asked };
    println!("CPU seconds (iterations of CG, to 1e-6) on a sheet of 1 m.");
    println!("soft: h = 2 ms, 500 N/m; everything else: 10 ms, 2000 N/m.");
    println!("factor and solve: single precision / double precision.");
    println!("stale: since the factor was made, the sheet has been waved by 0.1 mm, by 1 mm.");
    for blocks_per_row in [7, 13, 19] {
        for &side in &sides {
            row(&Sheet::new(side, blocks_per_row), blocks_per_row);
        }
    }
}

fn row(sheet: &Sheet, blocks_per_row: usize) {
    let n = sheet.positions.len();
    let settings = LinearSettings::default();
    let loads: Vec<Vector3<f64>> =
        sheet.positions.iter().map(|p| Vector3::new(0.0, 0.1 * (40.0 * p.x).sin(), -1.0)).collect();
    let mut x = vec![Vector3::zeros(); n];
    let mut solve = |solver: &mut dyn LinearSolver, matrix: &BlockMatrix| {
        x.fill(Vector3::zeros());
        solver.solve(matrix, &loads, &mut x).expect("the matrix is positive definite")
    };
    let soft = sheet.matrix(0.002, 500.0, 0.0);
    let stiff = sheet.matrix(0.01, 2000.0, 0.0);
    let slightly = sheet.matrix(0.01, 2000.0, 0.0001);
    let clearly = sheet.matrix(0.01, 2000.0, 0.001);

    // Another pattern, of the same size: in turn, they have to be analysed each time.
    let joined = sheet.joined().matrix(0.01, 2000.0, 0.0);

    let mut jacobi = BlockJacobiCg::new(settings);
    let cg = [&soft, &stiff].map(|matrix| {
        let iterations = solve(&mut jacobi, matrix).iterations;
        let seconds = seconds(|| {
            solve(&mut jacobi, matrix);
        });
        (seconds, iterations)
    });

    let mut size = None;
    let direct = [Precision::Mixed, Precision::Double].map(|precision| {
        let mut solver = SparseCholesky::new(LinearSettings { precision, ..settings });
        let both_first = seconds(|| {
            solve(&mut solver, &stiff);
            solve(&mut solver, &joined);
        });
        let report = solve(&mut solver, &stiff);
        let again = seconds(|| {
            solve(&mut solver, &stiff);
        });
        size = solver.factor_size();
        (0.5 * both_first - again, again, report.iterations)
    });
    let size = size.expect("a solver that has solved knows the size");

    let mut solver = SolverKind::StaleFactorCg.build(settings);
    let fresh = seconds(|| {
        solver.reset();
        solve(&mut *solver, &stiff);
    });
    let stale = [&slightly, &clearly].map(|waved| {
        let mut report = None;
        let both = seconds(|| {
            solver.reset();
            solve(&mut *solver, &stiff);
            report = Some(solve(&mut *solver, waved));
        });
        let report = report.expect("it ran");
        let note = if report.refactored { " and a new factor" } else { "" };
        (both - fresh, format!("({}{note})", report.iterations))
    });

    let blocks = sheet.pattern.n_blocks() as f64;
    let per_iteration = cg[1].0 / cg[1].1 as f64;
    println!(
        "{n:>6} vertices, {blocks_per_row:>2} blocks a row | analysis {:.4} | factor and solve \
         {:.4} ({}) / {:.4} ({}) | CG soft {:.4} ({}), stiff {:.4} ({}) | stale {:.4} {}, {:.4} {}",
        direct[1].0,
        direct[0].1,
        direct[0].2,
        direct[1].1,
        direct[1].2,
        cg[0].0,
        cg[0].1,
        cg[1].0,
        cg[1].1,
        stale[0].0,
        stale[0].1,
        stale[1].0,
        stale[1].1,
    );
    println!(
        "       factor: {:.2} Gflop, {:.2} M entries, {:.1} Gflop/s | ns: analysis {:.0} a block, CG \
         {:.1} a block",
        size.flops * 1e-9,
        size.entries * 1e-6,
        size.flops / direct[1].1 * 1e-9,
        direct[1].0 / blocks * 1e9,
        per_iteration / blocks * 1e9,
    );
}

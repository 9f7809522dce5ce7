//! A frame is a transaction.

use super::*;
use crate::checkpoint;
use crate::scene::{LoadOptions, from_sources, parse};
use cloth_dynamics::Constraints;
use std::sync::atomic::{AtomicU32, Ordering};

/// Steps like [`Sdirk2`], but only so often.
struct Budget(Arc<AtomicU32>);

impl TimeIntegrator for Budget {
    fn stage(&self, h: f64) -> f64 {
        Sdirk2.stage(h)
    }

    fn advance(
        &mut self,
        cloth: &mut ClothState,
        system: &mut System,
        solver: &mut dyn LinearSolver,
        constraints: &dyn Fn(f64) -> Constraints,
        settings: &NewtonSettings,
        step: Step,
    ) -> Result<SolveReport, SolveError> {
        let Step { time, h } = step;
        let left = self.0.load(Ordering::Relaxed).checked_sub(1);
        self.0.store(left.ok_or(SolveError::NotFinite { time, h })?, Ordering::Relaxed);
        Sdirk2.advance(cloth, system, solver, constraints, settings, step)
    }
}

/// A sheet that adapts; its second handle takes hold and lets go inside of frame 2.
fn sheet(linear_solver: &str) -> (World, Arc<AtomicU32>) {
    let text = format!(
        r#"{{
          frames: 9, frames_per_second: 25, substeps: 4, linear_solver: "{linear_solver}",
          wind: {{ velocity: [3, 1, 0] }},
          cloths: [{{
            mesh: {{ grid: {{ size_m: [1, 1], cells: [8, 8] }} }}, fabric: "woven-light",
            remeshing: {{ size_m: {{ min: 0.05, max: 0.3 }}, refine_angle: 0.3 }},
          }}],
          handles: [
            {{ select: {{ corners: ["upper-left", "upper-right"] }} }},
            {{ select: {{ sides: ["lower"] }}, start_s: 0.05, end_s: 0.07 }},
          ],
        }}"#
    );
    let options = LoadOptions::default();
    let loaded = parse(text, "sheet.json5", &options, &from_sources(&[])).unwrap();
    let mut world = World::new(&loaded).unwrap();
    let budget = Arc::new(AtomicU32::new(u32::MAX));
    world.integrator = Box::new(Budget(budget.clone()));
    (world, budget)
}

#[track_caller]
fn assert_same(a: &World, b: &World) {
    assert_eq!((a.frame, a.cloth.mesh.triangles()), (b.frame, b.cloth.mesh.triangles()));
    assert_eq!(a.cloth, b.cloth);
    assert_eq!(a.handles, b.handles);
}

#[test]
fn a_failed_frame_leaves_no_trace_at_any_step() {
    for solver in ["auto", "stale-cholesky", "pcg"] {
        // What a run gives that goes on from a checkpoint of frame 1.
        let (mut good, _) = sheet(solver);
        good.advance().unwrap();
        let start = checkpoint::save(&mut good);
        good.advance().unwrap();
        good.advance().unwrap();
        assert!(good.handles.list()[1].held.iter().all(|(_, home)| home.is_some()));

        for steps in 0..4 {
            let (mut world, budget) = sheet(solver);
            world.advance().unwrap();
            let before = (world.cloth.clone(), world.handles.clone());
            budget.store(steps, Ordering::Relaxed);
            let error = world.advance().unwrap_err();
            let StepError::Solve { frame: 2, time, h, .. } = error else { panic!("{error}") };
            assert!((time - 0.04 - 0.01 * f64::from(steps)).abs() < 1e-12, "{time}");
            assert!((h - 0.01 / 64.0).abs() < 1e-12, "{h}");
            assert_eq!((world.frame, &world.cloth, &world.handles), (1, &before.0, &before.1));
            // It fails again in the same way, and goes on once it can.
            assert_eq!(
                world.advance().unwrap_err().to_string().split(": ").next(),
                Some("frame 2")
            );
            budget.store(u32::MAX, Ordering::Relaxed);
            let report = world.advance().unwrap();
            assert_eq!((report.frame, report.substeps, report.retries), (2, 4, 0));
            world.advance().unwrap();
            assert_same(&world, &good);
        }

        // A checkpoint after a failure is that of the last finished frame.
        let (mut world, budget) = sheet(solver);
        world.advance().unwrap();
        budget.store(2, Ordering::Relaxed);
        world.advance().unwrap_err();
        let saved = checkpoint::save(&mut world);
        assert_eq!((saved.frame, saved.time_s), (start.frame, start.time_s));
        for (a, b) in saved.columns.iter().zip(&start.columns) {
            assert_eq!(format!("{a:?}"), format!("{b:?}"));
        }
    }
}

/// At the first frame nothing is known yet that could be forgotten.
#[test]
fn a_first_frame_that_failed_has_the_bits_of_one_that_did_not() {
    let ((mut good, _), (mut failed, budget)) = (sheet("auto"), sheet("auto"));
    budget.store(3, Ordering::Relaxed);
    failed.advance().unwrap_err();
    budget.store(u32::MAX, Ordering::Relaxed);
    for _ in 0..3 {
        good.advance().unwrap();
        failed.advance().unwrap();
        assert_same(&good, &failed);
    }
}

/// What a free sheet loses in height it wins in speed, stretched and bent as it may be.
#[test]
fn reported_energies_add_up() {
    let text = "{frames: 5, substeps: 50, newton: {max_iterations: 50, tolerance: 1e-9}, cloths: [
        {fabric: 'woven-light', mesh: {grid: {size_m: [1, 1], cells: [6, 6]}},
         initial_spin: {angular_velocity: [0.3, 2, 1], center: [0.5, 0.5, 0]}}]}";
    let loaded = parse(text, "s", &LoadOptions::default(), &from_sources(&[])).unwrap();
    let mut world = World::new(&loaded).unwrap();
    let energy = |report: &crate::report::FrameReport| {
        report.kinetic_energy_j + report.potential_energy_j.unwrap()
    };
    let first = crate::report::FrameReport::initial(&world);
    for _ in 0..5 {
        let report = world.advance().unwrap();
        assert!(report.kinetic_energy_j > first.kinetic_energy_j + 0.01);
        let change = energy(&report) - energy(&first);
        assert!(change.abs() < 1e-4 * report.kinetic_energy_j, "{change} J");
    }
}

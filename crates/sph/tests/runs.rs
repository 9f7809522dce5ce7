//! Whole runs: the same bits at any number of threads and after a restart, nozzles and sinks, scenes.

mod common;

use arps::Speed;
use mesh_core::par;
use nalgebra::Vector3;
use sph::{
    Bounds, Checkpoint, Emitter, Fluid, FluidError, FluidSettings, Open, RestraintSettings,
    Seconds, Sink, StepReport, Walls, scenes,
};

/// Restrained fluid in which some particles move and some rest.
fn half_at_rest() -> Fluid<Speed> {
    let fluid = common::block_in_box([8, 6, 8], [12, 8, 14], 9);
    let settings = RestraintSettings {
        bleeding: Some(0.02),
        inactivity: 0.02,
        ..RestraintSettings::of(fluid.settings())
    };
    fluid.restrained(Speed::new(0.1, 0.2).unwrap(), settings).unwrap()
}

/// A report without the times.
fn counts(report: StepReport) -> StepReport {
    StepReport { seconds: Seconds::default(), ..report }
}

#[test]
fn threads_do_not_change_a_bit() {
    let run = |n| {
        let work = || {
            let mut fluid = half_at_rest();
            let report = fluid.advance(1.8).unwrap();
            (common::bits(&fluid), counts(report))
        };
        par::with_threads(n, work).unwrap()
    };
    let (one, report) = run(1);
    assert!(report.sweeps < report.steps, "some steps are incremental: {report:?}");
    for n in [2, 3] {
        assert!(run(n) == (one.clone(), report), "{n} threads");
    }
}

#[test]
fn a_restart_does_not_change_a_bit() {
    let mut fluid = half_at_rest();
    let mut again = half_at_rest();
    let mut kinds = [0; 2];
    for _ in 0..12 {
        let report = fluid.advance(0.21).unwrap();
        kinds[0] += report.sweeps;
        kinds[1] += report.steps - report.sweeps;
        // A fluid fresh from the scene goes on from here as the first one does.
        let saved = fluid.checkpoint();
        let mut resumed = half_at_rest();
        resumed.restore(&saved).unwrap();
        assert_eq!(resumed.checkpoint(), saved);
        again.restore(&saved).unwrap();
        let (a, b) = (fluid.clone().advance(0.1).unwrap(), resumed.advance(0.1).unwrap());
        let mut ahead = fluid.clone();
        ahead.advance(0.1).unwrap();
        assert_eq!(counts(a), counts(b));
        assert_eq!(common::bits(&ahead), common::bits(&resumed));
        assert_eq!(ahead.checkpoint(), resumed.checkpoint());
    }
    assert!(kinds.iter().all(|&n| n > 100), "both kinds of step were met: {kinds:?}");
}

#[test]
fn a_checkpoint_that_does_not_fit_is_refused() {
    let mut fluid = half_at_rest();
    fluid.advance(0.05).unwrap();
    let saved = fluid.checkpoint();
    let short = Checkpoint { density: vec![], ..saved.clone() };
    let walls = Checkpoint { walls: vec![[0.0; 2]; 3], ..saved.clone() };
    let mut lost = saved.clone();
    lost.x[5][1] = f64::NAN;
    for bad in [short, walls, lost] {
        assert!(fluid.restore(&bad).is_err());
        assert_eq!(fluid.checkpoint(), saved, "nothing has changed");
    }
}

#[test]
fn nozzles_let_out_what_they_should_and_sinks_take_it() {
    let room = Bounds::new(Vector3::zeros(), Vector3::new(2.0, 1.0, 1.0));
    let settings = FluidSettings {
        gravity: Vector3::zeros(),
        ..FluidSettings::water(common::SPACING, 1.0, room)
    };
    let mut fluid = Fluid::new(settings, Walls::none(), &[], &[]).unwrap();
    let nozzle = |centre| Emitter::new(centre, Vector3::x(), [0.1, 0.075], 0.5).unwrap();
    fluid.add_emitter(nozzle(Vector3::new(0.2, 0.5, 0.5))).unwrap();
    let outside = fluid.add_emitter(nozzle(Vector3::new(0.2, 0.0, 0.5)));
    assert!(matches!(outside, Err(FluidError::OutOfRange { .. })));
    fluid.add_sink(Sink(Bounds::new(Vector3::new(1.0, 0.0, 0.0), room.max)));
    // Layers of four by three leave every tenth of a second, from the start on.
    let report = fluid.advance(1.05).unwrap();
    assert_eq!((report.emitted, report.drained, fluid.len()), (12 * 11, 0, 12 * 11));
    let report = fluid.advance(2.0).unwrap();
    assert_eq!(report.emitted, 12 * 20);
    assert_eq!(fluid.len() as u64, 12 * 31 - report.drained);
    assert!(report.drained >= 12 * 12, "{report:?}");
    assert!(fluid.particles().all(|p| p.position.x < 1.0));
    for bad in [0.0, f64::NAN, -1.0] {
        assert!(Emitter::new(Vector3::zeros(), Vector3::x(), [0.1, 0.1], bad).is_err());
        assert!(
            Emitter::new(Vector3::zeros(), Vector3::x() * bad, [0.1, 0.1], 1.0).is_err()
                || bad < 0.0
        );
    }
}

#[test]
fn water_rests_on_a_mesh_as_it_does_in_a_box() {
    // The floor of the box is made of two triangles instead.
    let inside = common::tank([8, 8, 10]);
    let mut walls = Walls::none();
    let open = Open { low: [false, false, true], high: [false, false, true] };
    walls.add_box(&inside, open, common::SPACING).unwrap();
    let far = 0.2;
    let corners = [
        Vector3::new(-far, -far, 0.0),
        Vector3::new(0.4 + far, -far, 0.0),
        Vector3::new(0.4 + far, 0.4 + far, 0.0),
        Vector3::new(-far, 0.4 + far, 0.0),
    ];
    let floor = [[0, 1, 2], [0, 2, 3]];
    walls.add_mesh(&corners, &floor, common::SPACING).unwrap();
    let settings = FluidSettings::water(common::SPACING, 0.3, inside.grown(0.5));
    let x = scenes::block([8, 8, 6], Vector3::zeros(), common::SPACING, 0);
    let mut fluid = Fluid::new(settings, walls, &x, &vec![Vector3::zeros(); x.len()]).unwrap();
    fluid.advance(2.0).unwrap();
    let lowest = fluid.particles().map(|p| p.position.z).fold(f64::INFINITY, f64::min);
    assert!(lowest > 0.0, "{lowest} m");
    let mean = fluid.particles().map(|p| p.position.z).sum::<f64>() / fluid.len() as f64;
    assert!((mean - 0.15).abs() < 0.2 * common::SPACING, "centre of mass at {mean} m");

    let mut walls = Walls::none();
    assert!(walls.add_mesh(&corners, &[[0, 1, 4]], common::SPACING).is_err());
    assert!(
        walls.add_mesh(&[Vector3::repeat(f64::NAN); 3], &[[0, 1, 2]], common::SPACING).is_err()
    );
    assert!(walls.add_mesh(&corners, &floor, 1e-9).is_err(), "too many particles");
    assert!(walls.add_box(&inside, open, 0.0).is_err());
    assert_eq!(walls.n_particles(), 0, "what failed left nothing");
}

#[test]
fn scenes_are_made_and_run() {
    let mut flow = scenes::permanent_flow(0).unwrap().fluid;
    assert!(flow.advance(0.1).unwrap().emitted > 0);
    for scene in [scenes::dam_break(6, 1), scenes::block_fall(6, 1)] {
        let mut fluid = scene.unwrap().fluid;
        let before = fluid.particles().map(|p| p.position.z).sum::<f64>();
        fluid.advance(0.05).unwrap();
        assert!(fluid.particles().map(|p| p.position.z).sum::<f64>() < before);
    }
    assert!(scenes::dam_break(0, 0).is_err());
}

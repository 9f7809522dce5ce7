//! Fluid that is restrained by what cameras see: who rests, when it wakes, what is told of it.

use mesh_core::{World3, par};
use organza::checkpoint;
use organza::report::{FluidSummary, FrameReport};
use organza::scene::{LoadOptions, Loaded, from_sources, load, parse};
use organza::world::World;
use sph::Bounds;
use sph::measure::Observation;
use std::path::Path;

fn scene(text: &str) -> Loaded {
    parse(text, "s.json5", &LoadOptions::default(), &from_sources(&[]))
        .unwrap_or_else(|errors| panic!("{errors}"))
}

/// Water in a basin that is 2.4 m long, with more keys of the fluid and the scene.
fn basin(fluid: &str, top: &str) -> World {
    let text = format!(
        "{{ frames: 100, fluids: [{{ spacing_m: 0.05, sound_speed_m_per_s: 25,
            blocks: [{{ min: [0, 0, 0], max: [2.4, 0.2, 0.3] }}],
            boxes: [{{ min: [0, 0, 0], max: [2.4, 0.2, 0.8] }}],
            {fluid} }}], {top} }}"
    );
    World::new(&scene(&text)).unwrap_or_else(|error| panic!("{error}"))
}

/// More of it pours into the left end.
const POURING: &str =
    "emitters: [{ position: [0.3, 0.1, 0.6], direction: [0, 0, -1], size_m: [0.1, 0.1],
     speed_m_per_s: 1 }],";

/// Sees the left half, where water pours in: 1.2 m of the basin at its back.
const LEFT: &str =
    "camera: { position: [0.5, -1, 0.5], target: [0.5, 0.1, 0.3], resolution: [640, 360] },
     view: { margin_m: 0.3 },";

const BY_VIEW: &str = "restraint: { policy: 'view', restrain_below_px_per_frame: 0.2,
     restore_above_px_per_frame: 0.4, most_m_per_s: 0.1 }";

fn run(world: &mut World, frames: usize) -> Vec<FrameReport> {
    (0..frames).map(|_| world.advance().unwrap_or_else(|e| panic!("{e}"))).collect()
}

/// Shares of the particles that rest in the picture, and in what is beyond its margin: left of the first and
/// right of the second of these (m).
fn resting(world: &World, [left, right]: [f64; 2]) -> [f64; 2] {
    let mut counts = [[0.0; 2]; 2];
    for particle in world.fluid.as_ref().unwrap().particles().unwrap() {
        let x = particle.position[0];
        let part = &mut counts[usize::from(x > left)];
        let counts = f64::from(u8::from(!(left..right).contains(&x)));
        part[0] += counts;
        part[1] += counts * f64::from(u8::from(particle.state == 2));
    }
    counts.map(|[all, rest]| rest / all)
}

/// What is out of the picture rests sooner, which saves work, and what shows is no worse for it than under
/// thresholds of energy that let as much of it rest.
#[test]
fn what_is_out_of_the_picture_rests_sooner() {
    let left = Bounds::new(World3::zeros(), World3::new(1.2, 0.2, 0.8));
    let seen = |world: &World| Observation::new(&world.fluid.as_ref().unwrap().fluid, &left);
    let mass = 1000.0 * 0.05_f64.powi(3);
    let kinetic = format!(
        "restraint: {{ policy: 'kinetic', restrain_below_j: {}, restore_above_j: {} }}",
        0.5 * mass * 0.1 * 0.1,
        0.5 * mass * 0.2 * 0.2
    );
    let mut worlds =
        ["", BY_VIEW, &kinetic].map(|restraint| basin(&format!("{POURING} {restraint}"), LEFT));
    let mut errors = [0.0; 3];
    let mut rest = [[0.0; 2]; 3];
    for frame in 0..50 {
        let observed: Vec<Observation> = worlds
            .iter_mut()
            .map(|world| {
                run(world, 1);
                seen(world)
            })
            .collect();
        for k in 0..3 {
            errors[k] += observed[k].difference(&observed[0]).height.powi(2);
            if frame >= 10 {
                let [inside, outside] = resting(&worlds[k], [1.2, 1.6]);
                rest[k] = [rest[k][0] + inside / 40.0, rest[k][1] + outside / 40.0];
            }
        }
    }
    let [free, view, by_energy] = rest;
    assert_eq!(free, [0.0; 2]);
    assert!(view[1] > 0.4 && view[0] < 0.1 * view[1], "{rest:?}");
    assert!(view[1] > 0.7 * by_energy[1] && view[0] < by_energy[0], "{rest:?}");
    assert!(errors[1] <= errors[2], "{errors:?}");
}

/// A scene whose camera looks away, and after two seconds at the water.
fn cut(fluid: &str) -> World {
    let look = |start: f64, target: &str| {
        let at = format!("time_s: {start}, position: [1.2, -4, 0.3], target: {target}");
        format!("{{ start_s: {start}, keyframes: [{{ {at} }}] }}")
    };
    let shots = format!("{}, {}", look(0.0, "[1.2, -9, 0.3]"), look(2.0, "[1.2, 0, 0.3]"));
    basin(
        fluid,
        &format!(
            "camera: {{ position: [1.2, -4, 0.3], target: [1.2, 0, 0.3], resolution: [640, 360] }},
             shots: [{shots}],"
        ),
    )
}

/// Fluid that rests out of the picture keeps its momentum, and with that moves before a cut to it, as soon as
/// the window shows the camera of the cut.
#[test]
fn fluid_wakes_before_a_cut_to_it() {
    let mut world = cut(&BY_VIEW.replace("0.2,", "0.05,"));
    let reports = run(&mut world, 51);
    let fluid = |frame: usize| reports[frame - 1].fluid.unwrap();
    let share =
        |fluid: FluidSummary, n: u64| n as f64 / (fluid.steps * fluid.particles as u64) as f64;
    let moved = |frame: usize| share(fluid(frame), fluid(frame).moved);
    // The window is 5 frames long, and the first frame after the cut is number 51. What a report tells of
    // thresholds is true from the next frame on.
    let rest = |frame: usize| fluid(frame).view.unwrap();
    for frame in 1..=45 {
        assert_eq!((rest(frame).rest_min_m_per_s, rest(frame).rest_max_m_per_s), (0.1, 0.1));
    }
    for frame in 46..=51 {
        assert!(rest(frame).rest_max_m_per_s < 0.05, "{frame}: {:?}", rest(frame));
    }
    assert!(moved(46) < 0.3, "{}", moved(46));
    assert!((47..=51).all(|frame| moved(frame) > 1.5 * moved(46)));
}

/// Nothing but a policy by view makes a fluid look at cameras.
#[test]
fn without_a_camera_nothing_looks() {
    let speed = "restraint: { restrain_below_m_per_s: 0.1, restore_above_m_per_s: 0.2 }";
    for (fluid, top) in [("", LEFT), (speed, LEFT), (speed, "")] {
        let report = run(&mut basin(fluid, top), 1).remove(0);
        assert_eq!((report.seconds.view, report.fluid.unwrap().view), (0.0, None));
        let told = report.skipped.iter().any(|text| text.starts_with("view: who rests"));
        assert_eq!(told, !fluid.is_empty(), "{:?}", report.skipped);
    }
    let report = run(&mut basin(BY_VIEW, LEFT), 1).remove(0);
    assert!(report.seconds.view > 0.0);
    let view = report.fluid.unwrap().view.unwrap();
    assert!(view.rest_min_m_per_s < 0.5 * view.rest_max_m_per_s, "{view:?}");
    assert_eq!(view.rest_max_m_per_s, 0.1);
    assert!(report.skipped.iter().all(|text| !text.starts_with("view")), "{:?}", report.skipped);
}

/// A screen before the camera lets what it hides rest sooner, if occlusion is to count.
#[test]
fn what_is_hidden_rests_sooner() {
    let screen = "obstacles: [{ mesh: { box: { size_m: [0.75, 0.02, 2] } },
        transform: { translate: [0.075, -0.5, 0.5] } }],";
    let fluid = format!("obstacles: [], {BY_VIEW}");
    let least = |keys: &str| {
        let top = LEFT.replace("margin_m: 0.3", &format!("margin_m: 0.3, {keys}")) + screen;
        let world = basin(&fluid, &top);
        let water = world.fluid.as_ref().unwrap();
        let policy = water.fluid.policy().unwrap();
        let mass = water.fluid.particle_mass();
        let of = |p: sph::Particle| {
            use arps::Restraint;
            let index = p.id as usize;
            policy.at(&arps::Particle { index, mass, x: p.position, time: 0.0 }).p_r() / mass
        };
        let behind = water.fluid.particles().filter(|p| p.position.x < 0.3);
        behind.map(of).fold(f64::INFINITY, f64::min)
    };
    let (open, hidden) = (least("occlusion: false"), least("occlusion: true, v_hidden: 0.5"));
    assert!((hidden / open - 2.0).abs() < 1e-9, "{hidden} {open}");
}

/// The same bits at any number of threads, and after a restart between two looks.
#[test]
fn runs_by_view_keep_their_bits() {
    let start = || cut(&format!("{POURING} {BY_VIEW}"));
    let bits = |world: &World| world.fluid.as_ref().unwrap().fluid.checkpoint();
    let on = |threads: usize| {
        let work = || {
            let mut world = start();
            let reports = run(&mut world, 48);
            assert!(reports.iter().any(|r| r.fluid.unwrap().sweeps < r.fluid.unwrap().steps));
            bits(&world)
        };
        par::with_threads(threads, work).unwrap()
    };
    let one = on(1);
    assert!(on(2) == one);
    let mut world = start();
    run(&mut world, 43);
    let saved = checkpoint::save(&mut world);
    let mut resumed = start();
    checkpoint::restore(&mut resumed, &saved).unwrap();
    run(&mut resumed, 5);
    assert!(bits(&resumed) == one);
}

/// The scene of restraint by view, with larger particles: it rests most where its camera does not look.
#[test]
fn flow_in_view_rests_out_of_the_picture() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/flow-in-view.json5");
    let count = |sets: &[&str]| {
        let sets = sets.iter().map(|set| (*set).to_owned()).collect();
        let loaded = load(&path, &LoadOptions { sets, allow_unsupported: false }).unwrap();
        assert!(loaded.warnings.is_empty() && loaded.scene.frames == 200, "{:?}", loaded.warnings);
        World::new(&loaded).unwrap()
    };
    assert_eq!(count(&[]).fluid.unwrap().fluid.len(), 64 * 8 * 8);
    let mut world = count(&["fluids[0].spacing_m=0.1"]);
    run(&mut world, 60);
    let [inside, outside] = resting(&world, [2.0, 2.4]);
    assert!(outside > 0.3 && inside < 0.5 * outside, "{inside} {outside}");
}

/// Thresholds by an error in pixels are those of the policy by view.
#[test]
fn an_error_in_pixels_chooses_thresholds() {
    let fluid = |keys: &str| basin(&format!("restraint: {{ {keys} }}"), LEFT).fluid.unwrap().fluid;
    // 4 s at 25 frames per second: 0.2 pixels per frame, and √20 times that.
    let chosen = fluid("policy: 'automatic-view', error_px: 20");
    let full = 0.2 * 20.0_f64.sqrt();
    let given = fluid(&format!(
        "policy: 'view', restrain_below_px_per_frame: 0.2, restore_above_px_per_frame: {full}"
    ));
    let half = fluid("policy: 'automatic-view', error_px: 10, duration_s: 2");
    let rest = |fluid: &sph::Fluid<organza::fluid::Policy>| match fluid.policy() {
        Some(organza::fluid::Policy::View(policy)) => policy.thresholds.rest(),
        other => panic!("{other:?}"),
    };
    for fluid in [&chosen, &half] {
        assert!((rest(fluid) - rest(&given)).abs() < 1e-12, "{}", rest(fluid));
    }
}

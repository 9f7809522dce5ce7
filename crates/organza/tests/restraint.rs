//! Restraint in scenes: what is refused, what rests, and that runs keep their bits.

use std::path::Path;

use organza::checkpoint;
use organza::report::FrameReport;
use organza::scene::{LoadOptions, Loaded, from_sources, load, parse};
use organza::world::World;

fn parsed(text: &str) -> Result<Loaded, String> {
    parse(text, "s.json5", &LoadOptions::default(), &from_sources(&[])).map_err(|e| e.to_string())
}

/// A small sheet that hangs, with some more keys.
fn sheet(keys: &str, cloth: &str) -> String {
    format!(
        "{{ frames: 40, substeps: 2, integrator: 'implicit-euler', {keys}
           cloths: [{{ mesh: {{ grid: {{ size_m: [0.4, 0.4], cells: [5, 5] }} }}, fabric: 'denim',
             transform: {{ rotate: {{ axis: [1, 0, 0], degrees: 80 }} }},
             damping: {{ mass_per_s: 4, stiffness_s: 0.01 }}, {cloth} }}],
           handles: [{{ select: {{ sides: ['upper'] }} }}] }}"
    )
}

const SPEED: &str = "restraint: { thresholds: { speed: { rest_m_per_s: 0.02, full_m_per_s: 0.08 } }, bleeding_s: 0.3 },";

fn own(name: &str, sets: &[&str]) -> Loaded {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(name);
    let sets = sets.iter().map(|set| (*set).to_owned()).collect();
    let loaded = load(&path, &LoadOptions { sets, allow_unsupported: false });
    let loaded = loaded.unwrap_or_else(|errors| panic!("{errors}"));
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    loaded
}

fn run(world: &mut World, frames: usize) -> Vec<FrameReport> {
    (0..frames).map(|_| world.advance().unwrap_or_else(|e| panic!("{e}"))).collect()
}

#[test]
fn bad_thresholds_are_told_with_their_place() {
    for (keys, told) in [
        ("restraint: { thresholds: { speed: { rest_m_per_s: 2, full_m_per_s: 1 } } },", "inverted"),
        (
            "restraint: { thresholds: { speed: { rest_m_per_s: 1, full_m_per_s: 1 } } },",
            "more room",
        ),
        (
            "restraint: { thresholds: { speed: { rest_m_per_s: -1, full_m_per_s: 1 } } },",
            "restraint.thresholds.speed.rest_m_per_s: must be zero or more",
        ),
        (
            "restraint: { thresholds: { speed: { rest_m_per_s: 1, full_m_per_s: 1e9 } } },",
            "beyond the limit",
        ),
        ("restraint: { thresholds: { kinetic: { rest_j: 1, full_j: 0.5 } } },", "inverted"),
        (
            "restraint: { thresholds: { automatic: { error_m: -1 } } },",
            "restraint.thresholds.automatic.error_m: must be zero or more",
        ),
        (
            "restraint: { thresholds: 'none', bleeding_s: 0 },",
            "restraint.bleeding_s: must be positive",
        ),
        ("restraint: { thresholds: 'none', law: 'spline' },", "spline"),
        ("restraint: { thresholds: { speed: { rest_m_per_s: 1 } } },", "full_m_per_s"),
        ("restraint: { law: 'ramp' },", "thresholds"),
        (
            "restraint: { thresholds: { view: { rest_px_per_frame: 0.1, full_px_per_frame: 1 } } },",
            "no `camera`",
        ),
        (
            "camera: { position: [2, 0, 0], target: [0, 0, 0] },
             restraint: { thresholds: { view: { rest_px_per_frame: 1, full_px_per_frame: 0.1 } } },",
            "inverted",
        ),
        (
            "camera: { position: [2, 0, 0], target: [0, 0, 0] },
             restraint: { thresholds: { view:
               { rest_px_per_frame: 0.1, full_px_per_frame: 1, most_m_per_s: -1 } } },",
            "restraint.thresholds.view.most_m_per_s: must be zero or more",
        ),
        (
            "camera: { position: [2, 0, 0], target: [0, 0, 0] },
             restraint: { thresholds: { 'automatic-view': { error_px: -1 } } },",
            "restraint.thresholds.automatic-view.error_px: must be zero or more",
        ),
        ("restraint: true,", "restraint"),
    ] {
        let error = parsed(&sheet(keys, "")).unwrap_err();
        assert!(error.starts_with("s.json5:") && error.contains(told), "{keys}\n{error}");
    }
    let own = "restraint: { thresholds: { kinetic: { rest_j: 2, full_j: 1 } } }";
    let error = parsed(&sheet("", own)).unwrap_err();
    assert!(error.contains("cloths[0].restraint.thresholds"), "{error}");
}

#[test]
fn no_restraint_and_that_of_nothing_have_the_same_bits() {
    let mut plain = World::new(&parsed(&sheet("", "")).unwrap()).unwrap();
    assert!(run(&mut plain, 4).iter().all(|report| report.restraint.is_none()));
    assert!(plain.skipped().iter().any(|text| text.starts_with("restraint")));
    let zero = "restraint: { thresholds: { speed: { rest_m_per_s: 0, full_m_per_s: 0 } } },";
    for (keys, cloth) in [
        ("restraint: { thresholds: 'none' },", ""),
        (zero, ""),
        (SPEED, "restraint: { thresholds: 'none' }"),
    ] {
        let mut world = World::new(&parsed(&sheet(keys, cloth)).unwrap()).unwrap();
        run(&mut world, 4);
        assert_eq!((&world.cloth.x, &world.cloth.v), (&plain.cloth.x, &plain.cloth.v), "{keys}");
    }
}

/// A run that goes on from a checkpoint has the bits of one that saved there and went on.
#[test]
fn resumed_runs_have_the_same_bits() {
    let loaded = parsed(&sheet(SPEED, "")).unwrap();
    let mut world = World::new(&loaded).unwrap();
    let mut states = Vec::new();
    for _ in 0..4 {
        run(&mut world, 9);
        let saved = checkpoint::save(&mut world);
        let mut other = World::new(&loaded).unwrap();
        checkpoint::restore(&mut other, &saved).unwrap();
        let reports = run(&mut world, 5);
        run(&mut other, 5);
        assert_eq!((&world.cloth.x, &world.cloth.v), (&other.cloth.x, &other.cloth.v));
        states.extend(reports.into_iter().map(|report| report.restraint.unwrap()));
    }
    // It had moved, and it has slept.
    assert!(states[0].active > 0 && states.last().unwrap().resting == 36, "{states:?}");
}

/// Frames of sleep assemble and solve nothing, and say so.
#[test]
fn what_rests_is_left_alone() {
    let mut world = World::new(&parsed(&sheet(SPEED, "")).unwrap()).unwrap();
    let reports = run(&mut world, 150);
    let slept: Vec<&FrameReport> = reports
        .iter()
        .filter(|report| {
            let restraint = report.restraint.as_ref().unwrap();
            restraint.stages == restraint.stages_slept
        })
        .collect();
    assert!(slept.len() > 40, "{}: {:?}", slept.len(), reports.last());
    for report in slept {
        assert_eq!((report.newton_iterations, report.factorisations), (0, 0));
        let seconds = &report.seconds;
        assert_eq!((seconds.assembly, seconds.linear, seconds.energy), (0.0, 0.0, 0.0));
        let restraint = report.restraint.as_ref().unwrap();
        assert_eq!((restraint.resting, restraint.states.join("").as_str()), (36, "36r"));
        assert_eq!(report.kinetic_energy_j, 0.0);
    }
    // Without work from outside, energy only falls.
    let energies: Vec<f64> =
        reports.iter().map(|report| report.restraint.as_ref().unwrap().energy_j).collect();
    let fall = energies[0] - energies.last().unwrap();
    assert!(fall > 0.0);
    assert!(energies.windows(2).all(|pair| pair[1] <= pair[0] + 1e-6 * fall), "{energies:?}");
}

/// With remeshing every frame, too, what has come to rest is left alone.
#[test]
fn remeshed_cloth_rests() {
    let remeshing = "remeshing: { size_m: { min: 0.05, max: 0.2 }, refine_angle: 0.3 }";
    let mut world = World::new(&parsed(&sheet(SPEED, remeshing)).unwrap()).unwrap();
    let reports = run(&mut world, 150);
    assert!(reports.iter().any(|report| report.remesh.is_some_and(|r| r.splits + r.collapses > 0)));
    let last = reports.last().unwrap().restraint.as_ref().unwrap();
    assert_eq!((last.stages_slept, last.resting), (last.stages, world.cloth.mesh.n_vertices()));
}

#[test]
fn hanging_cloth_is_pushed_once() {
    let loaded = own("hanging-cloth.json5", &["cloths[0].mesh.grid.cells=[6, 6]"]);
    let [_, push] = &loaded.scene.handles[..] else { panic!() };
    assert_eq!((push.start_s, loaded.scene.frames), (20.0, 750));
    let mut world = World::new(&loaded).unwrap();
    let reports = run(&mut world, 6);
    assert!(reports.iter().all(|report| report.restraint.as_ref().unwrap().active > 30));
}

#[test]
fn poke_wakes_cloth_that_sleeps() {
    let loaded = own("poke.json5", &["cloths[0].mesh.grid.cells=[6, 6]"]);
    let mut world = World::new(&loaded).unwrap();
    let before = run(&mut world, 50);
    let state = |report: &FrameReport| report.restraint.clone().unwrap();
    assert_eq!(state(&before[49]).stages_slept, 1);
    let poked = run(&mut world, 6);
    assert!(poked.iter().all(|report| state(report).stages_slept == 0));
    assert!(poked.iter().any(|report| state(report).active > 20), "{:?}", poked.last());
    // After it is let go, energy falls.
    let energies: Vec<f64> = poked[3..].iter().map(|report| state(report).energy_j).collect();
    assert!(energies.windows(2).all(|pair| pair[1] <= pair[0]), "{energies:?}");
}

#[test]
fn the_table_cloth_sleeps_beside_the_ball_and_after_it() {
    let loaded = own("table.json5", &["cloths[0].mesh.grid.cells=[24, 12]"]);
    let mut world = World::new(&loaded).unwrap();
    let start = world.cloth.x.clone();
    let reports = run(&mut world, 220);
    let state = |frame: usize| reports[frame - 1].restraint.clone().unwrap();
    assert_eq!(state(100).stages_slept, state(100).stages);
    // The ball is on the cloth, which it moves.
    let moving = state(140);
    assert!(moving.resting < 325 && moving.resting > 100, "{moving:?}");
    assert!(world.cloth.x.iter().zip(&start).any(|(a, b)| (a - b).norm() > 1e-3));
    assert_eq!(state(220).stages_slept, state(220).stages, "{:?}", state(220));
    assert!(reports.iter().all(|report| report.crossings.is_none_or(|n| n == 0)));
}

/// A small sheet on a board that leans by so many degrees, and goes to the side after a second.
fn on_a_board(degrees: f64, side_m: f64) -> World {
    let tilt = format!("rotate: {{ axis: [0, 1, 0], degrees: {degrees} }}");
    let text = format!(
        "{{ frames: 100, substeps: 4, integrator: 'implicit-euler', {SPEED}
           contact: {{ thickness_m: 0.005, friction: 0.4, self_contact: false }},
           cloths: [{{ mesh: {{ grid: {{ size_m: [0.2, 0.2], cells: [4, 4] }} }}, fabric: 'denim',
             transform: {{ {tilt}, translate: [0, 0, 0.006] }},
             damping: {{ mass_per_s: 4, stiffness_s: 0.01 }} }}],
           obstacles: [{{ mesh: {{ box: {{ size_m: [4, 4, 0.04] }} }}, friction: 0.4, motion: {{ keyframes: [
             {{ time_s: 1, transform: {{ {tilt}, translate: [0, 0, -0.02] }} }},
             {{ time_s: 3, transform: {{ {tilt}, translate: [0, {side_m}, -0.02] }} }} ] }} }}] }}"
    );
    World::new(&parsed(&text).unwrap_or_else(|e| panic!("{e}"))).unwrap()
}

/// Static friction in contacts holds what rests, up to its limit and not beyond, and what rests is carried
/// along.
#[test]
fn friction_holds_what_rests_on_a_slope() {
    // tan 14° = 0.25, tan 30° = 0.58.
    let mut shallow = on_a_board(14.0, 0.0);
    let last = run(&mut shallow, 60).pop().unwrap().restraint.unwrap();
    assert_eq!((last.resting, last.stages_slept), (25, last.stages), "{last:?}");
    let mut steep = on_a_board(30.0, 0.0);
    let before = steep.cloth.x.clone();
    let last = run(&mut steep, 60).pop().unwrap().restraint.unwrap();
    let way = before.iter().zip(&steep.cloth.x).map(|(a, b)| (a - b).norm());
    let way = way.fold(f64::INFINITY, f64::min);
    // g (sin 30° - 0.4 cos 30°), less the drag of the air: some 20 cm in the first 0.5 s.
    assert!(last.resting == 0 && way > 0.5, "{way} {last:?}");

    let mut carried = on_a_board(0.0, 0.5);
    run(&mut carried, 20);
    let before = carried.cloth.x.clone();
    run(&mut carried, 60);
    let ways: Vec<f64> = before.iter().zip(&carried.cloth.x).map(|(a, b)| b.y - a.y).collect();
    assert!(ways.iter().all(|way| (way - 0.5).abs() < 0.05), "{ways:?}");
}

/// Out of the picture a sheet is restrained that moves slowly; before a cut to it, it is not any more.
#[test]
fn cloth_wakes_before_a_cut_to_it() {
    let view = |keys: &str| {
        let look = |start: f64, target: &str| {
            let at = format!("time_s: {start}, position: [0.2, -3, 0], target: {target}");
            format!("{{ start_s: {start}, keyframes: [{{ {at} }}] }}")
        };
        let shots = format!("{}, {}", look(0.0, "[0, -9, 0]"), look(1.0, "[0.2, 0, 0]"));
        let keys = format!(
            "camera: {{ position: [0.2, -3, 0], target: [0.2, 0, 0] }}, shots: [{shots}],
             restraint: {{ bleeding_s: 0.3, thresholds: {{ {keys} }} }},"
        );
        World::new(&parsed(&sheet(&keys, "")).unwrap()).unwrap()
    };
    let mut world =
        view("view: { rest_px_per_frame: 0.002, full_px_per_frame: 0.01, most_m_per_s: 0.2 }");
    let reports = run(&mut world, 26);
    let active = |frame: usize| reports[frame - 1].restraint.as_ref().unwrap().active;
    // The window is 5 frames long, and the first frame after the cut is number 26. Six are held.
    assert!((18..=20).all(|frame| active(frame) < 15), "{reports:?}");
    assert!((21..=26).all(|frame| active(frame) >= 28), "{reports:?}");
    // It is the policy that the scene chooses for an error in pixels, too.
    let mut chosen = view("'automatic-view': { error_px: 0.8 }");
    let reports = run(&mut chosen, 40);
    assert!(reports[19].restraint.as_ref().unwrap().resting > 30, "{:?}", reports[19]);
}

/// Whoever stands has clothes that rest, and whoever dances does not.
#[test]
fn a_resting_crowd_dances_in_part() {
    let sets = ["crowd.count=4", "crowd.columns=2", "substeps=4", "crowd.character.ease_s=0.5"];
    let loaded = own("resting-crowd.json5", &sets);
    assert_eq!(loaded.scene.frames, 125);
    let mut world = World::new(&loaded).unwrap();
    run(&mut world, 75);
    let state = |report: &FrameReport| report.restraint.clone().unwrap();
    let after = run(&mut world, 30);
    assert_eq!(world.crossings(105), None);
    let last = state(&after[29]);
    let share = |garment: usize| {
        let mut counts = [0usize; 2];
        for run in last.states[garment].split_inclusive(char::is_alphabetic) {
            let (n, letter) = run.split_at(run.len() - 1);
            counts[usize::from(letter == "r")] += n.parse::<usize>().unwrap();
        }
        counts[1] as f64 / (counts[0] + counts[1]) as f64
    };
    let shares = [0, 1, 2, 3].map(share);
    assert!(shares[..3].iter().all(|share| *share > 0.8) && shares[3] < 0.5, "{shares:?}");
}

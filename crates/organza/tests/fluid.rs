//! Fluids from scene files: what is built, moved, recorded, continued, drawn and exported.

mod scene_help;

use std::path::{Path, PathBuf};

use io_mcap::{OwnedFrame, Recording};
use organza::checkpoint;
use organza::export::{Format, export};
use organza::picture::{self, PictureOptions, View};
use organza::record::{FrameRange, Resumed, Run, RunOptions, resume};
use organza::render::Size;
use organza::scene::{LoadOptions, Loaded, from_sources, load, parse};
use organza::world::World;
use scene_help::{complains, with};

fn own(name: &str, sets: &[&str]) -> Loaded {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(name);
    let sets = sets.iter().map(|set| (*set).to_owned()).collect();
    let options = LoadOptions { sets, allow_unsupported: false };
    let loaded = load(&path, &options).unwrap_or_else(|errors| panic!("{errors}"));
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    loaded
}

fn scene(text: &str) -> Loaded {
    parse(text, "s.json5", &LoadOptions::default(), &from_sources(&[]))
        .unwrap_or_else(|errors| panic!("{errors}"))
}

fn world(loaded: &Loaded) -> World {
    World::new(loaded).unwrap_or_else(|error| panic!("{error}"))
}

fn refusal(text: &str) -> String {
    World::new(&scene(text)).unwrap_err().to_string()
}

/// A basin of 0.4 m with water up to `height` (m), and more keys of the fluid and the scene.
fn basin(height: f64, fluid: &str, top: &str) -> String {
    format!(
        "{{ frames: 4, fluids: [{{ spacing_m: 0.05,
            blocks: [{{ min: [0, 0, 0], max: [0.4, 0.4, {height}] }}],
            boxes: [{{ min: [0, 0, 0], max: [0.4, 0.4, 0.8] }}], {fluid} }}], {top} }}"
    )
}

/// A folder of its own for a test.
fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("organza-{name}-{}", std::process::id()));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

#[test]
fn dam_break_runs_out_along_its_basin() {
    let loaded = own("dam-break.json5", &["fluids[0].spacing_m=0.1"]);
    assert_eq!(world(&own("dam-break.json5", &[])).fluid.unwrap().fluid.len(), 5120);
    let mut world = world(&loaded);
    let front = |world: &World| {
        let particles = world.fluid.as_ref().unwrap().fluid.particles();
        particles.map(|p| p.position.x).fold(0.0, f64::max)
    };
    assert_eq!(world.fluid.as_ref().unwrap().fluid.len(), 640);
    assert!(front(&world) < 0.8);
    for _ in 0..10 {
        let fluid = world.advance().unwrap().fluid.unwrap();
        // Nothing restrains it, so everything is computed in every step.
        assert_eq!((fluid.active, fluid.sweeps), (640, fluid.steps));
    }
    // 0.4 s after: a fast, thin front, and nothing in the walls.
    assert!(front(&world) > 1.1, "{}", front(&world));
    for p in world.fluid.as_ref().unwrap().fluid.particles() {
        let inside = (0..2).all(|k| p.position[k] > 0.0 && p.position[k] < [2.0, 0.8][k]);
        assert!(inside && p.position.z > 0.0, "{p:?}");
    }
}

#[test]
fn block_fall_comes_to_rest_and_costs_little_then() {
    let loaded = own("block-fall.json5", &["fluids[0].spacing_m=0.1"]);
    assert_eq!(world(&own("block-fall.json5", &[])).fluid.unwrap().fluid.len(), 5120);
    let mut world = world(&loaded);
    let first = world.advance().unwrap().fluid.unwrap();
    assert_eq!((first.particles, first.restrained), (640, 0));
    let later: Vec<_> = (1..200).map(|_| world.advance().unwrap().fluid.unwrap()).collect();
    let last = later.last().unwrap();
    assert!(last.restrained > 500, "{last:?}");
    let visited = last.force_pairs as f64 / (last.steps * 640 * 15) as f64;
    assert!(visited < 0.5, "{visited} of the pairs are visited: {last:?}");
}

#[test]
fn permanent_flow_keeps_its_level() {
    let loaded = own("permanent-flow.json5", &["fluids[0].spacing_m=0.1"]);
    assert_eq!(world(&own("permanent-flow.json5", &[])).fluid.unwrap().fluid.len(), 4200);
    let mut world = world(&loaded);
    let (mut emitted, mut drained) = (0, 0);
    for _ in 0..100 {
        let fluid = world.advance().unwrap().fluid.unwrap();
        emitted += fluid.emitted;
        drained += fluid.drained;
    }
    // A layer of two particles every 0.2 s, the first at once.
    assert!((40..=42).contains(&emitted), "{emitted}");
    assert!(drained > 0, "nothing is skimmed off");
    let n = world.fluid.as_ref().unwrap().fluid.len() as u64;
    assert_eq!(n, 525 + emitted - drained);
}

/// Layers of a block as its weight presses them: the scene's is that of the suite of benchmarks.
#[test]
fn a_pressed_block_is_lower() {
    let top = |world: &World| {
        let particles = world.fluid.as_ref().unwrap().fluid.particles();
        particles.map(|p| p.position.z).fold(0.0, f64::max)
    };
    let flow = world(&own("permanent-flow.json5", &[]));
    let plain = world(&own("permanent-flow.json5", &["fluids[0].blocks[0].pressed=false"]));
    let sunk = 9.81 * 1.5 * 1.5 / (2.0 * 40.0 * 40.0);
    assert!(((top(&plain) - top(&flow)) / sunk - 1.0).abs() < 0.1, "{}", top(&flow));
    let suite = sph::scenes::permanent_flow(0).unwrap().fluid;
    let places = |fluid: Vec<sph::Particle>| fluid.iter().map(|p| p.position).collect::<Vec<_>>();
    let ours = places(flow.fluid.unwrap().fluid.particles_by_id());
    let off = ours.iter().zip(places(suite.particles_by_id())).map(|(a, b)| (a - b).norm());
    assert!(off.fold(0.0, f64::max) < 1e-12);
}

#[test]
fn what_a_scene_does_not_need_is_not_there() {
    let mut water = world(&scene(&basin(0.2, "", "")));
    let report = water.advance().unwrap();
    assert_eq!(report.skipped, ["cloth: none in the scene", "restraint: none in the scene"]);
    assert_eq!((report.substeps, report.stretch, report.stages), (0, None, 0));
    assert!(!water.has_cloth() && water.force_names().is_empty());
    let fluid = report.fluid.unwrap();
    assert_eq!(fluid.active + fluid.transition + fluid.restrained, fluid.particles);
    assert!(fluid.steps > 0 && (fluid.step_s * fluid.steps as f64 - 0.04).abs() < 1e-12);
    let names: Vec<String> =
        checkpoint::save(&mut water).columns.into_iter().map(|(name, _)| name).collect();
    assert!(names.iter().all(|name| name.starts_with("fluid ")), "{names:?}");

    let cloth =
        "{frames: 1, cloths: [{fabric: 'swim', mesh: {grid: {size_m: [1, 1], cells: [2, 2]}}}]}";
    let mut cloth = world(&scene(cloth));
    let report = cloth.advance().unwrap();
    assert!(cloth.fluid.is_none() && report.fluid.is_none() && report.seconds.fluid == 0.0);
    assert!(report.skipped.contains(&"fluid: none in the scene".to_owned()));
    let names = checkpoint::save(&mut cloth).columns;
    assert!(!names.iter().any(|(name, _)| name.starts_with("fluid")));
}

#[test]
fn obstacles_are_walls() {
    // A slab in the way of a block that falls: it ends on the slab, not on the floor.
    let text = "{ frames: 20, fluids: [{ spacing_m: 0.05,
        blocks: [{ min: [0, 0, 0.4], max: [0.3, 0.3, 0.6] }],
        boxes: [{ min: [0, 0, 0], max: [0.3, 0.3, 1] }] }],
        obstacles: [{ name: 'slab', mesh: { box: { size_m: [0.5, 0.5, 0.2] } },
            transform: { translate: [0.15, 0.15, 0.2] } MOTION }] }";
    let lowest = |text: &str| {
        let mut world = world(&scene(text));
        for _ in 0..20 {
            world.advance().unwrap();
        }
        let particles = world.fluid.as_ref().unwrap().fluid.particles();
        particles.map(|p| p.position.z).fold(f64::INFINITY, f64::min)
    };
    let still = text.replace("MOTION", "");
    assert!((lowest(&still) - 0.32).abs() < 0.02, "{}", lowest(&still));
    let without = still.replace("fluids: [{", "fluids: [{ obstacles: [],");
    assert!(lowest(&without) < 0.05, "{}", lowest(&without));

    let leaving = text.replace("MOTION", ", end_s: 1");
    let why = refusal(&leaving);
    assert!(why.contains("fluids[0].obstacles") && why.contains("`slab`, which comes"), "{why}");
    world(&scene(&leaving.replace("fluids: [{", "fluids: [{ obstacles: [],")));
}

#[test]
fn fluid_that_would_burst_apart_is_refused() {
    let twice = "blocks: [{ min: [0, 0, 0], max: [0.2, 0.2, 0.2] },
        { min: [0.01, 0, 0], max: [0.21, 0.2, 0.2] }]";
    let text = format!("{{ frames: 1, fluids: [{{ spacing_m: 0.05, {twice} }}] }}");
    assert!(refusal(&text).contains("blocks reach into each other or into a wall"));
    let in_wall = basin(0.2, "", "").replace(
        "min: [0, 0, 0], max: [0.4, 0.4, 0.8]",
        "min: [0.02, 0, 0], max: [0.42, 0.4, 0.8]",
    );
    assert!(refusal(&in_wall).contains("fluids[0].blocks"));
    let outside = basin(0.2, "domain: { min: [0.1, 0, 0], max: [1, 1, 1] }", "");
    assert!(refusal(&outside).contains("outside of the domain"));
}

#[test]
fn a_failed_frame_leaves_the_world_as_it_was() {
    // Without a floor everything falls out of the domain.
    let open = basin(0.2, "domain: { min: [-0.1, -0.1, -0.2], max: [1, 1, 1] }", "")
        .replace("max: [0.4, 0.4, 0.8] }", "max: [0.4, 0.4, 0.8], open: ['-z'] }");
    let mut world = world(&scene(&open));
    let mut before = world.fluid.as_ref().unwrap().fluid.checkpoint();
    let error = loop {
        match world.advance() {
            Ok(_) => before = world.fluid.as_ref().unwrap().fluid.checkpoint(),
            Err(error) => break error.to_string(),
        }
        assert!(world.frame < 50);
    };
    assert!(error.contains("outside of the domain"), "{error}");
    assert_eq!(world.fluid.as_ref().unwrap().fluid.checkpoint(), before);
    assert!(world.advance().is_err());
}

#[test]
fn bad_values_are_named() {
    let fluid = |keys: &str| format!("{{frames: 2, fluids: [\n{{{keys}}}]}}");
    let block = "blocks: [{min: [0, 0, 0], max: [1, 1, 1]}]";
    for (keys, expected) in [
        (format!("spacing_m: 0, {block}"), "fluids[0].spacing_m: must be positive and finite, got 0"),
        (format!("spacing_m: 1e-4, {block}"), "fluids[0].blocks: 1e12 particles is beyond the limit of 1e7 particles"),
        (format!("spacing_m: 0.1, skin: -1, {block}"), "fluids[0].skin: must be zero or more and finite, got -1"),
        (format!("spacing_m: 0.1, courant: 2, {block}"), "fluids[0].courant: 2e0 is beyond the limit of 1e0"),
        ("spacing_m: 0.1".into(), "fluids[0]: has no fluid: give `blocks` or `emitters`"),
        ("spacing_m: 0.1, blocks: [{min: [0, 0, 0], max: [1, 1, 0.05]}]".into(), "fluids[0].blocks[0]: is thinner than one particle of 0.1 m"),
        ("spacing_m: 0.1, blocks: [{min: [0, 0, 0], max: [1, 0, 1]}]".into(), "fluids[0].blocks[0].max[1]: 0 m is not above the smallest, 0 m"),
        (format!("spacing_m: 0.1, obstacles: ['rock'], {block}"), "fluids[0].obstacles[0]: there is no obstacle `rock`"),
        (format!("spacing_m: 0.1, boxes: [{{min: [0, 0, 0], max: [1, 1, 1], open: ['up']}}], {block}"), "fluids[0].boxes[0].open[0]: unknown choice `up`, expected one of -x, +x, -y, +y, -z, +z"),
        (format!("spacing_m: 0.1, restraint: {{restrain_below_m_per_s: 0.1}}, {block}"), "fluids[0].restraint: key `restore_above_m_per_s` is missing"),
        (format!("spacing_m: 0.1, restraint: {{policy: 'automatic', error_m: 0.1, duration_s: 1, restrain_below_j: 1}}, {block}"), "fluids[0].restraint.restrain_below_j: belongs to another `policy`"),
        (format!("spacing_m: 0.1, restraint: {{policy: 'view', restrain_below_px_per_frame: 0.1, restore_above_px_per_frame: 1}}, {block}"), "fluids[0].restraint.policy: the scene has no `camera` to look through"),
        (format!("spacing_m: 0.1, restraint: {{policy: 'automatic-view', error_px: 1}}, {block}"), "fluids[0].restraint.policy: the scene has no `camera` to look through"),
        (format!("spacing_m: 0.1, restraint: {{policy: 'automatic-view'}}, {block}"), "fluids[0].restraint: key `error_px` is missing"),
        (format!("spacing_m: 0.1, restraint: {{policy: 'automatic-view', error_px: -1}}, {block}"), "fluids[0].restraint.error_px: must be zero or more and finite, got -1"),
        (format!("spacing_m: 0.1, restraint: {{policy: 'automatic-view', law: 'smooth', error_px: 1}}, {block}"), "fluids[0].restraint.law: the policy `automatic-view` has the law `ramp`"),
        (format!("spacing_m: 0.1, restraint: {{policy: 'view', restrain_below_px_per_frame: 0.1}}, {block}"), "fluids[0].restraint: key `restore_above_px_per_frame` is missing"),
        (format!("spacing_m: 0.1, restraint: {{policy: 'view', restrain_below_px_per_frame: 0.1, restore_above_px_per_frame: 1, most_m_per_s: -1}}, {block}"), "fluids[0].restraint.most_m_per_s: must be zero or more and finite, got -1"),
        (format!("spacing_m: 0.1, restraint: {{restrain_below_m_per_s: 0.1, restore_above_m_per_s: 1, most_m_per_s: 1}}, {block}"), "fluids[0].restraint.most_m_per_s: belongs to another `policy`"),
        (format!("spacing_m: 0.1, restraint: {{policy: 'sight'}}, {block}"), "fluids[0].restraint.policy: unknown choice `sight`"),
        ("spacing_m: 0.1, blocks: [{min: [0, 0, 0], max: [1, 1, 1], pressed: 1}]".into(), "fluids[0].blocks[0].pressed: "),
        (format!("spacing_m: 0.1, colour: 1, {block}"), "fluids[0].colour: unknown key `colour`"),
        ("spacing_m: 0.1, emitters: [{position: [0, 0, 0], direction: [0, 0, 0], size_m: [1, 1], speed_m_per_s: 1}]".into(), "fluids[0].emitters[0].direction: has no length"),
    ] {
        let errors = scene_help::errors_of(fluid(&keys).as_bytes(), &[]).to_string();
        assert!(errors.lines().any(|line| line.starts_with("s.json5:2:") && line.contains(expected)), "{keys}\n{errors}");
    }
    let inverted = format!(
        "spacing_m: 0.1, restraint: {{restrain_below_m_per_s: 0.2, restore_above_m_per_s: 0.1}}, {block}"
    );
    let errors = scene_help::errors_of(fluid(&inverted).as_bytes(), &[]).to_string();
    assert!(errors.contains("fluids[0].restraint: "), "{errors}");
    let still = format!("spacing_m: 0.1, {block}");
    complains(
        &format!("{{frames: 2, gravity: [0, 0, 0], fluids: [\n{{{still}}}]}}"),
        &[],
        &[
            "s.json5:2:1: fluids[0].sound_speed_m_per_s: is needed where nothing falls or moves at the start",
        ],
    );
    let two = format!("{{frames: 2, fluids: [{{{still}}}, {{{still}}}]}}");
    let errors = scene_help::errors_of(two.as_bytes(), &[]).to_string();
    assert!(errors.contains("fluids[1]: not supported yet: several fluids"), "{errors}");
    let errors = scene_help::errors_of(with("fluid: {},", "").as_bytes(), &[]).to_string();
    assert!(errors.contains("unknown key `fluid`, did you mean `fluids`?"), "{errors}");
}

/// Every frame of a recording.
fn frames(path: &Path) -> Vec<OwnedFrame> {
    let mut recording = Recording::open(path).unwrap();
    let indices: Vec<u64> = recording.frames().map(|frame| frame.index).collect();
    indices.into_iter().map(|k| recording.frame(k).unwrap()).collect()
}

fn record(loaded: &Loaded, load: &LoadOptions, path: &Path, n: u32) {
    let options = RunOptions { frames: Some(n), checkpoint_every: Some(3), overwrite: false };
    let mut run = Run::start(loaded, load, path, &options).unwrap();
    while run.next_frame().unwrap().is_some() {}
    run.finish().unwrap();
}

#[test]
fn a_continued_run_has_the_bits_of_an_uninterrupted_one() {
    let folder = folder("fluid-resumed");
    let (whole, parts) = (folder.join("whole.mcap"), folder.join("parts.mcap"));
    let sets = [
        "fluids[0].spacing_m=0.1",
        "fluids[0].restraint.restrain_below_m_per_s=0.15",
        "fluids[0].restraint.restore_above_m_per_s=0.2",
        "fluids[0].restraint.inactivity_m_per_s=0",
    ];
    let loaded = own("permanent-flow.json5", &sets);
    let load = LoadOptions { sets: sets.map(str::to_owned).to_vec(), allow_unsupported: false };
    record(&loaded, &load, &whole, 14);
    record(&loaded, &load, &parts, 5);
    match resume(&parts, Some(14)).unwrap() {
        Resumed::Continues { from, mut run, .. } => {
            assert_eq!(from, 3);
            while run.next_frame().unwrap().is_some() {}
            run.finish().unwrap();
        }
        other => panic!("{other:?}"),
    }
    let (a, b) = (frames(&whole), frames(&parts));
    assert_eq!((a.len(), b.len()), (15, 15));
    for (a, b) in a.iter().zip(&b) {
        assert_eq!(a.fluid, b.fluid, "frame {}", a.index);
        assert!(a.fluid.as_ref().is_some_and(|particles| particles.is_sorted_by_key(|p| p.id)));
    }
    // Some rest and some move: the continued run was in the middle of something.
    let states: Vec<u8> = a[14].fluid.as_ref().unwrap().iter().map(|p| p.state).collect();
    assert!((0..3).all(|state| states.contains(&state)), "{states:?}");
    let last = |path: &Path| Recording::open(path).unwrap().checkpoint(14).unwrap();
    assert_eq!(last(&whole), last(&parts));
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn particles_are_drawn_and_exported() {
    let folder = folder("fluid-drawn");
    let run = folder.join("run.mcap");
    let restraint = "restraint: { restrain_below_m_per_s: 0.1, restore_above_m_per_s: 0.2 }";
    let text = basin(0.3, restraint, "");
    record(&scene(&text), &LoadOptions::default(), &run, 1);
    let frame = &frames(&run)[1];
    let particles = frame.fluid.as_ref().unwrap();
    assert_eq!(particles.len(), 8 * 8 * 6);

    for (format, name) in [(Format::Ply, "ply"), (Format::Obj, "obj"), (Format::Bgeo, "bgeo")] {
        let out = folder.join(name);
        let written = export(&run, format, FrameRange::default(), &out, false, |_, _| {}).unwrap();
        // There is no cloth, and so there are no files of it.
        assert_eq!(written.files, 2);
        let bytes = std::fs::read(out.join(format!("fluid_00001.{name}"))).unwrap();
        match format {
            Format::Ply => {
                let end = bytes.windows(11).position(|w| w == b"end_header\n").unwrap() + 11;
                assert_eq!(bytes.len() - end, 384 * 49);
                let x = f64::from_le_bytes(bytes[end..end + 8].try_into().unwrap());
                assert_eq!(x, particles[0].position[0]);
            }
            Format::Obj => {
                let text = String::from_utf8(bytes).unwrap();
                assert_eq!(text.lines().filter(|line| line.starts_with("v ")).count(), 384);
                assert_eq!(text.lines().last(), Some("p 384"));
            }
            Format::Bgeo => assert_eq!(bytes[9..13], 384u32.to_be_bytes()),
        }
    }

    let (out, size) = (folder.join("pictures"), Some(Size::new(160, 120)));
    let options = PictureOptions { view: Some(View::Outside), size, ..PictureOptions::default() };
    picture::render(&run, FrameRange::default(), &options, &out, false, |_, _| {}).unwrap();
    let coloured = |frame: u32, channel: usize| {
        let file = std::fs::File::open(out.join(format!("frame_{frame:05}.png"))).unwrap();
        let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        let more = |p: &&[u8]| (0..3).all(|c| c == channel || p[channel] > p[c].saturating_add(30));
        pixels.chunks_exact(3).filter(more).count()
    };
    // At rest at the start: red. A frame later the surface falls at 0.4 m/s: blue.
    assert!(coloured(0, 0) > 500 && coloured(0, 2) == 0, "{}", coloured(0, 0));
    std::fs::remove_dir_all(folder).unwrap();
}

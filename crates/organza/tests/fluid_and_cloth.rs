//! Fluid with cloth and with bodies that move: they push each other, nothing passes, nothing is lost,
//! and a run goes on with the same bits.

use std::path::Path;

use mesh_core::{World3, par};
use organza::checkpoint;
use organza::scene::{LoadOptions, Loaded, from_sources, load, parse};
use organza::world::World;

fn scene(text: &str) -> Loaded {
    parse(text, "s.json5", &LoadOptions::default(), &from_sources(&[]))
        .unwrap_or_else(|errors| panic!("{errors}"))
}

fn world(loaded: &Loaded) -> World {
    World::new(loaded).unwrap_or_else(|error| panic!("{error}"))
}

fn fountain(sets: &[&str]) -> Loaded {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/fountain-on-cloth.json5");
    let sets = sets.iter().map(|set| (*set).to_owned()).collect();
    let options = LoadOptions { sets, allow_unsupported: false };
    load(&path, &options).unwrap_or_else(|errors| panic!("{errors}"))
}

/// Coarse enough for a test: a spacing of 6 cm, and the jet near the sheet from the first frame on.
const COARSE: [&str; 4] = [
    "fluids[0].spacing_m=0.06",
    "cloths[0].mesh.grid.cells=[8,8]",
    "fluids[0].emitters[0].direction=[0.3,0,-1]",
    "fluids[0].emitters[0].position=[-0.1,0,0.15]",
];

/// Sum of momenta of cloth and fluid, and of what is on its way between them (kg m/s).
fn momentum(world: &World) -> World3 {
    let cloth: World3 = world.cloth.v.iter().zip(&world.cloth.m).map(|(v, m)| v * *m).sum();
    let water = world.fluid.as_ref().unwrap();
    cloth + water.fluid.momentum() + water.on_its_way()
}

/// A sheet of 0.6 m in free fall, and a block of water that flies at it.
fn collision(top: &str, cloth: &str, fluid: &str) -> String {
    format!(
        "{{ frames: 12, frames_per_second: 50, gravity: [0, 0, 0], {top}
            cloths: [{{ name: 'sheet', fabric: 'woven-firm',
                mesh: {{ grid: {{ size_m: [0.6, 0.6], cells: [8, 8] }} }},
                transform: {{ translate: [-0.3, -0.3, 0] }}, {cloth} }}],
            fluids: [{{ spacing_m: 0.04, sound_speed_m_per_s: 20,
                blocks: [{{ min: [-0.1, -0.1, 0.05], max: [0.1, 0.1, 0.25],
                    velocity: [0.2, 0, -1.5] }}],
                domain: {{ min: [-5, -5, -5], max: [5, 5, 5] }}, {fluid} }}] }}"
    )
}

#[test]
fn momentum_goes_from_water_to_cloth_and_none_is_lost() {
    for integrator in ["implicit-euler", "sdirk2"] {
        let top = format!("integrator: '{integrator}', newton: {{ tolerance: 1e-9 }},");
        let mut world = world(&scene(&collision(&top, "", "")));
        let of_cloth = |world: &World| -> World3 {
            world.cloth.v.iter().zip(&world.cloth.m).map(|(v, m)| v * *m).sum()
        };
        let before = momentum(&world);
        assert_eq!(of_cloth(&world), World3::zeros());
        for _ in 0..8 {
            let fluid = world.advance().unwrap().fluid.unwrap();
            assert_eq!(fluid.squeezed, 0);
        }
        let given = of_cloth(&world);
        assert!(given.z < -0.02, "{integrator}: {given:?} of {before:?}");
        let lost = (momentum(&world) - before).norm();
        assert!(lost < 1e-8 * before.norm(), "{integrator}: {lost} of {before:?}");
    }
}

#[test]
fn water_stays_on_its_side_of_cloth_that_gives_way() {
    // Held by its corners, the sheet catches all that comes down in its middle.
    let hold = "handles: [{ cloth: 'sheet',
        select: { corners: ['upper-left', 'upper-right', 'lower-left', 'lower-right'] } }],";
    for cloth in ["", "remeshing: { size_m: { min: 0.04, max: 0.2 }, refine_angle: 0.3 },"] {
        let mut world = world(&scene(&collision(hold, cloth, "")));
        for _ in 0..7 {
            let report = world.advance().unwrap();
            assert_eq!(report.fluid.unwrap().squeezed, 0, "{report:?}");
        }
        // The ray up from a particle meets the sheet nowhere.
        let (x, mesh) = (&world.cloth.x, &world.cloth.mesh);
        let is_under = |p: &World3| {
            mesh.triangles().iter().any(|t| {
                let [a, b, c] = t.map(|k| x[k as usize] - p);
                let cross = |u: &World3, v: &World3| u.x * v.y - u.y * v.x;
                let (s, t, u) = (cross(&a, &b), cross(&b, &c), cross(&c, &a));
                let inside = (s > 0.0 && t > 0.0 && u > 0.0) || (s < 0.0 && t < 0.0 && u < 0.0);
                inside
                    && t * a.z / (s + t + u) + u * b.z / (s + t + u) + s * c.z / (s + t + u) > 0.0
            })
        };
        let water = world.fluid.as_ref().unwrap();
        let under = water.fluid.particles().filter(|p| is_under(&p.position)).count();
        assert_eq!(under, 0, "of {}", water.fluid.len());
        let lowest = x.iter().map(|x| x.z).fold(f64::INFINITY, f64::min);
        assert!(lowest < -0.03, "the sheet has not moved: {lowest}");
    }
}

#[test]
fn a_body_that_moves_drives_water_before_it() {
    let text = "{ frames: 10, fluids: [{ spacing_m: 0.04,
        blocks: [{ min: [0, 0, 0], max: [0.4, 0.24, 0.24] }],
        boxes: [{ min: [0, 0, 0], max: [0.8, 0.24, 0.8] }] }],
        obstacles: [{ name: 'paddle', mesh: { box: { size_m: [0.08, 0.4, 0.6] } },
            transform: { translate: [0.1, 0.12, 0.3] },
            motion: { keyframes: [{ time_s: 0 }, { time_s: 0.4, transform: { translate: [0.3, 0, 0] } }] } }] }";
    let mut world = world(&scene(text));
    let fluid = &world.fluid.as_ref().unwrap().fluid;
    // Where the paddle stands there is no water, and none within.
    assert!(fluid.particles().all(|p| (p.position.x - 0.1).abs() > 0.04));
    let behind: Vec<bool> = fluid.particles_by_id().iter().map(|p| p.position.x < 0.1).collect();
    assert!(behind.contains(&true) && behind.contains(&false));
    for _ in 0..10 {
        let report = world.advance().unwrap();
        assert_eq!(report.substeps, 0, "there is no cloth");
        assert_eq!(report.fluid.unwrap().squeezed, 0);
    }
    let fluid = &world.fluid.as_ref().unwrap().fluid;
    for (p, behind) in fluid.particles_by_id().iter().zip(behind) {
        // Nothing has come round the paddle, which is as wide as the basin, nor through it.
        let x = p.position.x - 0.4;
        assert!(if behind { x < -0.04 } else { x > 0.04 }, "{p:?}");
    }
}

#[test]
fn the_fountain_plays_with_the_same_bits_at_any_number_of_threads_and_continued() {
    let loaded = fountain(&COARSE);
    let run = |threads: usize| {
        par::with_threads(threads, || {
            let mut world = world(&loaded);
            let mut stopped = 0;
            for _ in 0..6 {
                let fluid = world.advance().unwrap().fluid.unwrap();
                stopped += fluid.stopped + u64::from(fluid.seconds.sheets > 0.0);
            }
            assert!(stopped > 0);
            checkpoint::save(&mut world)
        })
        .unwrap()
    };
    let whole = run(1);
    assert!(whole.columns.iter().any(|(name, _)| name == "fluid impulses"));
    assert!(whole == run(2));
    let mut first = world(&loaded);
    for _ in 0..3 {
        first.advance().unwrap();
    }
    let saved = checkpoint::save(&mut first);
    let mut second = world(&loaded);
    checkpoint::restore(&mut second, &saved).unwrap();
    for _ in 0..3 {
        second.advance().unwrap();
    }
    assert!(whole == checkpoint::save(&mut second));
}

#[test]
fn the_fountain_presses_its_sheet_down() {
    let deepest = |sets: &[&str]| {
        let mut world = world(&fountain(&[&COARSE[..], sets].concat()));
        for _ in 0..12 {
            world.advance().unwrap();
        }
        world.cloth.x.iter().map(|x| x.z).fold(0.0, f64::min)
    };
    let (with, without) = (deepest(&[]), deepest(&["fluids[0].cloths=[]"]));
    assert!(with < without - 0.02, "{with} m with water, {without} m without");
}

/// Where water meets one sheet, another that rests sleeps on; and one that is let go falls.
#[test]
fn what_water_does_not_touch_rests_or_falls_as_without() {
    let restraint =
        "restraint: { thresholds: { speed: { rest_m_per_s: 0.02, full_m_per_s: 0.08 } } },";
    let far = |loaded: &str, z: f64| {
        let sheet = format!(
            "{{ name: 'other', fabric: 'woven-firm', mesh: {{ grid: {{ size_m: [0.6, 0.6], cells: [8, 8] }} }},
                transform: {{ translate: [2, 0, {z}] }} }}],\n fluids:"
        );
        loaded.replace("],\n            fluids:", &format!(", {sheet}"))
    };
    let mut still = world(&scene(&far(&collision(restraint, "", ""), 0.0)));
    let n = still.cloth.x.len();
    let start = still.cloth.x.clone();
    for _ in 0..12 {
        let report = still.advance().unwrap().restraint.unwrap();
        assert!(report.untouched >= (n / 2 - 20) * (report.stages - 1), "{report:?}");
    }
    assert!(still.cloth.x[..n / 2].iter().any(|x| x.z < -0.01));
    assert_eq!(still.cloth.x[n / 2..], start[n / 2..]);

    let falling =
        collision(restraint, "", "").replace("gravity: [0, 0, 0]", "gravity: [0, 0, -9.81]");
    let mut falling = world(&scene(&far(&falling, 3.0)));
    for _ in 0..12 {
        falling.advance().unwrap();
    }
    let fell = start[n / 2..].iter().zip(&falling.cloth.x[n / 2..]).map(|(a, b)| 3.0 + a.z - b.z);
    // g t²/2 = 0.28 m, less the drag of the weave.
    assert!(fell.clone().all(|way| way > 0.2), "{:?}", fell.collect::<Vec<_>>());
}

#[test]
fn cloths_that_a_fluid_does_not_meet_are_left_alone() {
    let text = collision("", "", "cloths: [],");
    let mut both = world(&scene(&text));
    for _ in 0..2 {
        both.advance().unwrap();
    }
    assert!(both.cloth.x.iter().all(|x| x.z == 0.0));
    let names = checkpoint::save(&mut both).columns;
    assert!(!names.iter().any(|(name, _)| name == "fluid impulses"));
    let unknown = text.replace("cloths: [],", "cloths: ['sheat'],");
    let errors = parse(&*unknown, "s.json5", &LoadOptions::default(), &from_sources(&[]));
    let errors = errors.unwrap_err().to_string();
    assert!(errors.contains("there is no cloth `sheat`") && errors.contains("sheet"), "{errors}");
}

//! Tangled starts come apart: cloth that passes through itself, other cloth, or obstacles.

use cloth_dynamics::Stage;
use cloth_dynamics::contact::Contact;
use cloth_dynamics::solver::{BlockMatrix, PatternBuilder};
use mesh_core::{World3, par};
use nalgebra::{Rotation3, Unit};
use organza::checkpoint;
use organza::contact::SurfaceContact;
use organza::scene::{LoadOptions, from_sources, parse};
use organza::world::World;
use std::f64::consts::PI;
use std::sync::Arc;

/// The most frames that a tangle may take.
const FRAMES: usize = 50;
/// By how much the contours may grow from one frame to the next, in shares of their first length:
/// where they do not change, as those of a strip in a slit, they follow how the cloth moves.
const TOLERANCE: f64 = 1e-3;

fn world(body: &str) -> World {
    let text =
        format!("{{ frames: 60, frames_per_second: 25, substeps: 2, contact: {{}}, {body} }}");
    World::new(&parse(text, "s", &LoadOptions::default(), &from_sources(&[])).unwrap()).unwrap()
}

/// The weightless world of some sheets.
fn weightless(sheets: &[String]) -> World {
    world(&format!("gravity: [0, 0, 0], cloths: [{}]", sheets.join(", ")))
}

/// A sheet with its middle at `at` (m), turned by some degrees about an axis, in squares of about 5 cm.
fn sheet(size: [f64; 2], at: [f64; 3], axis: [f64; 3], degrees: f64) -> String {
    let turn =
        Rotation3::from_axis_angle(&Unit::new_normalize(World3::from(axis)), degrees.to_radians());
    let corner = World3::from(at) - turn * World3::new(0.5 * size[0], 0.5 * size[1], 0.0);
    let cells = size.map(|s| (s / 0.05).round() as usize);
    let (x, y, z) = (corner.x, corner.y, corner.z);
    format!(
        "{{ fabric: 'woven-light', mesh: {{ grid: {{ size_m: {size:?}, cells: {cells:?} }} }},
            transform: {{ translate: [{x}, {y}, {z}],
                          rotate: {{ axis: {axis:?}, degrees: {degrees} }} }} }}"
    )
}

const X: [f64; 3] = [1.0, 0.0, 0.0];

/// A square metre in the plane z = 0.
fn lying() -> String {
    sheet([1.0, 1.0], [0.0; 3], X, 0.0)
}

/// Puts the last vertices, or all, in other places at the start (m).
fn bent(mut world: World, all: bool, at: impl Fn(World3) -> World3) -> World {
    let first = if all { 0 } else { 21 * 21 };
    world.cloth.x[first..].iter_mut().for_each(|x| *x = at(*x));
    let saved = checkpoint::save(&mut world);
    checkpoint::restore(&mut world, &saved).unwrap();
    world
}

/// The contours of a tangle never grow, and are gone in time.
#[track_caller]
fn comes_apart(name: &str, world: &mut World) {
    let worst = growth_until_apart(name, world);
    assert!(worst < TOLERANCE, "{name}: grows by {worst}");
}

/// Runs a world until nothing crosses any more, and some frames on; returns by how much contours grew
/// at most from one frame to the next, in shares of their first length.
#[track_caller]
fn growth_until_apart(name: &str, world: &mut World) -> f64 {
    let first = world.contour_length(0);
    assert!(first > 0.0, "{name}: not tangled");
    let (mut lengths, mut worst) = (vec![first], 0.0f64);
    let free = (1..=FRAMES).find(|_| {
        let report = world.advance().unwrap();
        let now = world.contour_length(world.frame);
        worst = worst.max((now - lengths[lengths.len() - 1]) / first);
        lengths.push(now);
        assert!(report.kinetic_energy_j.is_finite());
        world.cloth.mesh.validate().unwrap();
        report.crossings == Some(0)
    });
    let frames = free.unwrap_or_else(|| panic!("{name} does not: {lengths:?} m"));
    println!("{name}: {first:.3} m gone in {frames} frames, grows by {worst:.5} at most");
    for _ in 0..5 {
        assert_eq!(world.advance().unwrap().crossings, Some(0), "{name}");
    }
    worst
}

/// Six tangles.
#[test]
fn sheets_pushed_through_a_sheet_come_apart() {
    // By how much (m), along the sheet, and at which angle to the plane.
    let ways = [(0.05, 90.0), (0.2, 90.0), (0.5, 90.0), (0.3, 60.0), (0.5, 45.0), (0.1, 30.0)];
    for (depth, degrees) in ways {
        let (s, c) = f64::to_radians(degrees).sin_cos();
        let at = [0.013, (0.5 - depth) * c + 0.007, (0.5 - depth) * s];
        let other = sheet([0.6, 1.0], at, X, degrees);
        comes_apart(&format!("{depth} m at {degrees}°"), &mut weightless(&[lying(), other]));
    }
}

/// Two tangles.
#[test]
fn a_corner_and_two_sheets_in_slits_come_apart() {
    let turn = Rotation3::from_axis_angle(&World3::x_axis(), 0.5 * PI)
        * Rotation3::from_axis_angle(&World3::z_axis(), 0.25 * PI);
    let flat = weightless(&[lying(), sheet([0.5, 0.5], [0.0; 3], X, 0.0)]);
    let corner = bent(flat, false, |x| turn * x + World3::new(0.01, 0.02, 0.25));
    comes_apart("corner", &mut { corner });
    // Each comes in over the other's side, so that nothing is cut off.
    let other = sheet([0.6, 0.6], [0.61, 0.013, 0.003], X, 80.0);
    comes_apart("slits", &mut weightless(&[lying(), other]));
}

/// A sheet of some size over a lying one.
fn above(size: f64) -> World {
    weightless(&[lying(), sheet([size, size], [0.013, 0.021, 0.0], X, 0.0)])
}

/// Waves of some slope and number per length (1/m) through a lying sheet, bent and not strained: the
/// slope is a function of the length along the sheet.
fn waves(size: f64, [slope, k]: [f64; 2]) -> World {
    bent(above(size), false, |at| {
        let (n, mut x) = (400, World3::new(0.0, at.y, 0.013));
        for i in 0..n {
            let s = at.x / f64::from(n);
            let angle = slope * f64::cos(k * s * (f64::from(i) + 0.5));
            x += World3::new(angle.cos(), 0.0, angle.sin()) * s;
        }
        x
    })
}

/// Four tangles, of closed contours and of several.
#[test]
fn bumps_and_waves_come_apart() {
    for depth in [0.02, 0.06] {
        let mut bump = bent(above(1.2), false, |x| {
            let hill = (-(x.x.hypot(x.y) / 0.35).powi(2)).exp();
            World3::new(x.x, x.y, 0.04 - (0.04 + depth) * hill)
        });
        comes_apart(&format!("bump by {depth} m"), &mut bump);
    }
    for shape in [[0.6, 12.0], [0.9, 9.0]] {
        comes_apart(&format!("waves {shape:?}"), &mut waves(1.0, shape));
    }
}

/// Where the waves are wider, what is left in the end is half of the lying sheet, which turns on its
/// way out: the contour grows in between, and is gone all the same.
#[test]
fn what_turns_on_its_way_comes_apart() {
    assert!(growth_until_apart("wide waves", &mut waves(1.2, [0.6, 12.0])) < 0.1);
}

/// Two tangles of a sheet with itself.
#[test]
fn a_sheet_in_a_loop_through_itself_comes_apart() {
    for turn in [0.3, 0.7] {
        let strip = weightless(&[sheet([0.5, 1.2], [0.0, 0.6, 0.0], X, 0.0)]);
        let mut loop_ = bent(strip, true, |x| {
            // Round a cylinder and straight on, through where it came from.
            let (r, bend) = (0.12, PI + turn + 0.6);
            let s = x.y - (0.6 - 0.5 * bend * r);
            let a = (s / r).clamp(0.0, bend);
            let left = s - a * r;
            let (sin, cos) = a.sin_cos();
            World3::new(x.x, r * sin + left * cos, r * (1.0 - cos) + left * sin)
        });
        comes_apart(&format!("loop by {turn}"), &mut loop_);
    }
}

/// Eight tangles.
#[test]
fn sheets_come_out_of_obstacles() {
    let shapes = ["sphere: { radius_m: 0.15 }", "box: { size_m: [0.3, 0.25, 0.2] }"];
    let ways = [(0.01, 0.0, 0.0), (0.01, 0.0, -9.81), (0.06, 20.0, -9.81), (-0.04, 75.0, -9.81)];
    for shape in shapes {
        for (z, degrees, gravity) in ways {
            let cloth = sheet([0.8, 0.8], [0.013, 0.021, z], X, degrees);
            let mut world = world(&format!(
                "gravity: [0, 0, {gravity}], obstacles: [{{ mesh: {{ {shape} }} }}], cloths: [{cloth}]"
            ));
            comes_apart(&format!("{shape} at {z} m, {degrees}°, {gravity} m/s²"), &mut world);
        }
    }
}

/// Remeshing goes on meanwhile.
#[test]
fn a_sheet_that_adapts_comes_apart() {
    let other = sheet([0.6, 1.0], [0.013, 0.007, 0.3], X, 90.0);
    let adapts = ", remeshing: { size_m: { min: 0.02, max: 0.2 }, refine_angle: 0.3 } }";
    let sheets = [lying(), other].map(|s| format!("{}{adapts}", s.strip_suffix('}').unwrap()));
    let mut world = weightless(&sheets);
    let edits = (0..FRAMES).scan(true, |tangled, _| {
        let report = world.advance().unwrap();
        let is_on = std::mem::replace(tangled, report.crossings != Some(0));
        let remesh = report.remesh.unwrap();
        is_on.then_some(remesh.splits + remesh.flips + remesh.collapses)
    });
    assert!(edits.sum::<usize>() > 0);
    assert!(world.crossings(world.frame).is_none());
    world.cloth.mesh.validate().unwrap();
}

/// What is not tangled builds nothing of this.
#[test]
fn untangling_is_absent_where_nothing_is_tangled() {
    let is_absent = |world: &mut World| {
        let skipped = world.advance().unwrap().skipped;
        skipped.iter().any(|stage| stage == "untangling: nothing passes through anything")
    };
    let mut apart = weightless(&[lying(), sheet([0.6, 1.0], [0.0, 0.0, 0.6], X, 90.0)]);
    assert!(is_absent(&mut apart) && apart.warnings.is_empty());
    let mut tangled = weightless(&[lying(), sheet([0.6, 1.0], [0.0, 0.0, 0.4], X, 90.0)]);
    let [warning] = &tangled.warnings[..] else { panic!("{:?}", tangled.warnings) };
    assert!(
        warning.starts_with("in the initial state: 34 edges pass through triangles"),
        "{warning}"
    );
    assert!(!is_absent(&mut tangled));
    assert!((0..FRAMES).any(|_| is_absent(&mut tangled)));
}

/// A sheet between two balls that leave it no room for a while.
fn pinch() -> World {
    let ball = |name: &str, side: f64| {
        let key = |t: f64, z: f64| {
            format!("{{ time_s: {t}, transform: {{ translate: [0.003, 0.002, {}] }} }}", side * z)
        };
        format!(
            "{{ name: '{name}', mesh: {{ sphere: {{ radius_m: 0.1 }} }}, motion: {{ interpolation: 'linear',
               keyframes: [{}, {}, {}, {}] }} }}",
            key(0.0, 0.115), key(0.16, 0.09), key(0.32, 0.09), key(0.48, 0.13)
        )
    };
    world(&format!(
        "gravity: [0, 0, -1], cloths: [{}], obstacles: [{}, {}]",
        sheet([0.8, 0.8], [0.0, 0.0, 0.001], X, 0.0),
        ball("above", 1.0),
        ball("below", -1.0)
    ))
}

#[test]
fn cloth_without_room_between_obstacles_is_let_through_and_led_back() {
    let mut world = pinch();
    let mut yielded = 0;
    for _ in 0..40 {
        let report = world.advance().unwrap();
        yielded += report.yielded;
        assert_eq!(report.warnings.len(), report.yielded);
        assert!(report.kinetic_energy_j.is_finite());
    }
    assert!(yielded > 0);
    assert!(world.crossings(40).is_none());
}

/// Two sheets, one through the other at an angle.
fn crossed() -> World {
    let [a, b] = [
        sheet([0.5, 0.5], [0.0; 3], X, 0.0),
        sheet([0.3, 0.4], [0.02, 0.01, 0.1], [1.0, 0.2, 0.0], 70.0),
    ];
    weightless(&[a, b])
}

#[test]
fn forces_and_stiffness_are_those_of_finite_differences() {
    let world = crossed();
    let cloth = &world.cloth;
    let settings = world.contact.unwrap();
    let mut contact = SurfaceContact::new(cloth, None, settings).unwrap().tangled(&[]);
    let h = 0.01;
    let stage = Stage { x_t0: &cloth.x, base: &cloth.x, h };
    contact.begin(stage, [0.0, h], &cloth.m, &cloth.x);
    let mut pattern = PatternBuilder::new(cloth.x.len());
    pattern.add(&contact.couples()).unwrap();
    let mut matrix = BlockMatrix::new(Arc::new(pattern.build().unwrap()));
    let wave = |i: usize, k: f64| {
        World3::new((k * i as f64).sin(), (1.7 * k * i as f64).cos(), (2.3 * k * i as f64).sin())
    };
    let x: Vec<World3> = cloth.x.iter().enumerate().map(|(i, x)| x + wave(i, 1.0) * 1e-3).collect();
    let mut gradient = vec![World3::zeros(); x.len()];
    contact.add_system(&x, &mut gradient, &mut matrix);
    let size: f64 = gradient.iter().map(|g| g.norm()).sum();
    assert!(size > 0.0 && contact.energy(&x) > 0.0);
    for k in 2..8 {
        let way: Vec<World3> = (0..x.len()).map(|i| wave(i, 0.3 * f64::from(k))).collect();
        let at = |s: f64| -> Vec<World3> { x.iter().zip(&way).map(|(x, d)| x + d * s).collect() };
        let e = 1e-6;
        let slope = (contact.energy(&at(e)) - contact.energy(&at(-e))) / (2.0 * e);
        let exact: f64 = gradient.iter().zip(&way).map(|(g, d)| g.dot(d)).sum();
        assert!((slope - exact).abs() < 1e-6 * size, "{slope} {exact}");
        let force = |s: f64| {
            let (mut gradient, mut unused) = (vec![World3::zeros(); x.len()], matrix.clone());
            contact.add_system(&at(s), &mut gradient, &mut unused);
            gradient
        };
        let mut product = vec![World3::zeros(); x.len()];
        matrix.multiply(&way, &mut product);
        let largest = product.iter().map(|p| p.norm()).fold(0.0, f64::max);
        for ((a, b), p) in force(e).iter().zip(&force(-e)).zip(&product) {
            assert!(((a - b) / (2.0 * e) - p).norm() < 1e-5 * largest);
        }
    }
}

/// The state is the positions alone.
#[test]
fn a_resumed_run_has_the_same_bits_at_any_number_of_threads() {
    let run = |resumed: bool, threads: usize| {
        let straight = || {
            let mut world = crossed();
            world.advance().unwrap();
            let saved = checkpoint::save(&mut world);
            if resumed {
                world = crossed();
                checkpoint::restore(&mut world, &saved).unwrap();
            }
            assert!(world.crossings(1).is_some());
            (0..6).for_each(|_| drop(world.advance().unwrap()));
            assert!(world.crossings(7).is_none());
            world.cloth
        };
        par::with_threads(threads, straight).unwrap()
    };
    let straight = run(false, 1);
    for (resumed, threads) in [(true, 1), (false, 2), (true, 2)] {
        assert_eq!(straight, run(resumed, threads), "{resumed} {threads}");
    }
}

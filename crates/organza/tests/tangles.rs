//! Tangled starts come apart: cloth that passes through itself, other cloth, or obstacles.

use cloth_dynamics::Stage;
use cloth_dynamics::contact::Contact;
use cloth_dynamics::solver::{BlockMatrix, PatternBuilder};
use mesh_core::{World3, par};
use organza::checkpoint;
use organza::contact::SurfaceContact;
use organza::scene::{LoadOptions, from_sources, parse};
use organza::world::World;
use std::sync::Arc;

/// The most frames that a tangle may take.
const FRAMES: usize = 50;
/// By how much a contour may grow from one frame to the next, in shares of its first length.
const TOLERANCE: f64 = 0.02;

fn world(body: &str) -> World {
    let text = format!("{{ frames: 60, frames_per_second: 25, substeps: 2, {body} }}");
    World::new(&parse(text, "s", &LoadOptions::default(), &from_sources(&[])).unwrap()).unwrap()
}

/// A sheet with its middle at `at` (m), turned by some degrees about an axis.
fn sheet(size: [f64; 2], cells: [usize; 2], at: [f64; 3], axis: [f64; 3], degrees: f64) -> String {
    let turn = nalgebra::Rotation3::from_axis_angle(
        &nalgebra::Unit::new_normalize(World3::from(axis)),
        degrees.to_radians(),
    );
    let corner = World3::from(at) - turn * World3::new(0.5 * size[0], 0.5 * size[1], 0.0);
    format!(
        "{{ fabric: 'woven-light', mesh: {{ grid: {{ size_m: {size:?}, cells: {cells:?} }} }},
            transform: {{ translate: [{}, {}, {}], rotate: {{ axis: {axis:?}, degrees: {degrees} }} }} }}",
        corner.x, corner.y, corner.z
    )
}

/// Where all vertices of a world go (m).
fn bent(mut world: World, at: impl Fn(World3) -> World3) -> World {
    world.cloth.x.iter_mut().for_each(|x| *x = at(*x));
    let saved = checkpoint::save(&mut world);
    checkpoint::restore(&mut world, &saved).unwrap();
    world
}

/// Lengths of the contours before and after every frame until nothing crosses.
fn untangle(name: &str, world: &mut World) -> Option<usize> {
    let first = world.contour_length(0);
    let mut length = first;
    let n = world.crossings(0).map_or(0, |c| c.n);
    let mut line = format!("{name}: {n} crossings, {first:.4} m:");
    let mut worst = 0.0f64;
    let (mut retries, mut iterations) = (0, 0);
    let start = std::time::Instant::now();
    for frame in 1..=FRAMES {
        let report = match world.advance() {
            Ok(report) => report,
            Err(error) => { println!("{line} {error}"); return None; }
        };
        let now = world.contour_length(world.frame);
        worst = worst.max((now - length) / first);
        line += &format!(" {:.3}", now);
        retries += report.retries;
        iterations += report.newton_iterations;
        length = now;
        assert!(report.kinetic_energy_j.is_finite());
        if report.crossings == Some(0) {
            println!("{line} | {frame} frames, worst {worst:.4}, {retries} retries, {iterations} it, {:.2} s", start.elapsed().as_secs_f64());
            return Some(frame);
        }
    }
    println!("{line} | NOT, worst {worst:.4}, {retries} retries, {iterations} it, {:.2} s", start.elapsed().as_secs_f64());
    None
}

fn tangles() -> Vec<(String, World)> {
    let mut all = Vec::new();
    let x = [1.0, 0.0, 0.0];
    let flat = |size: f64, n: usize, at: [f64; 3]| sheet([size, size], [n, n], at, x, 0.0);
    // Sheets through a lying one, by depth and angle.
    for (depth, degrees) in [(0.05, 90.0), (0.2, 90.0), (0.5, 90.0), (0.3, 60.0), (0.5, 45.0), (0.1, 30.0)] {
        let half = 0.5f64;
        let (s, c) = f64::to_radians(degrees).sin_cos();
        // Its lower edge is `depth` beyond the plane, along the sheet.
        let along = half - depth;
        let other = sheet([0.6, 1.0], [12, 20], [0.013, along * c + 0.007, along * s], x, degrees);
        let body = format!("gravity: [0, 0, 0], contact: {{}}, cloths: [{}, {other}]", flat(1.0, 20, [0.0; 3]));
        all.push((format!("{depth} m at {degrees}"), world(&body)));
    }
    // A corner poked through; a crossing at a boundary; slit into slit.
    let corner = {
        let turn = nalgebra::Rotation3::from_axis_angle(&World3::x_axis(), 1.5707963) * nalgebra::Rotation3::from_axis_angle(&World3::z_axis(), 0.7853981);
        let body = format!("gravity: [0, 0, 0], contact: {{}}, cloths: [{}, {}]", flat(1.0, 20, [0.0; 3]), sheet([0.5, 0.5], [10, 10], [0.0; 3], x, 0.0));
        bent2(&body, 21 * 21, move |p| turn * p + World3::new(0.01, 0.02, 0.25))
    };
    all.push(("corner".into(), corner));
    let body = format!("gravity: [0, 0, 0], contact: {{}}, cloths: [{}, {}]", flat(1.0, 20, [0.0; 3]), sheet([0.6, 0.6], [12, 12], [0.61, 0.013, 0.003], x, 80.0));
    all.push(("slits at a boundary".into(), world(&body)));
    // A bump through a lying sheet: closed contours.
    let body = format!("gravity: [0, 0, 0], contact: {{}}, cloths: [{}, {}]", flat(1.0, 20, [0.0; 3]), flat(1.0, 24, [0.013, 0.021, 0.0]));
    for depth in [0.02, 0.06] {
        let at = move |p: World3| World3::new(p.x, p.y, 0.04 - (0.04 + depth) * (-(p.x.hypot(p.y) / 0.35).powi(2)).exp());
        all.push((format!("bump {depth}"), bent2(&body, 21 * 21, at)));
    }
    // Waves through a sheet, bent but not strained: several contours at once.
    for (angle, k) in [(0.6, 12.0), (0.9, 9.0)] {
        let at = move |p: World3| {
            let n = 400;
            let s = p.x / n as f64;
            let angle = |i: usize| angle * f64::cos(k * s * (i as f64 + 0.5));
            let x: f64 = (0..n).map(|i| angle(i).cos() * s).sum();
            let z: f64 = (0..n).map(|i| angle(i).sin() * s).sum();
            World3::new(x, p.y, 0.013 + z)
        };
        all.push((format!("waves {angle}"), bent2(&body, 21 * 21, at)));
    }
    // A sheet folded over so that one end goes through the other, by an angle.
    for turn in [0.3, 0.7] {
        let body = format!("gravity: [0, 0, 0], contact: {{}}, cloths: [{}]", sheet([0.5, 1.2], [12, 28], [0.0, 0.6, 0.0], x, 0.0));
        let at = move |p: World3| {
            // A loop of radius 0.1 that comes back through its start.
            let (r, s) = (0.12, p.y);
            let bend = std::f64::consts::PI + turn + 0.6;
            let start = 0.6 - 0.5 * bend * r;
            let (y, z) = if s < start { (s - start, 0.0) } else {
                let a = ((s - start) / r).min(bend);
                let left = s - start - a * r;
                (r * a.sin() + left * a.cos(), r * (1.0 - a.cos()) + left * a.sin())
            };
            World3::new(p.x, y, z)
        };
        all.push((format!("fold {turn}"), bent(world(&body), at)));
    }
    // Obstacles.
    let sphere = "obstacles: [{ name: 'o', mesh: { sphere: { radius_m: 0.15 } } }]";
    let cuboid = "obstacles: [{ name: 'o', mesh: { box: { size_m: [0.3, 0.25, 0.2] } } }]";
    for (name, obstacle) in [("sphere", sphere), ("box", cuboid)] {
        for (z, degrees, g) in [(0.01, 0.0, 0.0), (0.01, 0.0, -9.81), (0.06, 20.0, -9.81), (-0.04, 75.0, -9.81)] {
            let body = format!("gravity: [0, 0, {g}], contact: {{}}, {obstacle}, cloths: [{}]", sheet([0.8, 0.8], [20, 20], [0.013, 0.021, z], x, degrees));
            all.push((format!("{name} {z} {degrees} {g}"), world(&body)));
        }
    }
    all
}

/// The same for vertices from `first` on.
fn bent2(body: &str, first: usize, at: impl Fn(World3) -> World3) -> World {
    let mut world = world(body);
    world.cloth.x[first..].iter_mut().for_each(|x| *x = at(*x));
    bent(world, |x| x)
}

#[test]
fn all() {
    let only: Option<usize> = std::env::var("ONLY").ok().map(|s| s.parse().unwrap());
    let mut n = 0;
    let mut of = 0;
    for (k, (name, mut world)) in tangles().into_iter().enumerate() {
        if only.is_some_and(|o| o != k) { continue; }
        of += 1;
        n += usize::from(untangle(&name, &mut world).is_some());
    }
    println!("{n} of {of}");
}

/// A sheet between two balls that leave it no room for a while.
fn pinch() -> World {
    let ball = |name: &str, side: f64| {
        let key = |t: f64, z: f64| format!("{{ time_s: {t}, transform: {{ translate: [0.003, 0.002, {}] }} }}", side * z);
        format!(
            "{{ name: '{name}', mesh: {{ sphere: {{ radius_m: 0.1 }} }}, motion: {{ interpolation: 'linear',
               keyframes: [{}, {}, {}, {}] }} }}",
            key(0.0, 0.115), key(0.16, 0.09), key(0.32, 0.09), key(0.48, 0.13)
        )
    };
    world(&format!(
        "contact: {{}}, gravity: [0, 0, -1], cloths: [{}], obstacles: [{}, {}]",
        sheet([0.4, 0.4], [16, 16], [0.0, 0.0, 0.001], [1.0, 0.0, 0.0], 0.0),
        ball("above", 1.0), ball("below", -1.0)
    ))
}

#[test]
fn cloth_without_room_between_obstacles_is_let_through_and_led_back() {
    let mut world = pinch();
    let mut yielded = 0;
    for _ in 0..40 {
        let report = world.advance().unwrap();
        yielded += report.yielded;
        println!("{} {:?} {} {} {:?}", report.frame, report.crossings, report.retries, report.yielded, report.warnings.first());
        assert_eq!(report.warnings.len(), report.yielded);
        assert!(report.kinetic_energy_j.is_finite());
    }
    assert!(yielded > 0);
    assert!(world.crossings(40).is_none());
}

/// Two sheets, one through the other at an angle.
fn crossed() -> World {
    let [a, b] = [
        sheet([0.5, 0.5], [5, 5], [0.0; 3], [1.0, 0.0, 0.0], 0.0),
        sheet([0.3, 0.4], [4, 5], [0.02, 0.01, 0.1], [1.0, 0.2, 0.0], 70.0),
    ];
    world(&format!("gravity: [0, 0, 0], contact: {{}}, cloths: [{a}, {b}]"))
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
    let wave = |i: usize, k: f64| World3::new((k * i as f64).sin(), (1.7 * k * i as f64).cos(), (2.3 * k * i as f64).sin());
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

//! Tangled starts come apart: cloth that passes through itself, other cloth, or obstacles.

use mesh_core::World3;
use organza::checkpoint;
use organza::scene::{LoadOptions, from_sources, parse};
use organza::world::World;

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
    // A bump pushed through a lying sheet: closed contour.
    let body = format!("gravity: [0, 0, 0], contact: {{}}, cloths: [{}, {}]", flat(1.0, 20, [0.0; 3]), flat(1.0, 24, [0.013, 0.021, 0.0]));
    for depth in [0.05, 0.2] {
        let at = move |p: World3| { let r = p.x.hypot(p.y); World3::new(p.x, p.y, 0.1 - (0.1 + depth) * (-(r / 0.2).powi(2)).exp()) };
        all.push((format!("bump {depth}"), bent2(&body, 21 * 21, at)));
    }
    // Waves through a sheet: several contours at once.
    let at = |p: World3| World3::new(p.x, p.y, 0.013 + 0.06 * (9.0 * p.x).sin());
    all.push(("waves".into(), bent2(&body, 21 * 21, at)));
    let at = |p: World3| World3::new(p.x, p.y, 0.05 * ((9.0 * p.x).sin() * (8.0 * p.y).cos() + 0.3));
    all.push(("bumps".into(), bent2(&body, 21 * 21, at)));
    // A sheet folded over so that one end goes through the other, by an angle.
    for (over, turn) in [(0.25, 0.3), (0.4, 0.7)] {
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
            let _ = over;
            World3::new(p.x, y, z)
        };
        all.push((format!("fold {over}"), bent(world(&body), at)));
    }
    // Obstacles.
    let sphere = "obstacles: [{ name: 'o', mesh: { sphere: { radius_m: 0.15 } } }]";
    let cuboid = "obstacles: [{ name: 'o', mesh: { box: { size_m: [0.3, 0.25, 0.2] } } }]";
    for (name, obstacle) in [("sphere", sphere), ("box", cuboid)] {
        for (z, degrees) in [(0.01, 0.0), (0.06, 20.0), (-0.04, 75.0)] {
            let body = format!("gravity: [0, 0, -9.81], contact: {{}}, {obstacle}, cloths: [{}]", sheet([0.8, 0.8], [20, 20], [0.013, 0.021, z], x, degrees));
            all.push((format!("{name} {z} {degrees}"), world(&body)));
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

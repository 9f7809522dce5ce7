//! What restraint of fluid by view saves, and what that costs the picture.
//!
//! ```text
//! fluid_view SCENE FRAMES V_R [PATH=VALUE ...]
//! ```
//!
//! Five runs of the scene on one thread: free, free with particles that start 1/1000 of a spacing elsewhere
//! (the floor), by view as the scene says, by speed with the threshold `V_R` (m/s) and twice that, and by speed
//! with the greatest threshold that the scene gives to what is out of the picture. The error is in pixels: the
//! difference to the free run of the height of the water over columns four spacings wide, where the camera sees
//! their top, root of the mean square over columns and frames. Lines that begin with `figure` are for programs.

#[path = "../../sph/examples/common/cpu_time.rs"]
mod cpu_time;

use mesh_core::{World3, par};
use organza::scene::{LoadOptions, Loaded, load};
use organza::world::World;
use sizing_view::{Camera, Frustum};
use sph::Bounds;
use sph::measure::Observation;
use std::error::Error;
use std::path::Path;

type Outcome<T> = Result<T, Box<dyn Error>>;

/// Spacings along the edge of a column, as [`Observation`] has it (1).
const CELL: f64 = 4.0;

/// What was seen and done in one frame of a run.
struct Frame {
    cpu_s: f64,
    looking_s: f64,
    seen: Observation,
    /// Particles in and out of the picture, and how many of these rest.
    resting: [[usize; 2]; 2],
}

/// A run of the scene with some changes.
fn run(loaded: &Loaded, frames: usize, bounds: &Bounds) -> Outcome<Vec<Frame>> {
    let mut world = World::new(loaded)?;
    let mut all = Vec::new();
    for _ in 0..frames {
        let before = cpu_time::of_this_thread()?;
        let report = world.advance()?;
        let cpu_s = cpu_time::of_this_thread()? - before;
        let water = world.fluid.as_ref().ok_or("the scene has no fluid")?;
        let camera = camera(loaded, world.time())?;
        let frustum = Frustum::new(&camera);
        let mut resting = [[0; 2]; 2];
        for particle in water.particles().ok_or("too many particles")? {
            let place = World3::from(particle.position);
            let outside = usize::from(frustum.distance(&[place; 3]) > 0.0);
            resting[outside][0] += 1;
            resting[outside][1] += usize::from(particle.state == 2);
        }
        let seen = Observation::new(&water.fluid, bounds);
        all.push(Frame { cpu_s, looking_s: report.seconds.view, seen, resting });
    }
    Ok(all)
}

fn camera(loaded: &Loaded, time: f64) -> Outcome<Camera> {
    let path = loaded.scene.camera_path.as_ref().ok_or("the scene has no camera")?;
    Ok(path.at(time))
}

/// Error in pixels of the heights of a run (px).
fn error(loaded: &Loaded, bounds: &Bounds, spacing: f64, [a, b]: [&[Frame]; 2]) -> Outcome<f64> {
    let cell = CELL * spacing;
    let n_x = (bounds.size().x / cell).ceil() as usize;
    let (mut sum, mut n) = (0.0, 0);
    for (k, (a, b)) in a.iter().zip(b).enumerate() {
        let camera = camera(loaded, (k + 1) as f64 * loaded.scene.frame_s())?;
        let frustum = Frustum::new(&camera);
        for (c, (&a, &b)) in a.seen.height.iter().zip(&b.seen.height).enumerate() {
            let [i, j] = [c % n_x, c / n_x].map(|k| (k as f64 + 0.5) * cell);
            let top = World3::new(bounds.min.x + i, bounds.min.y + j, a.max(b));
            if frustum.distance(&[top; 3]) == 0.0 {
                let depth = frustum.camera_space(top).z;
                sum += ((a - b) * camera.focal_px() / depth).powi(2);
                n += 1;
            }
        }
    }
    Ok((sum / f64::from(n.max(1))).sqrt())
}

fn measure() -> Outcome<()> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let word = |k: usize| words.get(k).ok_or("an argument is missing; see the head of the source");
    let (path, frames) = (Path::new(word(0)?), word(1)?.parse::<usize>()?);
    let v_r: f64 = word(2)?.parse()?;
    let scene = |sets: &[String]| -> Outcome<Loaded> {
        let sets = words[3..].iter().chain(sets).cloned().collect();
        Ok(load(path, &LoadOptions { sets, allow_unsupported: false })?)
    };
    let by_view = scene(&[])?;
    let fluid = &by_view.scene.fluid.as_ref().ok_or("the scene has no fluid")?.file;
    let most = fluid.restraint.as_ref().and_then(|restraint| restraint.most_m_per_s);
    let most = most.ok_or("the scene has no greatest threshold")?;
    let basin = fluid.boxes.first().ok_or("the fluid has no box")?;
    let bounds = Bounds::new(World3::from(basin.min), World3::from(basin.max));
    let by_speed = |v_r: f64| {
        let v_f = 2.0 * v_r;
        format!(
            "fluids[0].restraint={{policy: 'speed', restrain_below_m_per_s: {v_r}, \
             restore_above_m_per_s: {v_f}}}"
        )
    };
    let free = "fluids[0].restraint=null".to_owned();
    let variants = [
        ("free", vec![free.clone()]),
        ("twin", vec![free, "fluids[0].blocks[0].seed=1".to_owned()]),
        ("view", vec![]),
        ("speed", vec![by_speed(v_r)]),
        ("rough", vec![by_speed(most)]),
    ];
    let mut runs = Vec::new();
    for (name, sets) in variants {
        runs.push((name, run(&scene(&sets)?, frames, &bounds)?));
    }
    let cpu_s = |run: &[Frame]| run.iter().map(|frame| frame.cpu_s).sum::<f64>();
    let free = &runs[0].1;
    for (name, run) in &runs {
        let off = error(&by_view, &bounds, fluid.spacing_m, [free, run])?;
        let looking: f64 = run.iter().map(|frame| frame.looking_s).sum();
        let share = |outside: usize| {
            let sum = |k: usize| run.iter().map(|frame| frame.resting[outside][k]).sum::<usize>();
            sum(1) as f64 / sum(0).max(1) as f64
        };
        let (inside, outside, speedup) = (share(0), share(1), cpu_s(free) / cpu_s(run));
        println!("figure {name} {:e} {off:e} {inside:e} {outside:e} {looking:e}", cpu_s(run));
        println!(
            "{name}: {:.2} s, {speedup:.2} times as fast as free, {off:.2} px off; at rest {:.0} % in \
             the picture, {:.0} % outside; {looking:.3} s for looking",
            cpu_s(run),
            100.0 * inside,
            100.0 * outside,
        );
    }
    Ok(())
}

fn main() -> Outcome<()> {
    Ok(par::with_threads(1, || measure().map_err(|error| error.to_string()))??)
}

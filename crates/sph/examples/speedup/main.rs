//! Speed-up of restrained over free fluid for several thresholds, and beside it the difference between
//! the two and, as a floor, between two free runs whose particles start 1/1000 of a spacing elsewhere.
//!
//! `cargo run --release -p sph --example speedup -- block-fall|permanent-flow|dam-break [options]`,
//! with options `v_r=0.02,0.05,0.1 duration=15 frame=0.25 layers=20 ratio=2 tau=0.05 inactivity=0
//! tolerance=0.01 sweep=0.6 interval=1 law=ramp twin=1 threads=1 table=1`; `twin` is the seed of the second free
//! run. Lines that begin with `figure` are for programs.

#[path = "../common/cpu_time.rs"]
mod cpu_time;

use arps::{Law, Restraint, Speed};
use mesh_core::par;
use sph::measure::{Difference, Observation};
use sph::scenes::{self, Scene};
use sph::{Bounds, Fluid, RestraintSettings, StepReport};
use std::error::Error;

type Outcome<T> = Result<T, Box<dyn Error>>;

struct Options {
    scene: String,
    values: Vec<(String, String)>,
}

impl Options {
    fn read() -> Self {
        let mut arguments = std::env::args().skip(1);
        let scene = arguments.next().unwrap_or_else(|| "block-fall".into());
        let pair = |text: String| text.split_once('=').map(|(k, v)| (k.to_owned(), v.to_owned()));
        Options { scene, values: arguments.filter_map(pair).collect() }
    }

    fn text(&self, key: &str, default: &str) -> String {
        let found = self.values.iter().find(|(k, _)| k == key);
        found.map_or(default, |(_, v)| v).to_owned()
    }

    fn number(&self, key: &str, default: f64) -> Outcome<f64> {
        Ok(self.text(key, &default.to_string()).parse()?)
    }

    fn scene(&self, seed: u64) -> Outcome<Scene> {
        let layers = self.number("layers", 20.0)? as usize;
        Ok(match self.scene.as_str() {
            "block-fall" => scenes::block_fall(layers, seed)?,
            "permanent-flow" => scenes::permanent_flow(seed)?,
            "dam-break" => scenes::dam_break(layers, seed)?,
            other => return Err(format!("there is no scene `{other}`").into()),
        })
    }

    fn law(&self) -> Outcome<Law> {
        Ok(match self.text("law", "ramp").as_str() {
            "ramp" => Law::Ramp,
            "soft" => Law::Soft,
            "smooth" => Law::Smooth,
            "spline" => Law::Spline,
            other => return Err(format!("there is no law `{other}`").into()),
        })
    }
}

/// What was seen and done in one frame of a run.
struct Frame {
    cpu_s: f64,
    did: StepReport,
    seen: Observation,
}

/// Runs a fluid frame by frame.
fn run<R: Restraint>(mut fluid: Fluid<R>, bounds: &Bounds, times: &[f64]) -> Outcome<Vec<Frame>> {
    let frame = |&until: &f64| {
        let before = cpu_time::of_this_thread()?;
        let did = fluid.advance(until - fluid.time())?;
        let cpu_s = cpu_time::of_this_thread()? - before;
        Ok(Frame { cpu_s, did, seen: Observation::new(&fluid, bounds) })
    };
    times.iter().map(frame).collect()
}

/// The root of the mean square of the differences of two runs.
fn difference(a: &[Frame], b: &[Frame]) -> Difference {
    let mut sum = Difference::default();
    a.iter().zip(b).for_each(|(a, b)| sum.add_squares(&a.seen.difference(&b.seen)));
    sum.root_of_mean(a.len())
}

fn percent(part: u64, whole: u64) -> f64 {
    100.0 * part as f64 / whole.max(1) as f64
}

/// A line for each frame.
fn table(times: &[f64], free: &[Frame], held: &[Frame], out: &mut String) {
    *out += "   time   free s   held s  speed-up  moved%  swept%  changed%  dpairs%  fpairs%  lists     \
             dens   height   E_kin free held\n";
    for ((until, a), b) in times.iter().zip(free).zip(held) {
        let (off, did) = (b.seen.difference(&a.seen), &b.did);
        let pairs = |n: u64| percent(n * a.did.steps, a.did.force_pairs * did.steps);
        *out += &format!(
            "{until:7.2} {:8.3} {:8.3} {:9.2} {:7.1} {:7.1} {:9.1} {:8.1} {:8.1} {:6} {:8.4} {:8.4} \
             {:8.3} {:8.3}\n",
            a.cpu_s,
            b.cpu_s,
            a.cpu_s / b.cpu_s,
            percent(did.moved, did.particles),
            percent(did.sweeps, did.steps),
            percent(did.changed, did.particles),
            pairs(did.density_pairs),
            pairs(did.force_pairs),
            did.listings,
            off.density,
            off.height,
            a.seen.kinetic,
            b.seen.kinetic,
        );
    }
}

fn line(d: &Difference) -> String {
    format!("{:e} {:e} {:e} {:e}", d.density, d.centre, d.kinetic, d.height)
}

fn measure(options: &Options) -> Outcome<()> {
    let Scene { fluid, duration } = options.scene(0)?;
    let twin = options.scene(options.number("twin", 1.0)? as u64)?.fluid;
    let duration = options.number("duration", duration)?;
    let frame = options.number("frame", 0.25)?;
    let n_frames = (duration / frame).round() as usize;
    let times: Vec<f64> = (1..=n_frames).map(|k| k as f64 * frame).collect();
    let bounds = fluid.settings().domain;
    let free = run(fluid.clone(), &bounds, &times)?;
    let floor = difference(&run(twin, &bounds, &times)?, &free);
    println!("figure floor {}", line(&floor));
    let free_s: f64 = free.iter().map(|frame| frame.cpu_s).sum();
    println!("figure free_s {free_s:e}");

    let mut settings = RestraintSettings::of(fluid.settings());
    let tau = options.number("tau", 0.05)?;
    settings.bleeding = (tau > 0.0).then_some(tau);
    settings.inactivity = options.number("inactivity", 0.0)?;
    settings.pressure_tolerance *= options.number("tolerance", 0.01)? / 0.01;
    settings.sweep_above = options.number("sweep", settings.sweep_above)?;
    settings.force_interval = options.number("interval", 1.0)? as u32;
    for v_r in options.text("v_r", "0.05").split(',') {
        let v_r: f64 = v_r.parse()?;
        let v_f = v_r * options.number("ratio", 2.0)?;
        let policy = Speed::with_law(options.law()?, v_r, v_f)?;
        let held = run(fluid.clone().restrained(policy, settings)?, &bounds, &times)?;
        if options.number("table", 0.0)? > 0.0 {
            let mut lines = String::new();
            table(&times, &free, &held, &mut lines);
            print!("{lines}");
        }
        let error = difference(&held, &free);
        let held_s: f64 = held.iter().map(|frame| frame.cpu_s).sum();
        let each: Vec<f64> = free.iter().zip(&held).map(|(a, b)| a.cpu_s / b.cpu_s).collect();
        let min = each.iter().copied().fold(f64::INFINITY, f64::min);
        let max = each.iter().copied().fold(0.0, f64::max);
        println!(
            "figure curve {v_r} {min:e} {:e} {max:e} {:e} {}",
            free_s / held_s,
            error.over(&floor),
            line(&error)
        );
        println!(
            "v_r {v_r} m/s: free {free_s:.2} s, held {held_s:.2} s; speed-up min {min:.2} mean {:.2} \
             max {max:.2}; error over floor {:.2}: density {:.2}, centre {:.2}, kinetic {:.2}, \
             height {:.2}",
            free_s / held_s,
            error.over(&floor),
            error.density / floor.density,
            error.centre / floor.centre,
            error.kinetic / floor.kinetic,
            error.height / floor.height,
        );
    }
    Ok(())
}

fn main() -> Outcome<()> {
    let options = Options::read();
    // CPU seconds are those of the thread that works.
    let threads = options.number("threads", 1.0)? as usize;
    Ok(par::with_threads(threads, || measure(&options).map_err(|error| error.to_string()))??)
}

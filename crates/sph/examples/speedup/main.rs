//! Speed-up of restrained over free fluid, and beside it the difference between the two and between
//! two free runs whose particles start 1/1000 of a spacing elsewhere.
//!
//! `cargo run --release -p sph --example speedup -- block-fall|permanent-flow|dam-break [options]`,
//! with options `duration=15 frame=0.25 layers=20 v_r=0.05 ratio=2 tau=0.05 inactivity=0
//! tolerance=0.01 sweep=0.3 law=ramp twin=1`, the last one the seed of the second free run.

#[path = "../common/cpu_time.rs"]
mod cpu_time;

use arps::{Law, Speed};
use sph::measure::{Difference, Observation};
use sph::scenes::{self, Scene};
use sph::{Fluid, RestraintSettings, StepReport};
use std::error::Error;

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

    fn number(&self, key: &str, default: f64) -> Result<f64, Box<dyn Error>> {
        Ok(self.text(key, &default.to_string()).parse()?)
    }

    fn scene(&self, seed: u64) -> Result<Scene, Box<dyn Error>> {
        let layers = self.number("layers", 20.0)? as usize;
        Ok(match self.scene.as_str() {
            "block-fall" => scenes::block_fall(layers, seed)?,
            "permanent-flow" => scenes::permanent_flow(seed)?,
            "dam-break" => scenes::dam_break(layers, seed)?,
            other => return Err(format!("there is no scene `{other}`").into()),
        })
    }
}

/// Runs to a time (s); CPU seconds and what was done.
fn run<R: arps::Restraint>(
    fluid: &mut Fluid<R>,
    until: f64,
) -> Result<(f64, StepReport), Box<dyn Error>> {
    let before = cpu_time::of_this_thread()?;
    let report = fluid.advance(until - fluid.time())?;
    Ok((cpu_time::of_this_thread()? - before, report))
}

fn main() -> Result<(), Box<dyn Error>> {
    let options = Options::read();
    let law = match options.text("law", "ramp").as_str() {
        "ramp" => Law::Ramp,
        "soft" => Law::Soft,
        "smooth" => Law::Smooth,
        "spline" => Law::Spline,
        other => return Err(format!("there is no law `{other}`").into()),
    };
    let Scene { fluid: mut free, duration } = options.scene(0)?;
    let mut twin = options.scene(options.number("twin", 1.0)? as u64)?.fluid;
    let mut settings = RestraintSettings::of(free.settings());
    let v_r = options.number("v_r", 0.05)?;
    let tau = options.number("tau", 0.05)?;
    settings.bleeding = (tau > 0.0).then_some(tau);
    settings.inactivity = options.number("inactivity", 0.0)?;
    settings.pressure_tolerance *= options.number("tolerance", 0.01)? / 0.01;
    settings.sweep_above = options.number("sweep", settings.sweep_above)?;
    let policy = Speed::with_law(law, v_r, v_r * options.number("ratio", 2.0)?)?;
    let mut held = free.clone().restrained(policy, settings)?;

    let duration = options.number("duration", duration)?;
    let frame = options.number("frame", 0.25)?;
    let n_frames = (duration / frame).round() as usize;
    let bounds = free.settings().domain;
    println!(
        "   time   free s   held s  speed-up  moved%  swept%  changed%  fpairs%  lists   n    dens floor  height floor   E_kin free held"
    );
    let (mut error, mut floor) = (Difference::default(), Difference::default());
    let (mut free_s, mut held_s) = (0.0, 0.0);
    let mut speedups = Vec::new();
    for k in 1..=n_frames {
        let until = k as f64 * frame;
        let (a, of_free) = run(&mut free, until)?;
        let (b, did) = run(&mut held, until)?;
        run(&mut twin, until)?;
        (free_s, held_s) = (free_s + a, held_s + b);
        speedups.push(a / b);
        let [x, y, z] = [
            Observation::new(&free, &bounds),
            Observation::new(&held, &bounds),
            Observation::new(&twin, &bounds),
        ];
        let (off, noise) = (y.difference(&x), z.difference(&x));
        error.add_squares(&off);
        floor.add_squares(&noise);
        let percent = |part: u64, whole: u64| 100.0 * part as f64 / whole.max(1) as f64;
        println!(
            "{until:7.2} {a:8.3} {b:8.3} {:9.2} {:7.1} {:7.1} {:8.1} {:8.1} {:6} {:6} {:7.4} {:6.4} {:6.4} {:6.4} {:8.3} {:8.3}",
            a / b,
            percent(did.moved, did.particles),
            percent(did.sweeps, did.steps),
            percent(did.changed, did.particles),
            percent(did.force_pairs * of_free.steps, of_free.force_pairs * did.steps),
            did.listings,
            held.len(),
            off.density,
            noise.density,
            off.height,
            noise.height,
            x.kinetic,
            y.kinetic,
        );
    }
    speedups.sort_by(f64::total_cmp);
    let mean = free_s / held_s;
    println!(
        "free {free_s:.2} s, held {held_s:.2} s; speed-up min {:.2} mean {mean:.2} median {:.2} max {:.2}",
        speedups[0],
        speedups[n_frames / 2],
        speedups[n_frames - 1]
    );
    let (error, floor) = (error.root_of_mean(n_frames), floor.root_of_mean(n_frames));
    println!("error {error:?}\nfloor {floor:?}\nerror over floor {:.2}", error.over(&floor));
    Ok(())
}

//! Fluid: throughput without restraint, how it grows, and what restraint saves at what error.

use super::example::Example;
use super::points::{Point as Mark, Points};
use super::report::{Figure, Report};
use super::{Benchmark, Context, statistics};
use crate::command::{Failure, say};

/// The names of its figures.
const FIGURES: &[&str] = &[
    "sph.throughput",
    "sph.throughput.*",
    "sph.throughput.*.share.*",
    "sph.throughput.*.two_threads",
    "sph.scaling.exponent",
    "sph.*.curve.*.speedup",
    "sph.*.curve.*.error_over_floor",
    "sph.*.speedup.*",
    "sph.*.error",
    "sph.*.error.*",
    "sph.*.chaos_floor",
    "sph.*.chaos_floor.*",
    "pareto.block_fall.free",
    "pareto.block_fall.restrained",
    "pareto.permanent_flow.free",
    "pareto.permanent_flow.restrained",
    "sph.view.speedup",
    "sph.view.speedup.*",
    "sph.view.pixel_error",
    "sph.view.pixel_error.*",
    "sph.view.chaos_floor",
    "sph.view.resting.*",
    "sph.view.overhead_fraction",
];

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "sph",
    summary: "throughput of fluid, speed-up by restraint and its error, growth with the particles",
    figures: FIGURES,
    run,
};

/// Layers of particles over the height of the dam break and steps to make: 640 to 503,792 particles.
const SIZES: [(usize, usize); 4] = [(10, 2000), (20, 1500), (43, 300), (92, 50)];
const QUICK_SIZES: [(usize, usize); 3] = [(10, 1000), (20, 500), (43, 50)];
/// What of the sizes is compared with other programs, by the number of particles.
const NAMED: [(usize, &str); 2] = [(20, "5120"), (43, "49708")];
/// The names of the measures of error, in the order of the example's lines.
const METRICS: [(&str, &str); 4] =
    [("density", "1"), ("centre", "m"), ("kinetic", "J"), ("height", "m")];
/// Threshold of speed that is about that of a quarter of a pixel per frame in `flow-in-view` (m/s).
const V_IN_VIEW: &str = "0.03";
/// How many times the floor an error may be to count as equal.
const EQUAL: f64 = 2.0;

fn run(context: &Context, report: &mut Report) -> Result<(), Failure> {
    say("building the examples of sph");
    let dam_break = Example::build(&context.root, "sph", "dam_break")?;
    let speedup = Example::build(&context.root, "sph", "speedup")?;
    let quick = context.options.quick;
    throughput(&dam_break, if quick { &QUICK_SIZES } else { &SIZES }, report)?;
    context.save(report)?;
    salva(context, &dam_break, if quick { ["30", "500"] } else { ["200", "1500"] }, report)?;
    context.save(report)?;
    let thresholds = if quick { "v_r=0.05,0.1" } else { "v_r=0.02,0.05,0.1,0.15,0.2" };
    let size = if quick { "layers=10" } else { "layers=20" };
    let options = [size, thresholds, "tau=0.02", "frame=0.5"];
    saving(&speedup, "block-fall", "block_fall", &options, report)?;
    context.save(report)?;
    let thresholds = if quick { "v_r=0.02" } else { "v_r=0.01,0.015,0.02,0.03,0.05" };
    let duration = if quick { "duration=1" } else { "duration=30" };
    // Resting water withstands pressure that is not quite even: deep below the current all of it rests.
    let habits = ["tau=0.01", "inactivity=0.02", "tolerance=0.02", "interval=4"];
    let options = [&[duration, thresholds, "frame=0.5"], &habits[..]].concat();
    saving(&speedup, "permanent-flow", "permanent_flow", &options, report)?;
    context.save(report)?;
    by_view(context, report)
}

/// What restraint by view saves in the scene `flow-in-view`, and what that costs the picture.
fn by_view(context: &Context, report: &mut Report) -> Result<(), Failure> {
    say("fluid by view");
    let example = Example::build(&context.root, "organza", "fluid_view")?;
    let frames = if context.options.quick { "20" } else { "200" };
    let scene = context.root.join("scenes/flow-in-view.json5").display().to_string();
    let run = example.run(&[&scene, frames, V_IN_VIEW])?;
    let free = run.array::<5>("free")?;
    let note = format!(
        "Scene flow-in-view, {frames} frames, CPU time of one thread over that of the fluid without \
         restraint."
    );
    let error = "RMS over columns and frames of the difference in height of the water to the run without \
                 restraint, where the camera sees it.";
    for (name, of, what) in [
        ("view", "", "Thresholds by view.".to_owned()),
        ("speed", ".by_speed", format!("At {V_IN_VIEW} m/s wherever it is, as in the picture.")),
        (
            "rough",
            ".rough",
            "At the speed that is the most for what is out of the picture.".to_owned(),
        ),
    ] {
        let [cpu_s, off, inside, outside, looking] = run.array::<5>(name)?;
        say(format!("  {name}: {:.2} times as fast, {off:.2} px off", free[0] / cpu_s));
        let told = |note: &str| format!("{note} {what}");
        let mut add = |figure: &str, made| report.add(&format!("sph.view.{figure}{of}"), made);
        add("speedup", Figure::median(&[free[0] / cpu_s], "1", &told(&note)));
        add("pixel_error", Figure::exact(off, "px", &told(error)));
        if name == "view" {
            let share = "Share of the particles in the picture.";
            add("resting.in_picture", Figure::exact(inside, "1", &told(share)));
            let share = "Share of the particles out of it.";
            add("resting.outside", Figure::exact(outside, "1", &told(share)));
            let time = "Time to look through the cameras.";
            add("overhead_fraction", Figure::median(&[looking / cpu_s], "1", &told(time)));
        }
    }
    let [_, floor, ..] = run.array::<5>("twin")?;
    let note = format!("{error} Both without restraint, of another seed.");
    report.add("sph.view.chaos_floor", Figure::exact(floor, "px", &note));
    Ok(())
}

/// Throughput over that of salva3d, both measured here.
fn salva(
    context: &Context,
    dam_break: &Example,
    steps: [&str; 2],
    report: &mut Report,
) -> Result<(), Failure> {
    say("building the dam break of salva3d");
    let peer = match Example::apart(&context.root, "benches/salva", "salva-dam-break") {
        Ok(peer) => peer,
        Err(Failure::Unable(why)) => {
            report.remark(&format!("sph.vs_salva is left out: {why}"));
            return Ok(());
        }
        Err(failure) => return Err(failure),
    };
    let (mut quotients, mut peers) = (Vec::new(), Vec::new());
    for _ in 0..context.options.runs() {
        // In turns, so that both have the same load beside them.
        let theirs = peer.run(&["20", steps[0]])?.number("throughput")?;
        let ours = dam_break.run(&["20", steps[1]])?.number("throughput")?;
        quotients.push(ours / theirs);
        peers.push(theirs);
    }
    let what = "Throughput over that of salva3d 0.11 (DFSPH, single precision, steps of 1 ms, one \
                thread) at 5,120 particles, runs in turns.";
    report.add("sph.vs_salva", Figure::median(&quotients, "1", what));
    let what = "Particle-steps per CPU second of salva3d.";
    report.add("sph.salva.throughput", Figure::median(&peers, "1/s", what));
    Ok(())
}

/// Particle-steps per CPU second of an unrestrained dam break.
fn throughput(
    example: &Example,
    sizes: &[(usize, usize)],
    report: &mut Report,
) -> Result<(), Failure> {
    let mut points = Vec::new();
    for &(layers, steps) in sizes {
        say(format!("dam break with {layers} layers of particles"));
        let run = example.run(&[&layers.to_string(), &steps.to_string()])?;
        let n = run.number("particles")?;
        let s_per_step = run.number("s_per_step")?;
        points.push([n, s_per_step]);
        let note = format!(
            "{n} particles of fluid and {} of walls, {:.0} listed neighbours, double precision, one \
             thread, {steps} steps from the start.",
            run.number("walls")?,
            run.number("neighbours")?
        );
        let Some((_, name)) = NAMED.iter().find(|(named, _)| *named == layers) else { continue };
        let figure = |what: &str| format!("sph.throughput.{name}{what}");
        let throughput = run.number("throughput")?;
        say(format!("  {throughput:.3e} particle-steps per CPU second"));
        report.add(&figure(""), Figure::median(&[throughput], "1/s", &note));
        if layers == NAMED[0].0 {
            report.add("sph.throughput", Figure::median(&[throughput], "1/s", &note));
        }
        for share in ["neighbours", "density", "force", "motion"] {
            let value = run.number(&format!("share.{share}"))?;
            let what = "Share of the time of a step.";
            report.add(&figure(&format!(".share.{share}")), Figure::median(&[value], "1", what));
        }
        let two = example.run(&[&layers.to_string(), &steps.to_string(), "2"])?;
        let what = "Two threads, per second on the wall, whatever else runs on the machine.";
        let throughput = two.number("throughput")?;
        report.add(&figure(".two_threads"), Figure::median(&[throughput], "1/s", what));
    }
    let note =
        "Slope of the logarithm of the time of a step against that of the number of particles.";
    let exponent = statistics::power_law(&points);
    let exponent = exponent.and_then(|(power, _)| Figure::median(&[power], "1", note));
    report.add("sph.scaling.exponent", exponent);
    Ok(())
}

/// What a threshold gives: speed-up and error.
struct Point {
    threshold: f64,
    speedup: [f64; 3],
    /// Largest quotient of an error and its floor.
    over: f64,
    error: [f64; 4],
}

/// Speed-up over several thresholds, the errors, and the floor that chaos sets to them.
fn saving(
    example: &Example,
    scene: &str,
    name: &str,
    options: &[&str],
    report: &mut Report,
) -> Result<(), Failure> {
    say(format!("{scene}: {}", options.join(" ")));
    let run = example.run(&[&[scene], options].concat())?;
    let floor: [f64; 4] = run.array("floor")?;
    let mut points = Vec::new();
    for [threshold, min, mean, max, over, rest @ ..] in run.arrays::<9>("curve")? {
        points.push(Point { threshold, speedup: [min, mean, max], over, error: rest });
    }
    let setting = options.join(" ");
    for point in &points {
        let figure = |what: &str| format!("sph.{name}.curve.{}.{what}", point.threshold);
        let note = format!("At thresholds of {} and twice that (m/s). {setting}", point.threshold);
        say(format!(
            "  {}: {:.2?}, error {:.2} floors",
            point.threshold, point.speedup, point.over
        ));
        report.add(&figure("speedup"), Figure::median(&[point.speedup[1]], "1", &note));
        let what = "The largest quotient of an error and the difference of two unrestrained seeds.";
        report.add(&figure("error_over_floor"), Figure::exact(point.over, "1", what));
    }
    let marks = points.iter().map(|point| Mark {
        x: point.over,
        y: 1.0 / point.speedup[1],
        spread: [1.0 / point.speedup[2], 1.0 / point.speedup[0]],
        n: 1,
        label: format!("thresholds of {} m/s", point.threshold),
    });
    let note = format!(
        "Largest quotient of an error and the difference of two unrestrained seeds; CPU time of one thread \
         over that without restraint, with its spread over half seconds of the scene. {setting}"
    );
    let line = |points: Vec<Mark>| Points {
        axes: ["error over that of another seed".into(), "CPU time over that without".into()],
        units: ["1".into(), "1".into()],
        ..Points::errors(scene, "1", points, 1.0, &note)
    };
    report.points(&format!("pareto.{name}.restrained"), line(marks.collect()));
    let label = "another seed, without restraint".into();
    let free = Mark { x: 1.0, y: 1.0, spread: [1.0; 2], n: 1, label };
    report.points(&format!("pareto.{name}.free"), line(vec![free]));
    let equal = points.iter().filter(|point| point.over <= EQUAL);
    let best = equal.max_by(|a, b| a.speedup[1].total_cmp(&b.speedup[1]));
    let nearest = points.iter().min_by(|a, b| a.over.total_cmp(&b.over));
    let Some(chosen) = best.or(nearest) else { return Ok(()) };
    let how = if best.is_some() {
        "every error within twice its floor"
    } else {
        "no threshold has errors within twice the floor, this is the nearest"
    };
    let note = format!(
        "CPU time free over restrained, per half second and over all, at {} m/s: {how}. {setting}",
        chosen.threshold
    );
    for (what, value) in ["min", "mean", "max"].into_iter().zip(chosen.speedup) {
        let figure = format!("sph.{name}.speedup.{what}");
        report.add(&figure, Figure::median(&[value], "1", &note));
    }
    let quotient = |k: usize| chosen.error[k] / floor[k];
    let worst = (0..METRICS.len()).max_by(|&a, &b| quotient(a).total_cmp(&quotient(b)));
    let what = "Root mean square over the run of the difference to the unrestrained run; the floor is that of two seeds.";
    for (k, (metric, unit)) in METRICS.into_iter().enumerate() {
        let mut add = |of: &str, value| {
            report.add(&format!("sph.{name}.{of}.{metric}"), Figure::exact(value, unit, what));
            if Some(k) == worst {
                let note = format!("Of the measure that is worst over its floor: {metric}.");
                report.add(&format!("sph.{name}.{of}"), Figure::exact(value, unit, &note));
            }
        };
        add("error", chosen.error[k]);
        add("chaos_floor", floor[k]);
    }
    Ok(())
}

//! How the cost of a frame grows: with vertices, with characters, with the vertices that move among
//! others that rest, with threads; and how much memory a vertex takes.

mod characters;
mod restrained;
mod threads;
mod vertices;

use super::points::{Point, Points};
use super::program::{Measured, Simulation};
use super::report::{Figure, Report};
use super::statistics::{median, power_law, spread};
use super::{Benchmark, Context};
use crate::command::{Failure, say};

/// The names of its figures.
const FIGURES: &[&str] = &[
    "scaling.vertices",
    "scaling.vertices_fast",
    "scaling.restrained",
    "scaling.resting",
    "scaling.characters",
    "scaling.*.exponent",
    "scaling.threads.speedup",
    "scaling.threads.cpu_ratio",
    "memory.bytes_per_vertex",
    "memory.bytes_per_vertex_fast",
];

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "scaling",
    summary: "growth of cost with vertices, characters, moving vertices and threads; memory",
    figures: FIGURES,
    run,
};

/// CPU seconds that a run may take, foretold from smaller ones; larger ones are left out.
const LIMIT_S: f64 = 600.0;
/// By which power of the size cost is foretold to grow at most.
const STEEPEST: f64 = 2.0;

fn run(context: &Context, report: &mut Report) -> Result<(), Failure> {
    context.part(report, "scaling/vertices", |report| vertices::run(context, report))?;
    context.part(report, "scaling/restrained", |report| restrained::run(context, report))?;
    context.part(report, "scaling/characters", |report| characters::run(context, report))?;
    context.part(report, "scaling/threads", |report| threads::run(context, report))
}

/// What frames cost at one size.
struct Sample {
    /// How large.
    size: f64,
    /// CPU seconds a frame, of each repetition.
    cpu_s: Vec<f64>,
    /// The longer of the last two runs.
    run: Measured,
}

impl Sample {
    /// Runs the first frame alone and with as many more as the simulation says: the difference is
    /// free of what a process takes before it steps, and of its picture.
    fn take(context: &Context, size: f64, simulation: &Simulation) -> Result<Sample, Failure> {
        let frames = simulation.frames;
        let mut cpu_s = Vec::new();
        let run = loop {
            let [short, long] = [1, 1 + frames].map(|frames| {
                context.program.simulate(&Simulation { frames, ..simulation.clone() })
            });
            let long = long?;
            cpu_s.push((long.cpu_s - short?.cpu_s) / frames as f64);
            if cpu_s.len() == context.options.runs() {
                break long;
            }
        };
        let sample = Sample { size, cpu_s, run };
        say(format!("  {size:.0}: {:.4} CPU seconds a frame", sample.middle()));
        Ok(sample)
    }

    fn middle(&self) -> f64 {
        median(&self.cpu_s).unwrap_or(f64::NAN)
    }

    /// The point of a plot of growth.
    fn point(&self) -> Point {
        let y = self.middle();
        let label = format!("{:.0}", self.size);
        Point {
            x: self.size,
            y,
            spread: spread(&self.cpu_s).unwrap_or([y; 2]),
            n: self.cpu_s.len(),
            label,
        }
    }

    /// Whether a run of another size would take too long, if cost grows as steeply as it may.
    fn forbids(&self, size: f64) -> bool {
        self.run.cpu_s * (size / self.size).powf(STEEPEST) > LIMIT_S
    }
}

/// A series of samples: its figure, the exponent, and its points.
struct Growth {
    /// Its figures are `scaling.NAME.exponent` and `scaling.NAME`.
    name: &'static str,
    /// Title of the plot.
    plot: &'static str,
    /// What the size is.
    axis: &'static str,
    note: String,
}

impl Growth {
    /// Adds what samples say. A size left out for its cost is told by [`too_large`].
    fn tell(&self, report: &mut Report, samples: &[Sample]) {
        let Growth { name, plot, axis, note } = self;
        // An exponent for each repetition tells its noise.
        let n = samples.iter().map(|s| s.cpu_s.len()).min().unwrap_or(0);
        let of =
            |k: usize| -> Vec<[f64; 2]> { samples.iter().map(|s| [s.size, s.cpu_s[k]]).collect() };
        let exponents: Vec<f64> = (0..n).filter_map(|k| Some(power_law(&of(k))?.0)).collect();
        say(format!("  grows as the power {:.2}", median(&exponents).unwrap_or(f64::NAN)));
        let about = format!(
            "Slope of the logarithm of CPU seconds a frame against that of the number of {axis}, \
             least squares; median of the runs. {note}"
        );
        report.add(&format!("scaling.{name}.exponent"), Figure::median(&exponents, "1", &about));
        let points = samples.iter().map(Sample::point).collect();
        let axes = [axis, "CPU time a frame"];
        report.points(
            &format!("scaling.{name}"),
            Points { points, ..Points::growth(plot, axes, ["1", "s"], &[], note) },
        );
    }
}

/// Says that a size was left out.
fn too_large(report: &mut Report, name: &str, size: f64, why: &str) {
    let text = format!("scaling.{name}: {size:.0} is left out: {why}.");
    say(format!("  {text}"));
    report.remark(&text);
}

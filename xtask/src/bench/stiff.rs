//! Stiff cloth falls as fast as soft cloth, and costs the same.

use super::program::{Simulation, fixed_grid};
use super::report::{Figure, Report};
use super::statistics::median;
use super::surface::Surface;
use super::{Benchmark, Context};
use crate::command::{Failure, say};

/// The names of its figures.
const FIGURES: &[&str] =
    &["stiff.hang64.*.cpu_s", "stiff.hang64.*.cpu_ratio", "stiff.hang64.*.drop_m"];

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "stiff",
    summary: "a sheet of 64 x 64 vertices at steps of 40 ms, up to 10^4 times as stiff",
    figures: FIGURES,
    run,
};

/// CPU seconds that C-IPC takes for a simulated second of the same, at each stiffness.
const CASES: [(&str, f64); 3] = [("1", 40.0), ("100", 97.0), ("10000", 308.0)];
/// Frames after which the drop is measured (0.2 s).
const DROP: usize = 5;
/// Frames that are timed: whole runs, and quick ones.
const FRAMES: [usize; 2] = [50, 15];

fn run(context: &Context, report: &mut Report) -> Result<(), Failure> {
    for (times, peer) in CASES {
        let mut sets = fixed_grid([63, 63]);
        sets.extend(
            [
                "substeps=1",
                // As C-IPC, whose drop is that of this integrator at this step.
                "integrator=implicit-euler",
                // To the end, however long it takes: where it stops early, the sheet falls too slowly.
                // Ten times finer a tolerance changes no drop by half a percent.
                "newton.max_iterations=300",
                "newton.tolerance=1e-2",
            ]
            .map(str::to_owned),
        );
        sets.push(format!("cloths[0].multipliers.stretching={times}"));
        let simulation = Simulation {
            scene: context.root.join("scenes/hang.json5"),
            frames: FRAMES[usize::from(context.options.quick)],
            sets,
            out: context.runs().join(format!("stiff_{times}.mcap")),
        };
        let mut costs = Vec::new();
        let mut note = String::new();
        for _ in 0..context.options.runs() {
            let first = Simulation { frames: 1, ..simulation.clone() };
            let first = context.program.simulate(&first)?;
            let run = context.program.simulate(&simulation)?;
            costs.push((run.cpu_s - first.cpu_s) * 25.0 / (simulation.frames - 1) as f64);
            note = run.info.troubles();
        }
        let folder = context.runs().join(format!("stiff_{times}"));
        context.program.export_obj(&simulation.out, DROP, &folder)?;
        let height = |frame: usize| {
            let path = folder.join(format!("frame_{frame:05}.obj"));
            Surface::read(&path).map(|surface| surface.center()[2]).map_err(Failure::Unable)
        };
        let drop = height(0)? - height(DROP)?;
        let cpu_s = median(&costs).unwrap_or(f64::NAN);
        say(format!("x {times}: drops by {drop:.4} m, {cpu_s:.2} CPU s a second; C-IPC {peer}"));
        let name = |what: &str| format!("stiff.hang64.x{times}.{what}");
        let about = format!(
            "Stepping alone, without the first frame, one thread, per simulated second. C-IPC takes {peer} s \
             on another machine.{note}"
        );
        report.add(&name("cpu_s"), Figure::median(&costs, "s", &about));
        let ratios: Vec<f64> = costs.iter().map(|cost| cost / peer).collect();
        let about = "CPU seconds over those of C-IPC, as above.";
        report.add(&name("cpu_ratio"), Figure::median(&ratios, "1", about));
        let about = "Centre of mass in the first 0.2 s; 0.19 m where implicit Euler converges at this step.";
        report.add(&name("drop_m"), Figure::exact(drop, "m", about));
        context.save(report)?;
    }
    Ok(())
}

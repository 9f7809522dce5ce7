//! Error against CPU time: every scene by every method, as the knobs sweep.

mod method;
mod scene;
mod settings;

use super::figure::Figure;
use super::points::{Point, Points};
use super::program::{Measured, Simulation};
use super::report::Report;
use super::statistics::{front_ratio, mean, median, spread};
use super::surface::{Surface, World, lattice, rms};
use super::table::{Cell, Table, Tone};
use super::view::ask;
use super::{Benchmark, Context, number, stages};
use crate::command::{Failure, say};
use method::{METHODS, Method};
use scene::{Plan, SCENES, Scene};
use settings::{Cut, Setting};
use std::fs;
use std::path::{Path, PathBuf};

/// The names of its figures.
const FIGURES: &[&str] = &[
    "pareto.*.floor",
    "pareto.*.reference.cpu_s",
    "pareto.*.reference.peak_mb",
    "pareto.*.cpu_ratio.*",
    "pareto.*.stage_s.*.*",
    "pareto.*.runs",
    "pareto.*.fixed",
    "pareto.*.adaptive",
    "pareto.*.view",
    "pareto.*.restrained",
    "pareto.*.both",
];

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "pareto",
    summary: "error against CPU time as the knobs sweep: meshes, sizes by view, restraint, and both",
    figures: FIGURES,
    run,
};

/// Material points in each direction at which surfaces are compared.
const LATTICE: [usize; 2] = [25, 25];

fn run(context: &Context, report: &mut Report) -> Result<(), Failure> {
    for scene in context.chosen(report, SCENES, |scene| scene.name) {
        if context.options.quick && matches!(scene.cut, Cut::Garment) {
            report.remark(&format!("pareto.{} is left out of quick runs.", scene.name));
            continue;
        }
        let part = format!("pareto/{}", scene.name);
        context.part(report, &part, |report| sweep(context, report, scene))?;
    }
    Ok(())
}

/// Where the material points are in each frame but the first.
type Ways = Vec<Vec<World>>;

/// What errors are measured against.
enum Truth {
    /// Material points, and where they are.
    Points(Vec<[f64; 2]>, Ways),
    /// The recording of the reference.
    Recorded(PathBuf),
}

impl Truth {
    /// How far a run is off, mean over the frames (m or px).
    fn error(&self, context: &Context, scene: &Scene, plan: &Plan, run: &Simulation) -> Fallible {
        match self {
            Truth::Points(points, truth) => Ok(distance(&ways(context, plan, run, points)?, truth)),
            Truth::Recorded(truth) => {
                let file = scene_file(context, scene);
                let words = ["recorded".into(), text(&file), text(truth), text(&run.out)];
                let told = ask(&context.program, &words)?;
                told["errors_px"][0].as_f64().ok_or_else(|| Failure::Unable(told.to_string()))
            }
        }
    }
}

type Fallible = Result<f64, Failure>;

fn text(path: &Path) -> String {
    path.display().to_string()
}

/// One way to run a scene, and what came of it.
struct Candidate {
    method: &'static Method,
    setting: Setting,
    measured: Vec<Measured>,
    /// Mean over the frames of the RMS distance from the reference (m or px).
    error: f64,
    /// RMS difference of the kinetic energies from those of the reference, over their RMS (1).
    energy_error: f64,
    /// Why it could not be run.
    failure: Option<String>,
}

fn sweep(context: &Context, report: &mut Report, scene: &Scene) -> Result<(), Failure> {
    let plan = scene.plan(context.options.quick);

    let [reference, other] = scene.references(plan);
    let simulation_of =
        |name: &str, setting: &Setting| simulation(context, scene, plan, name, setting);
    let first = simulation_of("reference", &reference);
    let cost = simulate(context, scene, "reference", &reference, &first)?;
    let truth = match scene.cut {
        Cut::Grid(size_m) => {
            let points = lattice([[0.0; 2], size_m], LATTICE);
            let ways = ways(context, plan, &first, &points)?;
            Truth::Points(points, ways)
        }
        Cut::Garment => Truth::Recorded(first.out.clone()),
    };
    let second = simulation_of("other_reference", &other);
    simulate(context, scene, "reference", &other, &second)?;
    let floor = truth.error(context, scene, plan, &second)?;
    let unit = scene.cut.unit();
    say(format!("  floor {} {unit}: two references apart", number::short(floor)));

    let mut candidates: Vec<Candidate> = METHODS
        .iter()
        .filter(|method| !context.options.quick || method.quick)
        .flat_map(|method| method.settings(scene, plan).into_iter().map(move |s| (method, s)))
        .map(|(method, setting)| Candidate {
            method,
            setting,
            measured: Vec::new(),
            error: f64::NAN,
            energy_error: f64::NAN,
            failure: None,
        })
        .collect();
    for candidate in &mut candidates {
        let Candidate { method, setting, .. } = candidate;
        let run = simulation_of(method.name, setting);
        let measured = simulate(context, scene, method.name, setting, &run);
        match measured.and_then(|m| Ok((truth.error(context, scene, plan, &run)?, m))) {
            Ok((error, measured)) => {
                candidate.error = error;
                candidate.energy_error = energy_error(&measured, &cost);
                candidate.measured.push(measured);
                say(format!("    error {} {unit}", number::short(error)));
            }
            Err(Failure::Unable(why)) => candidate.failure = Some(why),
            Err(failure) => return Err(failure),
        }
    }
    // All take turns, so that a change of load on the machine meets all alike.
    for _ in 1..context.options.runs() {
        for candidate in candidates.iter_mut().filter(|c| c.failure.is_none()) {
            let Candidate { method, setting, .. } = candidate;
            candidate
                .measured
                .push(context.program.simulate(&simulation_of(method.name, setting))?);
        }
    }
    tell(report, scene, plan, &candidates, floor, &cost);
    Ok(())
}

fn simulation(
    context: &Context,
    scene: &Scene,
    plan: &Plan,
    method: &str,
    setting: &Setting,
) -> Simulation {
    Simulation {
        scene: scene_file(context, scene),
        frames: plan.frames,
        sets: setting.sets.clone(),
        out: context.runs().join(format!("pareto_{}_{method}.mcap", scene.name)),
    }
}

fn scene_file(context: &Context, scene: &Scene) -> PathBuf {
    context.root.join(format!("scenes/{}.json5", scene.name))
}

/// Runs a scene and says what it took.
fn simulate(
    context: &Context,
    scene: &Scene,
    method: &str,
    setting: &Setting,
    simulation: &Simulation,
) -> Result<Measured, Failure> {
    say(format!("  {} {method}: {}", scene.name, setting.label));
    let measured = context.program.simulate(simulation)?;
    let faces = measured.info.mean("/faces");
    say(format!("    {:.2} CPU seconds, {faces:.0} faces", measured.cpu_s));
    Ok(measured)
}

/// Where material points are in a run.
fn ways(
    context: &Context,
    plan: &Plan,
    run: &Simulation,
    points: &[[f64; 2]],
) -> Result<Ways, Failure> {
    let folder = run.out.with_extension("frames");
    context.program.export_obj(&run.out, plan.frames, &folder)?;
    let ways = (1..=plan.frames)
        .map(|frame| {
            let surface = Surface::read(&folder.join(format!("frame_{frame:05}.obj")))?;
            surface.places(points)
        })
        .collect::<Result<Ways, String>>()
        .map_err(|why| Failure::Unable(format!("{}: {why}", text(&run.out))));
    // The recording holds all that is in them.
    let _ = fs::remove_dir_all(&folder);
    ways
}

/// Mean over the frames of the RMS distance of the same material points (m).
fn distance(one: &Ways, other: &Ways) -> f64 {
    let each: Vec<f64> = one.iter().zip(other).map(|(a, b)| rms(a, b)).collect();
    mean(&each).unwrap_or(f64::NAN)
}

/// How far the kinetic energies of the frames are from those of the reference, RMS over RMS.
fn energy_error(run: &Measured, reference: &Measured) -> f64 {
    let [run, truth] = [run, reference].map(|m| m.info.each("/kinetic_energy_j"));
    let square: f64 = run.iter().zip(&truth).map(|(a, b)| (a - b).powi(2)).sum();
    (square / truth.iter().map(|b| b * b).sum::<f64>()).sqrt()
}

/// Adds what was found.
fn tell(
    report: &mut Report,
    scene: &Scene,
    plan: &Plan,
    candidates: &[Candidate],
    floor: f64,
    cost: &Measured,
) {
    let name = |what: &str| format!("pareto.{}.{what}", scene.name);
    let unit = scene.cut.unit();
    let [nx, ny] = LATTICE;
    let places = match scene.cut {
        Cut::Grid(_) => format!("{nx} × {ny} material points"),
        Cut::Garment => "material points in the picture".into(),
    };
    let note = format!(
        "RMS distance from a reference of {:.0} faces at the same {places}, mean \
         over frames 1 to {}. {} CPU seconds of the whole process, median of the runs. The floor is \
         the distance of two references, with edges of {} and {} mm: smaller errors cannot be told \
         from those of the reference.",
        cost.info.mean("/faces"),
        plan.frames,
        scene.note,
        number::short(1e3 * plan.reference.edge_m),
        number::short(1e3 * plan.other_edge_m),
    );
    report.add(&name("floor"), Figure::exact(floor, unit, &note));
    let whole = "The reference, run once.";
    report.add(&name("reference.cpu_s"), Figure::median(&[cost.cpu_s], "s", whole));
    let peak = cost.peak_mb.and_then(|mb| Figure::exact(mb, "MB", "Peak of resident memory."));
    report.add(&name("reference.peak_mb"), peak);

    let mut first: Option<Fronts> = None;
    for method in METHODS {
        let ours = || candidates.iter().filter(|c| c.method.name == method.name);
        let points: Vec<Point> = ours().filter_map(point).collect();
        if points.is_empty() {
            continue;
        }
        // The finest of the levels: the last of them, before the knobs.
        if let Some(finest) = ours().nth(plan.levels.len() - 1) {
            stages::add(report, &format!("pareto.{}", scene.name), method.name, &finest.measured);
        }
        // The points of each repetition.
        let run = |k: usize| ours().filter_map(move |c| Some([c.error, c.measured.get(k)?.cpu_s]));
        let pairs: Fronts = (0..points[0].n).map(|k| run(k).collect()).collect();
        report.points(&name(method.name), Points::errors(scene.name, unit, points, floor, &note));
        let Some(fixed) = &first else {
            first = Some(pairs);
            continue;
        };
        compare(report, &name(&format!("cpu_ratio.{}", method.name)), method, &pairs, fixed);
    }
    report.table_of(&name("runs"), table(candidates, unit, &note));
}

/// Points (error, CPU seconds) of every repetition.
type Fronts = Vec<Vec<[f64; 2]>>;

/// How the front of a method lies to that of the fixed mesh.
fn compare(report: &mut Report, name: &str, method: &Method, ours: &Fronts, fixed: &Fronts) {
    let ratios: Vec<f64> =
        ours.iter().zip(fixed).filter_map(|(ours, fixed)| front_ratio(ours, fixed)).collect();
    let Some(ratio) = median(&ratios) else {
        return report.remark(&format!("{name} is left out: no errors above zero."));
    };
    let note = "CPU seconds over those on the fixed mesh at equal error: geometric mean from \
                the smallest error that both reach to the largest. Below 1 the method pays.";
    report.add(name, Figure::median(&ratios, "1", note));
    if ratio >= 1.0 {
        let told = number::short(ratio);
        report.remark(&format!(
            "{name}: {} does not lie below fixed here; it takes {told} times as long at equal error.",
            method.name
        ));
    }
}

fn point(candidate: &Candidate) -> Option<Point> {
    let times: Vec<f64> = candidate.measured.iter().map(|m| m.cpu_s).collect();
    let (y, spread, n) = (median(&times)?, spread(&times)?, times.len());
    let label = candidate.setting.label.clone();
    Some(Point { x: candidate.error, y, spread, n, label })
}

fn table(candidates: &[Candidate], unit: &str, note: &str) -> Table {
    let error = format!("RMS error ({unit})");
    let columns = [
        "method",
        "settings",
        &error,
        "kinetic energy error",
        "CPU (s)",
        "faces",
        "peak (MB)",
        "unconverged",
    ];
    let row = |c: &Candidate| {
        let mut row = vec![Cell::plain(c.method.name), Cell::plain(&c.setting.label)];
        let (Some(point), Some(run)) = (point(c), c.measured.first()) else {
            let text = c.failure.clone().unwrap_or_default();
            row.push(Cell { text, tone: Tone::Bad });
            return row;
        };
        let (unconverged, stages) = (run.info.sum("/unconverged_stages"), run.info.sum("/stages"));
        row.extend([
            Cell::plain(number::short(point.x)),
            Cell::plain(number::short(c.energy_error)),
            Cell::plain(number::short(point.y)),
            Cell::plain(format!("{:.0}", run.info.mean("/faces"))),
            Cell::plain(run.peak_mb.map_or(String::new(), number::short)),
            Cell::plain(format!("{unconverged} of {stages} stages")),
        ]);
        row
    };
    Table {
        columns: columns.map(str::to_owned).to_vec(),
        rows: candidates.iter().map(row).collect(),
        note: note.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_means_of_rms() {
        let one = vec![vec![[0.0; 3], [0.0; 3]], vec![[1.0, 0.0, 0.0]; 2]];
        let other = vec![vec![[3.0, 0.0, 4.0], [0.0, 5.0, 0.0]], vec![[1.0, 0.0, 1.0]; 2]];
        assert!((distance(&one, &other) - 3.0).abs() < 1e-14);
        assert!(distance(&Vec::new(), &other).is_nan());
    }
}

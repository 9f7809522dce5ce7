//! Error against CPU time beside other programs, on the fixed meshes and by the protocol by which
//! those were measured.
//!
//! Error is the root mean square distance of the path of the centre of mass over two seconds, at 25
//! frames a second, from that of a reference with small steps. Their CPU seconds count stepping alone;
//! ours those of all frames but the first, recording included, without the process around them.
//!
//! The falling sheet is unstable after about 1.2 s: a difference of 10⁻¹⁶ m has then grown to
//! centimetres, and the error of one run is partly chance. So every repetition has a slightly heavier
//! sheet and the median counts, and errors below the distance of two references count as equal.

mod here;
mod marks;
mod scene;

use super::number::short;
use super::points::{Point, Points, Shape};
use super::program::{Measured, Simulation};
use super::report::{Figure, Report};
use super::statistics::{mean, median, spread};
use super::surface::{Surface, World};
use super::table::{Cell, Table, Tone};
use super::{Benchmark, Context};
use crate::command::{Failure, say};
use marks::{Mark, PEERS, Peer};
use scene::{FRAMES, SCENES, SECONDS, Scene, Setting};
use std::fs;

/// The names of its figures.
const FIGURES: &[&str] = &[
    "peers.machine.cpu_ratio",
    "peers.*.*.cpu_s",
    "peers.*.*.error",
    "peers.*.floor",
    "peers.*.ratio",
    "peers.*.ratio_here",
    "peers.*.reference_distance",
    "peers.points.*.*",
    "peers.table.*",
];

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "peers",
    summary: "fixed meshes beside Blender, MuJoCo, Newton and C-IPC: error against CPU time",
    figures: FIGURES,
    run,
};

/// How far apart two other programs are at steps of 0.5 ms (m): smaller errors tell nothing.
const FLOOR_M: f64 = 0.013;
/// At most so much of the CPU seconds of the best of the others is the goal.
const GOAL: f64 = 0.5;

fn run(context: &Context, report: &mut Report) -> Result<(), Failure> {
    context.part(report, "peers/here", |report| here::run(context, report))?;
    let quick = context.options.quick;
    for scene in context.chosen(report, SCENES, |scene| scene.name) {
        if quick && !scene.quick {
            report.remark(&format!("peers.{} is left out of quick runs.", scene.name));
            continue;
        }
        let part = format!("peers/{}", scene.name);
        context.part(report, &part, |report| one(context, report, scene))?;
    }
    Ok(())
}

/// How many settings quick runs have, the cheapest.
const QUICK_SETTINGS: usize = 4;

/// Places of the centre of mass in the frames after the first.
type Path = Vec<World>;

/// One of our settings, and what came of it.
struct Ours {
    label: String,
    /// Of each repetition.
    errors_m: Vec<f64>,
    /// CPU seconds per simulated second, of each repetition.
    cpu_s: Vec<f64>,
    crossings: f64,
    troubles: String,
}

impl Ours {
    fn middle(&self) -> f64 {
        median(&self.cpu_s).unwrap_or(f64::NAN)
    }

    fn error_m(&self) -> f64 {
        median(&self.errors_m).unwrap_or(f64::NAN)
    }
}

fn one(context: &Context, report: &mut Report, scene: &Scene) -> Result<(), Failure> {
    let [reference, other] = scene.references(context.options.quick);
    let (truth, _) = follow(context, scene, &reference)?;
    if scene.name == here::SCENE {
        here::compare(report, &truth)?;
    }
    let (other, _) = follow(context, scene, &other)?;
    let apart = distance(&truth, &other);
    say(format!("    two references are {} m apart", short(apart)));
    let note = "How far two references are apart whose steps differ by a third: what chance does.";
    let name = format!("peers.{}.floor", scene.name);
    report.add(&name, Figure::exact(apart, "m", note));
    let floor_m = apart.max(FLOOR_M);
    let mut all = Vec::new();
    let most = if context.options.quick { QUICK_SETTINGS } else { usize::MAX };
    for setting in scene.settings().take(most) {
        let (mut errors_m, mut cpu_s) = (Vec::new(), Vec::new());
        let (mut crossings, mut troubles) = (0.0f64, String::new());
        for k in 0..context.options.runs() {
            let setting = setting.again(k);
            let first = Simulation { frames: 1, ..simulation(context, scene, &setting) };
            let first = context.program.simulate(&first)?;
            let (path, run) = follow(context, scene, &setting)?;
            errors_m.push(distance(&path, &truth));
            cpu_s.push((run.cpu_s - first.cpu_s) / (SECONDS * (1.0 - 1.0 / FRAMES as f64)));
            crossings = crossings.max(run.info.each("/crossings").last().copied().unwrap_or(0.0));
            troubles = run.info.troubles();
        }
        let ours = Ours { label: setting.label.clone(), errors_m, cpu_s, crossings, troubles };
        let (error, cost) = (short(ours.error_m()), ours.middle());
        say(format!("    error {error} m for {cost:.3} CPU s a second"));
        all.push(ours);
    }
    tell(report, scene, &all, floor_m);
    Ok(())
}

fn simulation(context: &Context, scene: &Scene, setting: &Setting) -> Simulation {
    Simulation {
        scene: context.root.join(format!("scenes/{}.json5", scene.file)),
        frames: FRAMES,
        sets: setting.sets.clone(),
        out: context.runs().join(format!("peers_{}.mcap", scene.name)),
    }
}

/// Runs a scene and follows its centre of mass.
fn follow(
    context: &Context,
    scene: &Scene,
    setting: &Setting,
) -> Result<(Path, Measured), Failure> {
    say(format!("  {}: {}", scene.name, setting.label));
    let simulation = simulation(context, scene, setting);
    let measured = context.program.simulate(&simulation)?;
    let folder = simulation.out.with_extension("frames");
    context.program.export_obj(&simulation.out, FRAMES, &folder)?;
    let center = |frame| {
        Surface::read(&folder.join(format!("frame_{frame:05}.obj"))).map(|surface| surface.center())
    };
    let path = (1..=FRAMES).map(center).collect::<Result<Path, String>>();
    // The recording holds all that is in them.
    let _ = fs::remove_dir_all(&folder);
    Ok((path.map_err(Failure::Unable)?, measured))
}

/// Root mean square distance of two paths (m).
fn distance(one: &[World], other: &[World]) -> f64 {
    let square = |(a, b): (&World, &World)| (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>();
    let squares: Vec<f64> = one.iter().zip(other).map(square).collect();
    mean(&squares).unwrap_or(f64::NAN).sqrt()
}

/// The cheapest of ours that is as accurate as a peer, with no more crossings than it has.
/// Errors below a floor are equal.
fn match_for<'a>(all: &'a [Ours], peer: &Peer, mark: &Mark, floor_m: f64) -> Option<&'a Ours> {
    let bound = mark.crossings.map_or(f64::INFINITY, f64::from);
    let good =
        |ours: &&Ours| ours.error_m() <= peer.error_m.max(floor_m) && ours.crossings <= bound;
    all.iter().filter(good).min_by(|a, b| a.middle().total_cmp(&b.middle()))
}

/// Adds what was found.
fn tell(report: &mut Report, scene: &Scene, all: &[Ours], floor_m: f64) {
    let rivals: Vec<(&Peer, Mark)> =
        PEERS.iter().filter_map(|peer| Some((peer, peer.mark(scene.name)?))).collect();
    points(report, scene, all, &rivals, floor_m);
    for (peer, mark) in &rivals {
        let name = |what: &str| format!("peers.{}.{}.{what}", peer.name, scene.name);
        let note = format!("{}. {}", peer.says, marks::NOTE);
        report.add(&name("cpu_s"), Figure::exact(mark.cpu_s, "s", &note));
        report.add(&name("error"), Figure::exact(peer.error_m, "m", &note));
    }

    let machine = report.value(here::RATIO);
    let mut worst: Option<(&Ours, &Peer, Mark)> = None;
    let mut rows = Vec::new();
    for &(peer, mark) in &rivals {
        let mut row = vec![
            Cell::plain(peer.says),
            Cell::plain(format!("{}{}", if mark.is_slow { "> " } else { "" }, short(peer.error_m))),
            Cell::plain(short(mark.cpu_s)),
        ];
        let Some(ours) = match_for(all, peer, &mark, floor_m) else {
            row.push(Cell { text: "none is as good".into(), tone: Tone::Bad });
            rows.push(row);
            report.remark(&format!("peers.{}: nothing is as good as {}.", scene.name, peer.says));
            continue;
        };
        let ratio = ours.middle() / mark.cpu_s;
        let judged = |ratio: f64| Cell {
            text: short(ratio),
            tone: if ratio <= GOAL { Tone::Good } else { Tone::Bad },
        };
        row.extend([
            Cell::plain(&ours.label),
            Cell::plain(short(ours.error_m())),
            Cell::plain(short(ours.middle())),
            Cell { tone: Tone::Plain, ..judged(ratio) },
            machine.map_or(Cell::plain("unknown"), |machine| judged(ratio / machine)),
        ]);
        rows.push(row);
        if worst.is_none_or(|(ours, _, mark)| ratio > ours.middle() / mark.cpu_s) {
            worst = Some((ours, peer, mark));
        }
    }
    let columns = [
        "program",
        "error (m)",
        "CPU s / s, its machine",
        "ours",
        "error (m)",
        "CPU s / s, here",
        "ratio",
        "ratio, one machine",
    ];
    let note = format!(
        "Beside each program the cheapest of our settings that is as accurate and passes through \
         itself as seldom. {} {}",
        marks::NOTE,
        scene.note
    );
    let columns = columns.map(str::to_owned).to_vec();
    report.table_of(&format!("peers.table.{}", scene.name), Table { columns, rows, note });
    let Some((ours, peer, mark)) = worst else { return };
    ratio(report, scene, ours, peer, mark, machine);
}

/// Adds how we compare with the peer that is hardest to beat.
fn ratio(
    report: &mut Report,
    scene: &Scene,
    ours: &Ours,
    peer: &Peer,
    mark: Mark,
    machine: Option<f64>,
) {
    let name = |what: &str| format!("peers.organza.{}.{what}", scene.name);
    let note = format!(
        "{}, the cheapest that is as accurate as {}, which is the hardest to beat.{}",
        ours.label, peer.says, ours.troubles
    );
    report.add(&name("cpu_s"), Figure::median(&ours.cpu_s, "s", &note));
    report.add(&name("error"), Figure::median(&ours.errors_m, "m", &note));
    let ratios: Vec<f64> = ours.cpu_s.iter().map(|s| s / mark.cpu_s).collect();
    let note = format!(
        "Our CPU seconds here over those of {} on its machine, at equal error or less, beside the \
         program where this is largest.",
        peer.says
    );
    report.add(&format!("peers.{}.ratio", scene.name), Figure::median(&ratios, "1", &note));
    say(format!("  {:.3} of {}", median(&ratios).unwrap_or(f64::NAN), peer.says));
    if let Some(machine) = machine {
        let ratios: Vec<f64> = ratios.iter().map(|ratio| ratio / machine).collect();
        say(format!("  {:.3} on one machine", median(&ratios).unwrap_or(f64::NAN)));
        let note = format!("The same over `{}`: as if both had run here.", here::RATIO);
        let name = format!("peers.{}.ratio_here", scene.name);
        report.add(&name, Figure::median(&ratios, "1", &note));
    }
}

/// Adds our points and those of the others to one plane.
fn points(
    report: &mut Report,
    scene: &Scene,
    all: &[Ours],
    rivals: &[(&Peer, Mark)],
    floor_m: f64,
) {
    let plane = |points: Vec<Point>, note: &str| Points {
        plot: format!("{}: error of the centre of mass against CPU time", scene.name),
        shape: Shape::Front,
        axes: ["RMS error of the centre of mass".into(), "CPU time for a second".into()],
        units: ["m".into(), "s".into()],
        points,
        floor: Some(floor_m),
        note: note.to_owned(),
    };
    let ours = all.iter().map(|ours| {
        let (y, n) = (ours.middle(), ours.cpu_s.len());
        let spread = spread(&ours.cpu_s).unwrap_or([y; 2]);
        Point { x: ours.error_m(), y, spread, n, label: ours.label.clone() }
    });
    report
        .points(&format!("peers.points.{}.organza", scene.name), plane(ours.collect(), scene.note));
    for program in marks::PROGRAMS {
        let theirs = rivals.iter().filter(|(peer, _)| peer.name.starts_with(program));
        let points: Vec<Point> = theirs
            .map(|(peer, mark)| Point {
                x: peer.error_m,
                y: mark.cpu_s,
                spread: [mark.cpu_s; 2],
                n: 1,
                label: format!(
                    "{}{}",
                    peer.says,
                    if mark.is_slow { ", not converged" } else { "" }
                ),
            })
            .collect();
        if !points.is_empty() {
            let name = format!("peers.points.{}.{program}", scene.name);
            report.points(&name, plane(points, marks::NOTE));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ours(label: &str, error_m: f64, cpu_s: f64, crossings: f64) -> Ours {
        let (label, troubles) = (label.to_owned(), String::new());
        Ours { label, errors_m: vec![error_m], cpu_s: vec![cpu_s], crossings, troubles }
    }

    #[test]
    fn the_cheapest_that_is_as_good_is_compared() {
        let all = [
            ours("coarse", 0.2, 0.1, 0.0),
            ours("tangled", 0.02, 0.2, 3.0),
            ours("good", 0.05, 0.4, 0.0),
            ours("best", 0.012, 2.0, 0.0),
        ];
        let matched = |error_m, crossings| {
            let peer = Peer { error_m, name: "p", says: "", marks: &[] };
            let mark = Mark { cpu_s: 1.0, is_slow: false, crossings };
            match_for(&all, &peer, &mark, 0.013).map(|ours| ours.label.as_str())
        };
        assert_eq!(matched(0.3, None), Some("coarse"));
        assert_eq!(matched(0.1, None), Some("tangled"));
        assert_eq!(matched(0.1, Some(0)), Some("good"));
        // Below the floor errors are equal.
        assert_eq!(matched(0.001, None), Some("best"));
        assert_eq!(matched(0.0125, Some(0)), Some("best"));
    }

    #[test]
    fn paths_are_apart_by_the_root_mean_square() {
        let one = [[0.0; 3], [1.0, 0.0, 0.0]];
        let other = [[3.0, 0.0, 4.0], [1.0, 0.0, 5.0]];
        assert!((distance(&one, &other) - 5.0).abs() < 1e-14);
    }
}

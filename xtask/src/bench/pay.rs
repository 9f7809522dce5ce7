//! Nothing paid for nothing: what each optional part costs a scene that does not have it, has it
//! switched off, or has it on with nothing to do.

use super::program::Simulation;
use super::report::{Figure, Report};
use super::run_info::RunInfo;
use super::statistics::median;
use super::{Benchmark, Context};
use crate::command::{Failure, say};
use serde_json::{Value, json};
use std::fs;

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "pay",
    summary: "optional parts of a scene: absent, switched off, and on but idle",
    run,
};

/// An optional part of a scene.
struct Part {
    name: &'static str,
    /// Where it stands in the scene.
    at: &'static str,
    /// Switched off.
    off: fn() -> Value,
    /// On, but with nothing to do.
    idle: fn() -> Value,
    /// Whether it needs a mesh that adapts.
    adapts: bool,
    /// How the line begins by which a run says that it was left out.
    skipped: &'static str,
}

const PARTS: &[Part] = &[
    Part {
        name: "contact",
        at: "/contact",
        off: || Value::Null,
        idle: || json!({}),
        adapts: false,
        skipped: "contact: ",
    },
    Part {
        name: "obstacles",
        at: "/obstacles",
        off: || json!([]),
        idle: || {
            json!([{ "mesh": { "sphere": { "radius_m": 0.2, "detail": 4 } },
                     "transform": { "translate": [40, 0, 0] } }])
        },
        adapts: false,
        skipped: "contact: ",
    },
    Part {
        name: "remeshing",
        at: "/cloths/0/remeshing",
        off: || Value::Null,
        // The longest edges of the mesh are allowed, and nothing asks for shorter ones.
        idle: || json!({ "size_m": { "min": 0.019, "max": 0.036 } }),
        adapts: false,
        skipped: "sizing, remeshing: ",
    },
    Part {
        name: "view",
        at: "/view",
        off: || Value::Null,
        idle: || json!({}),
        adapts: true,
        skipped: "view: ",
    },
    Part {
        name: "wind",
        at: "/wind",
        off: || Value::Null,
        idle: || json!({ "velocity": [0, 0, 0], "density": 1e-9, "drag": 0 }),
        adapts: false,
        skipped: "wind: ",
    },
    Part {
        name: "strain_limits",
        at: "/cloths/0/strain_limits",
        off: || Value::Null,
        idle: || json!([0.01, 100]),
        adapts: false,
        skipped: "strain limits: ",
    },
];

fn run(context: &Context, report: &mut Report) -> Result<(), Failure> {
    let (frames, runs) = if context.options.quick { (4, 3) } else { (20, 9) };
    let mut worst: Option<f64> = None;
    for part in PARTS {
        let mut simulations = Vec::new();
        for (kind, value) in
            [("absent", None), ("off", Some((part.off)())), ("idle", Some((part.idle)()))]
        {
            let mut scene = sheet(part.adapts);
            if let Some(value) = value {
                set(&mut scene, part.at, value);
            }
            scene["frames"] = frames.into();
            let path = context.runs().join(format!("pay_{}_{kind}.json5", part.name));
            let told = |error| Failure::Unable(format!("cannot write {}: {error}", path.display()));
            fs::create_dir_all(context.runs())
                .and_then(|()| fs::write(&path, format!("{scene:#}")))
                .map_err(told)?;
            let out = path.with_extension("mcap");
            simulations.push(Simulation { scene: path, frames, sets: Vec::new(), out });
        }
        let (mut off, mut idle) = (Vec::new(), Vec::new());
        let mut skips = true;
        // In turns, so that what else the machine does falls on all alike; the first turn warms up.
        for turn in 0..=runs {
            let mut seconds = [0.0; 3];
            for (simulation, seconds) in simulations.iter().zip(&mut seconds) {
                let info = context.program.simulate(simulation)?.info;
                *seconds = info.sum("/seconds/total");
                let is_idle = std::ptr::eq(simulation, &simulations[2]);
                skips &= is_idle != names(&info, part.skipped);
            }
            if turn > 0 {
                off.push(seconds[1] / seconds[0] - 1.0);
                idle.push(seconds[2] / seconds[0] - 1.0);
            }
        }
        let [off_by, idle_by] = [&off, &idle].map(|all| median(all).unwrap_or(f64::NAN));
        say(format!("{:14} off {off_by:+.3}, idle {idle_by:+.3} of the time", part.name));
        if !skips {
            report.remark(&format!(
                "pay: runs do not say rightly whether {} was left out",
                part.name
            ));
        }
        worst = Some(worst.map_or(off_by.abs(), |worst: f64| worst.max(off_by.abs())));
        let note = "By how much a run takes longer than without the part: median of runs in turns.";
        report.add(&format!("pay.{}.off", part.name), Figure::median(&off, "1", note));
        report.add(&format!("pay.{}.idle", part.name), Figure::median(&idle, "1", note));
        context.save(report)?;
    }
    let note = "Largest of the differences between parts switched off and absent.";
    report.add("pay.max_difference", worst.and_then(|worst| Figure::median(&[worst], "1", note)));
    Ok(())
}

/// A sheet that swings on two corners, in view of a camera that stands still.
fn sheet(adapts: bool) -> Value {
    let mut scene = json!({
        "substeps": 4,
        "newton": { "max_iterations": 4, "tolerance": 1e-3 },
        "cloths": [{ "mesh": { "grid": { "size_m": [1, 1], "cells": [40, 40] } },
                     "fabric": "woven-light" }],
        "handles": [{ "select": { "corners": ["upper-left", "upper-right"] } }],
        "camera": { "position": [2.6, -2.2, 0.6], "target": [0.5, 0.7, -0.35] },
        "shots": [{ "keyframes": [
            { "time_s": 0, "position": [2.6, -2.2, 0.6], "target": [0.5, 0.7, -0.35] },
        ] }],
    });
    if adapts {
        scene["cloths"][0]["remeshing"] =
            json!({ "size_m": { "min": 0.01, "max": 0.1 }, "refine_angle": 0.3 });
    }
    scene
}

/// Sets the value at a JSON pointer whose last key may be new.
fn set(scene: &mut Value, at: &str, value: Value) {
    let (parent, key) = at.rsplit_once('/').unwrap_or(("", at));
    if let Some(parent) = scene.pointer_mut(parent) {
        parent[key] = value;
    }
}

/// Whether a run says that a part was left out.
fn names(info: &RunInfo, part: &str) -> bool {
    info.skipped().iter().any(|line| line.starts_with(part))
}

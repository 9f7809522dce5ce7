//! The optional parts, and a scene for each.

use super::super::run_info::RunInfo;
use serde_json::{Value, json};

/// An optional part of a scene.
pub(super) struct Part {
    pub(super) name: &'static str,
    /// The scene without it.
    scene: fn() -> Value,
    /// Where it stands in the scene.
    at: &'static str,
    /// Switched off.
    off: fn() -> Value,
    /// On, but with nothing to do.
    idle: fn() -> Value,
    /// How the line begins by which a run says that it was left out, if there is one.
    skipped: Option<&'static str>,
}

pub(super) const PARTS: &[Part] = &[
    Part {
        name: "contact",
        scene: sheet,
        at: "/contact",
        off: || Value::Null,
        idle: || json!({}),
        skipped: Some("contact: "),
    },
    Part {
        name: "self_contact",
        scene: beside_a_ball,
        at: "/contact",
        off: || json!({ "self_contact": false }),
        idle: || json!({ "self_contact": true }),
        skipped: None,
    },
    Part {
        name: "obstacles",
        scene: sheet,
        at: "/obstacles",
        off: || json!([]),
        idle: || json!([far_ball()]),
        skipped: Some("contact: "),
    },
    Part {
        name: "remeshing",
        scene: sheet,
        at: "/cloths/0/remeshing",
        off: || Value::Null,
        // The longest edges of the mesh are allowed, and nothing asks for shorter ones.
        idle: || json!({ "size_m": { "min": 0.03, "max": 0.06 } }),
        skipped: Some("sizing, remeshing: "),
    },
    Part {
        name: "view",
        scene: adaptive,
        at: "/view",
        off: || Value::Null,
        // Nothing may be coarser than without a view.
        idle: || json!({ "v_back": 1, "v_hidden": 1, "v_out": 1, "size_min_px": 1e-3 }),
        skipped: Some("view: "),
    },
    Part {
        name: "restraint",
        scene: sheet,
        at: "/restraint",
        off: || Value::Null,
        // Nothing is ever as slow.
        idle: || json!({ "thresholds": { "speed": { "rest_m_per_s": 1e-9, "full_m_per_s": 4e-9 } } }),
        skipped: Some("restraint: "),
    },
    Part {
        name: "wind",
        scene: sheet,
        at: "/wind",
        off: || Value::Null,
        idle: || json!({ "velocity": [0, 0, 0], "density": 1e-9, "drag": 0 }),
        skipped: Some("wind: "),
    },
    Part {
        name: "strain_limits",
        scene: sheet,
        at: "/cloths/0/strain_limits",
        off: || Value::Null,
        idle: || json!([0.01, 100]),
        skipped: Some("strain limits: "),
    },
];

impl Part {
    /// The scene without it, with it switched off, and with it idle.
    pub(super) fn scenes(&self) -> [Value; 3] {
        [None, Some((self.off)()), Some((self.idle)())].map(|value| {
            let mut scene = (self.scene)();
            if let Some(value) = value {
                set(&mut scene, self.at, value);
            }
            scene
        })
    }

    /// Whether a run says that the part was left out, if it would.
    pub(super) fn is_left_out(&self, info: &RunInfo) -> Option<bool> {
        let part = self.skipped?;
        Some(info.skipped().iter().any(|line| line.starts_with(part)))
    }
}

/// A sheet that swings on two corners, in view of a camera that stands still.
fn sheet() -> Value {
    json!({
        "frames": 1,
        "substeps": 4,
        "newton": { "max_iterations": 4, "tolerance": 1e-3 },
        "cloths": [{ "mesh": { "grid": { "size_m": [1, 1], "cells": [24, 24] } },
                     "fabric": "woven-light" }],
        "handles": [{ "select": { "corners": ["upper-left", "upper-right"] } }],
        "camera": { "position": [2.6, -2.2, 0.6], "target": [0.5, 0.7, -0.35],
                    "resolution": [128, 72] },
        "shots": [{ "keyframes": [
            { "time_s": 0, "position": [2.6, -2.2, 0.6], "target": [0.5, 0.7, -0.35] },
        ] }],
    })
}

/// The same, and a ball that it does not meet.
fn beside_a_ball() -> Value {
    let mut scene = sheet();
    scene["obstacles"] = json!([far_ball()]);
    scene
}

/// The same sheet, with a mesh that adapts.
fn adaptive() -> Value {
    let mut scene = sheet();
    scene["cloths"][0]["remeshing"] =
        json!({ "size_m": { "min": 0.01, "max": 0.1 }, "refine_angle": 0.3 });
    scene
}

fn far_ball() -> Value {
    json!({ "mesh": { "sphere": { "radius_m": 0.2, "detail": 4 } },
            "transform": { "translate": [40, 0, 0] } })
}

/// Sets the value at a JSON pointer whose last key may be new.
fn set(scene: &mut Value, at: &str, value: Value) {
    let (parent, key) = at.rsplit_once('/').unwrap_or(("", at));
    if let Some(parent) = scene.pointer_mut(parent) {
        parent[key] = value;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variants_differ_in_the_part_alone() {
        for part in PARTS {
            let [absent, off, idle] = part.scenes();
            assert_eq!(absent.pointer(part.at), None, "{}", part.name);
            assert_eq!(off.pointer(part.at), Some(&(part.off)()), "{}", part.name);
            assert_eq!(idle.pointer(part.at), Some(&(part.idle)()), "{}", part.name);
        }
    }
}

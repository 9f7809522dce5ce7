//! What scenes are put under.

use serde_json::{Value, json};

/// A change of a scene.
pub(super) struct Stress {
    pub(super) name: &'static str,
    pub(super) apply: fn(&mut Value),
    /// Nothing but gravity does work on the cloth.
    pub(super) is_closed: bool,
    /// The cloth is stiffer than without it, so that it may not stretch more.
    pub(super) is_stiffer: bool,
    /// The scene on which it takes long; empty for none.
    slow_on: &'static str,
    /// The only scenes that it can be put to; empty for all.
    only: &'static [&'static str],
}

impl Stress {
    pub(super) fn suits(&self, scene: &str) -> bool {
        self.only.is_empty() || self.only.contains(&scene)
    }

    /// Whether quick runs are without it.
    pub(super) fn is_slow_on(&self, scene: &str) -> bool {
        self.slow_on == scene
    }

    /// Whether it is the mesh that it changes.
    pub(super) fn remeshes(&self) -> bool {
        self.only == ["adaptive"]
    }

    const fn plain(name: &'static str, apply: fn(&mut Value)) -> Stress {
        Stress { name, apply, is_closed: true, is_stiffer: false, slow_on: "", only: &[] }
    }

    const fn stiffer(name: &'static str, apply: fn(&mut Value)) -> Stress {
        Stress { is_stiffer: true, ..Stress::plain(name, apply) }
    }

    const fn only(self, only: &'static [&'static str]) -> Stress {
        Stress { only, ..self }
    }

    const fn driven(self) -> Stress {
        Stress { is_closed: false, ..self }
    }
}

/// The first is none.
pub(super) const ALL: &[Stress] = &[
    Stress::plain("none", |_| ()),
    Stress::stiffer("stretching x 1e2", |s| multiply(s, "stretching", 1e2)),
    Stress::stiffer("stretching x 1e4", |s| multiply(s, "stretching", 1e4)),
    Stress::stiffer("stretching x 1e6", |s| multiply(s, "stretching", 1e6)),
    Stress::plain("bending x 1e2", |s| multiply(s, "bending", 1e2)),
    Stress::plain("bending x 1e4", |s| multiply(s, "bending", 1e4)),
    Stress::plain("bending x 1e6", |s| multiply(s, "bending", 1e6)),
    Stress::plain("density x 1e-3", |s| multiply(s, "density", 1e-3)),
    Stress::plain("density x 1e3", |s| multiply(s, "density", 1e3)),
    Stress::plain("1e6 times heavier on top", heavier_on_top).only(&["drape"]),
    Stress::plain("steps of 1/2000 s", |s| step(s, 25, 80)),
    Stress::plain("steps of 1/25 s", |s| step(s, 25, 1)),
    Stress::plain("steps of 1/10 s", |s| step(s, 10, 1)),
    Stress::plain("one iteration", |s| {
        s["newton"] = json!({ "max_iterations": 1, "tolerance": 0.1 });
    }),
    Stress {
        slow_on: "drape",
        ..Stress::plain("twice as large as its pattern", |s| begin_as(s, "stretched.obj"))
            .only(&["hang", "drape"])
    },
    Stress::plain("inverted", |s| begin_as(s, "inverted.obj")).only(&["hang", "drape"]),
    Stress::plain("crumpled", |s| begin_as(s, "crumpled.obj")).only(&["hang"]),
    Stress::plain("spinning at 100 rad/s", |s| {
        s["cloths"][0]["initial_spin"] = json!({ "angular_velocity": [0, 0, 100] });
    }),
    Stress::plain("gravity x 100", |s| s["gravity"] = json!([0, 0, -981])),
    Stress::plain("a corner at 50 m/s", corner_at_50_m_per_s).driven(),
    Stress::plain("cuts every frame", cuts).only(&["adaptive"]),
    Stress::plain("sizes swing every frame", |s| {
        cuts(s);
        s["view"] = json!({ "v_out": 0.01, "v_back": 0.01, "window_frames": 1, "margin_m": 0.01 });
    })
    .only(&["adaptive"]),
    Stress::stiffer("limits of 1 %, stretching x 1e-2", |s| {
        multiply(s, "stretching", 1e-2);
        s["cloths"][0]["strain_limits"] = json!([0.99, 1.01]);
    })
    .only(&["hang", "adaptive", "flag"]),
];

fn multiply(scene: &mut Value, what: &str, by: f64) {
    scene["cloths"][0]["multipliers"][what] = by.into();
}

fn step(scene: &mut Value, frames_per_second: u32, substeps: u32) {
    scene["frames_per_second"] = frames_per_second.into();
    scene["substeps"] = substeps.into();
}

fn begin_as(scene: &mut Value, file: &str) {
    scene["cloths"][0]["mesh"] = json!({ "obj": file });
}

/// A second sheet, a million times as heavy, that falls on the first.
fn heavier_on_top(scene: &mut Value) {
    let mut heavy = scene["cloths"][0].clone();
    heavy["transform"]["translate"] = json!([-0.4, -0.37, 0.25]);
    heavy["multipliers"] = json!({ "density": 1e3 });
    multiply(scene, "density", 1e-3);
    if let Some(cloths) = scene["cloths"].as_array_mut() {
        cloths.push(heavy);
    }
}

fn corner_at_50_m_per_s(scene: &mut Value) {
    scene["handles"] = json!([{
        "select": { "corners": ["upper-right"] },
        "motion": { "interpolation": "linear", "keyframes": [
            { "time_s": 0 }, { "time_s": 2, "transform": { "translate": [100, 0, 0] } },
        ] },
    }]);
}

/// A camera that looks at the cloth and away from it in turns.
fn cuts(scene: &mut Value) {
    let shot = |k: u32| {
        let (time, away) = (f64::from(k) / 25.0, f64::from(k % 2));
        json!({ "start_s": time, "keyframes": [{ "time_s": time,
            "position": [2.6, -2.2, 0.6], "target": [0.4 + 20.0 * away, 0.6, -0.3] }] })
    };
    scene["shots"] = (0..30).map(shot).collect();
    scene["view"] = json!({});
}

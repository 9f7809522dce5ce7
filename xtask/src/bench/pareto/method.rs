//! The methods that are compared. To add one, add it to the list: its mesh, and what it varies.

use super::scene::{Plan, Scene};
use super::settings::{Cut, Level, Setting};

/// A method of choosing mesh and effort.
pub(super) struct Method {
    /// What its points are called.
    pub(super) name: &'static str,
    /// Whether quick runs have it.
    pub(super) quick: bool,
    /// Its meshes: a name, and the values that make it with shortest edges of a given length (m).
    meshes: &'static [(&'static str, Mesh)],
    /// What comes to rest; the first is what is told of levels, the others are knobs.
    rests: &'static [(&'static str, &'static str)],
    /// Whether what a step is made of is varied, too.
    turns_effort: bool,
    /// What it alone can vary: a name and values.
    knobs: &'static [(&'static str, &'static [&'static str])],
}

type Mesh = fn(&Scene, f64) -> Vec<String>;

/// The first is what the others are compared with.
pub(super) const METHODS: &[Method] = &[
    Method {
        name: "fixed",
        quick: true,
        meshes: &[("", fixed)],
        rests: NOBODY,
        turns_effort: true,
        knobs: &[],
    },
    Method {
        name: "adaptive",
        quick: true,
        meshes: &[("", adaptive), ("longest edges twice the shortest", narrow)],
        rests: NOBODY,
        turns_effort: true,
        knobs: ADAPTIVE,
    },
    Method {
        name: "view",
        quick: false,
        meshes: &[("", view)],
        rests: NOBODY,
        turns_effort: true,
        knobs: VIEW,
    },
    Method {
        name: "restrained",
        quick: true,
        meshes: &[("", fixed)],
        rests: BY_SPEED,
        turns_effort: false,
        knobs: &[],
    },
    Method {
        name: "both",
        quick: false,
        meshes: &[("", view)],
        rests: BY_VIEW,
        turns_effort: false,
        knobs: &[],
    },
];

const NOBODY: &[(&str, &str)] = &[("", "restraint=null")];
const BY_SPEED: &[(&str, &str)] = &[
    (
        "rest below 4 mm/s",
        "restraint={ thresholds: { speed: { rest_m_per_s: 0.004, full_m_per_s: 0.016 } } }",
    ),
    (
        "rest below 1 mm/s",
        "restraint={ thresholds: { speed: { rest_m_per_s: 0.001, full_m_per_s: 0.004 } } }",
    ),
    (
        "rest below 16 mm/s",
        "restraint={ thresholds: { speed: { rest_m_per_s: 0.016, full_m_per_s: 0.064 } } }",
    ),
];
/// Pixels of a picture of the default size.
const BY_VIEW: &[(&str, &str)] = &[
    (
        "rest below 0.1 px a frame",
        "restraint={ thresholds: { view: { rest_px_per_frame: 0.01, full_px_per_frame: 0.04 } } }",
    ),
    (
        "rest below 0.4 px a frame",
        "restraint={ thresholds: { view: { rest_px_per_frame: 0.04, full_px_per_frame: 0.16 } } }",
    ),
];

/// What every method varies: what a step is made of.
const EFFORT: &[(&str, &[&str])] = &[
    ("one Newton iteration", &["newton.max_iterations=1"]),
    ("loose linear solver", &["linear_solver=pcg", "linear_tolerance=1e-2"]),
];
/// The step that the scene does not have by itself.
const STEPS: [(&str, &[&str]); 2] =
    [("implicit Euler", &["integrator=implicit-euler"]), ("SDIRK2", &["integrator=sdirk2"])];

const VIEW: &[(&str, &[&str])] = &[
    ("v_back 0.5, v_out 0.1", &["view.v_back=0.5", "view.v_out=0.1"]),
    ("edges of 8 pixels", &["view.size_min_px=0.8"]),
];
const ADAPTIVE: &[(&str, &[&str])] = &[(
    "half the thresholds",
    &[
        "cloths[0].remeshing.refine_angle=0.15",
        "cloths[0].remeshing.refine_velocity=0.25",
        "cloths[0].remeshing.refine_compression=0.0025",
    ],
)];

impl Method {
    /// All settings of a scene: the levels, and at some of them one knob after the other.
    pub(super) fn settings(&self, scene: &Scene, plan: &Plan) -> Vec<Setting> {
        let at = |level: &Level, (label, mesh): &(&str, Mesh)| {
            let setting = Setting::of(*level, mesh(scene, level.edge_m));
            setting.with("", &SMALL_PICTURE).with(label, &[])
        };
        let rest = |setting: Setting, (label, sets): &(&str, &str)| setting.with(label, &[*sets]);
        let mut settings: Vec<Setting> = Vec::new();
        // Where a scene bounds the longest edges, meshes may be the same.
        let mut add = |setting: Setting| {
            if settings.iter().all(|other| other.sets != setting.sets) {
                settings.push(setting);
            }
        };
        for mesh in self.meshes {
            plan.levels.iter().for_each(|level| add(rest(at(level, mesh), &self.rests[0])));
        }
        for (level, mesh) in
            plan.knobs_at().iter().flat_map(|l| self.meshes.first().map(|m| (l, m)))
        {
            for other in &self.rests[1..] {
                add(rest(at(level, mesh), other));
            }
            if !self.turns_effort {
                continue;
            }
            let Level { edge_m, substeps } = *level;
            for substeps in [substeps / 2, 2 * substeps] {
                add(rest(at(&Level { edge_m, substeps }, mesh), &self.rests[0]));
            }
            let step = STEPS.iter().filter(|(_, sets)| sets[0] != scene.integrator);
            for (label, sets) in EFFORT.iter().chain(step).chain(self.knobs) {
                add(rest(at(level, mesh), &self.rests[0]).with(label, sets));
            }
        }
        settings
    }
}

/// A tenth of the default in each direction: drawing it must not be what is measured.
const SMALL_PICTURE: [&str; 1] = ["camera.resolution=[128, 72]"];

fn fixed(scene: &Scene, edge_m: f64) -> Vec<String> {
    let mut sets = scene.cut.fixed_mesh(edge_m);
    sets.push("view=null".into());
    sets
}

/// Four times as long where nothing happens, as everywhere at the start.
fn adaptive(scene: &Scene, edge_m: f64) -> Vec<String> {
    between(scene, edge_m, 4.0 * edge_m)
}

/// Only twice as long.
fn narrow(scene: &Scene, edge_m: f64) -> Vec<String> {
    between(scene, edge_m, 2.0 * edge_m)
}

fn between(scene: &Scene, edge_m: f64, coarse_m: f64) -> Vec<String> {
    let coarse_m = coarse_m.min(scene.coarsest_m);
    let remeshing = format!(
        "cloths[0].remeshing={{ size_m: {{ min: {edge_m}, max: {coarse_m} }}, refine_angle: 0.3, \
         refine_velocity: 0.5, refine_compression: 0.005 }}"
    );
    // A garment is fitted with the cells of its scene.
    let start = matches!(scene.cut, Cut::Grid(_)).then(|| scene.cut.mesh(coarse_m));
    [remeshing, "view=null".into()].into_iter().chain(start).collect()
}

/// Adaptive, and by what the camera of the scene sees. The smallest edges in pixels are those of the
/// default in a picture of the default size.
fn view(scene: &Scene, edge_m: f64) -> Vec<String> {
    let mut sets = adaptive(scene, edge_m);
    sets.push("view={ size_min_px: 0.4 }".into());
    sets
}

#[cfg(test)]
mod tests {
    use super::super::scene::SCENES;
    use super::*;

    #[test]
    fn settings_differ_and_have_different_names() {
        for scene in SCENES {
            for (method, quick) in METHODS.iter().flat_map(|m| [(m, true), (m, false)]) {
                let settings = method.settings(scene, scene.plan(quick));
                for (k, one) in settings.iter().enumerate() {
                    for other in &settings[..k] {
                        assert!(one.label != other.label && one.sets != other.sets, "{one:?}");
                    }
                }
            }
        }
    }
}

//! The methods that are compared. To add one, add it to the list: its mesh, and what it varies.

use super::scene::{Plan, Scene};
use super::settings::{Level, Setting, cells, fixed_mesh};

/// A method of choosing mesh and effort.
pub(super) struct Method {
    /// What its points are called.
    pub(super) name: &'static str,
    /// Whether quick runs have it.
    pub(super) quick: bool,
    /// Its meshes: a name, and the values that make it with shortest edges of a given length (m).
    meshes: &'static [(&'static str, Mesh)],
    /// What it alone can vary: a name and values.
    knobs: &'static [(&'static str, &'static [&'static str])],
}

type Mesh = fn(&Scene, f64) -> Vec<String>;

/// The first is what the others are compared with.
pub(super) const METHODS: &[Method] = &[
    Method { name: "fixed", quick: true, meshes: &[("", fixed)], knobs: &[] },
    Method {
        name: "adaptive",
        quick: true,
        meshes: &[("", adaptive), ("longest edges twice the shortest", narrow)],
        knobs: ADAPTIVE,
    },
    Method { name: "view", quick: false, meshes: &[("", view)], knobs: &[] },
];

/// What every method varies: what a step is made of.
const EFFORT: &[(&str, &[&str])] = &[
    ("one Newton iteration", &["newton.max_iterations=1"]),
    ("loose linear solver", &["linear_solver=pcg", "linear_tolerance=1e-2"]),
];
/// The step that the scene does not have by itself.
const STEPS: [(&str, &[&str]); 2] =
    [("implicit Euler", &["integrator=implicit-euler"]), ("SDIRK2", &["integrator=sdirk2"])];

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
        let mut settings: Vec<Setting> = Vec::new();
        // Where a scene bounds the longest edges, meshes may be the same.
        let mut add = |setting: Setting| {
            if settings.iter().all(|other| other.sets != setting.sets) {
                settings.push(setting);
            }
        };
        for mesh in self.meshes {
            plan.levels.iter().for_each(|level| add(at(level, mesh)));
        }
        for (level, mesh) in
            plan.knobs_at().iter().flat_map(|l| self.meshes.first().map(|m| (l, m)))
        {
            let Level { edge_m, substeps } = *level;
            for substeps in [substeps / 2, 2 * substeps] {
                add(at(&Level { edge_m, substeps }, mesh));
            }
            let step = STEPS.iter().filter(|(_, sets)| sets[0] != scene.integrator);
            for (label, sets) in EFFORT.iter().chain(step).chain(self.knobs) {
                add(at(level, mesh).with(label, sets));
            }
        }
        settings
    }
}

/// A tenth of the default in each direction: drawing it must not be what is measured.
const SMALL_PICTURE: [&str; 1] = ["camera.resolution=[128, 72]"];

fn fixed(scene: &Scene, edge_m: f64) -> Vec<String> {
    fixed_mesh(scene.size_m, edge_m)
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
    let [nx, ny] = cells(scene.size_m, coarse_m);
    let remeshing = format!(
        "cloths[0].remeshing={{ size_m: {{ min: {edge_m}, max: {coarse_m} }}, refine_angle: 0.3, \
         refine_velocity: 0.5, refine_compression: 0.005 }}"
    );
    vec![remeshing, format!("cloths[0].mesh.grid.cells=[{nx}, {ny}]")]
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

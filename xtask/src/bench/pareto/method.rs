//! The methods that are compared. To add one, add it to the list: its mesh, and what it varies.

use super::scene::{Plan, Scene};
use super::settings::{Level, Setting, cells, fixed_mesh};

/// A method of choosing mesh and effort.
pub(super) struct Method {
    /// What its points are called.
    pub(super) name: &'static str,
    /// Whether quick runs have it.
    pub(super) quick: bool,
    /// The values that make its mesh, with shortest edges of the given length (m).
    mesh: fn(&Scene, f64) -> Vec<String>,
    /// What it alone can vary: a name and values.
    knobs: &'static [(&'static str, &'static [&'static str])],
}

/// The first is what the others are compared with.
pub(super) const METHODS: &[Method] = &[
    Method { name: "fixed", quick: true, mesh: fixed, knobs: &[] },
    Method { name: "adaptive", quick: true, mesh: adaptive, knobs: ADAPTIVE },
    Method { name: "view", quick: false, mesh: view, knobs: &[] },
];

/// What every method varies, at the second of the levels: what a step is made of.
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
    /// All settings of a scene: the levels, and at the second of them one knob after the other.
    pub(super) fn settings(&self, scene: &Scene, plan: &Plan) -> Vec<Setting> {
        let at = |level: &Level| Setting::of(*level, (self.mesh)(scene, level.edge_m));
        let mut settings: Vec<Setting> = plan.levels.iter().map(at).collect();
        let Some(middle) = plan.levels.get(1) else { return settings };
        let Level { edge_m, substeps } = *middle;
        for substeps in [substeps / 2, 2 * substeps] {
            settings.push(at(&Level { edge_m, substeps }));
        }
        let step = STEPS.iter().filter(|(_, sets)| sets[0] != scene.integrator);
        for (label, sets) in EFFORT.iter().chain(step).chain(self.knobs) {
            settings.push(at(middle).with(label, sets));
        }
        settings
    }
}

fn fixed(scene: &Scene, edge_m: f64) -> Vec<String> {
    fixed_mesh(scene.size_m, edge_m)
}

/// Four times as long where nothing happens, as everywhere at the start.
fn adaptive(scene: &Scene, edge_m: f64) -> Vec<String> {
    let coarse = (4.0 * edge_m).min(scene.coarsest_m);
    let [nx, ny] = cells(scene.size_m, coarse);
    let remeshing = format!(
        "cloths[0].remeshing={{ size_m: {{ min: {edge_m}, max: {coarse} }}, refine_angle: 0.3, \
         refine_velocity: 0.5, refine_compression: 0.005 }}"
    );
    vec![remeshing, format!("cloths[0].mesh.grid.cells=[{nx}, {ny}]")]
}

/// Adaptive, and by what the camera of the scene sees.
fn view(scene: &Scene, edge_m: f64) -> Vec<String> {
    let mut sets = adaptive(scene, edge_m);
    sets.push("view={}".into());
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

//! The scenes that other programs were measured on, and our settings.

use super::super::program::fixed_grid;

/// Simulated seconds of each run, and frames.
pub(super) const SECONDS: f64 = 2.0;
pub(super) const FRAMES: usize = 50;

/// A scene at one mesh.
pub(super) struct Scene {
    pub(super) name: &'static str,
    /// Its file, without ending.
    pub(super) file: &'static str,
    /// Cells along each side.
    cells: usize,
    /// More values of it.
    sets: &'static [&'static str],
    /// Steps a frame of the reference, of second order and solved well.
    reference: usize,
    /// Integrator, steps a frame and Newton iterations of each setting.
    settings: &'static [(&'static str, usize, usize)],
    /// Whether quick runs have it.
    pub(super) quick: bool,
    /// What to know of it.
    pub(super) note: &'static str,
}

/// Values of a scene.
#[derive(Clone, Debug)]
pub(super) struct Setting {
    pub(super) label: String,
    pub(super) sets: Vec<String>,
}

const SDIRK2: &str = "sdirk2";
const EULER: &str = "implicit-euler";

const HANG: &[(&str, usize, usize)] = &[
    (EULER, 1, 1),
    (EULER, 2, 1),
    (SDIRK2, 1, 1),
    (SDIRK2, 2, 1),
    (SDIRK2, 3, 1),
    (SDIRK2, 3, 2),
    (SDIRK2, 5, 1),
];
const DRAPE: &[(&str, usize, usize)] =
    &[(SDIRK2, 2, 1), (EULER, 4, 1), (EULER, 4, 2), (EULER, 8, 2), (SDIRK2, 4, 2)];

/// Friction as where the others have it.
const ON_A_SPHERE: &[&str] = &["contact.friction=0.4", "obstacles[0].friction=0.4"];

const HANG_NOTE: &str = "A sheet of one metre falls from level and swings on two corners; our errors \
                         are from our reference, second-order steps solved to 1e-3 m/s.";
const DRAPE_NOTE: &str = "The sheet falls on a sphere of 0.25 m and touches itself. Of the others only \
                          CPU time and crossings are known here: the errors beside them are those of \
                          `hang`.";

/// All of them.
pub(super) const SCENES: &[Scene] = &[
    hang("hang32", 31, 80, true),
    hang("hang64", 63, 20, false),
    hang("hang128", 127, 8, false),
    drape("drape32", 31, 20),
    drape("drape64", 63, 16),
];

const fn hang(name: &'static str, cells: usize, reference: usize, quick: bool) -> Scene {
    let (sets, settings, note) = (&[], HANG, HANG_NOTE);
    Scene { name, file: "hang", cells, sets, reference, settings, quick, note }
}

const fn drape(name: &'static str, cells: usize, reference: usize) -> Scene {
    let (sets, settings, note) = (ON_A_SPHERE, DRAPE, DRAPE_NOTE);
    Scene { name, file: "drape", cells, sets, reference, settings, quick: false, note }
}

impl Setting {
    /// The same with cloth that is heavier by next to nothing: what comes of that tells what is chance.
    pub(super) fn again(&self, k: usize) -> Setting {
        let mut again = self.clone();
        again.sets.push(format!("cloths[0].multipliers.density={}", 1.0 + 1e-6 * k as f64));
        again
    }
}

impl Scene {
    /// Small second-order steps, solved well; and somewhat longer ones, as different from them as good
    /// solutions are. Twice as long in quick runs.
    pub(super) fn references(&self, quick: bool) -> [Setting; 2] {
        let finest = if quick { self.reference / 2 } else { self.reference };
        [finest, 3 * finest / 4].map(|substeps| {
            let Setting { label, mut sets } = self.setting(SDIRK2, substeps, 20);
            sets.push("newton.tolerance=1e-3".into());
            Setting { label: format!("reference, {label}"), sets }
        })
    }

    pub(super) fn settings(&self) -> impl Iterator<Item = Setting> {
        self.settings.iter().map(|&(integrator, substeps, n)| self.setting(integrator, substeps, n))
    }

    fn setting(&self, integrator: &str, substeps: usize, iterations: usize) -> Setting {
        let mut sets = fixed_grid([self.cells; 2]);
        sets.extend(self.sets.iter().map(|set| (*set).to_owned()));
        sets.extend([
            format!("integrator={integrator}"),
            format!("substeps={substeps}"),
            format!("newton.max_iterations={iterations}"),
            // Drawing must not be what is measured.
            "camera.resolution=[128, 72]".into(),
        ]);
        let step_ms = 40.0 / substeps as f64;
        let times = if iterations == 1 { "iteration" } else { "iterations" };
        let label = format!("{integrator}, steps of {step_ms:.1} ms, {iterations} {times}");
        Setting { label, sets }
    }
}

#[cfg(test)]
mod tests {
    use super::super::marks::PEERS;
    use super::*;

    #[test]
    fn every_scene_has_peers_and_settings_of_its_own() {
        for scene in SCENES {
            assert!(PEERS.iter().any(|peer| peer.mark(scene.name).is_some()), "{}", scene.name);
            let labels: Vec<String> = scene.settings().map(|s| s.label).collect();
            for (k, label) in labels.iter().enumerate() {
                assert!(!labels[..k].contains(label), "{label}");
            }
            let finest = scene.settings.iter().map(|(_, substeps, _)| *substeps).max();
            assert!(finest.unwrap() < 3 * scene.reference / 4, "{}", scene.name);
        }
    }
}

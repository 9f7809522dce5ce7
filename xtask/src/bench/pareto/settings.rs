//! One setting of all knobs, as values of a scene.

use super::super::program::grid;

/// How fine, in space and time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Level {
    /// Length of the shortest edges (m).
    pub(super) edge_m: f64,
    /// Time steps a frame.
    pub(super) substeps: usize,
}

/// Values to be set in a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Setting {
    /// What tells it from the others.
    pub(super) label: String,
    /// `PATH=VALUE` each.
    pub(super) sets: Vec<String>,
}

impl Setting {
    /// The steps of a level; the mesh is the method's.
    pub(super) fn of(level: Level, mesh: Vec<String>) -> Setting {
        let Level { edge_m, substeps } = level;
        let mm = (1e4 * edge_m).round() / 10.0;
        let mut sets = mesh;
        sets.push(format!("substeps={substeps}"));
        Setting { label: format!("{mm} mm, {substeps} steps"), sets }
    }

    /// The same with other values; what needs no telling has no label.
    pub(super) fn with(mut self, label: &str, sets: &[&str]) -> Setting {
        if !label.is_empty() {
            self.label = format!("{}, {label}", self.label);
        }
        self.sets.extend(sets.iter().map(|set| (*set).to_owned()));
        self
    }
}

/// What the first cloth of a scene is cut from, and with that how errors are measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Cut {
    /// A rectangle (m): distance of the same material points, all over the cloth.
    Grid([f64; 2]),
    /// The panels of a garment: their distance in the picture, of those that the camera sees.
    Garment,
}

impl Cut {
    /// The unit of errors.
    pub(super) fn unit(self) -> &'static str {
        match self {
            Cut::Grid(_) => "m",
            Cut::Garment => "px",
        }
    }

    /// Values for a mesh of cells with edges of this length.
    pub(super) fn mesh(self, edge_m: f64) -> String {
        match self {
            Cut::Grid(size_m) => grid(cells(size_m, edge_m)),
            Cut::Garment => format!("cloths[0].mesh.garment.cell_m={edge_m}"),
        }
    }

    /// Values for such a mesh that stays as it is.
    pub(super) fn fixed_mesh(self, edge_m: f64) -> Vec<String> {
        vec!["cloths[0].remeshing=null".into(), self.mesh(edge_m)]
    }
}

/// Cells with edges of about this length.
pub(super) fn cells(size_m: [f64; 2], edge_m: f64) -> [usize; 2] {
    size_m.map(|side| (side / edge_m).round().max(1.0) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_say_what_they_are() {
        let level = Level { edge_m: 0.0025, substeps: 8 };
        let setting = Setting::of(level, Cut::Grid([0.12, 0.03]).fixed_mesh(0.0025));
        let setting = setting.with("one", &["newton.max_iterations=1"]);
        assert_eq!(setting.label, "2.5 mm, 8 steps, one");
        assert_eq!(
            setting.sets[1..],
            ["cloths[0].mesh.grid.cells=[48, 12]", "substeps=8", "newton.max_iterations=1"]
        );
        assert_eq!(cells([1.0, 0.01], 0.3), [3, 1]);
    }
}

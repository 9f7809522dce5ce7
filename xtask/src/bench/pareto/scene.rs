//! The scenes, how far they are followed, and how fine.

use super::settings::{Cut, Level, Setting};

/// A scene of the project with one cloth.
pub(super) struct Scene {
    /// Name of its file, without ending.
    pub(super) name: &'static str,
    /// Its cloth.
    pub(super) cut: Cut,
    /// Longest edges of adaptive meshes (m).
    pub(super) coarsest_m: f64,
    /// The step that the file asks for.
    pub(super) integrator: &'static str,
    /// Why it is followed as far as it is.
    pub(super) note: &'static str,
    quick: Plan,
    full: Plan,
}

/// How far a scene is followed, and how fine.
pub(super) struct Plan {
    /// Frames after the first.
    pub(super) frames: usize,
    /// From coarse to fine.
    pub(super) levels: &'static [Level],
    pub(super) reference: Level,
    /// Edges of the second reference (m).
    pub(super) other_edge_m: f64,
    /// How many of the levels, from the second on, have all knobs turned.
    n_turned: usize,
}

impl Plan {
    /// The levels at which all knobs are turned.
    pub(super) fn knobs_at(&self) -> &[Level] {
        &self.levels[1..][..self.n_turned]
    }
}

impl Scene {
    pub(super) fn plan(&self, quick: bool) -> &Plan {
        if quick { &self.quick } else { &self.full }
    }

    /// Two references on fixed meshes, with the second-order step and everything solved well.
    pub(super) fn references(&self, plan: &Plan) -> [Setting; 2] {
        [plan.reference.edge_m, plan.other_edge_m].map(|edge_m| {
            let level = Level { edge_m, ..plan.reference };
            let well = [
                "integrator=sdirk2",
                "newton.max_iterations=30",
                "newton.tolerance=1e-3",
                "linear_solver=auto",
                "linear_tolerance=1e-6",
                "view=null",
                "restraint=null",
            ];
            Setting::of(level, self.cut.fixed_mesh(edge_m)).with("solved well", &well)
        })
    }
}

const fn level(edge_m: f64, substeps: usize) -> Level {
    Level { edge_m, substeps }
}

const SDIRK2: &str = "integrator=sdirk2";
const EULER: &str = "integrator=implicit-euler";

/// A sheet of a metre that meets a sphere, which many edges make expensive.
const ON_A_SPHERE: Plan = Plan {
    frames: 12,
    levels: &[level(1.0 / 8.0, 4), level(1.0 / 16.0, 8), level(1.0 / 24.0, 12)],
    reference: level(1.0 / 40.0, 20),
    other_edge_m: 1.0 / 36.0,
    n_turned: 2,
};
const ON_A_SPHERE_QUICK: Plan = Plan {
    frames: 6,
    levels: &[level(0.25, 4), level(0.125, 6), level(1.0 / 12.0, 8)],
    reference: level(0.05, 12),
    other_edge_m: 1.0 / 18.0,
    n_turned: 1,
};

/// All of them.
pub(super) const SCENES: &[Scene] = &[
    Scene {
        name: "hang",
        cut: Cut::Grid([1.0, 1.0]),
        coarsest_m: 0.5,
        integrator: SDIRK2,
        note: "It is followed down to the bottom of its first swing; later its folds are chaotic.",
        quick: Plan {
            frames: 8,
            levels: &[level(0.25, 4), level(0.125, 4), level(0.0625, 6)],
            reference: level(1.0 / 28.0, 12),
            other_edge_m: 0.04,
            n_turned: 1,
        },
        full: Plan {
            frames: 15,
            levels: &[
                level(1.0 / 8.0, 4),
                level(1.0 / 16.0, 6),
                level(1.0 / 32.0, 8),
                level(1.0 / 48.0, 8),
            ],
            reference: level(1.0 / 72.0, 16),
            other_edge_m: 1.0 / 64.0,
            n_turned: 2,
        },
    },
    // Edges go into the 20 mm of the clamp a whole number of times, so that all clamp the same.
    Scene {
        name: "cantilever",
        cut: Cut::Grid([0.12, 0.03]),
        coarsest_m: 0.02,
        integrator: SDIRK2,
        note: "It bends in a plane; nothing is chaotic.",
        quick: Plan {
            frames: 8,
            levels: &[level(0.01, 4), level(0.005, 6)],
            reference: level(0.0025, 12),
            other_edge_m: 0.02 / 7.0,
            n_turned: 1,
        },
        full: Plan {
            frames: 25,
            levels: &[level(0.01, 4), level(0.005, 8), level(0.0025, 12)],
            reference: level(0.02 / 14.0, 24),
            other_edge_m: 0.02 / 12.0,
            n_turned: 2,
        },
    },
    Scene {
        name: "drape",
        cut: Cut::Grid([1.0, 1.0]),
        coarsest_m: 0.5,
        integrator: EULER,
        note: "It is followed until it bends over the sphere; how its folds then buckle is chaotic.",
        quick: ON_A_SPHERE_QUICK,
        full: Plan { frames: 7, ..ON_A_SPHERE },
    },
    Scene {
        name: "flag",
        cut: Cut::Grid([3.0, 2.0]),
        coarsest_m: 1.0,
        integrator: EULER,
        note: "Flags are chaotic: only the first frames are compared, from rest, as no run can \
               start from a state of the reference.",
        quick: Plan {
            frames: 5,
            levels: &[level(0.5, 4), level(0.25, 6), level(1.0 / 6.0, 8)],
            reference: level(0.1, 12),
            other_edge_m: 1.0 / 9.0,
            n_turned: 1,
        },
        full: Plan {
            frames: 10,
            levels: &[level(0.25, 4), level(0.125, 8), level(0.0833, 12)],
            reference: level(0.05, 16),
            other_edge_m: 0.0555,
            n_turned: 2,
        },
    },
    Scene {
        name: "sphere",
        cut: Cut::Grid([1.0, 1.0]),
        coarsest_m: 0.5,
        integrator: EULER,
        note: "Cloth struck by a sphere is chaotic: only the first frames are compared, from rest, \
               as no run can start from a state of the reference.",
        quick: ON_A_SPHERE_QUICK,
        full: ON_A_SPHERE,
    },
    Scene {
        name: "hanging-cloth",
        cut: Cut::Grid([1.0, 1.0]),
        coarsest_m: 0.5,
        integrator: EULER,
        note: "It swings and comes to rest.",
        quick: Plan {
            frames: 150,
            levels: &[level(0.25, 2), level(0.125, 2)],
            reference: level(1.0 / 12.0, 4),
            other_edge_m: 0.1,
            n_turned: 1,
        },
        full: Plan {
            frames: 400,
            levels: &[level(1.0 / 8.0, 2), level(1.0 / 16.0, 4), level(1.0 / 24.0, 4)],
            reference: level(1.0 / 36.0, 8),
            other_edge_m: 1.0 / 32.0,
            n_turned: 2,
        },
    },
    // Its first second: later two dancers in dresses of different meshes part ways.
    Scene {
        name: "dancer",
        cut: Cut::Garment,
        coarsest_m: 0.12,
        integrator: EULER,
        note: "Pixels of the scene's camera, whose picture is 1280 wide, of cloth that it sees. Cloth that \
               is worn is chaotic: only her first steps are compared, from rest.",
        quick: Plan {
            frames: 12,
            levels: &[level(0.06, 4), level(0.045, 6)],
            reference: level(0.03, 8),
            other_edge_m: 0.034,
            n_turned: 1,
        },
        full: Plan {
            frames: 25,
            levels: &[level(0.045, 4), level(0.03, 8), level(0.02, 8)],
            reference: level(0.0145, 12),
            other_edge_m: 0.0165,
            n_turned: 1,
        },
    },
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn references_are_finer_than_all_levels_and_differ() {
        for scene in SCENES {
            for plan in [&scene.quick, &scene.full] {
                let finest = plan.levels.last().unwrap();
                assert!(plan.levels.is_sorted_by(|a, b| a.edge_m > b.edge_m));
                assert!(plan.reference.edge_m < plan.other_edge_m);
                assert!(plan.other_edge_m < finest.edge_m, "{}", scene.name);
                assert!(plan.reference.substeps > finest.substeps);
                let [fine, other] = [plan.reference.edge_m, plan.other_edge_m];
                assert_ne!(scene.cut.mesh(fine), scene.cut.mesh(other));
            }
        }
    }

    #[test]
    fn every_scene_has_its_file() {
        for scene in SCENES {
            let file = format!("{}/../scenes/{}.json5", env!("CARGO_MANIFEST_DIR"), scene.name);
            assert!(std::path::Path::new(&file).is_file(), "{file}");
        }
    }
}

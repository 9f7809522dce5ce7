//! What other programs take for the same scenes, measured once on another machine.
//!
//! CPU seconds per simulated second without set-up, one thread, a quiet AMD EPYC. Errors are those of
//! the path of the centre of mass from one of steps of 0.5 ms, root mean square over two seconds, and
//! were measured at 32 × 32 vertices alone: on finer meshes the same program at the same step is given
//! the same error, in its favour, as its damping stays and its solver converges less.

/// The same for those who read figures.
pub(super) const NOTE: &str = "CPU seconds of other programs for a simulated second, stepping alone, \
     on one thread of a quiet AMD EPYC; errors from a path of steps of 0.5 ms, measured at 32 x 32 \
     vertices and given to finer meshes too, in their favour.";

/// What the names of their settings begin with.
pub(super) const PROGRAMS: [&str; 4] = ["blender", "mujoco", "newton", "c-ipc"];

/// A program at one setting.
pub(super) struct Peer {
    /// What figures call it.
    pub(super) name: &'static str,
    pub(super) says: &'static str,
    /// Error on `hang` at 32 × 32 vertices (m).
    pub(super) error_m: f64,
    /// What it takes, by the name of the scene.
    pub(super) marks: &'static [(&'static str, Mark)],
}

/// What a program takes for a scene.
#[derive(Clone, Copy)]
pub(super) struct Mark {
    /// CPU seconds per simulated second.
    pub(super) cpu_s: f64,
    /// Visibly not converged: it falls more slowly, or drops off its pins.
    pub(super) is_slow: bool,
    /// Edges that pass through triangles at the end, where cloth touches itself.
    pub(super) crossings: Option<u32>,
}

const fn of(cpu_s: f64) -> Mark {
    Mark { cpu_s, is_slow: false, crossings: None }
}

const fn slow(cpu_s: f64) -> Mark {
    Mark { is_slow: true, ..of(cpu_s) }
}

const fn drape(cpu_s: f64, crossings: u32) -> Mark {
    Mark { crossings: Some(crossings), ..of(cpu_s) }
}

/// All of them.
pub(super) const PEERS: &[Peer] = &[
    Peer {
        name: "blender-8ms",
        says: "Blender 5.2, steps of 8 ms",
        error_m: 0.109,
        marks: &[
            ("hang32", of(0.49)),
            ("hang64", of(2.2)),
            ("hang128", slow(10.5)),
            ("drape32", drape(2.4, 0)),
            ("drape64", drape(4.2, 25)),
            ("drape128", drape(24.0, 43)),
        ],
    },
    Peer {
        name: "blender-0.5ms",
        says: "Blender 5.2, steps of 0.5 ms",
        error_m: 0.013,
        marks: &[("hang32", of(1.6))],
    },
    Peer {
        name: "mujoco-40ms",
        says: "MuJoCo 4.0 flex, steps of 40 ms",
        error_m: 0.37,
        marks: &[("hang32", of(0.13))],
    },
    Peer {
        name: "mujoco-8ms",
        says: "MuJoCo 4.0 flex, steps of 8 ms",
        error_m: 0.118,
        marks: &[
            ("hang32", of(0.59)),
            ("hang64", of(5.2)),
            ("hang128", slow(17.0)),
            ("drape64", drape(10.1, 0)),
        ],
    },
    Peer {
        name: "mujoco-2ms",
        says: "MuJoCo 4.0 flex, steps of 2 ms",
        error_m: 0.030,
        marks: &[("hang32", of(2.0)), ("drape32", drape(5.2, 0))],
    },
    Peer {
        name: "newton-vbd",
        says: "Newton 1.8 VBD, steps of 1.67 ms, 10 iterations",
        error_m: 0.027,
        marks: &[
            ("hang32", of(7.0)),
            ("hang64", slow(28.0)),
            ("hang128", slow(114.0)),
            ("drape32", drape(15.2, 9)),
        ],
    },
    Peer {
        name: "newton-style3d",
        says: "Newton 1.8 Style3D, steps of 8 ms, 10 iterations",
        error_m: 0.50,
        marks: &[
            ("hang32", slow(1.5)),
            ("hang64", slow(3.3)),
            ("hang128", slow(10.5)),
            ("drape32", drape(2.6, 0)),
            ("drape64", drape(6.7, 0)),
        ],
    },
    Peer {
        name: "c-ipc-40ms",
        says: "C-IPC, converged, steps of 40 ms",
        error_m: 0.20,
        marks: &[
            ("hang32", of(7.0)),
            ("hang64", of(39.9)),
            ("hang128", of(135.0)),
            ("drape32", drape(22.2, 0)),
            ("drape64", drape(168.0, 0)),
        ],
    },
    Peer {
        name: "c-ipc-8ms",
        says: "C-IPC, converged, steps of 8 ms",
        error_m: 0.069,
        marks: &[("hang32", of(22.5))],
    },
];

impl Peer {
    /// What it takes for a scene, if that was measured.
    pub(super) fn mark(&self, scene: &str) -> Option<Mark> {
        self.marks.iter().find(|(name, _)| *name == scene).map(|(_, mark)| *mark)
    }
}

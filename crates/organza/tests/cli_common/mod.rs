//! Runs the program on small scenes in a folder of its own.

#![allow(dead_code, reason = "every test takes what it needs")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use io_mcap::{OwnedFrame, Recording};

/// Two garments, both remeshed; one is let go half-way. Checkpoints at frames 0, 2, 4, 6.
pub(crate) const TWO: &str = r#"{
  frames: 6, substeps: 2,
  wind: { velocity: [3, 1, 0] },
  newton: { max_iterations: 4 },
  cloths: [
    { name: "sheet", fabric: "woven-light",
      mesh: { grid: { size_m: [1, 1], cells: [12, 12] } },
      remeshing: { size_m: { min: 0.05, max: 0.3 }, refine_angle: 0.3, refine_velocity: 0.5 } },
    { name: "skirt", fabric: "denim", transform: { translate: [3, 0, 0] },
      mesh: { skirt: { panels: 2, waist_m: 0.6, hem_m: 1.2, length_m: 0.4, cells: [6, 4] } },
      remeshing: { size_m: { min: 0.05, max: 0.2 }, refine_angle: 0.3 } },
  ],
  handles: [
    { cloth: "sheet", select: { corners: ["upper-left", "upper-right"] } },
    { cloth: "skirt", select: { sides: ["upper"] }, end_s: 0.1 },
  ],
  recording: { checkpoint_every_frames: 2 },
}"#;

/// One triangle on a fixed mesh, and a camera: as quick as can be. It names a file.
pub(crate) const TRIANGLE: &str = r#"{
  frames: 3, substeps: 1,
  cloths: [{ name: "scrap", mesh: { obj: "scrap.obj" }, fabric: "denim" }],
  camera: { position: [0.5, -4, 0], target: [0.5, 0, 0], resolution: [64, 48] },
}"#;

/// The mesh of [`TRIANGLE`].
pub(crate) const SCRAP: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// A folder for one test, empty at the start.
pub(crate) struct Folder(PathBuf);

impl Folder {
    pub(crate) fn new(name: &str) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("cli").join(name);
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    pub(crate) fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        let path = self.path(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, content).unwrap();
    }

    pub(crate) fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    pub(crate) fn text(&self, name: &str) -> String {
        String::from_utf8(self.read(name)).unwrap()
    }

    /// Names of everything inside, folders included, sorted.
    pub(crate) fn listing(&self) -> Vec<String> {
        fn walk(folder: &Path, prefix: &str, names: &mut Vec<String>) {
            for entry in fs::read_dir(folder).unwrap() {
                let entry = entry.unwrap();
                let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
                if entry.file_type().unwrap().is_dir() {
                    walk(&entry.path(), &format!("{name}/"), names);
                }
                names.push(name);
            }
        }
        let mut names = Vec::new();
        walk(&self.0, "", &mut names);
        names.sort();
        names
    }

    /// Runs the program with this folder as its working directory.
    pub(crate) fn run<A: AsRef<std::ffi::OsStr>>(&self, args: &[A]) -> Ran {
        let output = self.command(args).output().unwrap();
        Ran::new(output)
    }

    pub(crate) fn command<A: AsRef<std::ffi::OsStr>>(&self, args: &[A]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_organza"));
        command.args(args).current_dir(&self.0);
        command
    }

    /// Runs the program and expects success.
    #[track_caller]
    pub(crate) fn good<A: AsRef<std::ffi::OsStr> + std::fmt::Debug>(&self, args: &[A]) -> Ran {
        let ran = self.run(args);
        assert_eq!(ran.code, 0, "{args:?}: {ran:?}");
        ran
    }
}

/// What a run of the program gave.
#[derive(Debug)]
pub(crate) struct Ran {
    pub(crate) code: i32,
    pub(crate) out: String,
    pub(crate) err: String,
}

impl Ran {
    pub(crate) fn new(output: Output) -> Self {
        let text = |bytes: Vec<u8>| String::from_utf8_lossy(&bytes).into_owned();
        let err = text(output.stderr);
        assert!(!err.contains("panicked"), "{err}");
        Self { code: output.status.code().unwrap_or(-1), out: text(output.stdout), err }
    }
}

/// All complete frames of a recording.
pub(crate) fn frames(path: &Path) -> Vec<OwnedFrame> {
    let mut recording = Recording::open(path).unwrap();
    let indices: Vec<u64> = recording.frames().map(|f| f.index).collect();
    indices.into_iter().map(|k| recording.frame(k).unwrap()).collect()
}

/// Asserts that two frames have the same bits; reports may differ in wall time alone.
#[track_caller]
pub(crate) fn assert_same(a: &OwnedFrame, b: &OwnedFrame, what: &str) {
    let what = format!("{what}, frame {}", a.index);
    assert_eq!((a.index, a.time_s.to_bits()), (b.index, b.time_s.to_bits()), "{what}");
    assert_eq!(a.garments.len(), b.garments.len(), "{what}");
    for (a, b) in a.garments.iter().zip(&b.garments) {
        assert_eq!((&a.name, a.color), (&b.name, b.color), "{what}");
        assert_eq!(a.triangles, b.triangles, "{what}");
        let bits = |points: &[[f64; 3]]| -> Vec<[u64; 3]> {
            points.iter().map(|p| p.map(f64::to_bits)).collect()
        };
        assert!(bits(&a.points) == bits(&b.points), "{what}: points differ");
        assert!(a.material == b.material, "{what}: material coordinates differ");
    }
    assert_eq!(a.obstacles, b.obstacles, "{what}");
    assert_eq!((&a.camera, &a.transforms), (&b.camera, &b.transforms), "{what}");
    let without_time = |report: &serde_json::Value| {
        let mut report = report.clone();
        report.as_object_mut().unwrap().remove("seconds").unwrap();
        report
    };
    assert_eq!(without_time(&a.report), without_time(&b.report), "{what}");
}

/// SplitMix64, for choices that look random and are always the same.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % n as u64) as usize
    }
}

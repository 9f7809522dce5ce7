//! The program under test, run as its users run it.

use super::child;
use super::run_info::RunInfo;
use crate::command::Failure;
use serde_json::Value;
use std::fmt::Display;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

/// The `organza` binary.
#[derive(Clone, Debug)]
pub(super) struct Program {
    path: PathBuf,
    /// Folder of the workspace.
    root: PathBuf,
}

/// A simulation to run.
#[derive(Clone, Debug)]
pub(super) struct Simulation {
    pub(super) scene: PathBuf,
    pub(super) frames: usize,
    /// `PATH=VALUE` each.
    pub(super) sets: Vec<String>,
    /// Recording to write; an old one is replaced.
    pub(super) out: PathBuf,
}

/// The value that gives the first cloth of a scene a grid of cells.
pub(super) fn grid([nx, ny]: [usize; 2]) -> String {
    format!("cloths[0].mesh.grid.cells=[{nx}, {ny}]")
}

/// Values that give the first cloth of a scene a grid of cells that stays as it is.
pub(super) fn fixed_grid(cells: [usize; 2]) -> Vec<String> {
    vec!["cloths[0].remeshing=null".into(), grid(cells)]
}

/// What a run took and told.
#[derive(Clone, Debug)]
pub(super) struct Measured {
    /// CPU time of the whole process, from reading the scene to drawing the last frame (s).
    pub(super) cpu_s: f64,
    /// Peak of its resident memory (MB), where Linux tells it.
    pub(super) peak_mb: Option<f64>,
    pub(super) info: RunInfo,
}

/// How a simulation ended that may fail.
#[derive(Clone, Debug)]
pub(super) enum Attempt {
    Done(Measured),
    /// The error that the program ended with.
    Refused(String),
    Crashed(String),
    TooLong,
}

impl Program {
    /// Builds the binary with Cargo, which also says where it is.
    ///
    /// # Errors
    /// If it does not build.
    pub(super) fn build(root: &Path) -> Result<Program, Failure> {
        let path = built(root, "--package organza --bin organza", "organza", "bin")?;
        Ok(Program { path, root: root.to_owned() })
    }

    /// Runs a simulation on one thread.
    ///
    /// # Errors
    /// If the run fails, or says something that is not understood.
    pub(super) fn simulate(&self, simulation: &Simulation) -> Result<Measured, Failure> {
        self.simulate_on(simulation, 1)
    }

    /// Runs a simulation on so many threads.
    ///
    /// # Errors
    /// As [`Program::simulate`].
    pub(super) fn simulate_on(
        &self,
        simulation: &Simulation,
        threads: usize,
    ) -> Result<Measured, Failure> {
        // Standard error is the user's: progress, warnings, what failed.
        let child::Ended { status, cpu_s, peak_mb } =
            child::run(&mut self.command(simulation, threads), None)?;
        if !status.is_some_and(|status| status.success()) {
            let (scene, status) = (simulation.scene.display(), status.unwrap_or_default());
            return Err(Failure::Unable(format!("the simulation of {scene} failed ({status})")));
        }
        Ok(Measured { cpu_s, peak_mb, info: self.info(simulation)? })
    }

    /// Runs a simulation that may be refused, or not come to its end within a limit.
    ///
    /// # Errors
    /// If the program cannot be run, or says something that is not understood.
    pub(super) fn attempt(
        &self,
        simulation: &Simulation,
        limit: Duration,
    ) -> Result<Attempt, Failure> {
        let log = simulation.out.with_extension("log");
        let told = unable(log.display());
        let file = File::create(&log).map_err(&told)?;
        let mut command = self.command(simulation, 1);
        let child::Ended { status, cpu_s, peak_mb } =
            child::run(command.arg("--quiet").stderr(file), Some(limit))?;
        let Some(status) = status else { return Ok(Attempt::TooLong) };
        if status.success() {
            let info = self.info(simulation)?;
            return Ok(Attempt::Done(Measured { cpu_s, peak_mb, info }));
        }
        let message = fs::read_to_string(&log).map_err(told)?;
        match status.code() {
            Some(1 | 2) => Ok(Attempt::Refused(last_error(&message))),
            _ => Ok(Attempt::Crashed(format!("{status}: {}", last_error(&message)))),
        }
    }

    fn command(&self, simulation: &Simulation, threads: usize) -> Command {
        let Simulation { scene, frames, sets, out } = simulation;
        let mut command = Command::new(&self.path);
        command.arg("simulate").arg(scene).arg("--out").arg(out);
        command.args(["--overwrite", "--allow-unsupported"]);
        command.args(["--threads", &threads.to_string(), "--frames", &frames.to_string()]);
        sets.iter().for_each(|set| {
            command.args(["--set", set]);
        });
        command.stdout(Stdio::null());
        command
    }

    /// What the recording of a simulation tells, which must be whole.
    fn info(&self, Simulation { frames, out, .. }: &Simulation) -> Result<RunInfo, Failure> {
        let info = self.output(Command::new(&self.path).arg("info").arg(out).arg("--json"))?;
        let info = RunInfo::parse(&info).map_err(unable(out.display()))?;
        if info.n_frames() != *frames {
            let (n, out) = (info.n_frames(), out.display());
            return Err(Failure::Unable(format!("{out} has {n} frames instead of {frames}")));
        }
        Ok(info)
    }

    /// How many frames a scene has after the first.
    ///
    /// # Errors
    /// If it is not a good scene.
    pub(super) fn n_frames(&self, scene: &Path) -> Result<usize, Failure> {
        let told = self.output(Command::new(&self.path).arg("check").arg(scene))?;
        let frames = told.split_whitespace().zip(told.split_whitespace().skip(1));
        let n =
            frames.filter(|(_, what)| what.starts_with("frame")).find_map(|(n, _)| n.parse().ok());
        n.ok_or_else(|| Failure::Unable(format!("{}: no number of frames", scene.display())))
    }

    /// Writes frames 0 to `last` of a recording as `frame_00000.obj` and so on into a folder.
    ///
    /// # Errors
    /// If that fails.
    pub(super) fn export_obj(&self, run: &Path, last: usize, out: &Path) -> Result<(), Failure> {
        let mut command = Command::new(&self.path);
        command.arg("export").arg(run).args(["--format", "obj", "--overwrite", "--out"]).arg(out);
        command.args(["--frames", &format!("0..{}", last + 1)]);
        self.output(&mut command).map(drop)
    }

    /// The warnings about a scene.
    ///
    /// # Errors
    /// If it is not a good scene.
    pub(super) fn warnings(&self, scene: &Path) -> Result<Vec<String>, Failure> {
        let mut command = Command::new(&self.path);
        command.arg("check").arg(scene).arg("--allow-unsupported");
        let output = command.output().map_err(self.cannot_start())?;
        let told = String::from_utf8_lossy(&output.stderr);
        if !output.status.success() {
            return Err(Failure::Unable(told.trim().to_owned()));
        }
        Ok(told.lines().filter_map(|l| l.strip_prefix("warning: ")).map(str::to_owned).collect())
    }

    /// What an example of the program's crate prints, built first if need be.
    ///
    /// # Errors
    /// If it does not build or fails.
    pub(super) fn example(&self, name: &str, arguments: &[String]) -> Result<String, Failure> {
        let mut command = Command::new("cargo");
        command.args(["run", "--release", "--quiet", "--package", "organza", "--example", name]);
        command.arg("--").args(arguments).current_dir(&self.root);
        self.output(&mut command)
    }

    fn output(&self, command: &mut Command) -> Result<String, Failure> {
        let output = command.stderr(Stdio::inherit()).output().map_err(self.cannot_start())?;
        if !output.status.success() {
            return Err(Failure::Unable(format!("{command:?} failed ({})", output.status)));
        }
        Ok(String::from_utf8_lossy(&output.stdout).into_owned())
    }

    fn cannot_start<E: Display>(&self) -> impl Fn(E) -> Failure {
        unable(format!("cannot start {}", self.path.display()))
    }
}

pub(super) fn unable<E: Display>(what: impl Display) -> impl Fn(E) -> Failure {
    move |error| Failure::Unable(format!("{what}: {error}"))
}

/// The error among what the program said: its last line that begins so, or the last of all.
fn last_error(text: &str) -> String {
    let mut lines = text.lines().rev();
    let error = lines.clone().find(|line| line.starts_with("error"));
    error.or_else(|| lines.next()).unwrap_or_default().to_owned()
}

/// Builds a target with Cargo, which also says where it is.
///
/// # Errors
/// If it does not build.
pub(super) fn built(root: &Path, words: &str, name: &str, kind: &str) -> Result<PathBuf, Failure> {
    let cargo = Command::new("cargo")
        .args(["build", "--release", "--message-format", "json-render-diagnostics"])
        .args(words.split(' '))
        .current_dir(root)
        .stderr(Stdio::inherit())
        .output()
        .map_err(unable("cannot start cargo"))?;
    if !cargo.status.success() {
        return Err(Failure::Unable(format!("{name} does not build")));
    }
    executable(&String::from_utf8_lossy(&cargo.stdout), name, kind)
        .ok_or_else(|| Failure::Unable(format!("cargo names no {kind} `{name}`")))
}

/// The executable in what Cargo tells of a build: one JSON object a line.
fn executable(messages: &str, name: &str, kind: &str) -> Option<PathBuf> {
    messages.lines().filter_map(|line| serde_json::from_str::<Value>(line).ok()).find_map(
        |message| {
            let target = &message["target"];
            let ours = target["name"] == name && target["kind"][0] == kind;
            message["executable"].as_str().filter(|_| ours).map(PathBuf::from)
        },
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_error_is_found_among_warnings() {
        assert_eq!(last_error("warning: a\nerror: b\n  c\n"), "error: b");
        assert_eq!(last_error("x\ny"), "y");
        assert_eq!(last_error(""), "");
    }

    #[test]
    fn the_binary_is_the_one_that_cargo_names() {
        let messages = r#"
            {"reason":"compiler-artifact","target":{"name":"organza","kind":["lib"]},"executable":null}
            {"reason":"compiler-artifact","target":{"name":"build","kind":["custom-build"]},"executable":"x/build"}
            not JSON
            {"reason":"compiler-artifact","target":{"name":"organza","kind":["bin"]},"executable":"x/organza"}
            {"reason":"build-finished","success":true}"#;
        assert_eq!(executable(messages, "organza", "bin"), Some("x/organza".into()));
        assert_eq!(executable("{}\n", "organza", "bin"), None);
    }
}

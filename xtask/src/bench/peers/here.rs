//! One of the other programs run here, where it is installed: what this machine takes beside the one
//! on which all were measured, and whether both agree where the sheet goes.

use super::super::Context;
use super::super::example::Told;
use super::super::report::{Figure, Report};
use super::distance;
use super::marks::PEERS;
use crate::bench::statistics::median;
use crate::command::{Failure, say};
use std::ffi::OsString;
use std::process::{Command, Stdio};

/// The scene that it runs.
pub(super) const SCENE: &str = "hang32";
/// The figure of what this machine takes beside the other.
pub(super) const RATIO: &str = "peers.machine.cpu_ratio";
/// The setting that it runs with.
const PEER: &str = "mujoco-8ms";
const ARGUMENTS: [&str; 2] = ["32", "0.008"];
const SCRIPT: &str = "benches/peers/mujoco_hang.py";
/// The path of its centre of mass with steps of 0.5 ms: time (s), y and z (m).
const PATH: &str = include_str!("../../../../benches/peers/hang32_mujoco.csv");

/// Adds what this machine takes for what MuJoCo took on the other.
pub(super) fn run(context: &Context, report: &mut Report) -> Result<(), Failure> {
    let python = std::env::var_os("ORGANZA_PYTHON").unwrap_or_else(|| OsString::from("python3"));
    let told = (0..context.options.runs()).map(|_| measure(context, &python));
    let Some(cpu_s) = told.collect::<Option<Vec<f64>>>() else {
        let why = format!(
            "{RATIO} is left out, so that CPU seconds of two machines are compared: {SCRIPT} does not \
             run. Install benches/peers/requirements.txt for python3, or for the Python that \
             ORGANZA_PYTHON names."
        );
        say(&why);
        report.remark(&why);
        return Ok(());
    };
    let mark = PEERS.iter().find(|peer| peer.name == PEER).and_then(|peer| peer.mark(SCENE));
    let Some(mark) = mark else { return Ok(()) };
    let ratios: Vec<f64> = cpu_s.iter().map(|s| s / mark.cpu_s).collect();
    let ratio = median(&ratios).unwrap_or(f64::NAN);
    say(format!("  this machine takes {ratio:.2} times the CPU seconds of the other"));
    let note = format!(
        "CPU seconds of MuJoCo for `{SCENE}` at steps of 8 ms here, with whatever else runs, over the \
         {} s on the machine on which the others were measured. Programs differ in what a processor \
         suits, so that this is a rough guide.",
        mark.cpu_s
    );
    report.add(RATIO, Figure::median(&ratios, "1", &note));
    Ok(())
}

/// CPU seconds per simulated second; `None` where it does not run.
fn measure(context: &Context, python: &OsString) -> Option<f64> {
    let output = Command::new(python)
        .arg(context.root.join(SCRIPT))
        .args(ARGUMENTS)
        // One thread each.
        .envs([("OMP_NUM_THREADS", "1"), ("OPENBLAS_NUM_THREADS", "1")])
        .stderr(Stdio::null())
        .output()
        .ok()?;
    let told = Told::parse(&String::from_utf8_lossy(&output.stdout)).ok()?;
    output.status.success().then(|| told.number("cpu_s").ok())?
}

/// Adds how far our reference is from MuJoCo's path with the same steps.
pub(super) fn compare(report: &mut Report, truth: &[[f64; 3]]) -> Result<(), Failure> {
    let path = path().ok_or_else(|| Failure::Unable("cannot read MuJoCo's path".into()))?;
    let apart = distance(truth, &path);
    say(format!("    {apart:.4} m from MuJoCo's path with steps of 0.5 ms"));
    let note = "RMS distance of our reference and MuJoCo's path with steps of 0.5 ms, from which the \
                errors of the others are measured.";
    report.add(&format!("peers.{SCENE}.reference_distance"), Figure::exact(apart, "m", note));
    Ok(())
}

/// MuJoCo's path in our scene, where the sheet hangs from the other side, after the first frame.
fn path() -> Option<Vec<[f64; 3]>> {
    let lines = PATH.lines().skip(2);
    lines
        .map(|line| {
            let mut numbers = line.split(',').map(|word| word.parse::<f64>().ok());
            let [_, y, z] = [numbers.next()??, numbers.next()??, numbers.next()??];
            Some([0.5, 1.0 - y, z])
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::scene::FRAMES;
    use super::*;

    #[test]
    fn the_path_has_all_frames_and_falls_freely_at_first() {
        let path = path().unwrap();
        assert_eq!(path.len(), FRAMES);
        // ½ g t² after a frame of 40 ms, to a percent or two, as the corners hold.
        assert!((path[0][2] + 0.5 * 9.81 * 0.04 * 0.04).abs() < 3e-4, "{:?}", path[0]);
    }
}

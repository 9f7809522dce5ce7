//! Where and on what the figures were measured.

use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use std::process::Command;

/// The machine, as far as it tells.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Machine {
    /// Cores that this program may use.
    cores: Option<usize>,
    /// Model of the processor.
    cpu_model: Option<String>,
    /// Programs that ran or waited for a core, averaged over the last minute, before the benchmark.
    load_average: Option<f64>,
}

impl Machine {
    /// This one.
    pub(super) fn here() -> Machine {
        let read = |path: &str| fs::read_to_string(path).ok();
        Machine {
            cores: std::thread::available_parallelism().ok().map(usize::from),
            cpu_model: read("/proc/cpuinfo").and_then(|text| cpu_model(&text)),
            load_average: read("/proc/loadavg")
                .and_then(|text| text.split_whitespace().next()?.parse().ok()),
        }
    }

    pub(super) fn json(&self) -> Value {
        let Machine { cores, cpu_model, load_average } = self;
        json!({ "cores": cores, "cpu_model": cpu_model, "load_average": load_average })
    }
}

fn cpu_model(cpuinfo: &str) -> Option<String> {
    let line = cpuinfo.lines().find(|line| line.starts_with("model name"))?;
    Some(line.split_once(':')?.1.trim().to_owned())
}

/// The commit of the workspace, with `-dirty` behind it where files have changed since. `None`
/// where there is no git.
pub(super) fn commit(root: &Path) -> Option<String> {
    let arguments = ["describe", "--always", "--dirty", "--abbrev=40", "--exclude=*"];
    let output = Command::new("git").args(arguments).current_dir(root).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    (output.status.success() && !text.trim().is_empty()).then(|| text.trim().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_model_is_one_of_many_lines() {
        let text =
            "processor\t: 0\nmodel\t\t: 1\nmodel name\t: A: fast one \nmodel name\t: other\n";
        assert_eq!(cpu_model(text).as_deref(), Some("A: fast one"));
        assert_eq!(cpu_model("processor : 0"), None);
    }
}

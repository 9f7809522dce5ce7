//! The machine on which figures were measured.

use serde_json::{Value, json};
use std::fs;

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

    /// Reads what [`Machine::json`] made; what is missing is not known.
    pub(super) fn read(json: &Value) -> Machine {
        Machine {
            cores: json["cores"].as_u64().map(|n| n as usize),
            cpu_model: json["cpu_model"].as_str().map(str::to_owned),
            load_average: json["load_average"].as_f64(),
        }
    }

    /// True if times on both can be compared, as far as is known.
    pub(super) fn is_same(&self, other: &Machine) -> bool {
        (self.cores, &self.cpu_model) == (other.cores, &other.cpu_model)
    }

    /// One line on it.
    pub(super) fn text(&self) -> String {
        let known = |text: Option<String>| text.unwrap_or_else(|| "unknown".into());
        format!(
            "{} cores of {}, load {} when it began",
            known(self.cores.map(|n| n.to_string())),
            known(self.cpu_model.clone()),
            known(self.load_average.map(|x| x.to_string()))
        )
    }
}

/// Memory that new programs may have without swapping (MB), `MemAvailable` of proc_meminfo(5); `None`
/// where the machine does not tell.
pub(super) fn available_mb() -> Option<f64> {
    megabytes(&fs::read_to_string("/proc/meminfo").ok()?, "MemAvailable:")
}

/// What stands behind a key in one of Linux' files on memory, which count in KiB (MB = 10⁶ bytes).
pub(super) fn megabytes(text: &str, key: &str) -> Option<f64> {
    let rest = text.lines().find_map(|line| line.strip_prefix(key))?;
    let kib: f64 = rest.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kib * 1024.0 / 1e6)
}

fn cpu_model(cpuinfo: &str) -> Option<String> {
    let line = cpuinfo.lines().find(|line| line.starts_with("model name"))?;
    Some(line.split_once(':')?.1.trim().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_reads_back_and_load_does_not_make_another_machine() {
        let machine =
            Machine { cores: Some(2), cpu_model: Some("A".into()), load_average: Some(0.5) };
        assert_eq!(Machine::read(&machine.json()), machine);
        assert!(machine.is_same(&Machine { load_average: None, ..machine.clone() }));
        assert!(!machine.is_same(&Machine { cores: Some(4), ..machine.clone() }));
    }

    #[test]
    fn the_model_is_one_of_many_lines() {
        let text =
            "processor\t: 0\nmodel\t\t: 1\nmodel name\t: A: fast one \nmodel name\t: other\n";
        assert_eq!(cpu_model(text).as_deref(), Some("A: fast one"));
        assert_eq!(cpu_model("processor : 0"), None);
    }

    #[test]
    fn memory_is_one_of_many_lines() {
        let text = "Name:\tx\nVmPeak:\t  9 kB\nVmHWM:\t  250000 kB\nVmRSS:\t 1 kB\n";
        assert_eq!(megabytes(text, "VmHWM:"), Some(256.0));
        assert_eq!(megabytes("Name:\tx\nState:\tZ (zombie)\n", "VmHWM:"), None);
    }
}

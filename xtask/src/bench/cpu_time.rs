//! CPU seconds of child processes, as Linux tells them.

use crate::command::Failure;
use std::fs;

/// Ticks of the clock of `/proc` (1/s): the same on every architecture that Rust builds for.
const TICKS_PER_S: f64 = 100.0;

/// User and system time of all children that have ended and been waited for (s), to 10 ms.
///
/// # Errors
/// Where there is no `/proc` of Linux.
pub(super) fn of_children() -> Result<f64, Failure> {
    let stat = fs::read_to_string("/proc/self/stat")
        .map_err(|error| Failure::Unable(format!("CPU seconds need Linux: {error}")))?;
    ticks(&stat)
        .map(|ticks| ticks as f64 / TICKS_PER_S)
        .ok_or_else(|| Failure::Unable(format!("cannot read CPU seconds from `{}`", stat.trim())))
}

/// The sum of the fields 16 and 17, `cutime` and `cstime` (proc_pid_stat(5)).
fn ticks(stat: &str) -> Option<u64> {
    // The name in brackets, field 2, may hold blanks and brackets.
    let (_, from_field_3) = stat.rsplit_once(')')?;
    let mut fields = from_field_3.split_whitespace().skip(16 - 3);
    let mut next = || fields.next()?.parse::<u64>().ok();
    Some(next()? + next()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_are_counted_behind_the_name() {
        let stat = "4 (a b) c) R 1 2 3 0 -1 5 100 200 0 0 7 8 1250 34 20 0 1 0 99";
        assert_eq!(ticks(stat), Some(1284));
        assert_eq!(ticks("4 (a) R 1 2"), None);
        assert_eq!(ticks(""), None);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_child_that_works_takes_time() {
        let before = of_children().unwrap();
        let script = "i=0; while [ $i -lt 200000 ]; do i=$((i+1)); done";
        let status = std::process::Command::new("sh").args(["-c", script]).status().unwrap();
        assert!(status.success());
        assert!(of_children().unwrap() >= before + 0.02);
    }
}

//! CPU seconds of child processes.

use crate::command::Failure;
use std::time::Duration;

/// User and system time of all children that have ended and been waited for (s).
///
/// # Errors
/// Where the system does not tell.
#[cfg(unix)]
pub(super) fn of_children() -> Result<f64, Failure> {
    use nix::sys::resource::{UsageWho, getrusage};
    use nix::sys::time::TimeValLike;
    let usage = getrusage(UsageWho::RUSAGE_CHILDREN)
        .map_err(|error| Failure::Unable(format!("cannot read CPU seconds: {error}")))?;
    Ok((usage.user_time() + usage.system_time()).num_microseconds() as f64 * 1e-6)
}

#[cfg(not(unix))]
pub(super) fn of_children() -> Result<f64, Failure> {
    Err(Failure::Unable("CPU seconds need a system like Unix".into()))
}

/// User and system time in a `stat` of proc_pid_stat(5), which counts in hundredths of a second.
pub(super) fn of_stat(stat: &str) -> Option<Duration> {
    // The name of the program, in brackets, may hold anything. The state is the third field.
    let mut fields = stat.rsplit_once(')')?.1.split_whitespace().skip(11);
    let mut ticks = || fields.next()?.parse::<u64>().ok();
    Some(Duration::from_millis(10 * (ticks()? + ticks()?)))
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn the_times_of_a_process_stand_behind_its_name() {
        let stat = "7 (a) b) R 1 7 7 0 -1 4194304 100 0 0 0 250 31 0 0 20 0 1 0 99 1 2";
        assert_eq!(of_stat(stat), Some(Duration::from_millis(2810)));
        assert_eq!(of_stat("7 (a) R 1"), None);
    }

    #[test]
    fn a_child_that_works_takes_time() {
        let before = of_children().unwrap();
        let script = "i=0; while [ $i -lt 200000 ]; do i=$((i+1)); done";
        let status = std::process::Command::new("sh").args(["-c", script]).status().unwrap();
        assert!(status.success());
        assert!(of_children().unwrap() >= before + 0.02);
    }
}

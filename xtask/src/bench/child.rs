//! A child process, run to its end: CPU seconds and peak memory.

use super::{cpu_time, machine};
use crate::command::Failure;
use std::fs;
use std::process::{Command, ExitStatus};
use std::time::{Duration, Instant};

/// How often the memory is looked at. Linux keeps the peak itself, so that only what is added in the
/// last moments can be missed.
const LOOK: Duration = Duration::from_millis(4);

/// What a child took.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ended {
    /// `None` if it was ended at the limit.
    pub(super) status: Option<ExitStatus>,
    /// User and system time (s).
    pub(super) cpu_s: f64,
    /// Peak of resident memory (MB = 10⁶ bytes), where Linux tells it.
    pub(super) peak_mb: Option<f64>,
}

/// How often the limit of CPU time a child may take on the clock, if it only waits.
const WAITING: u32 = 10;

/// Runs a command to its end, or until it has taken as much CPU time as a limit, which does not depend
/// on what else the machine does. No other child may end meanwhile.
///
/// # Errors
/// If it cannot be started.
pub(super) fn run(command: &mut Command, limit: Option<Duration>) -> Result<Ended, Failure> {
    let program = command.get_program().to_string_lossy().into_owned();
    let told = |error| Failure::Unable(format!("cannot start {program}: {error}"));
    let before = cpu_time::of_children()?;
    let mut child = command.spawn().map_err(told)?;
    let [status, stat] = ["status", "stat"].map(|file| format!("/proc/{}/{file}", child.id()));
    let clock = Instant::now();
    let cannot_wait = |error| Failure::Unable(format!("cannot wait: {error}"));
    let mut peak_mb = None;
    let ended = loop {
        // proc_pid_status(5); a process that has ended has no such line.
        let text = fs::read_to_string(&status).ok();
        peak_mb = text.and_then(|text| machine::megabytes(&text, "VmHWM:")).or(peak_mb);
        if let Some(ended) = child.try_wait().map_err(cannot_wait)? {
            break Some(ended);
        }
        let is_over = |limit: Duration| {
            let elapsed = clock.elapsed();
            let worked =
                || fs::read_to_string(&stat).ok().and_then(|text| cpu_time::of_stat(&text));
            // Nothing can have worked for longer than it has been there.
            elapsed > limit && (elapsed > WAITING * limit || worked().is_none_or(|cpu| cpu > limit))
        };
        if limit.is_some_and(is_over) {
            child.kill().and_then(|()| child.wait()).map_err(cannot_wait)?;
            break None;
        }
        std::thread::sleep(LOOK);
    };
    Ok(Ended { status: ended, cpu_s: cpu_time::of_children()? - before, peak_mb })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(target_os = "linux")]
    #[test]
    fn a_child_that_holds_memory_is_seen_to() {
        // Long enough to be looked at, with a string of 2²⁴ letters.
        let script =
            "x=x; i=0; while [ $i -lt 24 ]; do x=$x$x; i=$((i+1)); done; sleep 0.3; exit 3";
        let ended = run(Command::new("sh").args(["-c", script]), None).unwrap();
        assert_eq!(ended.status.unwrap().code(), Some(3));
        assert!(ended.peak_mb.unwrap() > 16.0, "{ended:?}");
        let missing = run(&mut Command::new("/no/such"), None);
        assert!(matches!(missing, Err(Failure::Unable(why)) if why.contains("/no/such")));
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_child_without_end_is_ended() {
        let limit = Some(Duration::from_millis(50));
        for (program, arguments) in
            [("sleep", ["1000", "1000"]), ("sh", ["-c", "while :; do :; done"])]
        {
            let ended = run(Command::new(program).args(arguments), limit).unwrap();
            assert!(ended.status.is_none(), "{program}");
        }
    }
}

//! CPU seconds of child processes.

use crate::command::Failure;

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

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn a_child_that_works_takes_time() {
        let before = of_children().unwrap();
        let script = "i=0; while [ $i -lt 200000 ]; do i=$((i+1)); done";
        let status = std::process::Command::new("sh").args(["-c", script]).status().unwrap();
        assert!(status.success());
        assert!(of_children().unwrap() >= before + 0.02);
    }
}

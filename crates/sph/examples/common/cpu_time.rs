//! CPU seconds of this thread, as Linux tells them.

use std::error::Error;

/// Time on a processor (s), to some microseconds.
pub(crate) fn of_this_thread() -> Result<f64, Box<dyn Error>> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat")?;
    let nanoseconds: f64 = text.split_whitespace().next().unwrap_or("").parse()?;
    Ok(nanoseconds * 1e-9)
}

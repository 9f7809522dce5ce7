//! Progress with the time that remains: a bar on a terminal, a few plain lines elsewhere.

use std::time::{Duration, Instant};

use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::output;

/// Progress from one frame to another.
pub(crate) struct Progress {
    how: How,
    first: u64,
    end: u64,
    start: Instant,
}

enum How {
    Quiet,
    Bar(ProgressBar),
    /// Share of the work (percent) and time of the last line.
    Lines(u64, Instant),
}

/// A line comes after this share of the work,
const LINE_PERCENT: u64 = 10;
/// but not before this time has passed since the last,
const LINE_AT_LEAST: Duration = Duration::from_secs(2);
/// and after this time in any case.
const LINE_AT_MOST: Duration = Duration::from_secs(60);

impl Progress {
    /// Progress over the frames behind `first` up to `end`.
    pub(crate) fn new(first: u64, end: u64, quiet: bool) -> Self {
        let start = Instant::now();
        let how = if quiet {
            How::Quiet
        } else {
            let target = ProgressDrawTarget::stderr();
            if target.is_hidden() {
                How::Lines(0, start)
            } else {
                How::Bar(bar(first, end, target))
            }
        };
        Self { how, first, end, start }
    }

    /// Frame `frame` is done; `words` say something about it.
    pub(crate) fn done(&mut self, frame: u64, words: impl FnOnce() -> String) {
        match &mut self.how {
            How::Quiet => {}
            How::Bar(bar) => {
                bar.set_message(words());
                bar.set_position(frame);
            }
            How::Lines(last_percent, last_time) => {
                let (done, all) = (frame.saturating_sub(self.first), self.end - self.first);
                let percent = 100 * done / all.max(1);
                let passed = last_time.elapsed();
                let due = percent >= *last_percent + LINE_PERCENT && passed >= LINE_AT_LEAST;
                if due || passed >= LINE_AT_MOST {
                    (*last_percent, *last_time) = (percent, Instant::now());
                    // Saturates for times that no clock shows.
                    let left = self.start.elapsed().as_secs_f64() * (all - done.min(all)) as f64
                        / done.max(1) as f64;
                    let left = Duration::try_from_secs_f64(left).unwrap_or(Duration::MAX);
                    let (end, left) = (self.end, HumanDuration(left));
                    output::note(&format!("frame {frame} of {end}, {}, {left} left", words()));
                }
            }
        }
    }

    /// Warns without disturbing the bar.
    pub(crate) fn warn(&self, message: &str) {
        match &self.how {
            How::Bar(bar) => bar.suspend(|| output::warning(message)),
            _ => output::warning(message),
        }
    }

    /// Takes the bar away.
    pub(crate) fn stop(self) {
        if let How::Bar(bar) = self.how {
            bar.finish_and_clear();
        }
    }
}

fn bar(first: u64, end: u64, target: ProgressDrawTarget) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(end), target).with_position(first);
    // Frames that were there before say nothing about the speed of this run.
    bar.reset_eta();
    let template = "{bar:32} frame {pos} of {len}, {msg}, {eta} left";
    bar.with_style(
        ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar()),
    )
}

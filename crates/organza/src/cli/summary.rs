//! The words at the end of a run.

use std::fmt::Write;
use std::path::Path;

use organza::report::{FluidSummary, FrameReport};

/// Sums over the frames of a run.
#[derive(Debug, Default)]
pub(crate) struct Summary {
    frames: u64,
    seconds: f64,
    faces: u64,
    faces_range: Option<[usize; 2]>,
    fluid: Option<FluidSummary>,
    stages: usize,
    unconverged: usize,
    retries: u32,
    limit_reached: u64,
    skipped: Vec<String>,
}

impl Summary {
    pub(crate) fn add(&mut self, report: &FrameReport) {
        self.frames += 1;
        self.seconds += report.seconds.total;
        self.faces += report.faces as u64;
        let [low, high] = self.faces_range.unwrap_or([report.faces; 2]);
        self.faces_range = Some([low.min(report.faces), high.max(report.faces)]);
        self.fluid = report.fluid;
        self.stages += report.stages;
        self.unconverged += report.unconverged_stages;
        self.retries += report.retries;
        self.limit_reached += u64::from(report.remesh.is_some_and(|r| r.limit_reached));
        self.skipped.clone_from(&report.skipped);
    }

    /// What to tell of a finished run.
    pub(crate) fn text(&self, recording: &Path, poster: &Path) -> String {
        let mut text = String::new();
        // Writing to a String cannot fail.
        let _ = self.write(&mut text, recording, poster);
        text
    }

    fn write(&self, out: &mut String, recording: &Path, poster: &Path) -> std::fmt::Result {
        let Summary { frames, seconds, .. } = self;
        if let Some([low, high]) = self.faces_range {
            let n = *frames as f64;
            writeln!(
                out,
                "{frames} frames in {seconds:.2} s, {:.4} s a frame; {:.0} faces on average, \
                 {low} to {high}",
                seconds / n,
                self.faces as f64 / n,
            )?;
        }
        if let Some(FluidSummary { particles, active, transition, restrained, .. }) = self.fluid {
            writeln!(
                out,
                "{particles} particles in the end: {active} move freely, {transition} are in \
                 transition, {restrained} rest"
            )?;
        }
        if self.unconverged > 0 {
            let (unconverged, stages) = (self.unconverged, self.stages);
            writeln!(out, "{unconverged} of {stages} implicit stages did not converge")?;
        }
        if self.retries > 0 {
            writeln!(out, "{} steps failed and were redone in halves", self.retries)?;
        }
        if self.limit_reached > 0 {
            let n = self.limit_reached;
            writeln!(
                out,
                "in {n} frames the mesh is coarser than wanted: it reached max_vertices"
            )?;
        }
        for stage in &self.skipped {
            writeln!(out, "skipped: {stage}")?;
        }
        writeln!(out, "recording: {}", recording.display())?;
        writeln!(out, "picture: {}", poster.display())
    }
}

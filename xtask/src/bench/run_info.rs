//! What `organza info --json` tells of a recording.

use serde_json::Value;

/// The document, with the questions that benchmarks ask.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct RunInfo(Value);

impl RunInfo {
    /// Reads the document; the error says what is missing in it.
    pub(super) fn parse(text: &str) -> Result<RunInfo, String> {
        let document: Value = serde_json::from_str(text).map_err(|error| error.to_string())?;
        let state = document["status"]["state"].as_str().unwrap_or("without state");
        if state != "complete" {
            return Err(format!("the recording is {state}"));
        }
        let info = RunInfo(document);
        if info.frames().is_empty() { Err("it has no frames".into()) } else { Ok(info) }
    }

    /// Reports of all frames but the initial state.
    fn frames(&self) -> &[Value] {
        let all = self.0["frames"].as_array().map_or(&[][..], Vec::as_slice);
        all.get(1..).unwrap_or_default()
    }

    /// One number of the initial state.
    pub(super) fn initial(&self, pointer: &str) -> Option<f64> {
        self.0["frames"].get(0)?.pointer(pointer)?.as_f64()
    }

    /// What the scene did not need, and why.
    pub(super) fn skipped(&self) -> Vec<&str> {
        let skipped = self.0["skipped"].as_array().map_or(&[][..], Vec::as_slice);
        skipped.iter().filter_map(Value::as_str).collect()
    }

    /// Number of frames after the first.
    pub(super) fn n_frames(&self) -> usize {
        self.frames().len()
    }

    /// One number of every frame that has it, such as `/faces` or `/seconds/total`.
    pub(super) fn each(&self, pointer: &str) -> Vec<f64> {
        self.frames().iter().filter_map(|frame| frame.pointer(pointer)?.as_f64()).collect()
    }

    /// Sum of one number over the frames.
    pub(super) fn sum(&self, pointer: &str) -> f64 {
        self.each(pointer).iter().sum()
    }

    /// Mean of one number over the frames.
    pub(super) fn mean(&self, pointer: &str) -> f64 {
        self.sum(pointer) / self.n_frames() as f64
    }

    /// Smallest of one number over the frames.
    pub(super) fn min(&self, pointer: &str) -> Option<f64> {
        self.each(pointer).into_iter().min_by(f64::total_cmp)
    }

    /// Largest of one number over the frames.
    pub(super) fn max(&self, pointer: &str) -> Option<f64> {
        self.each(pointer).into_iter().max_by(f64::total_cmp)
    }

    /// Names of the stages whose seconds the frames tell, the whole frame among them.
    pub(super) fn stages(&self) -> Vec<String> {
        let first = self.frames().first().and_then(|frame| frame["seconds"].as_object());
        first.map_or(Vec::new(), |seconds| seconds.keys().cloned().collect())
    }

    /// A sentence on what went less well than it should; empty if nothing did.
    pub(super) fn troubles(&self) -> String {
        let (unconverged, stages) = (self.sum("/unconverged_stages"), self.sum("/stages"));
        let retries = self.sum("/retries");
        let mut text = String::new();
        if unconverged > 0.0 {
            text += &format!(" {unconverged} of {stages} implicit stages did not converge.");
        }
        if retries > 0.0 {
            text += &format!(" {retries} steps failed and were redone in halves.");
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = r#"{ "status": { "state": "complete" }, "frames": [
        { "faces": 2, "seconds": { "total": 0.0 } },
        { "faces": 10, "stages": 8, "unconverged_stages": 1, "retries": 0,
          "stretch": { "min": 0.9, "max": 1.2 }, "seconds": { "total": 0.5, "linear": 0.25 } },
        { "faces": 20, "stages": 8, "unconverged_stages": 2, "retries": 0,
          "stretch": null, "seconds": { "total": 1.5, "linear": 0.5 } } ] }"#;

    #[test]
    fn the_initial_state_does_not_count() {
        let info = RunInfo::parse(TEXT).unwrap();
        assert_eq!((info.n_frames(), info.mean("/faces")), (2, 15.0));
        assert_eq!((info.min("/faces"), info.max("/seconds/total")), (Some(10.0), Some(1.5)));
        assert_eq!(info.stages(), ["linear", "total"]);
    }

    #[test]
    fn what_a_frame_does_not_tell_is_no_number() {
        let info = RunInfo::parse(TEXT).unwrap();
        assert_eq!(info.each("/stretch/max"), [1.2]);
        assert_eq!((info.min("/nothing"), info.sum("/nothing")), (None, 0.0));
    }

    #[test]
    fn troubles_are_told_where_there_are_any() {
        let info = RunInfo::parse(TEXT).unwrap();
        assert_eq!(info.troubles(), " 3 of 16 implicit stages did not converge.");
        let fine = TEXT.replace("\"unconverged_stages\": 1", "\"unconverged_stages\": 0");
        let fine = fine.replace("\"unconverged_stages\": 2", "\"unconverged_stages\": 0");
        assert_eq!(RunInfo::parse(&fine).unwrap().troubles(), "");
    }

    #[test]
    fn recordings_that_are_not_whole_are_refused() {
        assert!(RunInfo::parse(&TEXT.replace("complete", "cut")).unwrap_err().contains("cut"));
        assert!(
            RunInfo::parse(r#"{ "status": { "state": "complete" }, "frames": [{}] }"#).is_err()
        );
        assert!(RunInfo::parse("{").is_err());
    }
}

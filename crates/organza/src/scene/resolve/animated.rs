//! Reads the files of animated obstacles.

use super::super::check::At;
use super::super::data::Sequence;
use super::super::format::{Gltf, ObjSequence};
use super::super::issue::IssueKind;
use super::super::limits::{MAX_FRAME_RATE, MAX_MESH_BYTES, MAX_SEQUENCE_FRAMES, MAX_TIME_S};
use super::super::pattern::Pattern;
use super::{Context, beyond};
use crate::character::buffer_files;

/// Checks an animation by one file for every frame, and reads them all.
pub(super) fn sequence(
    sequence: &ObjSequence,
    at: &At<'_>,
    context: &mut Context<'_, '_>,
) -> Option<Sequence> {
    at.key("frames_per_second").positive(sequence.frames_per_second, MAX_FRAME_RATE, "1/s");
    at.key("start_s").bounded(sequence.start_s, MAX_TIME_S, "s");
    let [first, last] = sequence.frames;
    let frames = at.key("frames");
    if first > last {
        frames.complain(format!("the first, {first}, is above the last, {last}"));
        return None;
    }
    if last - first >= MAX_SEQUENCE_FRAMES {
        let n = f64::from(last - first) + 1.0;
        frames.complain(beyond(n, f64::from(MAX_SEQUENCE_FRAMES), "frames"));
        return None;
    }
    let at = at.key("files");
    let pattern = Pattern::parse(&sequence.files).map_err(|message| at.complain(message)).ok()?;
    let files: Vec<String> = (first..=last).map(|number| pattern.name(number)).collect();
    let mut left = MAX_MESH_BYTES;
    for name in &files {
        // One that is missing is said once: there may be thousands.
        left -= (context.read(&at, name, left)?.len() as u64).min(left);
    }
    let (frames_per_second, start_s) = (sequence.frames_per_second, sequence.start_s);
    Some(Sequence { files, frames_per_second, start_s })
}

/// Reads a character's file and the buffers it names.
pub(super) fn read_gltf(gltf: &Gltf, at: &At<'_>, context: &mut Context<'_, '_>) -> Option<()> {
    at.key("start_s").bounded(gltf.start_s, MAX_TIME_S, "s");
    read_file(&gltf.file, &at.key("file"), context)
}

/// Reads a glTF file and the buffers it names.
pub(super) fn read_file(file: &str, at: &At<'_>, context: &mut Context<'_, '_>) -> Option<()> {
    let bytes = context.read(at, file, MAX_MESH_BYTES)?;
    let buffers = buffer_files(file, bytes);
    let buffers = buffers
        .map_err(|message| at.report(IssueKind::File, format!("`{file}` {message}")))
        .ok()?;
    for name in buffers {
        context.read(at, &name, MAX_MESH_BYTES)?;
    }
    Some(())
}

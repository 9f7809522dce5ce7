//! Handles of ARCSim.

use super::format::{ArcsimHandle, Magic};
use super::motion::Motions;
use super::translate::Notes;
use crate::scene::format::{ClothRef, HandleFile, Select};
use crate::scene::typed::suggestion;

/// Stiffness of ARCSim's handles where the scene names none (N/m).
const HANDLE_STIFFNESS_N_PER_M: f64 = 1e3;

/// Translates the handles on nodes; complains of the others and leaves them out.
pub(super) fn translate(
    handles: &[ArcsimHandle],
    motions: &Motions,
    magic: &Magic,
    notes: &mut Notes,
) -> Vec<HandleFile> {
    let mut translated = Vec::new();
    for (theirs, handle) in handles.iter().enumerate() {
        let ours = format!("handles[{}]", translated.len());
        let theirs = format!("handles[{theirs}]");
        let Some(nodes) = nodes(handle, &theirs, notes) else { continue };
        for (our_key, their_key) in [
            ("cloth", "cloth"),
            ("select", "nodes"),
            ("start_s", "start_time"),
            ("end_s", "end_time"),
            ("fade_s", "fade_time"),
        ] {
            notes.rename(&format!("{ours}.{our_key}"), &format!("{theirs}.{their_key}"));
        }
        notes.rename(&format!("{ours}.select.vertices"), &format!("{theirs}.nodes"));
        notes.rename(&format!("{ours}.stiffness_n_per_m"), "magic.handle_stiffness");
        let motion = motions.translate(handle.motion, [&ours, &theirs], notes);
        translated.push(HandleFile {
            cloth: ClothRef::Index(handle.cloth.unwrap_or(0)),
            select: Select::Vertices(nodes),
            motion,
            start_s: handle.start_time.unwrap_or(0.0),
            end_s: handle.end_time,
            // Without an end, nothing fades.
            fade_s: handle.end_time.and(handle.fade_time).unwrap_or(0.0),
            stiffness_n_per_m: Some(magic.handle_stiffness.unwrap_or(HANDLE_STIFFNESS_N_PER_M)),
        });
    }
    translated
}

/// The nodes of a handle that is on nodes.
fn nodes(handle: &ArcsimHandle, at: &str, notes: &mut Notes) -> Option<Vec<u32>> {
    const KINDS: [&str; 3] = ["node", "circle", "glue"];
    match handle.kind.as_deref().unwrap_or("node") {
        "node" if handle.label.as_ref().is_some_and(|label| label.as_i64() != Some(-1)) => {
            notes.unsupported(&format!("{at}.label"), "handles by label");
            None
        }
        "node" => {
            if handle.nodes.is_none() {
                notes.complain(at, "key `nodes` is missing");
            }
            handle.nodes.clone()
        }
        kind @ ("circle" | "glue") => {
            notes.unsupported(&format!("{at}.type"), &format!("{kind} handles"));
            None
        }
        kind => {
            let hint = suggestion(kind, &KINDS);
            notes.complain(&format!("{at}.type"), format!("unknown kind of handle `{kind}`{hint}"));
            None
        }
    }
}

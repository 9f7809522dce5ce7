//! Motions of ARCSim, of handles and obstacles.

use super::cloth::translate_transform;
use super::format::ArcsimKeyframe;
use super::translate::Notes;
use crate::scene::motion::{Interpolation, Keyframe, Motion, Turning};
use crate::scene::unsupported::asks;

/// Translates the motion number `index` of the handle or obstacle at the paths `[ours, theirs]`; −1
/// stands for none.
pub(super) fn translate(
    index: Option<i64>,
    motions: &[Vec<ArcsimKeyframe>],
    [ours, theirs]: [&str; 2],
    notes: &mut Notes,
) -> Option<Motion> {
    let index = index.filter(|index| *index != -1)?;
    let index = usize::try_from(index).unwrap_or(usize::MAX);
    let Some(keyframes) = motions.get(index) else {
        if notes.has_motion_file {
            return None;
        }
        let n = motions.len();
        let message = format!("there is no such motion, the scene has {n}");
        notes.complain(&format!("{theirs}.motion"), message);
        return None;
    };
    let theirs = format!("motions[{index}]");
    let keyframes = keyframes.iter().enumerate().map(|(k, key)| {
        let (our_key, their_key) =
            (format!("{ours}.motion.keyframes[{k}]"), format!("{theirs}[{k}]"));
        if key.velocity.as_ref().is_some_and(asks) {
            notes.unsupported(&format!("{their_key}.velocity"), "velocities of keyframes");
        }
        notes.rename(&format!("{our_key}.time_s"), &format!("{their_key}.time"));
        notes.rename(&format!("{our_key}.transform"), &format!("{their_key}.transform"));
        let paths = [format!("{our_key}.transform"), format!("{their_key}.transform")];
        let transform = translate_transform(key.transform, paths.each_ref().map(|p| &**p), notes);
        Keyframe { time_s: key.time, transform }
    });
    let keyframes = keyframes.collect();
    notes.rename(&format!("{ours}.motion.keyframes"), &theirs);
    Some(Motion { interpolation: Interpolation::Smooth, turning: Turning::Shortest, keyframes })
}

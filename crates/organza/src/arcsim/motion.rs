//! Motions of ARCSim, of handles and obstacles.

use nalgebra::Similarity3;

use super::cloth::translate_transform;
use super::format::{ArcsimKeyframe, ArcsimMotionFile, ArcsimMotions};
use super::mot;
use super::translate::Notes;
use crate::scene::Files;
use crate::scene::issue::IssueKind;
use crate::scene::limits::{MAX_FACTOR, MAX_FRAME_RATE, MAX_MOTION_BYTES};
use crate::scene::motion::{
    AxisAngle, Interpolation, Keyframe, Motion, Transform, Turning, Velocity,
};

/// The motions of a scene, by number.
pub(super) enum Motions {
    /// As the scene has them.
    Lists(Vec<Vec<ArcsimKeyframe>>),
    /// As a file has them; none where it was complained of.
    File(Option<Vec<Motion>>),
}

impl Motions {
    /// Reads the motions of a scene, and the file that it may name.
    pub(super) fn read(motions: ArcsimMotions, files: &mut Files<'_>, notes: &mut Notes) -> Self {
        match motions {
            ArcsimMotions::Lists(lists) => Self::Lists(lists),
            ArcsimMotions::File(file) => Self::File(read_file(&file, files, notes)),
        }
    }

    /// How many there are, if that is known.
    pub(super) fn count(&self) -> Option<usize> {
        match self {
            Self::Lists(lists) => Some(lists.len()),
            Self::File(motions) => motions.as_ref().map(Vec::len),
        }
    }

    /// The motion number `index` of the handle or obstacle at the paths `[ours, theirs]`; −1 stands
    /// for none.
    pub(super) fn translate(
        &self,
        index: Option<i64>,
        [ours, theirs]: [&str; 2],
        notes: &mut Notes,
    ) -> Option<Motion> {
        let index = index.filter(|index| *index != -1)?;
        let n = self.count()?;
        let index = usize::try_from(index).ok().filter(|index| *index < n);
        let Some(index) = index else {
            let message = format!("there is no such motion, the scene has {n}");
            notes.complain(&format!("{theirs}.motion"), message);
            return None;
        };
        match self {
            Self::Lists(lists) => Some(translate(&lists[index], index, ours, notes)),
            Self::File(motions) => {
                notes.rename(&format!("{ours}.motion"), "motions");
                motions.as_ref().map(|motions| motions[index].clone())
            }
        }
    }
}

fn translate(keyframes: &[ArcsimKeyframe], index: usize, ours: &str, notes: &mut Notes) -> Motion {
    let theirs = format!("motions[{index}]");
    let keyframes = keyframes.iter().enumerate().map(|(k, key)| {
        let (our_key, their_key) =
            (format!("{ours}.motion.keyframes[{k}]"), format!("{theirs}[{k}]"));
        notes.rename(&format!("{our_key}.time_s"), &format!("{their_key}.time"));
        let part = |part: &str| [&our_key, &their_key].map(|key| format!("{key}.{part}"));
        let paths = part("transform");
        notes.rename(&paths[0], &paths[1]);
        let transform = translate_transform(key.transform, paths.each_ref().map(|p| &**p), notes);
        let paths = part("velocity");
        notes.rename(&paths[0], &paths[1]);
        let velocity = key.velocity.map(|velocity| {
            if velocity.rotate.is_some_and(|[degrees, ..]| degrees != 0.0) {
                notes.unsupported(&format!("{}.rotate", paths[1]), "keyframes with a spin");
            }
            // What a velocity leaves out, and a factor of one, stands for no change.
            Velocity {
                translate: velocity.translate.unwrap_or_default(),
                scale: velocity.scale.filter(|scale| *scale != 1.0).unwrap_or(0.0),
            }
        });
        Keyframe { time_s: key.time, transform, velocity }
    });
    let keyframes = keyframes.collect();
    notes.rename(&format!("{ours}.motion.keyframes"), &theirs);
    Motion { interpolation: Interpolation::Smooth, turning: Turning::Shortest, keyframes }
}

/// Reads the motions of a file; `None` where something was wrong.
fn read_file(
    file: &ArcsimMotionFile,
    files: &mut Files<'_>,
    notes: &mut Notes,
) -> Option<Vec<Motion>> {
    let fps = file.fps;
    if !(1.0 / MAX_FRAME_RATE..=MAX_FRAME_RATE).contains(&fps) {
        let limit = MAX_FRAME_RATE;
        let message =
            format!("must lie between 1/{limit:e} and {limit:e} frames a second, got {fps}");
        notes.complain("motions.fps", message);
        return None;
    }
    let place = "motions.transform";
    let place = translate_transform(file.transform, [place, place], notes);
    if !(1.0 / MAX_FACTOR..=MAX_FACTOR).contains(&place.scale) {
        let limit = MAX_FACTOR;
        let message = format!("must lie between 1/{limit:e} and {limit:e}, got {}", place.scale);
        notes.complain("motions.transform.scale", message);
        return None;
    }
    let bytes = match files.read(&file.motfile, MAX_MOTION_BYTES) {
        Ok(bytes) => bytes,
        Err(error) => {
            notes.note(IssueKind::File, "motions.motfile", error.to_string());
            return None;
        }
    };
    let bodies = mot::read(bytes).map_err(|message| {
        let message = format!("`{}`: {message}", file.motfile);
        notes.note(IssueKind::File, "motions.motfile", message);
    });
    let similarity = place.similarity();
    let keyframe = |(k, pose)| {
        let pose: Similarity3<f64> = similarity * pose;
        let turn = pose.isometry.rotation.scaled_axis();
        let rotate = AxisAngle { axis: turn.into(), degrees: turn.norm().to_degrees() };
        let transform = Transform {
            scale: pose.scaling(),
            rotate: (rotate.degrees != 0.0).then_some(rotate),
            translate: pose.isometry.translation.vector.into(),
        };
        Keyframe::new(k as f64 / fps, transform)
    };
    let motions = bodies.ok()?.into_iter().map(|poses| Motion {
        interpolation: Interpolation::Smooth,
        turning: Turning::Shortest,
        keyframes: poses.into_iter().enumerate().map(keyframe).collect(),
    });
    Some(motions.collect())
}

//! Checks and resolves handles, motions and transforms.

use super::super::check::At;
use super::super::data::Handle;
use super::super::format::{ClothRef, HandleFile, Select};
use super::super::limits::{MAX_FACTOR, MAX_SPEED_M_PER_S, MAX_STIFFNESS, MAX_TIME_S};
use super::super::motion::{Interpolation, Motion, Transform, Velocity};
use super::super::typed::suggestion;

/// Checks all handles and finds their cloths among `names`.
pub(super) fn resolve(
    handles: Vec<HandleFile>,
    names: &[String],
    at: &At<'_>,
) -> Option<Vec<Handle>> {
    let resolved: Vec<Option<Handle>> = handles
        .into_iter()
        .enumerate()
        .map(|(i, handle)| resolve_one(handle, names, &at.index(i)))
        .collect();
    resolved.into_iter().collect()
}

fn resolve_one(handle: HandleFile, names: &[String], at: &At<'_>) -> Option<Handle> {
    check_select(&handle.select, &at.key("select"));
    if let Some(motion) = &handle.motion {
        check_motion(motion, 0.0, &at.key("motion"));
        if motion.at(handle.start_s).scaling() < 1.0 / MAX_FACTOR {
            at.key("motion").complain("its scale is 0 when the handle takes hold");
        }
    }
    check_times(handle.start_s, handle.end_s, at);
    at.key("fade_s").not_negative(handle.fade_s, MAX_TIME_S, "s");
    if handle.fade_s > 0.0 && (handle.stiffness_n_per_m.is_none() || handle.end_s.is_none()) {
        at.key("fade_s")
            .complain("only springs with an end fade: give `stiffness_n_per_m`, `end_s`");
    }
    if let Some(stiffness) = handle.stiffness_n_per_m {
        at.key("stiffness_n_per_m").positive(stiffness, MAX_STIFFNESS, "N/m");
    }
    Some(Handle {
        cloth: find_cloth(&handle.cloth, names, &at.key("cloth"))?,
        select: handle.select,
        motion: handle.motion,
        start_s: handle.start_s,
        end_s: handle.end_s.unwrap_or(f64::INFINITY),
        fade_s: handle.fade_s,
        stiffness_n_per_m: handle.stiffness_n_per_m,
    })
}

fn find_cloth(cloth: &ClothRef, names: &[String], at: &At<'_>) -> Option<usize> {
    match cloth {
        ClothRef::Index(index) => {
            let index = *index as usize;
            if index >= names.len() {
                at.complain(format!("there is no cloth {index}, the scene has {}", names.len()));
            }
            (index < names.len()).then_some(index)
        }
        ClothRef::Name(name) => {
            let found = names.iter().position(|other| other == name);
            if found.is_none() {
                at.complain(format!("there is no cloth `{name}`{}", suggestion(name, names)));
            }
            found
        }
    }
}

fn check_select(select: &Select, at: &At<'_>) {
    let empty = match select {
        Select::Vertices(list) => list.is_empty(),
        Select::Corners(list) => list.is_empty(),
        Select::Sides(list) => list.is_empty(),
        Select::Borders(list) | Select::Panels(list) => list.is_empty(),
        Select::Box(area) => {
            at.key("box.min").coordinates(&area.min);
            at.key("box.max").coordinates(&area.max);
            for (i, axis) in ["u", "v"].into_iter().enumerate() {
                let (min, max) = (area.min[i], area.max[i]);
                if min > max {
                    at.key("box").complain(format!("{axis}: min {min} is above max {max}"));
                }
            }
            false
        }
        Select::Boundary | Select::All => false,
    };
    if empty {
        at.complain("selects no vertex");
    }
}

/// Checks the start and the end of what comes and goes.
pub(super) fn check_times(start_s: f64, end_s: Option<f64>, at: &At<'_>) {
    at.key("start_s").not_negative(start_s, MAX_TIME_S, "s");
    if let Some(end_s) = end_s {
        at.key("end_s").not_negative(end_s, MAX_TIME_S, "s");
        if end_s <= start_s {
            at.key("end_s").complain(format!("{end_s} s is not after the start at {start_s} s"));
        }
    }
}

/// Checks a motion, whose scales may be as small as usual or `least`.
pub(super) fn check_motion(motion: &Motion, least: f64, at: &At<'_>) {
    let keyframes = at.key("keyframes");
    if motion.keyframes.is_empty() {
        keyframes.complain("a motion needs at least one keyframe");
    }
    for (i, key) in motion.keyframes.iter().enumerate() {
        let at = keyframes.index(i);
        at.key("time_s").bounded(key.time_s, MAX_TIME_S, "s");
        let transform = at.key("transform");
        if key.transform.scale != least {
            transform.key("scale").factor(key.transform.scale);
        }
        check_place(&key.transform, &transform);
        if let Some(Velocity { translate, scale }) = key.velocity {
            let velocity = at.key("velocity");
            if motion.interpolation == Interpolation::Linear {
                velocity.complain("a linear motion has its velocity from its keyframes alone");
            }
            velocity.key("translate").vector(&translate, MAX_SPEED_M_PER_S, "m/s");
            velocity.key("scale").bounded(scale, MAX_FACTOR, "1/s");
        }
        if let Some(before) = i.checked_sub(1).map(|i| motion.keyframes[i].time_s)
            && key.time_s <= before
        {
            let message = format!("{} s is not after the keyframe before, {before} s", key.time_s);
            at.key("time_s").complain(message);
        }
    }
}

pub(super) fn check_transform(transform: &Transform, at: &At<'_>) {
    at.key("scale").factor(transform.scale);
    check_place(transform, at);
}

/// Checks all of a transform but its scale.
fn check_place(transform: &Transform, at: &At<'_>) {
    at.key("translate").coordinates(&transform.translate);
    if let Some(rotate) = &transform.rotate {
        let axis = at.key("rotate.axis");
        axis.coordinates(&rotate.axis);
        at.key("rotate.degrees").bounded(rotate.degrees, MAX_FACTOR, "degrees");
        if rotate.degrees != 0.0 && rotate.axis.iter().all(|a| a.abs() < 1e-9) {
            axis.complain("is zero, so it has no direction");
        }
    }
}

//! Cameras over time: keyframes, shots, cuts, and a guess where nothing is prescribed.

use crate::camera::Camera;
use crate::error::{ViewError, check};

/// Times nearer to each other than this are the same (s), so that rounding in multiples of a frame
/// does not put a frame on the wrong side of a cut.
pub(crate) const SAME_TIME: f64 = 1e-9;

/// A camera at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Key {
    /// Time (s).
    pub time: f64,
    /// The camera at that time.
    pub camera: Camera,
}

/// What one camera sees until the next cut.
#[derive(Clone, Debug, PartialEq)]
pub struct Shot {
    /// Time of the cut to this shot (s). The first shot of a path also shows what comes before.
    pub start: f64,
    /// Cameras at increasing times. Between two of them position, focal length (in picture heights)
    /// and rotation change at constant rate, rotation by the shorter way; the resolution and the
    /// nearest depth stay those of the earlier. Before the first and after the last nothing moves.
    pub keys: Vec<Key>,
}

impl Shot {
    /// The camera at a time (s).
    fn at(&self, time: f64) -> Camera {
        let next = self.keys.partition_point(|key| key.time <= time);
        match (next.checked_sub(1).map(|i| self.keys[i]), self.keys.get(next)) {
            (Some(a), Some(b)) => a.camera.towards(&b.camera, (time - a.time) / (b.time - a.time)),
            (Some(only), None) => only.camera,
            (None, _) => self.keys[0].camera,
        }
    }
}

/// A prescribed camera: shots with cuts between them.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraPath {
    shots: Vec<Shot>,
}

impl CameraPath {
    /// A path of shots in the order of their starts.
    ///
    /// # Errors
    /// If there is no shot or one without a camera, or if times are not finite and increasing by
    /// more than a nanosecond.
    pub fn new(shots: Vec<Shot>) -> Result<CameraPath, ViewError> {
        if shots.is_empty() {
            return Err(ViewError::Empty { shot: 0 });
        }
        for (i, shot) in shots.iter().enumerate() {
            if shot.keys.is_empty() {
                return Err(ViewError::Empty { shot: i });
            }
            let times = shot.keys.iter().map(|key| key.time);
            for time in times.clone().chain([shot.start]) {
                check("a time of the camera path", time, "finite (s)", f64::is_finite)?;
            }
            let starts = i.checked_sub(1).map(|before| [shots[before].start, shot.start]);
            let steps = times.clone().zip(times.skip(1)).map(|(a, b)| [a, b]).chain(starts);
            for [previous, time] in steps {
                if time - previous <= SAME_TIME {
                    return Err(ViewError::Order { shot: i, previous, time });
                }
            }
        }
        Ok(CameraPath { shots })
    }

    /// A camera that never moves.
    pub fn still(camera: Camera) -> CameraPath {
        CameraPath { shots: vec![Shot { start: 0.0, keys: vec![Key { time: 0.0, camera }] }] }
    }

    /// A guess for the time until `horizon` after `now` (s) where no path is prescribed: the camera
    /// goes on as it did from `before` to `now`, in its position and its rotation at constant rates.
    /// The focal length stays. Make a new one every frame.
    ///
    /// # Errors
    /// If the times do not increase, a number is not finite, or the horizon is more than a thousand
    /// times as far as the two cameras are apart in time.
    pub fn predicted(before: Key, now: Key, horizon: f64) -> Result<CameraPath, ViewError> {
        let step = now.time - before.time;
        check("the time between two cameras", step, "above 1e-9 and finite (s)", |step| {
            step > SAME_TIME && step.is_finite()
        })?;
        check("the horizon", horizon / step, "from 0 to 1000 steps", |n| {
            (0.0..=1000.0).contains(&n)
        })?;
        let turn = before.camera.world_from_camera().rotation_to(&now.camera.world_from_camera());
        let shift = now.camera.position() - before.camera.position();
        let mut keys = vec![now];
        // One key per step, so that the shorter way is always the way on.
        while keys.len() as f64 - 1.0 < horizon / step {
            let n = keys.len() as f64;
            let last = keys[keys.len() - 1].camera;
            let camera = Camera::new(
                now.camera.position() + shift * n,
                turn * last.world_from_camera(),
                now.camera.focal_px(),
                now.camera.resolution(),
            )?
            .with_near(now.camera.near())?;
            keys.push(Key { time: now.time + step * n, camera });
        }
        CameraPath::new(vec![Shot { start: now.time, keys }])
    }

    /// What one who does not know the path would make of it at `time` (s): [`Self::predicted`] from the
    /// cameras of this frame and of the last one, `frame` (s) before, until `frames` from now. After a
    /// cut between them, which tells nothing, the camera is taken to stay where it is.
    ///
    /// # Errors
    /// As [`Self::predicted`].
    pub fn foreseen(&self, time: f64, frame: f64, frames: f64) -> Result<CameraPath, ViewError> {
        let key = |time: f64| Key { time, camera: self.at(time) };
        let cuts = self.shots.iter().skip(1).map(|shot| shot.start - SAME_TIME);
        if cuts.into_iter().any(|cut| time - frame < cut && cut <= time) {
            return Ok(CameraPath::still(self.at(time)));
        }
        CameraPath::predicted(key(time - frame), key(time), frames * frame)
    }

    /// The shots.
    pub fn shots(&self) -> &[Shot] {
        &self.shots
    }

    /// The camera at a time (s); at a cut that of the new shot.
    pub fn at(&self, time: f64) -> Camera {
        let next = self.shots.partition_point(|shot| shot.start <= time + SAME_TIME);
        self.shots[next.saturating_sub(1)].at(time)
    }

    /// The cuts strictly between two times: when (s), and the cameras on both sides.
    pub(crate) fn cuts(&self, from: f64, to: f64) -> impl Iterator<Item = (f64, [Camera; 2])> {
        self.shots.windows(2).filter_map(move |pair| {
            let cut = pair[1].start;
            let inside = cut > from + SAME_TIME && cut < to - SAME_TIME;
            inside.then(|| (cut, [pair[0].at(cut), pair[1].at(cut)]))
        })
    }
}

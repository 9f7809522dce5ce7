//! The constants of the view policy.

use crate::error::{ViewError, check};

/// The constants of Koh2014. The defaults are the paper's (§4) where it gives any.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewSettings {
    /// View factor of cloth in the picture that faces away from the camera, from 0 to 1 (1). Right
    /// for closed garments, whose inside is not seen; give 1 for sheets with two visible sides.
    pub v_back: f64,
    /// View factor of cloth far outside of the picture, from 0 to `v_back` and `v_hidden` (1).
    pub v_out: f64,
    /// View factor of cloth in the picture with something in the way, from 0 to 1 (1); counts where
    /// samples have a [`DepthBuffer`](crate::DepthBuffer).
    pub v_hidden: f64,
    /// Distance m from the frustum over which the view factor falls to `v_out` (m).
    pub margin: f64,
    /// Length T of the temporal window in frames, up to 10 000 (1).
    pub window: f64,
    /// ℓ_min: edges are not made shorter than this in the picture; 0 switches the bound off (px).
    pub size_min_px: f64,
    /// No single edit of the mesh moves what shows by more than this; 0 switches the limit off (px).
    pub shift_max_px: f64,
    /// Coarsening makes no edge longer than this, unless the field that is coarsened does (m).
    pub size_max: f64,
    /// Smallest ratio of the two sizes of a coarsened metric, from 0 to 1; best that of the
    /// remesher's settings (1).
    pub aspect_min: f64,
    /// View factors that differ by more than this across an edge are smoothed, §3.3 (1).
    pub silhouette: f64,
}

impl Default for ViewSettings {
    fn default() -> Self {
        ViewSettings {
            v_back: 0.2,
            v_out: 0.01,
            v_hidden: 0.2,
            margin: 0.4,
            window: 5.0,
            size_min_px: 4.0,
            shift_max_px: 1.0,
            size_max: 0.5,
            aspect_min: 0.2,
            silhouette: 0.1,
        }
    }
}

impl ViewSettings {
    /// Checks the numbers.
    ///
    /// # Errors
    /// [`ViewError::OutOfRange`] names the first one out of range.
    pub fn check(&self) -> Result<(), ViewError> {
        let unit = |x: f64| (0.0..=1.0).contains(&x);
        check("v_back", self.v_back, "from 0 to 1", unit)?;
        check("v_hidden", self.v_hidden, "from 0 to 1", unit)?;
        let least = self.v_back.min(self.v_hidden);
        check("v_out", self.v_out, "from 0 to v_back and v_hidden", |x| unit(x) && x <= least)?;
        check("the margin", self.margin, "at least 0 and finite (m)", |x| {
            x >= 0.0 && x.is_finite()
        })?;
        check("the window", self.window, "from 0 to 10 000 frames", |x| {
            (0.0..=10_000.0).contains(&x)
        })?;
        check("size_min_px", self.size_min_px, "at least 0 and finite (px)", |x| {
            x >= 0.0 && x.is_finite()
        })?;
        check("shift_max_px", self.shift_max_px, "at least 0 and finite (px)", |x| {
            x >= 0.0 && x.is_finite()
        })?;
        check("size_max", self.size_max, "above 0 (m)", |x| x > 0.0)?;
        check("aspect_min", self.aspect_min, "from 0 to 1", unit)?;
        check("silhouette", self.silhouette, "at least 0", |x| x >= 0.0)
    }

    /// Koh2014 Eq. (3): the spatially smoothed view factor ṽ of a face with the factor `v_fb` inside
    /// the frustum, at distance `d` from it (m).
    pub fn smoothed(&self, v_fb: f64, d: f64) -> f64 {
        if d >= self.margin {
            // Also inside if there is no margin, where it must not.
            if d > 0.0 { self.v_out } else { v_fb }
        } else {
            v_fb - d / self.margin * (v_fb - self.v_out)
        }
    }
}

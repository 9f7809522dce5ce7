//! What a fluid is made of, and what can be wrong with it.

use nalgebra::Vector3;

/// A box along the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The corner with the smallest coordinates (m).
    pub min: Vector3<f64>,
    /// The corner with the largest coordinates (m).
    pub max: Vector3<f64>,
}

impl Bounds {
    /// The box between two corners (m).
    pub fn new(min: Vector3<f64>, max: Vector3<f64>) -> Self {
        Bounds { min, max }
    }

    /// True for points within, borders included.
    pub fn contains(&self, x: &Vector3<f64>) -> bool {
        (0..3).all(|k| self.min[k] <= x[k] && x[k] <= self.max[k])
    }

    /// The box with `margin` (m) more room on every side.
    pub fn grown(&self, margin: f64) -> Self {
        let margin = Vector3::repeat(margin);
        Bounds { min: self.min - margin, max: self.max + margin }
    }

    /// Edge lengths (m).
    pub fn size(&self) -> Vector3<f64> {
        self.max - self.min
    }
}

/// Properties of a fluid and limits of its simulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FluidSettings {
    /// Distance of neighbouring particles at rest (m).
    pub spacing: f64,
    /// Density at rest (kg/m³).
    pub rest_density: f64,
    /// Speed of sound c_s (m/s). Density varies by about (v/c_s)², so take ten times the fastest flow.
    pub sound_speed: f64,
    /// Artificial viscosity α between particles, Manteaux2013 Eq. (6) (1).
    pub viscosity: f64,
    /// The same between particles and walls (1).
    pub wall_viscosity: f64,
    /// Acceleration of gravity (m/s²).
    pub gravity: Vector3<f64>,
    /// Where particles may be; one that leaves it makes the step fail (m).
    pub domain: Bounds,
    /// How much farther than the support neighbours are listed, in spacings (1). Changes the speed only.
    pub skin: f64,
    /// Courant number: part of the time of sound through a smoothing length that a step may take (1).
    pub courant: f64,
}

impl FluidSettings {
    /// Water of this particle spacing (m) that falls or stands by at most `height` (m) within `domain`:
    /// sound is ten times as fast as water after such a fall.
    pub fn water(spacing: f64, height: f64, domain: Bounds) -> Self {
        let gravity = Vector3::new(0.0, 0.0, -9.81);
        FluidSettings {
            spacing,
            rest_density: 1000.0,
            sound_speed: 10.0 * (2.0 * 9.81 * height).sqrt(),
            viscosity: 0.1,
            wall_viscosity: 0.02,
            gravity,
            domain,
            skin: 0.3,
            courant: 0.4,
        }
    }

    /// Looks for values out of range.
    ///
    /// # Errors
    /// The first of them.
    pub fn check(&self) -> Result<(), FluidError> {
        let positive = |name, value: f64| match value.is_finite() && value > 0.0 {
            true => Ok(()),
            false => Err(FluidError::OutOfRange { name, value, wanted: "positive and finite" }),
        };
        let not_negative = |name, value: f64| match value.is_finite() && value >= 0.0 {
            true => Ok(()),
            false => Err(FluidError::OutOfRange { name, value, wanted: "0 or more and finite" }),
        };
        positive("spacing", self.spacing)?;
        positive("rest_density", self.rest_density)?;
        positive("sound_speed", self.sound_speed)?;
        not_negative("viscosity", self.viscosity)?;
        not_negative("wall_viscosity", self.wall_viscosity)?;
        not_negative("gravity", self.gravity.norm())?;
        not_negative("skin", self.skin)?;
        positive("courant", self.courant)?;
        if self.courant > 1.0 {
            let (value, wanted) = (self.courant, "at most 1");
            return Err(FluidError::OutOfRange { name: "courant", value, wanted });
        }
        let size = self.domain.size();
        for k in 0..3 {
            positive("size of domain", size[k])?;
            if size[k] / self.spacing > f64::from(MOST_CELLS) {
                let wanted = "at most two million spacings";
                return Err(FluidError::OutOfRange {
                    name: "size of domain",
                    value: size[k],
                    wanted,
                });
            }
        }
        Ok(())
    }
}

/// Longest domain in spacings. Distances within a cell keep more than nine digits.
const MOST_CELLS: u32 = 1 << 21;

/// Why a fluid could not be made or could not go on. The fluid is as it was before the call.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FluidError {
    /// A setting has no sense.
    #[error("{name} is {value}; it must be {wanted}")]
    OutOfRange {
        /// Name of the setting.
        name: &'static str,
        /// Its value, in SI units.
        value: f64,
        /// What it has to be.
        wanted: &'static str,
    },
    /// Two lists that belong together differ in length.
    #[error("there are {found} {what}, but {expected} particles")]
    Length {
        /// What the list is of.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The length it needs.
        expected: usize,
    },
    /// A triangle has a corner that does not exist.
    #[error("triangle {triangle} of a wall has corner {corner}, but there are {n_corners} corners")]
    Corner {
        /// Number of the triangle.
        triangle: usize,
        /// The corner it names.
        corner: u32,
        /// How many there are.
        n_corners: usize,
    },
    /// A particle is not in the domain, or its position or velocity is not a number.
    #[error("particle {id} is at ({x}, {y}, {z}) m with {speed} m/s, outside of the domain")]
    Escaped {
        /// Lasting number of the particle.
        id: u64,
        /// Position (m).
        x: f64,
        /// Position (m).
        y: f64,
        /// Position (m).
        z: f64,
        /// Speed (m/s).
        speed: f64,
    },
    /// The step is longer than what stays stable.
    #[error("a step of {step} s is longer than the bound of {bound} s for this state")]
    StepTooLong {
        /// Step that was asked for (s).
        step: f64,
        /// Longest stable one (s).
        bound: f64,
    },
    /// More particles than 32-bit numbers can tell apart.
    #[error("{n} particles are too many")]
    TooMany {
        /// How many.
        n: usize,
    },
}

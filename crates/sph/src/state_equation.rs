//! The equation of Tait: pressure as a function of density (Becker2007 Eq. (7)).

use crate::lanes::Number;

/// Tait's equation with exponent 7: p(ρ) = (c² ρ₀ / 7) [(ρ/ρ₀)⁷ − 1], without tension.
///
/// Below the rest density the pressure is zero, so that a free surface does not clump.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tait {
    rest_density: f64,
    inverse_rest_density: f64,
    stiffness: f64,
}

impl Tait {
    /// Fluid of a rest density (kg/m³) in which sound travels at `sound_speed` (m/s).
    pub fn new(rest_density: f64, sound_speed: f64) -> Self {
        let stiffness = rest_density * sound_speed * sound_speed / 7.0;
        Tait { rest_density, inverse_rest_density: 1.0 / rest_density, stiffness }
    }

    /// Pressure at a density (kg/m³), in Pa.
    #[inline(always)]
    pub fn pressure(&self, density: f64) -> f64 {
        let ratio = density * self.inverse_rest_density;
        let cube = ratio * ratio * ratio;
        (self.stiffness * (cube * cube * ratio - 1.0)).at_least(0.0)
    }

    /// Energy of compression per mass at a density (kg/m³), in J/kg: its derivative by the density
    /// is p/ρ².
    pub fn energy(&self, density: f64) -> f64 {
        let ratio = (density * self.inverse_rest_density).max(1.0);
        let per_volume = self.stiffness * (ratio.powi(6) / 6.0 + 1.0 / ratio - 7.0 / 6.0);
        per_volume / self.rest_density
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pressure_is_the_derivative_of_the_energy() {
        let tait = Tait::new(1000.0, 40.0);
        for k in 0..50 {
            let density = 990.0 + 4.0 * f64::from(k);
            let d = 1e-3;
            let slope = (tait.energy(density + d) - tait.energy(density - d)) / (2.0 * d);
            let p = tait.pressure(density);
            assert!((slope * density * density - p).abs() < 1e-6 * 1.6e6, "{p} at {density}");
        }
        assert_eq!(tait.pressure(999.0), 0.0);
        assert_eq!(tait.energy(999.0), 0.0);
    }

    #[test]
    fn sound_travels_at_its_speed() {
        let tait = Tait::new(1000.0, 40.0);
        let slope = (tait.pressure(1000.2) - tait.pressure(1000.1)) / 0.1;
        assert!((slope.sqrt() - 40.0).abs() < 0.05);
    }
}

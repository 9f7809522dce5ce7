//! What two particles do to each other: pressure and artificial viscosity.

use crate::grid::Point;
use crate::kernel::CubicSpline;
use crate::settings::FluidSettings;
use crate::state_equation::Tait;
use crate::walls;

/// The constants of a fluid's forces.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Laws {
    pub(crate) kernel: CubicSpline,
    pub(crate) tait: Tait,
    /// Mass of a particle (kg): a lattice at the spacing has the rest density.
    pub(crate) mass: f64,
    /// Factor of the volumes of wall particles, see [`walls::lattice_sums`].
    pub(crate) wall_factor: f64,
    rest_density: f64,
    /// 2 α h c_s of Manteaux2013 Eq. (6), between particles and with walls.
    viscous: f64,
    wall_viscous: f64,
    /// ε h² of Eq. (6), ε = 0.01.
    softening: f64,
}

/// One of two particles: position, effective velocity, P = p/ρ² and ρ.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Side {
    pub(crate) x: [f64; 3],
    pub(crate) w: [f64; 3],
    pub(crate) pressure_term: f64,
    pub(crate) density: f64,
}

impl Side {
    /// From a position that carries P and an effective velocity that carries ρ.
    #[inline(always)]
    pub(crate) fn new(x: &Point, w: &Point) -> Self {
        Side {
            x: [x[0], x[1], x[2]],
            w: [w[0], w[1], w[2]],
            pressure_term: x[3],
            density: w[3],
        }
    }
}

impl Laws {
    pub(crate) fn new(settings: &FluidSettings) -> Self {
        let h = settings.spacing;
        let kernel = CubicSpline::new(h);
        let (everywhere, plate) = walls::lattice_sums(&kernel, settings.spacing);
        Laws {
            kernel,
            tait: Tait::new(settings.rest_density, settings.sound_speed),
            mass: settings.rest_density / everywhere,
            wall_factor: plate / everywhere,
            rest_density: settings.rest_density,
            viscous: 2.0 * settings.viscosity * h * settings.sound_speed,
            wall_viscous: 2.0 * settings.wall_viscosity * h * settings.sound_speed,
            softening: 0.01 * h * h,
        }
    }

    /// P = p/ρ² at a density (kg/m³).
    #[inline(always)]
    pub(crate) fn pressure_term(&self, density: f64) -> f64 {
        self.tait.pressure(density) / (density * density)
    }

    /// The acceleration of `here` by `there` (m/s²), Manteaux2013 Eq. (5), (6) with the pressure of
    /// Becker2007 Eq. (6), where F = `slope` (1/m⁵). Swapping the two gives exactly the opposite.
    #[inline(always)]
    pub(crate) fn between(&self, here: &Side, there: &Side, slope: f64) -> [f64; 3] {
        let d = [here.x[0] - there.x[0], here.x[1] - there.x[1], here.x[2] - there.x[2]];
        let v = [here.w[0] - there.w[0], here.w[1] - there.w[1], here.w[2] - there.w[2]];
        let r_squared = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        let closing = v[0] * d[0] + v[1] * d[1] + v[2] * d[2];
        let closing = if closing < 0.0 { closing } else { 0.0 };
        let drag = closing / ((r_squared + self.softening) * (here.density + there.density));
        let pressure = here.pressure_term + there.pressure_term;
        let s = (self.viscous * drag - pressure) * (self.mass * slope);
        [s * d[0], s * d[1], s * d[2]]
    }

    /// The acceleration of `here` by a wall particle (m/s²): it has the pressure of the particle that
    /// it touches (Akinci2012 Eq. (9)) and the rest density.
    #[inline(always)]
    pub(crate) fn by_wall(&self, here: &Side, wall: &Point, slope: f64) -> [f64; 3] {
        let d = [here.x[0] - wall[0], here.x[1] - wall[1], here.x[2] - wall[2]];
        let v = here.w;
        let r_squared = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        let closing = v[0] * d[0] + v[1] * d[1] + v[2] * d[2];
        let closing = if closing < 0.0 { closing } else { 0.0 };
        let drag = closing / ((r_squared + self.softening) * (here.density + self.rest_density));
        let s = (self.wall_viscous * drag - here.pressure_term) * (wall[3] * slope);
        [s * d[0], s * d[1], s * d[2]]
    }
}

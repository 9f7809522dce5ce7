//! What two particles do to each other: pressure and artificial viscosity.

use crate::grid::Point;
use crate::kernel::CubicSpline;
use crate::lanes::{Four, LANES, Number};
use crate::settings::FluidSettings;
use crate::sheets::Surface;
use crate::state_equation::Tait;
use crate::walls;
use pulp::Simd;

/// The constants of a fluid's forces.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Laws {
    pub(crate) kernel: CubicSpline,
    pub(crate) tait: Tait,
    /// Mass of a particle (kg): a lattice at the spacing has the rest density.
    pub(crate) mass: f64,
    /// Factor of the volumes of wall particles, see [`walls::lattice_sums`].
    pub(crate) wall_factor: f64,
    /// What moving surfaces add to densities.
    pub(crate) surface: Surface,
    /// 2 α h c_s of Manteaux2013 Eq. (6), between particles and with walls.
    viscous: f64,
    wall_viscous: f64,
    /// ε h² of Eq. (6), ε = 0.01.
    softening: f64,
}

/// One of two particles, or of four pairs at once: position, effective velocity, P = p/ρ² and ρ.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Side<N> {
    pub(crate) x: [N; 3],
    pub(crate) w: [N; 3],
    pub(crate) pressure_term: N,
    pub(crate) density: N,
}

impl Side<f64> {
    /// From a position that carries P and an effective velocity that carries ρ.
    #[inline(always)]
    pub(crate) fn new(x: &Point, w: &Point) -> Self {
        Side { x: [x[0], x[1], x[2]], w: [w[0], w[1], w[2]], pressure_term: x[3], density: w[3] }
    }
}

impl<S: Simd> Side<Four<S>> {
    /// Four times the same particle.
    #[inline(always)]
    pub(crate) fn splat(simd: S, x: &Point, w: &Point) -> Self {
        let splat = |number: f64| Four::splat(simd, number);
        Side {
            x: [splat(x[0]), splat(x[1]), splat(x[2])],
            w: [splat(w[0]), splat(w[1]), splat(w[2])],
            pressure_term: splat(x[3]),
            density: splat(w[3]),
        }
    }

    /// Four particles.
    #[inline(always)]
    pub(crate) fn gather(simd: S, x: [&Point; LANES], w: [&Point; LANES]) -> Self {
        let [x0, x1, x2, x3] = transpose(simd, x);
        let [w0, w1, w2, w3] = transpose(simd, w);
        Side { x: [x0, x1, x2], w: [w0, w1, w2], pressure_term: x3, density: w3 }
    }
}

/// The first numbers of four points, the second ones, and so on.
#[inline(always)]
pub(crate) fn transpose<S: Simd>(simd: S, p: [&Point; LANES]) -> [Four<S>; 4] {
    let row = |k: usize| Four::new(simd, [p[0][k], p[1][k], p[2][k], p[3][k]]);
    [row(0), row(1), row(2), row(3)]
}

impl Laws {
    pub(crate) fn new(settings: &FluidSettings) -> Self {
        let h = settings.spacing;
        let kernel = CubicSpline::new(h);
        let (everywhere, plate) = walls::lattice_sums(&kernel, settings.spacing);
        // What lies behind a layer is half of all but that layer.
        let layer = walls::layer_sum(&kernel, settings.spacing);
        let missing = 0.5 * (1.0 - layer / everywhere);
        Laws {
            kernel,
            tait: Tait::new(settings.rest_density, settings.sound_speed),
            mass: settings.rest_density / everywhere,
            wall_factor: plate / everywhere,
            surface: Surface::new(missing, settings.spacing, settings.rest_density),
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
    pub(crate) fn between<N: Number>(&self, here: &Side<N>, there: &Side<N>, slope: N) -> [N; 3] {
        let d = difference(&here.x, &there.x);
        let v = difference(&here.w, &there.w);
        let drag = self.drag(&d, &v, here.density + there.density) * self.viscous;
        let s = (drag - (here.pressure_term + there.pressure_term)) * (slope * self.mass);
        [s * d[0], s * d[1], s * d[2]]
    }

    /// The part of [`Laws::between`] by a sum Pᵢ + Pⱼ = `terms`, for particles at `x` and `y` (m).
    #[inline(always)]
    pub(crate) fn by_pressure<N: Number>(
        &self,
        x: &[N; 3],
        y: &[N; 3],
        terms: N,
        slope: N,
    ) -> [N; 3] {
        let d = difference(x, y);
        let s = terms * (slope * -self.mass);
        [s * d[0], s * d[1], s * d[2]]
    }

    /// The acceleration of `here` by wall particles (m/s²) at `x`, with a pressure P = `term` of their
    /// own and the masses `mass` (kg). For the drag they have the density of the particle they brake.
    ///
    /// A wall that mirrors the pressure of the particle that it touches drives a basin at rest to 0.1 m/s
    /// and more, for ever; one without pressure (Akinci2012 Eq. (9)) is conservative, but the lowest
    /// layer is pressed together twice as much as it should be. With pressures by density on both sides
    /// (Crespo2007) there is an energy and neither happens.
    #[inline(always)]
    pub(crate) fn by_wall<N: Number>(
        &self,
        here: &Side<N>,
        x: &[N; 3],
        term: N,
        mass: N,
        slope: N,
    ) -> [N; 3] {
        let d = difference(&here.x, x);
        let drag = self.drag(&d, &here.w, here.density + here.density) * self.wall_viscous;
        let s = (drag - (here.pressure_term + term)) * (slope * mass);
        [s * d[0], s * d[1], s * d[2]]
    }

    /// The acceleration by a moving surface (m/s²), away from it, of a particle with P = `term` and this
    /// density (kg/m³) at a distance (m), which grows at the rate `opening` (m/s).
    pub(crate) fn by_surface(&self, term: f64, density: f64, distance: f64, opening: f64) -> f64 {
        let (d, v) = ([distance, 0.0, 0.0], [opening, 0.0, 0.0]);
        let drag = self.drag(&d, &v, density + density) * self.wall_viscous;
        (term - drag) * self.surface.slope(distance)
    }

    /// v·d / ((d² + ε h²) (ρᵢ + ρⱼ)) where particles approach each other, else 0.
    #[inline(always)]
    fn drag<N: Number>(&self, d: &[N; 3], v: &[N; 3], densities: N) -> N {
        let r_squared = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        let approach = v[0] * d[0] + v[1] * d[1] + v[2] * d[2];
        approach.at_most(0.0) / ((r_squared + self.softening) * densities)
    }
}

#[inline(always)]
fn difference<N: Number>(a: &[N; 3], b: &[N; 3]) -> [N; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

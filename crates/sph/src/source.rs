//! Where particles come from and where they go.

use crate::settings::{Bounds, FluidError};
use nalgebra::Vector3;

/// A nozzle that lets layers of particles out at a constant speed.
#[derive(Clone, Debug, PartialEq)]
pub struct Emitter {
    centre: Vector3<f64>,
    direction: Vector3<f64>,
    sides: [Vector3<f64>; 2],
    half_size: [f64; 2],
    speed: f64,
    /// When the first layer leaves, and until when (s).
    from: f64,
    until: f64,
    /// Layers that have left.
    pub(crate) n_layers: u64,
}

impl Emitter {
    /// A rectangular nozzle around `centre` (m) that sends fluid along `direction` with `speed` (m/s).
    /// `half_size` (m) are half its edge lengths; the first lies as level as the direction allows.
    ///
    /// # Errors
    /// If the direction has no length or a number is not positive and finite.
    pub fn new(
        centre: Vector3<f64>,
        direction: Vector3<f64>,
        half_size: [f64; 2],
        speed: f64,
    ) -> Result<Self, FluidError> {
        let positive = |name, value: f64| match value.is_finite() && value > 0.0 {
            true => Ok(()),
            false => Err(FluidError::OutOfRange { name, value, wanted: "positive and finite" }),
        };
        positive("length of an emitter's direction", direction.norm())?;
        positive("half size of an emitter", half_size[0])?;
        positive("half size of an emitter", half_size[1])?;
        positive("speed of an emitter", speed)?;
        if !centre.norm().is_finite() {
            let (name, value) = ("centre of an emitter", centre.norm());
            return Err(FluidError::OutOfRange { name, value, wanted: "finite" });
        }
        let direction = direction.normalize();
        let level = Vector3::z().cross(&direction);
        let first = if level.norm() > 1e-9 { level.normalize() } else { Vector3::x() };
        let sides = [first, direction.cross(&first)];
        let (from, until) = (0.0, f64::INFINITY);
        Ok(Emitter { centre, direction, sides, half_size, speed, from, until, n_layers: 0 })
    }

    /// The same nozzle, open only from one time to another (s).
    pub fn open(self, from: f64, until: f64) -> Self {
        Emitter { from, until, ..self }
    }

    /// The corner farthest from the centre along each axis, as a box (m).
    pub(crate) fn bounds(&self) -> Bounds {
        let reach = (0..2).map(|k| self.sides[k].abs() * self.half_size[k]).sum::<Vector3<f64>>();
        Bounds::new(self.centre - reach, self.centre + reach)
    }

    /// When the next layer leaves (s).
    fn leaves(&self, spacing: f64) -> f64 {
        self.from + self.n_layers as f64 * (spacing / self.speed)
    }

    /// True if a layer has left by a time (s) and has not been let out yet.
    pub(crate) fn is_due(&self, time: f64, spacing: f64) -> bool {
        let leaves = self.leaves(spacing);
        leaves <= time && leaves <= self.until
    }

    /// Hands the particles that have left up to a time (s) to `push`: positions (m), velocities (m/s).
    pub(crate) fn emit(
        &mut self,
        time: f64,
        spacing: f64,
        mut push: impl FnMut(Vector3<f64>, Vector3<f64>),
    ) {
        let n = self.half_size.map(|half| ((2.0 * half / spacing + 1e-9).floor() as i64).max(1));
        let velocity = self.direction * self.speed;
        while self.is_due(time, spacing) {
            let middle = self.centre + velocity * (time - self.leaves(spacing));
            for i in 0..n[0] {
                for j in 0..n[1] {
                    let at = |i: i64, n: i64| (i as f64 - 0.5 * (n - 1) as f64) * spacing;
                    push(
                        middle + self.sides[0] * at(i, n[0]) + self.sides[1] * at(j, n[1]),
                        velocity,
                    );
                }
            }
            self.n_layers += 1;
        }
    }
}

/// A box in which particles vanish.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sink(
    /// The box (m).
    pub Bounds,
);

impl Sink {
    /// True for a particle that vanishes.
    pub(crate) fn swallows(&self, x: &Vector3<f64>) -> bool {
        self.0.contains(x)
    }
}

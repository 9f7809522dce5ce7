//! The physical sizing field: curvature, velocity gradient, compression and obstacle proximity.

use crate::context::SizingContext;
use crate::field::SizingField;
use crate::metric::Metric;
use crate::settings::RemeshError;
use mesh_core::{TriangleId, World3};

/// The sizing field of Narain2012 §4.1. Each criterion asks that some quantity changes little along
/// an edge; an infinite bound switches it off. The criteria are clamped to the sizes and
/// combined by the tensor maximum.
///
/// - *Curvature*: the normal turns by at most `refine_angle` along an edge, SᵀS / angle². S is taken
///   twice, as the triangle's [discrete shape operator](SizingContext::shape_operator) and as the
///   gradient of the vertex normals: the first sees a single sharp fold, the second does not
///   flicker with the diagonals of the mesh.
/// - *Velocity*: v differs by at most `refine_velocity` between the ends, VᵀV / velocity² with V =
///   ∂v/∂u. A rigid rotation counts too, as in the paper.
/// - *Compression*: (I − FᵀF)₊ / compression². A compressed edge wants to buckle out of its line. An
///   edge of material length ℓ squeezed to the chord d has ℓ² − d² = uᵀ(I − FᵀF)u; bent into a
///   shallow arc over that chord it is ℓ ≈ d + 8 h²/(3 d) long with the sagitta h, so h² ≈ (3/16)
///   (ℓ² − d²). With size ≤ 1 the bulge that an edge cannot show stays below (√3/4) compression ≈
///   0.43 compression.
/// - *Obstacles*: the metric in [`SizingContext::obstacle`] as it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhysicalSizing {
    /// Largest turn of the normal along an edge (rad).
    pub refine_angle: f64,
    /// Largest difference of velocity along an edge (m/s).
    pub refine_velocity: f64,
    /// 2.3 times the largest bulge that a compressed edge may hide (m).
    pub refine_compression: f64,
    /// Shortest edge asked for (m).
    pub size_min: f64,
    /// Longest edge allowed (m).
    pub size_max: f64,
    /// Smallest ratio of the two sizes of an anisotropic metric, in (0, 1] (no unit).
    pub aspect_min: f64,
}

impl Default for PhysicalSizing {
    /// For garments and flags of about a metre: the angle as in Narain2012, edges from 10 mm to
    /// 200 mm.
    fn default() -> Self {
        PhysicalSizing {
            refine_angle: 0.3,
            refine_velocity: 0.5,
            refine_compression: 0.005,
            size_min: 0.01,
            size_max: 0.2,
            aspect_min: 0.2,
        }
    }
}

impl PhysicalSizing {
    /// Checks that every bound is positive and the sizes are in order.
    ///
    /// # Errors
    /// [`RemeshError::Setting`] names the first value out of range.
    pub fn check(&self) -> Result<(), RemeshError> {
        let fail = |name, value, range| Err(RemeshError::Setting { name, value, range });
        for (name, value) in [
            ("refine_angle", self.refine_angle),
            ("refine_velocity", self.refine_velocity),
            ("refine_compression", self.refine_compression),
            ("size_min", self.size_min),
        ] {
            if value.is_nan() || value <= 0.0 {
                return fail(name, value, "above 0");
            }
        }
        if !(self.size_max >= self.size_min && self.size_max.is_finite()) {
            return fail("size_max", self.size_max, "finite and not below size_min");
        }
        if !(self.aspect_min > 0.0 && self.aspect_min <= 1.0) {
            return fail("aspect_min", self.aspect_min, "above 0 and up to 1");
        }
        Ok(())
    }
}

impl SizingField for PhysicalSizing {
    fn metric(&self, context: &SizingContext<'_>, at: TriangleId) -> Metric {
        let t = at.index();
        let mesh = &context.cloth.mesh;
        let (corners, u) = (mesh.triangles()[t], &mesh.material()[t]);
        let (p, q) = (u[1] - u[0], u[2] - u[0]);
        let over_det = 1.0 / (p.x * q.y - p.y * q.x);
        // With the material edges E = [p, q] and the differences D of a quantity along them, its
        // gradient is G = D E⁻¹, and GᵀG = E⁻ᵀ (DᵀD) E⁻¹.
        let inverse = [q.y * over_det, -q.x * over_det, -p.y * over_det, p.x * over_det];
        let squared_gradient = |values: &[World3]| {
            let origin = values[corners[0] as usize];
            let (d, e) =
                (values[corners[1] as usize] - origin, values[corners[2] as usize] - origin);
            Metric::new(d.norm_squared(), d.dot(&e), e.norm_squared()).congruent(inverse)
        };
        let [xx, xy, yy] = context.shape_entries(at);
        let shape = Metric::new(xx * xx + xy * xy, xy * (xx + yy), xy * xy + yy * yy);
        let over_square = |bound: f64| 1.0 / (bound * bound);

        let squeeze = Metric::uniform(1.0) + squared_gradient(&context.cloth.x) * -1.0;
        let criteria = [
            shape * over_square(self.refine_angle),
            squared_gradient(context.normals()) * over_square(self.refine_angle),
            squared_gradient(&context.cloth.v) * over_square(self.refine_velocity),
            squeeze * over_square(self.refine_compression),
            context.obstacle.map_or(Metric::ZERO, |obstacle| obstacle[t]),
        ];
        // Clamped one by one: two nearly parallel tensors of rank 1 would add up in the maximum,
        // and the result is clamped to the same bounds anyway, which also takes the positive part.
        let (coarsest, finest) = (over_square(self.size_max), over_square(self.size_min));
        let clamp = |m: Metric| m.clamp_eigenvalues(coarsest, finest, self.aspect_min.powi(2));
        let mut wanted = Metric::uniform(self.size_max);
        for criterion in criteria {
            // Most are below the coarsest in every direction; what is not a number is not.
            let is_below = criterion.bound() <= coarsest;
            if !is_below {
                wanted = wanted.max(clamp(criterion));
            }
        }
        clamp(wanted)
    }
}

//! From the numbers of a scene to the fabric that the forces use.

use super::BuildError;
use crate::fabric::Fabric as Material;
use crate::scene;
use crate::scene::format::BendingModel as SceneBending;
use cloth_dynamics::law::{Bending, Law, MeasuredBending, MeasuredMembrane, Membrane, Quadratic};
use cloth_dynamics::{BendingModel, Damping, Fabric, StrainLimits};

/// The fabric of a cloth that is made of `material`.
pub(super) fn fabric(
    cloth: &scene::Cloth,
    material: &Material,
    warnings: &mut Vec<String>,
) -> Result<Fabric, BuildError> {
    let scale = &cloth.multipliers;
    let bad = |source| BuildError::Fabric { cloth: cloth.name.clone(), source };
    let (density, membrane, bending) = match material {
        Material::Orthotropic(fabric) => {
            let c = fabric.stretching_n_per_m;
            let k = scale.stretching;
            let membrane =
                Quadratic::orthotropic(c.warp * k, c.coupling * k, c.weft * k, c.shear * k)
                    .map_err(bad)?;
            let b = fabric.bending_n_m;
            let [warp, bias, weft] = [b.warp, b.bias, b.weft].map(|b| b * scale.bending);
            let bending = if warp.max(bias).max(weft) > 0.0 {
                Some(Bending::Orthotropic(Quadratic::plate(warp, bias, weft).map_err(bad)?))
            } else {
                None
            };
            (fabric.density_kg_per_m2, Membrane::Orthotropic(membrane), bending)
        }
        Material::Measured(fabric) => {
            let membrane = MeasuredMembrane::new(&fabric.stretching, scale.stretching);
            if membrane.repaired_rows() > 0 {
                warnings.push(format!(
                    "cloth `{}`: {} of 6 measured rows of stretching are not positive \
                     semi-definite and are projected",
                    cloth.name,
                    membrane.repaired_rows()
                ));
            }
            // A file's constants are those of the discrete hinge, whose rigidity is a quarter.
            let bending = MeasuredBending::new(&fabric.bending, 0.25 * scale.bending);
            (fabric.density, Membrane::Measured(membrane), Some(Bending::Measured(bending)))
        }
    };
    if cloth.tension_field && membrane.at_rest().try_inverse().is_none() {
        warnings.push(format!(
            "cloth `{}`: `tension_field` has no effect on a fabric without stiffness in some direction",
            cloth.name
        ));
    }
    Ok(Fabric {
        density: density * scale.density,
        membrane,
        bending,
        bending_model: match cloth.bending {
            SceneBending::Patch => BendingModel::ShapeOperator,
            SceneBending::Hinge => BendingModel::Hinge,
        },
        strain_limits: cloth.strain_limits.map(|[min, max]| StrainLimits {
            // Wrinkles hide what a triangle is shortened by.
            min: if cloth.tension_field { 0.0 } else { min },
            max,
        }),
        tension_field: cloth.tension_field,
        damping: Damping { mass: cloth.damping.mass_per_s, stiffness: cloth.damping.stiffness_s },
    })
}

//! The project's own fabrics.
//!
//! Constants rounded from published measurements of ten fabrics (Wang2011, table of stretching and
//! bending): the median over the measured strains for stretching, the mean over the measured
//! curvatures for bending, the median of the positive values for shear, two figures kept. A real
//! fabric stiffens as it stretches and these do not; use a file with measurements where that
//! matters.

use super::{Bending, OrthotropicFabric, Stretching};
use crate::scene::format::FabricChoice;

/// The numbers of a named fabric; nothing for files and custom numbers.
#[must_use]
pub fn preset(choice: &FabricChoice) -> Option<OrthotropicFabric> {
    // Density (kg/m²); warp, weft, coupling, shear (N/m); warp, weft, bias (1e-6 N·m).
    let (density, stretching, bending) = match choice {
        FabricChoice::WovenLight => (0.13, [2100.0, 2100.0, 45.0, 30.0], [45.0, 25.0, 25.0]),
        FabricChoice::WovenFirm => (0.22, [2100.0, 2100.0, 50.0, 40.0], [190.0, 190.0, 130.0]),
        FabricChoice::Denim => (0.32, [220.0, 1050.0, 40.0, 70.0], [55.0, 100.0, 60.0]),
        FabricChoice::KnitLight => (0.11, [90.0, 300.0, 85.0, 28.0], [20.0, 16.0, 20.0]),
        FabricChoice::KnitInterlock => (0.19, [85.0, 310.0, 80.0, 35.0], [30.0, 16.0, 19.0]),
        FabricChoice::KnitHeavy => (0.28, [95.0, 180.0, 50.0, 35.0], [40.0, 30.0, 30.0]),
        FabricChoice::Swim => (0.20, [50.0, 110.0, 15.0, 35.0], [55.0, 45.0, 50.0]),
        FabricChoice::Measured(_) | FabricChoice::Custom(_) => return None,
    };
    let [warp, weft, coupling, shear] = stretching;
    let [bend_warp, bend_weft, bend_bias] = bending.map(|micro: f64| micro * 1e-6);
    Some(OrthotropicFabric {
        density_kg_per_m2: density,
        stretching_n_per_m: Stretching { warp, weft, coupling, shear },
        bending_n_m: Bending { warp: bend_warp, weft: bend_weft, bias: bend_bias },
    })
}

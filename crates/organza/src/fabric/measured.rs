//! Files with measurements of a fabric, in the form of Wang et al. 2011 that ARCSim reads.

use serde::Deserialize;

use crate::scene::check::Complaints;
use crate::scene::issue::Issue;
use crate::scene::limits;
use crate::scene::read::read_document;

/// A measured fabric, exactly as its file has it. Some tables hold negative entries; laws that
/// use them must project.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeasuredFabric {
    /// Mass per area (kg/m²).
    pub density: f64,
    /// Rows of C₁₁, C₁₂, C₂₂, C₃₃ (N/m): unstretched, then stretched in five directions from warp
    /// to weft.
    pub stretching: [[f64; 4]; 6],
    /// Rows for bending directions 0°, 45°, 90° from the warp, columns for growing curvature
    /// (N·m).
    pub bending: [[f64; 5]; 3],
}

/// Reads the text of such a file. `name` is for messages.
///
/// # Errors
/// All that is wrong, with places in the file.
pub(crate) fn read_measured(name: &str, bytes: &[u8]) -> Result<MeasuredFabric, Vec<Issue>> {
    let document = read_document(name, bytes)?;
    let (mut value, places) = (document.value, document.places);
    let complaints = Complaints::default();
    let mut structure = Vec::new();
    let fabric = crate::scene::typed::read::<MeasuredFabric>(&mut value, &mut structure);
    complaints.extend(structure);
    if let Some(fabric) = &fabric {
        let top = complaints.at_top();
        top.key("density").positive(fabric.density, limits::MAX_DENSITY_KG_PER_M2, "kg/m²");
        for (i, row) in fabric.stretching.iter().enumerate() {
            top.key("stretching").index(i).vector(row, limits::MAX_STIFFNESS, "N/m");
        }
        for (i, row) in fabric.bending.iter().enumerate() {
            top.key("bending").index(i).vector(row, limits::MAX_STIFFNESS, "N·m");
        }
    }
    let issues = places.resolve_some(complaints.into_vec().into_iter());
    match fabric {
        Some(fabric) if issues.is_empty() => Ok(fabric),
        _ => Err(issues),
    }
}

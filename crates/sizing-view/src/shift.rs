//! How far edits of the mesh may move what shows.

use crate::frustum::Frustum;
use crate::screen::projection;
use crate::settings::ViewSettings;
use crate::window::Sample;
use mesh_core::{ClothState, TriangleId, par};
use nalgebra::Matrix3;

/// The metric of displacements in the picture, by vertex, for
/// [`RemeshSettings::shift`](remesh::RemeshSettings::shift) (1/m²): the square of the displacement in
/// pixels over `settings.shift_max_px`, where a triangle at the vertex is visible now; of several cameras
/// the sum. Zero, so without a limit, where none is. Samples with a weight below 1 are those of other
/// times and do not count.
///
/// Empty if `shift_max_px` is 0, which switches the limit off.
pub fn shift_metrics(
    cloth: &ClothState,
    samples: &[Sample],
    settings: &ViewSettings,
) -> Vec<Matrix3<f64>> {
    if settings.shift_max_px == 0.0 {
        return Vec::new();
    }
    let mut metrics = vec![Matrix3::zeros(); cloth.x.len()];
    for sample in samples.iter().filter(|sample| sample.weight >= 1.0) {
        let camera = &sample.camera;
        let frustum = Frustum::new(camera);
        let mut visible = vec![false; cloth.mesh.n_triangles()];
        par::fill(&mut visible, |t| {
            let corners = cloth.corners(TriangleId(t as u32));
            let c = corners.map(|p| frustum.camera_space(p));
            sample.factor(&corners, &c, settings) == 1.0
                && frustum.distance_in_camera(&c, settings.margin) == 0.0
        });
        let mut seen = vec![false; cloth.x.len()];
        for (triangle, _) in cloth.mesh.triangles().iter().zip(&visible).filter(|(_, is)| **is) {
            triangle.iter().for_each(|v| seen[*v as usize] = true);
        }
        par::for_each(&mut metrics, |v, metric| {
            if seen[v] {
                let c = frustum.camera_space(cloth.x[v]);
                let scale = camera.focal_px() / c.z.max(camera.near()) / settings.shift_max_px;
                let p = projection(camera, &c) * frustum.camera_from_world() * scale;
                *metric += p.tr_mul(&p);
            }
        });
    }
    metrics
}

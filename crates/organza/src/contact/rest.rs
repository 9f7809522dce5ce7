//! How far apart the parts of a garment are at rest: what is close there is not in contact for being
//! close.

use mesh_core::{ClothState, Material2};

/// Share of the distance at rest between the nearest vertices of a pair that its thickness may have.
/// In a mesh of triangles whose lowest height is a fifth of their longest edge the pair itself is not
/// much nearer than that: cloth may be compressed and folded before it touches itself across a fold.
const OF_DISTANCE: f64 = 0.25;
/// Share of the lowest height of the triangles around a vertex that its radius may have next to a seam,
/// where distances in material space mean nothing.
const OF_HEIGHT: f64 = 0.2;

/// The cloth at rest.
pub(super) struct RestSheet {
    /// Panel and position of each vertex (m).
    place: Vec<(u32, Material2)>,
    /// Whether a vertex is at a seam or next to one.
    near_seam: Vec<bool>,
    /// Half the most thickness of a vertex near a seam (m); empty without seams.
    radius: Vec<f64>,
}

impl RestSheet {
    pub(super) fn new(cloth: &ClothState) -> RestSheet {
        let mesh = &cloth.mesh;
        let n = mesh.n_vertices();
        let mut place = vec![(u32::MAX, Material2::zeros()); n];
        let mut on_seam = vec![false; n];
        let corners = mesh.triangles().iter().zip(mesh.material()).zip(mesh.panels());
        for ((vertices, material), panel) in corners {
            for (&v, at) in vertices.iter().zip(material) {
                let (v, new) = (v as usize, (*panel, *at));
                on_seam[v] |= place[v].0 != u32::MAX && place[v] != new;
                place[v] = new;
            }
        }
        let mut sheet = RestSheet { place, near_seam: vec![false; n], radius: Vec::new() };
        if on_seam.contains(&true) {
            sheet.radius = vec![f64::INFINITY; n];
            for (t, vertices) in mesh.triangle_ids().zip(mesh.triangles()) {
                let edges = [0, 1, 2].map(|k| mesh.material_edge(t.half_edge(k)).norm());
                let height = 2.0 * mesh.area(t) / edges.into_iter().fold(0.0, f64::max);
                let is_near = vertices.iter().any(|&v| on_seam[v as usize]);
                for v in vertices.map(|v| v as usize) {
                    sheet.radius[v] = sheet.radius[v].min(OF_HEIGHT * height);
                    sheet.near_seam[v] |= is_near;
                }
            }
        }
        sheet
    }

    /// The most thickness that a pair within the cloth may have (m), by its vertices, of which the first
    /// `n_first` belong to the first part.
    pub(super) fn most(&self, vertices: &[u32; 4], n_first: usize) -> f64 {
        let vertices = vertices.map(|v| v as usize);
        if vertices.iter().any(|&v| self.near_seam[v]) {
            let radius = |k: usize| self.radius[vertices[k]];
            let largest = |of: std::ops::Range<usize>| of.map(radius).fold(0.0, f64::max);
            return largest(0..n_first) + largest(n_first..4);
        }
        let at = vertices.map(|v| &self.place[v]);
        if at.iter().any(|(panel, _)| *panel != at[0].0) {
            return f64::INFINITY;
        }
        let mut nearest = f64::INFINITY;
        for (_, a) in &at[..n_first] {
            for (_, b) in &at[n_first..] {
                nearest = nearest.min((a - b).norm_squared());
            }
        }
        OF_DISTANCE * nearest.sqrt()
    }
}

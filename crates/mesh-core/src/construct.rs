//! Building a mesh from an index buffer, and what can be wrong with one.

use crate::geometry::{Material2, signed_area};
use crate::ids::{NONE, VertexId};
use crate::mesh::Mesh;

/// What is wrong with a mesh or with the data it should be built from.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeshError {
    /// There is no triangle.
    #[error("the mesh has no triangles")]
    Empty,
    /// Lists that belong together differ in length.
    #[error("{what}: expected {expected} entries, got {got}")]
    Length {
        /// Which list.
        what: &'static str,
        /// How many it should have.
        expected: usize,
        /// How many it has.
        got: usize,
    },
    /// A triangle names a vertex that does not exist.
    #[error("triangle {triangle} refers to vertex {vertex}, but there are only {n_vertices}")]
    Index {
        /// The triangle.
        triangle: usize,
        /// The index it names.
        vertex: u32,
        /// How many there are.
        n_vertices: usize,
    },
    /// A triangle has the same vertex twice.
    #[error("triangle {triangle} uses vertex {vertex} twice")]
    RepeatedVertex {
        /// The triangle.
        triangle: usize,
        /// The repeated vertex.
        vertex: u32,
    },
    /// A coordinate is not a number.
    #[error("{what} {index} has a coordinate that is not finite")]
    NotFinite {
        /// Vertex, or triangle corner.
        what: &'static str,
        /// Which one.
        index: usize,
    },
    /// A triangle has no positive area in material space.
    #[error("triangle {triangle} has area {area} m² in material space; it must be positive")]
    MaterialArea {
        /// The triangle.
        triangle: usize,
        /// Its signed area (m²).
        area: f64,
    },
    /// More than two triangles at one edge, or two that disagree in orientation.
    #[error(
        "the edge between vertices {a} and {b} is not manifold: triangles {first} and {second} \
         run along it in the same direction"
    )]
    Edge {
        /// One end.
        a: u32,
        /// The other end.
        b: u32,
        /// A triangle at the edge.
        first: usize,
        /// Another one with the same direction.
        second: usize,
    },
    /// Triangles touch in a vertex without sharing an edge there.
    #[error("vertex {vertex} is not manifold: it joins several fans of triangles")]
    Vertex {
        /// The vertex.
        vertex: usize,
    },
    /// A vertex belongs to no triangle.
    #[error("vertex {vertex} belongs to no triangle")]
    Isolated {
        /// The vertex.
        vertex: usize,
    },
    /// A density that is not positive.
    #[error("panel {panel} has the density {density} kg/m²; it must be positive and finite")]
    Density {
        /// The panel.
        panel: usize,
        /// The offending value (kg/m²).
        density: f64,
    },
    /// An invariant of the corner table is broken: a defect of this crate.
    #[error("inconsistent corner table: {0}")]
    Broken(String),
}

impl Mesh {
    /// Builds a mesh of `n_vertices` vertices from counter-clockwise triangles, the material
    /// coordinates of their corners (m) and their panels.
    ///
    /// # Errors
    /// The first defect found: an index out of range, repeated corners, coordinates that are not
    /// finite, triangles without positive material area, and anything that is not an oriented
    /// manifold with boundary.
    pub fn new(
        n_vertices: usize,
        triangles: Vec<[u32; 3]>,
        material: Vec<[Material2; 3]>,
        panels: Vec<u32>,
    ) -> Result<Mesh, MeshError> {
        let n = triangles.len();
        if n == 0 {
            return Err(MeshError::Empty);
        }
        for (what, got) in [("material corners", material.len()), ("panels", panels.len())] {
            if got != n {
                return Err(MeshError::Length { what, expected: n, got });
            }
        }
        for (t, (corners, u)) in triangles.iter().zip(&material).enumerate() {
            check_triangle(t, *corners, u, n_vertices)?;
        }
        let mut mesh = Mesh {
            twin: match_twins(&triangles)?,
            tri: triangles,
            material,
            panel: panels,
            out: vec![NONE; n_vertices],
            uid: (0..n_vertices as u64).collect(),
            next_uid: n_vertices as u64,
            epoch: 0,
        };
        mesh.anchor_all()?;
        Ok(mesh)
    }

    /// A mesh without any vertex or triangle.
    pub fn empty() -> Mesh {
        Mesh {
            twin: Vec::new(),
            tri: Vec::new(),
            material: Vec::new(),
            panel: Vec::new(),
            out: Vec::new(),
            uid: Vec::new(),
            next_uid: 0,
            epoch: 0,
        }
    }

    /// The same mesh with the lasting names it had when it was saved (a checkpoint).
    ///
    /// # Errors
    /// If there is not one name per vertex, or `next_uid` is not above all of them.
    pub fn with_uids(mut self, uids: Vec<u64>, next_uid: u64) -> Result<Mesh, MeshError> {
        if uids.len() != self.n_vertices() {
            return Err(MeshError::Length {
                what: "vertex names",
                expected: self.n_vertices(),
                got: uids.len(),
            });
        }
        self.uid = uids;
        self.next_uid = next_uid;
        self.check_uids()?;
        Ok(self)
    }

    /// Finds each vertex's first outgoing half-edge and makes sure that one fan holds them all.
    fn anchor_all(&mut self) -> Result<(), MeshError> {
        self.normalise();
        let mut degree = vec![0u32; self.n_vertices()];
        for &vertex in self.tri.iter().flatten() {
            degree[vertex as usize] += 1;
        }
        for (vertex, &count) in degree.iter().enumerate() {
            if count == 0 {
                return Err(MeshError::Isolated { vertex });
            }
            let fan = self.outgoing(VertexId(vertex as u32)).take(count as usize + 1).count();
            if fan != count as usize {
                return Err(MeshError::Vertex { vertex });
            }
        }
        Ok(())
    }
}

fn check_triangle(
    t: usize,
    corners: [u32; 3],
    u: &[Material2; 3],
    n_vertices: usize,
) -> Result<(), MeshError> {
    for (k, &vertex) in corners.iter().enumerate() {
        if vertex as usize >= n_vertices {
            return Err(MeshError::Index { triangle: t, vertex, n_vertices });
        }
        if corners[(k + 1) % 3] == vertex {
            return Err(MeshError::RepeatedVertex { triangle: t, vertex });
        }
    }
    if u.iter().any(|p| !p.x.is_finite() || !p.y.is_finite()) {
        return Err(MeshError::NotFinite { what: "material corner of triangle", index: t });
    }
    let area = signed_area(u[0], u[1], u[2]);
    let longest = (u[1] - u[0]).norm_squared().max((u[2] - u[0]).norm_squared());
    // Below this the sign is rounding noise.
    if area.is_nan() || area <= 4.0 * f64::EPSILON * longest {
        return Err(MeshError::MaterialArea { triangle: t, area });
    }
    Ok(())
}

/// Pairs half-edges by sorting their vertex pairs: no hashing, so no order to depend on.
fn match_twins(triangles: &[[u32; 3]]) -> Result<Vec<u32>, MeshError> {
    let mut keys: Vec<(u32, u32, u32, bool)> = Vec::with_capacity(3 * triangles.len());
    for (t, corners) in triangles.iter().enumerate() {
        for k in 0..3 {
            let (a, b) = (corners[k], corners[(k + 1) % 3]);
            keys.push((a.min(b), a.max(b), (3 * t + k) as u32, a < b));
        }
    }
    keys.sort_unstable();
    let mut twin = vec![NONE; keys.len()];
    for group in keys.chunk_by(|x, y| (x.0, x.1) == (y.0, y.1)) {
        let clash = match group {
            [_] => None,
            [x, y] if x.3 != y.3 => {
                twin[x.2 as usize] = y.2;
                twin[y.2 as usize] = x.2;
                None
            }
            [x, rest @ ..] => rest.iter().find(|y| y.3 == x.3).map(|y| (x, y)).or_else(|| {
                // Three or more: two of the others must agree with each other.
                rest.first().zip(rest.get(1))
            }),
            [] => None,
        };
        if let Some((x, y)) = clash {
            return Err(MeshError::Edge {
                a: x.0,
                b: x.1,
                first: x.2 as usize / 3,
                second: y.2 as usize / 3,
            });
        }
    }
    Ok(twin)
}

//! Wavefront OBJ: triangles with positions and texture coordinates, in and out.
//!
//! Reading goes through the library parser `tobj` in f64. A guard in front of it checks what the
//! library lets pass and remembers lines, so that every error names one. Read are `v` (three
//! coordinates; a weight or a colour after them is ignored), `vt` (two coordinates), `f` (polygons
//! are cut into fans, relative indices are resolved) and the names after `g` and `o`. Everything else
//! is ignored: `vn`, `vv`, lines, points, smoothing, materials; `mtllib` is never opened.
//!
//! ```
//! use mesh_core::obj;
//!
//! let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
//! let file = obj::read(text.as_bytes())?;
//! let cloth = file.to_mesh()?;
//! assert_eq!(cloth.mesh.n_triangles(), 2);
//! assert_eq!(cloth.mesh.total_area(), 1.0);
//! # Ok::<(), obj::ObjError>(())
//! ```

mod cloth;
mod error;
mod guard;
mod write;

pub use cloth::ObjCloth;
pub use error::ObjError;
pub use write::write;

use crate::generate::Surface;
use crate::geometry::{Material2, World3};
use guard::{Guarded, guard};

/// Largest coordinate that is read (m): beyond it f64 resolves less than a tenth of a micrometre.
pub const MAX_COORDINATE: f64 = 1e9;

/// What an OBJ file says: positions, triangles and, where it has them, texture coordinates.
///
/// This needs no material space and no manifold: obstacles use it as it is, cloth goes through
/// [`ObjMesh::to_mesh`].
#[derive(Clone, Debug, PartialEq)]
pub struct ObjMesh {
    /// Every `v` in file order, used by a face or not (m).
    pub positions: Vec<World3>,
    /// Vertices of every triangle: indices into `positions`, so file index − 1.
    pub triangles: Vec<[u32; 3]>,
    /// Texture coordinates of every triangle's corners, if the faces have them (m where they are
    /// used as material coordinates) (m).
    pub texture: Option<Vec<[Material2; 3]>>,
    /// Names of the groups that have faces, in order of their first ones: what stands after the last
    /// `g` or `o` before a face, or `default` before any.
    pub groups: Vec<String>,
    /// Group of every face.
    group_of_face: Vec<u32>,
    /// The face each triangle was cut from.
    face_of: Vec<u32>,
    /// The line each face begins on, from 1.
    face_lines: Vec<u32>,
    /// The line of each `v`, from 1.
    vertex_lines: Vec<u32>,
}

impl ObjMesh {
    /// Number of faces in the file: less than the number of triangles if some are polygons.
    pub fn n_faces(&self) -> usize {
        self.face_lines.len()
    }

    /// The face that a triangle was cut from, counted from 0 in file order.
    ///
    /// # Panics
    /// If there is no such triangle.
    pub fn face(&self, triangle: usize) -> usize {
        self.face_of[triangle] as usize
    }

    /// The group that a triangle belongs to, an index into `groups`.
    ///
    /// # Panics
    /// If there is no such triangle.
    pub fn group(&self, triangle: usize) -> usize {
        self.group_of_face[self.face(triangle)] as usize
    }

    /// Makes all groups one.
    pub fn ungroup(&mut self) {
        self.groups.truncate(1);
        self.group_of_face.fill(0);
    }

    /// The line in the file that a triangle comes from, counted from 1.
    ///
    /// # Panics
    /// If there is no such triangle.
    pub fn line(&self, triangle: usize) -> usize {
        self.face_lines[self.face(triangle)] as usize
    }

    /// The line in the file of a vertex, counted from 1.
    ///
    /// # Panics
    /// If there is no such vertex.
    pub fn vertex_line(&self, vertex: usize) -> usize {
        self.vertex_lines[vertex] as usize
    }

    /// The triangles and the vertices they use, without the others: an obstacle.
    pub fn to_surface(&self) -> Surface {
        let (triangles, kept) = self.used_only();
        Surface { positions: kept.iter().map(|&v| self.positions[v as usize]).collect(), triangles }
    }

    /// The triangles renumbered to the vertices in use, and the file index of each of those.
    fn used_only(&self) -> (Vec<[u32; 3]>, Vec<u32>) {
        let mut number = vec![0u32; self.positions.len()];
        self.triangles.iter().flatten().for_each(|&v| number[v as usize] = 1);
        let kept: Vec<u32> =
            (0..number.len() as u32).filter(|&v| number[v as usize] == 1).collect();
        for (new, &old) in kept.iter().enumerate() {
            number[old as usize] = new as u32;
        }
        let renumbered = |t: &[u32; 3]| t.map(|v| number[v as usize]);
        (self.triangles.iter().map(renumbered).collect(), kept)
    }
}

/// Reads the bytes of an OBJ file.
///
/// # Errors
/// Named with their line: garbage in place of a number, coordinates that are not finite or larger
/// than [`MAX_COORDINATE`], too few or too many of them, an index out of range, a face with fewer
/// than three corners or one of which only some have texture coordinates, binary data. Without a
/// line: a file without vertices or without faces.
pub fn read(bytes: &[u8]) -> Result<ObjMesh, ObjError> {
    let guarded = guard(bytes)?;
    let parsed = parse(&guarded)?;
    let positions: Vec<World3> =
        parsed.positions.chunks_exact(3).map(World3::from_row_slice).collect();
    let points: Vec<Material2> =
        parsed.texcoords.chunks_exact(2).map(Material2::from_row_slice).collect();
    check("v", positions.iter().map(|p| p.as_slice()), &guarded.vertex_lines)?;
    check("vt", points.iter().map(|p| p.as_slice()), &guarded.texture_lines)?;

    // Behind the single corners that fixed the numbering come the triangles.
    let corners = 3 * guarded.n_numbering..parsed.indices.len();
    let triangles = parsed.indices[corners.clone()].chunks_exact(3).map(|c| [c[0], c[1], c[2]]);
    let texture = guarded.faces_have_texture.then(|| {
        let corners = parsed.texcoord_indices[corners].chunks_exact(3);
        corners.map(|c| [c[0], c[1], c[2]].map(|i| points[i as usize])).collect()
    });
    Ok(ObjMesh {
        triangles: triangles.collect(),
        positions,
        texture,
        groups: guarded.groups,
        group_of_face: guarded.group_of_face,
        face_of: guarded.face_of,
        face_lines: guarded.face_lines,
        vertex_lines: guarded.vertex_lines,
    })
}

/// Runs the library parser over the guarded text.
fn parse(guarded: &Guarded) -> Result<tobj::Mesh, ObjError> {
    let options = tobj::LoadOptions { triangulate: true, ..Default::default() };
    let mut rest = guarded.text.as_bytes();
    let loaded = tobj::load_obj_buf(&mut rest, &options, |_| Err(tobj::LoadError::OpenFileFailed));
    match loaded {
        Ok((mut models, _)) if models.len() == 1 => Ok(models.swap_remove(0).mesh),
        Ok((models, _)) => Err(ObjError::Parser(format!("{} models", models.len()))),
        Err(error) => {
            // The parser says what, not where; but it stops right behind the line at fault.
            let read = &guarded.text[..guarded.text.len() - rest.len()];
            Err(match (error, guarded.source_line(read)) {
                (
                    tobj::LoadError::PositionParseError | tobj::LoadError::TexcoordParseError,
                    Some(line),
                ) => {
                    let text = read.lines().next_back().unwrap_or_default();
                    ObjError::number(line, text)
                }
                (error, _) => ObjError::Parser(error.to_string()),
            })
        }
    }
}

fn check<'a>(
    keyword: &'static str,
    points: impl Iterator<Item = &'a [f64]>,
    lines: &[u32],
) -> Result<(), ObjError> {
    for (point, &line) in points.zip(lines) {
        if let Some(&value) = point.iter().find(|c| c.is_nan() || c.abs() > MAX_COORDINATE) {
            let line = line as usize;
            return Err(if value.is_finite() {
                ObjError::TooLarge { line, keyword, value }
            } else {
                ObjError::NotFinite { line, keyword, value }
            });
        }
    }
    Ok(())
}

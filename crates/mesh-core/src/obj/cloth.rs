//! From the faces of an OBJ file to a cloth mesh with material space.

use super::{ObjError, ObjMesh};
use crate::construct::MeshError;
use crate::geometry::{Material2, World3};
use crate::ids::VertexId;
use crate::mesh::Mesh;

/// A cloth mesh read from an OBJ file.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjCloth {
    /// Topology and material space; the panels are the [groups](ObjMesh::groups).
    pub mesh: Mesh,
    /// World positions of the vertices (m).
    pub positions: Vec<World3>,
    /// The vertex that each `v` of the file became, by file index − 1; `None` for a vertex that no
    /// face uses. Scenes that name vertices by their place in the file need it.
    pub vertex_of_file: Vec<Option<VertexId>>,
}

impl ObjMesh {
    /// The cloth mesh whose material coordinates (m) are the texture coordinates; a file without
    /// them is taken to lie flat: then x and y of the positions are the material coordinates.
    ///
    /// Texture coordinates count per corner: where the two sides of an edge differ there is a seam.
    /// Vertices are kept apart even where positions agree. Vertices that no face uses are left out
    /// (modelling programs leave such), see [`ObjCloth::vertex_of_file`].
    ///
    /// # Errors
    /// Named with their line: faces without positive area in material space (turned over or
    /// degenerate; a closed surface without texture coordinates always has some), faces that use a
    /// vertex twice, and whatever is not an oriented manifold with boundary.
    pub fn to_mesh(&self) -> Result<ObjCloth, ObjError> {
        let material = self.texture.clone().unwrap_or_else(|| self.flat());
        self.build(material, self)
    }

    /// The cloth mesh whose material coordinates (m) are x and y of another OBJ file: the same
    /// faces in the same order over a list of vertices of its own, as ARCSim uses it. Texture
    /// coordinates of both files and groups of the other are ignored.
    ///
    /// # Errors
    /// If the faces differ in number or corners; and as for [`ObjMesh::to_mesh`], where an error in
    /// material space names the line in the file of the material space.
    pub fn to_mesh_with(&self, material: &ObjMesh) -> Result<ObjCloth, ObjError> {
        if material.n_faces() != self.n_faces() {
            return Err(ObjError::MaterialFaces(format!(
                "{} instead of {}",
                material.n_faces(),
                self.n_faces()
            )));
        }
        // The first triangle of another face is where the numbers of corners part.
        let pairs = self.face_of.iter().zip(&material.face_of);
        let differ = pairs.clone().position(|(ours, theirs)| ours != theirs);
        let shorter = self.face_of.len().min(material.face_of.len());
        if differ.is_some() || self.face_of.len() != material.face_of.len() {
            let at = differ.unwrap_or(shorter).saturating_sub(1);
            let (ours, theirs) = (self.line(at), material.line(at));
            return Err(ObjError::MaterialFaces(format!(
                "the face on line {theirs} has another number of corners than the one on line \
                 {ours} of the OBJ of the positions"
            )));
        }
        self.build(material.flat(), material)
    }

    /// x and y of the positions at every corner.
    fn flat(&self) -> Vec<[Material2; 3]> {
        self.triangles.iter().map(|t| t.map(|v| self.positions[v as usize].xy())).collect()
    }

    /// Builds the mesh; `material_file` is the file whose lines an error in material space names.
    fn build(
        &self,
        material: Vec<[Material2; 3]>,
        material_file: &ObjMesh,
    ) -> Result<ObjCloth, ObjError> {
        let (triangles, kept) = self.used_only();
        let panels = (0..triangles.len()).map(|t| self.group(t) as u32).collect();
        let mesh = Mesh::new(kept.len(), triangles, material, panels)
            .map_err(|error| self.located(error, &kept, material_file))?;
        let mut vertex_of_file = vec![None; self.positions.len()];
        for (new, &old) in kept.iter().enumerate() {
            vertex_of_file[old as usize] = Some(VertexId(new as u32));
        }
        let positions = kept.iter().map(|&v| self.positions[v as usize]).collect();
        Ok(ObjCloth { mesh, positions, vertex_of_file })
    }

    /// A defect of the mesh, in the words and lines of the file. `kept` holds the file index of
    /// every mesh vertex.
    fn located(&self, error: MeshError, kept: &[u32], material_file: &ObjMesh) -> ObjError {
        let number = |vertex: usize| kept[vertex] as usize + 1;
        match error {
            MeshError::RepeatedVertex { triangle, vertex } => ObjError::RepeatedVertex {
                line: self.line(triangle),
                vertex: number(vertex as usize),
            },
            MeshError::MaterialArea { triangle, area } => {
                let (line, face) = (material_file.line(triangle), material_file.face(triangle) + 1);
                let error = ObjError::MaterialArea { line, face, area };
                if std::ptr::eq(material_file, self) {
                    error
                } else {
                    ObjError::MaterialSpace(Box::new(error))
                }
            }
            MeshError::Edge { a, b, first, second } => {
                let lines = [self.line(first), self.line(second)];
                ObjError::Edge {
                    line: lines[0].max(lines[1]),
                    other: lines[0].min(lines[1]),
                    a: number(a as usize),
                    b: number(b as usize),
                }
            }
            MeshError::Vertex { vertex } => ObjError::Vertex {
                line: self.vertex_line(kept[vertex] as usize),
                vertex: number(vertex),
            },
            other => ObjError::Mesh(other),
        }
    }
}

//! What can be wrong with an OBJ file. Lines, faces and vertices are counted from 1, as editors and
//! the format do.

use super::MAX_COORDINATE;
use crate::construct::MeshError;

/// What is wrong with an OBJ file, and where.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ObjError {
    /// There is no `v` line.
    #[error("the OBJ file has no vertices")]
    NoVertices,
    /// There is no `f` line.
    #[error("the OBJ file has no faces")]
    NoFaces,
    /// A zero byte: this is not text.
    #[error("line {line}: not text, so not an OBJ file")]
    Binary {
        /// Where.
        line: usize,
    },
    /// More vertices, texture coordinates or triangles than 32-bit indices can name.
    #[error("line {line}: too large a file: more than {limit} vertices or triangles")]
    TooMany {
        /// Where the limit was passed.
        line: usize,
        /// The limit.
        limit: usize,
    },
    /// Something that should be a number is none.
    #[error("line {line}: `{text}` holds something that is not a number")]
    Number {
        /// Where.
        line: usize,
        /// The line, cut after some characters.
        text: String,
    },
    /// Too few or too many numbers.
    #[error("line {line}: {got} numbers after `{keyword}`, expected {expected}")]
    Coordinates {
        /// Where.
        line: usize,
        /// `v` or `vt`.
        keyword: &'static str,
        /// How many there may be.
        expected: &'static str,
        /// How many there are.
        got: usize,
    },
    /// A coordinate is infinite or not a number.
    #[error("line {line}: a coordinate of this `{keyword}` is {value}")]
    NotFinite {
        /// Where.
        line: usize,
        /// `v` or `vt`.
        keyword: &'static str,
        /// The coordinate.
        value: f64,
    },
    /// A coordinate is beyond all reason.
    #[error(
        "line {line}: a coordinate of this `{keyword}` is {value:e} m; the limit is {MAX_COORDINATE:e} m"
    )]
    TooLarge {
        /// Where.
        line: usize,
        /// `v` or `vt`.
        keyword: &'static str,
        /// The coordinate (m).
        value: f64,
    },
    /// A face with one or two corners, or none.
    #[error("line {line}: a face of {got} corners; it needs at least 3")]
    Corners {
        /// Where.
        line: usize,
        /// How many there are.
        got: usize,
    },
    /// A corner is not of the form `v`, `v/vt`, `v//vn` or `v/vt/vn`.
    #[error("line {line}: `{text}` is not a corner of a face")]
    Corner {
        /// Where.
        line: usize,
        /// The corner, cut after some characters.
        text: String,
    },
    /// A face refers to something that does not exist.
    #[error("line {line}: a corner refers to `{keyword}` number {index}, but there are {count}")]
    Index {
        /// Where.
        line: usize,
        /// `v` or `vt`.
        keyword: &'static str,
        /// The index as it stands in the file: from 1, or negative and relative.
        index: i64,
        /// How many there are (before the face, if the index is relative).
        count: usize,
    },
    /// Some corners have texture coordinates and some do not.
    #[error(
        "line {line}: a face with{} texture coordinates, unlike the corners before it; either all \
         corners of the file have them or none",
        if *.has { "" } else { "out" }
    )]
    MixedTexture {
        /// Where.
        line: usize,
        /// True if the corner at fault has texture coordinates.
        has: bool,
    },
    /// A face uses the same vertex twice.
    #[error("line {line}: the face uses vertex {vertex} twice")]
    RepeatedVertex {
        /// Where.
        line: usize,
        /// Number of the vertex.
        vertex: usize,
    },
    /// A face has no positive area in material space.
    #[error(
        "line {line}: face {face} has a triangle of area {area:e} m² in material space; it must be \
         positive (negative: turned over; zero: degenerate)"
    )]
    MaterialArea {
        /// Where.
        line: usize,
        /// Number of the face.
        face: usize,
        /// Signed area (m²).
        area: f64,
    },
    /// Three faces at an edge, or two of opposite orientation.
    #[error(
        "line {line}: the edge between vertices {a} and {b} is not manifold: the face here and the \
         one on line {other} run along it in the same direction"
    )]
    Edge {
        /// Where one of the faces is.
        line: usize,
        /// Line of the other face.
        other: usize,
        /// Number of one end.
        a: usize,
        /// Number of the other end.
        b: usize,
    },
    /// Faces touch in a vertex without sharing an edge there.
    #[error("line {line}: vertex {vertex} is not manifold: it joins several fans of triangles")]
    Vertex {
        /// Line of the vertex.
        line: usize,
        /// Number of the vertex.
        vertex: usize,
    },
    /// The OBJ file of the material space has other faces than the one of the positions.
    #[error("the material-space OBJ has other faces: {0}")]
    MaterialFaces(String),
    /// Something is wrong in the OBJ file of the material space.
    #[error("in the material-space OBJ: {0}")]
    MaterialSpace(Box<ObjError>),
    /// Any other defect of the mesh.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The library parser refused what the guard let pass: a defect of this crate.
    #[error("the OBJ parser failed: {0}")]
    Parser(String),
}

impl ObjError {
    pub(super) fn number(line: usize, text: &str) -> ObjError {
        ObjError::Number { line, text: shortened(text) }
    }

    pub(super) fn corner(line: usize, text: &str) -> ObjError {
        ObjError::Corner { line, text: shortened(text) }
    }
}

/// At most 40 characters of what may be a very long line.
fn shortened(text: &str) -> String {
    let mut short: String = text.trim().chars().take(40).collect();
    if short.len() < text.trim().len() {
        short.push('…');
    }
    short
}

//! What a generator refuses to make, and why.

use crate::construct::MeshError;

/// A request that no mesh can be generated for.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GenerateError {
    /// A length that is not finite, not positive, or beyond all reason.
    #[error("{what} is {value} m; it must lie between {min:e} and {max:e} m")]
    Size {
        /// Which length.
        what: &'static str,
        /// Its value (m).
        value: f64,
        /// Smallest possible (m).
        min: f64,
        /// Largest possible (m).
        max: f64,
    },
    /// Too few of something.
    #[error("{what}: {value} are too few; there must be at least {min}")]
    TooFew {
        /// Of what.
        what: &'static str,
        /// How many were wanted.
        value: usize,
        /// The fewest possible.
        min: usize,
    },
    /// More triangles than fit in memory with some sense.
    #[error("{wanted:e} triangles are too many; the limit is {limit}")]
    TooMany {
        /// About how many were wanted.
        wanted: f64,
        /// The most possible.
        limit: usize,
    },
    /// A seam names a sheet or a vertex that does not exist.
    #[error("seam {seam}: no vertex {vertex} in sheet {sheet}")]
    SeamVertex {
        /// The seam, from 0.
        seam: usize,
        /// The sheet it names.
        sheet: usize,
        /// The vertex it names.
        vertex: u32,
    },
    /// The two sides of a seam cannot be matched vertex by vertex.
    #[error(
        "seam {seam}: {first} vertices on one side and {second} on the other; both need the same number, at least 2"
    )]
    SeamLength {
        /// The seam, from 0.
        seam: usize,
        /// Vertices of the first side.
        first: usize,
        /// Vertices of the second side.
        second: usize,
    },
    /// A side of a seam leaves the boundary.
    #[error("seam {seam}: vertices {a} and {b} of sheet {sheet} share no boundary edge")]
    NotBoundary {
        /// The seam, from 0.
        seam: usize,
        /// The sheet.
        sheet: usize,
        /// A vertex of the side.
        a: u32,
        /// The next one.
        b: u32,
    },
    /// Both sides of a seam run the same way around: sewn together, one sheet would be inside out.
    #[error("seam {seam}: at step {step} both sides run the same way around; turn one of them")]
    SeamDirection {
        /// The seam, from 0.
        seam: usize,
        /// Step along the seam, from 0.
        step: usize,
    },
    /// Sewing closed edges that no seam joins: an opening of only two edges fell shut.
    #[error(
        "sewing closed {got} edges instead of the {expected} of the seams; an opening needs more than two edges"
    )]
    Closed {
        /// Edges of all seams.
        expected: usize,
        /// Edges that were closed.
        got: usize,
    },
    /// No boundary leads from one vertex to the other.
    #[error("no boundary runs from vertex {from} to vertex {to}")]
    NoChain {
        /// The first vertex.
        from: u32,
        /// The last vertex.
        to: u32,
    },
    /// The result is no mesh.
    #[error(transparent)]
    Mesh(#[from] MeshError),
}

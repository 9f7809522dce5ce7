//! What can go wrong when a picture is drawn or written.

use std::path::PathBuf;

use super::Viewpoint;

/// Why a picture could not be drawn, encoded or written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// The picture has no pixels, or a side that is too long.
    #[error("picture of {width} x {height} pixels: each side must be from 1 to {most} pixels")]
    Size {
        /// Width that was asked for (px).
        width: u32,
        /// Height that was asked for (px).
        height: u32,
        /// Longest side that can be drawn (px).
        most: u32,
    },
    /// The viewpoint does not say where to look.
    #[error(
        "viewpoint cannot be used: eye {:?}, target {:?}, up {:?}, vertical field of view {} rad; \
         all must be finite, the eye away from the target, and the field of view between 0 and π",
        .0.eye, .0.target, .0.up, .0.vertical_fov
    )]
    Viewpoint(Viewpoint),
    /// A triangle names a point that does not exist.
    #[error(
        "layer {layer}, triangle {triangle} uses point {point}, but there are {n_points} points"
    )]
    Index {
        /// Place in the list of layers.
        layer: usize,
        /// Place in the list of triangles.
        triangle: usize,
        /// The point named by the triangle.
        point: u32,
        /// Number of points of the layer.
        n_points: usize,
    },
    /// The number of colours does not match the number of triangles or points.
    #[error("layer {layer} has {n_colours} colours for {n_wanted} {what}")]
    Paint {
        /// Place in the list of layers.
        layer: usize,
        /// What is coloured: "triangles" or "points".
        what: &'static str,
        /// Number of colours given.
        n_colours: usize,
        /// Number of triangles or points.
        n_wanted: usize,
    },
    /// More triangles and segments than can be told apart.
    #[error("{n_parts} triangles and segments in one picture: at most {most} can be drawn")]
    TooMany {
        /// Number of triangles and segments of all layers.
        n_parts: usize,
        /// The greatest number that can be drawn.
        most: usize,
    },
    /// The picture could not be encoded.
    #[error("picture could not be encoded as PNG: {0}")]
    Encode(#[from] png::EncodingError),
    /// The file could not be written.
    #[error("picture could not be written to {}: {source}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
}

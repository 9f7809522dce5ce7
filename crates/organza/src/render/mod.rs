//! Shaded pictures of cloth, drawn in software.
//!
//! No window, no graphics card, no threads: [`draw`] turns triangles and line segments into an
//! [`Image`], and the same input always gives the same pixels. The cloth is lit by a key light, a
//! fill light, the sky and a slight rim, with shadows, so that folds read well; its two sides have
//! their own colours; edges are smoothed by eight samples per pixel; the mesh can be drawn on top.
//!
//! ```
//! use organza::render::{Layer, Size, Surface, Viewpoint, draw};
//!
//! # fn main() -> Result<(), organza::render::RenderError> {
//! let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.2, 1.0], [0.0, 0.0, 1.0]];
//! let triangles = [[0, 1, 2], [0, 2, 3]];
//! let size = Size::new(320, 180);
//! let viewpoint = Viewpoint::fit(points, [0.0, 0.0, 1.0], size);
//! let sheet = Surface { wireframe: true, ..Surface::new(&points, &triangles) };
//! let image = draw(&[Layer::Surface(sheet)], &viewpoint, size)?;
//! assert_eq!(image.encode_png()?[1..4], *b"PNG");
//! # Ok(())
//! # }
//! ```
//!
//! How a picture is made: the triangles are projected, clipped and put into a buffer that holds, for
//! every sample, which triangle is nearest (`raster`). Then each pixel is shaded once for every
//! triangle seen in it (`shade`) and the results are mixed by the number of samples. Hidden surfaces
//! therefore cost no shading, and a picture is made in strips, so that memory does not grow with its
//! height.
//!
//! Points that are not finite are left out together with the triangles that use them: a simulation
//! that has gone wrong can still be looked at.

mod backdrop;
mod bounds;
mod clip;
mod colour;
mod colour_map;
mod error;
mod image;
mod layer;
mod lens;
mod painter;
mod project;
mod raster;
mod shade;
mod shadow;
mod viewpoint;

#[cfg(test)]
mod tests;

pub use bounds::Bounds;
pub use colour::Rgb;
pub use colour_map::{ColourMap, VIRIDIS};
pub use error::RenderError;
pub use image::{Image, Size};
pub use layer::{Layer, Lines, Paint, Surface};
pub use painter::{Style, draw, draw_with};
pub use viewpoint::Viewpoint;

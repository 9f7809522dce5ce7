//! A finished picture and its PNG file.

use std::path::Path;

use super::{RenderError, Rgb};

/// Size of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    /// Number of columns (px).
    pub width: u32,
    /// Number of rows (px).
    pub height: u32,
}

impl Size {
    /// A size of `width` by `height` (px).
    pub const fn new(width: u32, height: u32) -> Self {
        Self { width, height }
    }

    /// Width divided by height; 1 if a side is zero.
    pub fn aspect(self) -> f64 {
        if self.width == 0 || self.height == 0 {
            return 1.0;
        }
        f64::from(self.width) / f64::from(self.height)
    }
}

/// A picture of 8-bit sRGB colours.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Number of columns and rows (px).
    pub size: Size,
    /// Colours row by row, beginning at the top left; `width * height` of them.
    pub pixels: Vec<Rgb>,
}

impl Image {
    /// The colour in column `x` and row `y` counted from the top left, or `None` outside.
    pub fn pixel(&self, x: u32, y: u32) -> Option<Rgb> {
        if x >= self.size.width || y >= self.size.height {
            return None;
        }
        self.pixels.get(y as usize * self.size.width as usize + x as usize).copied()
    }

    /// The picture as the bytes of a PNG file.
    ///
    /// # Errors
    /// [`RenderError::Encode`] if the number of pixels does not match the size.
    pub fn encode_png(&self) -> Result<Vec<u8>, RenderError> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.size.width, self.size.height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(self.pixels.as_flattened())?;
        writer.finish()?;
        Ok(bytes)
    }

    /// Writes the picture as a PNG file. The picture is encoded first, so that a picture that cannot
    /// be encoded leaves no file.
    ///
    /// # Errors
    /// [`RenderError::Encode`] as in [`Image::encode_png`]; [`RenderError::Write`] if the system
    /// refuses the file.
    pub fn write_png(&self, path: impl AsRef<Path>) -> Result<(), RenderError> {
        let path = path.as_ref();
        let bytes = self.encode_png()?;
        std::fs::write(path, bytes)
            .map_err(|source| RenderError::Write { path: path.to_owned(), source })
    }
}

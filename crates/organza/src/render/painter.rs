//! Draws a picture strip by strip: which triangle is where, then its light.

use super::backdrop::{self, Floor};
use super::colour::{Encoder, Light, add, scale};
use super::lens::Lens;
use super::project::{Scene, Shape};
use super::raster::{BLOCK, NOBODY, Strip};
use super::shade::Lights;
use super::shadow::Shadow;
use super::{Image, Layer, RenderError, Size, Viewpoint};

/// Samples per pixel.
const N: usize = 8;

/// Places of the samples in a pixel (px / 256): no two in one column or row of a grid of eight, so
/// that edges near the axes, too, are smoothed in nine steps.
const PATTERN: [[i64; 2]; N] =
    [[144, 80], [112, 176], [208, 144], [80, 48], [48, 208], [16, 112], [176, 240], [240, 16]];

/// What a picture shows besides its layers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Style {
    /// Whether surfaces throw shadows.
    pub shadows: bool,
    /// Height, along [`Viewpoint::up`], of a floor that shows nothing but a soft shadow, if `shadows`
    /// are on. It should lie below everything, as [`Bounds::lowest`](super::Bounds::lowest) of a
    /// sequence does (m).
    pub floor: Option<f64>,
}

impl Default for Style {
    /// Shadows, no floor.
    fn default() -> Self {
        Self { shadows: true, floor: None }
    }
}

/// Draws `layers` as seen from `viewpoint` in the default [`Style`].
///
/// Costs time proportional to the number of triangles and of pixels, whatever the size of the
/// triangles; about 100 bytes for each triangle, 1000 for each column of pixels, and 8 MB for shadows.
///
/// # Errors
/// A size of zero or more than 16384 pixels, a viewpoint that looks nowhere, a triangle that uses a
/// missing point, or a wrong number of colours: see [`RenderError`]. Broken points are no error.
pub fn draw(layers: &[Layer<'_>], viewpoint: &Viewpoint, size: Size) -> Result<Image, RenderError> {
    draw_with(layers, viewpoint, size, &Style::default())
}

/// As [`draw`], in a given `style`.
///
/// # Errors
/// As [`draw`].
pub fn draw_with(
    layers: &[Layer<'_>],
    viewpoint: &Viewpoint,
    size: Size,
    style: &Style,
) -> Result<Image, RenderError> {
    let lens = Lens::new(viewpoint, size)?;
    let scene = Scene::new(layers, &lens)?;
    let shadow = if style.shadows {
        Shadow::new(&scene, &lens, Lights::key(), style.floor.is_some())
    } else {
        None
    };
    let lights = Lights::new(&lens, shadow);
    let floor = style.floor.and_then(|height| Floor::new(&lens, &lights, height));
    let painter = Painter { lens, scene, lights, floor, encoder: Encoder::new() };
    Ok(painter.paint())
}

struct Painter<'a> {
    lens: Lens,
    scene: Scene<'a>,
    lights: Lights,
    floor: Option<Floor>,
    encoder: Encoder,
}

impl Painter<'_> {
    fn paint(&self) -> Image {
        let size = self.lens.size;
        let (width, height) = (size.width as usize, size.height as usize);
        let prims = self.scene.prims(&self.lens);
        let n_strips = height.div_ceil(BLOCK);
        let mut in_strip = vec![Vec::new(); n_strips];
        for (i, prim) in prims.iter().enumerate() {
            let rows = prim.rows(height);
            if !rows.is_empty() {
                for list in &mut in_strip[rows.start / BLOCK..=(rows.end - 1) / BLOCK] {
                    list.push(i);
                }
            }
        }
        let mut strip = Strip::<N>::new(&PATTERN, width, BLOCK, 0.0);
        let mut pixels = Vec::with_capacity(width * height);
        for (number, list) in in_strip.iter().enumerate() {
            let top = number * BLOCK;
            strip.restart(top, 0.0);
            list.iter().for_each(|&i| strip.fill(&prims[i]));
            let rows = BLOCK.min(height - top);
            for (i, owners) in strip.owner[..rows * width].iter().enumerate() {
                let at = [(i % width) as f64 + 0.5, (top + i / width) as f64 + 0.5];
                pixels.push(self.encoder.encode(self.pixel(owners, at)));
            }
        }
        Image { size, pixels }
    }

    /// Light of one pixel: every owner is shaded once and counts by its samples.
    fn pixel(&self, owners: &[u32; N], at: [f64; 2]) -> Light {
        let mut light = [0.0; 3];
        let mut done = [false; N];
        for i in 0..N {
            if !done[i] {
                let mut count = 0;
                for j in i..N {
                    if owners[j] == owners[i] {
                        (done[j], count) = (true, count + 1);
                    }
                }
                let part = count as f32 / N as f32;
                light = add(light, scale(self.owner_light(owners[i], at), part));
            }
        }
        light
    }

    fn owner_light(&self, owner: u32, at: [f64; 2]) -> Light {
        if owner == NOBODY {
            let floor = self.floor.as_ref().map_or(1.0, |floor| floor.lit(&self.lens, at));
            return scale(backdrop::light(self.lens.size, at), floor);
        }
        match self.scene.find(owner) {
            (Shape::Cloth(cloth), t) => {
                self.lights.shade(&self.lens, self.scene.decoder(), cloth, t, at)
            }
            (Shape::Lines(_, colour), _) => *colour,
        }
    }
}

//! Tests of the renderer.

mod coverage;
mod framing;
mod pictures;
mod robustness;

use super::{Image, Layer, Paint, Rgb, Size, Style, Surface, Viewpoint, draw_with};

/// A picture without shadows, so that only the geometry and the paint decide.
fn plain(layers: &[Layer<'_>], viewpoint: &Viewpoint, size: Size) -> Image {
    let style = Style { shadows: false, floor: None };
    draw_with(layers, viewpoint, size, &style).expect("a sound scene is drawn")
}

/// Looks down the z axis from a height of 1 m, so that a picture with a side of `2 f` pixels shows
/// the plane z = 0 with `f` pixels per metre.
const FACING: Viewpoint = Viewpoint {
    eye: [0.0, 0.0, 1.0],
    target: [0.0, 0.0, 0.0],
    up: [0.0, 1.0, 0.0],
    vertical_fov: std::f64::consts::FRAC_PI_2,
};

/// The point of height `z` that [`FACING`] sees at a place of a square picture (px).
fn seen_at(column: f64, row: f64, z: f64, size: Size) -> [f64; 3] {
    let half = f64::from(size.height) / 2.0;
    [(column - half) / half * (1.0 - z), (half - row) / half * (1.0 - z), z]
}

fn painted<'a>(points: &'a [[f64; 3]], triangles: &'a [[u32; 3]], colour: Rgb) -> Layer<'a> {
    Layer::Surface(Surface { paint: Paint::both(colour), ..Surface::new(points, triangles) })
}

/// Sum of the channels: enough to tell light from dark.
fn brightness(colour: Rgb) -> i32 {
    colour.iter().map(|&c| i32::from(c)).sum()
}

/// Numbers in `[0, 1)` for random tests, the same in every run (splitmix64).
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z >> 40) as f64 / (1_u64 << 24) as f64
    }

    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    fn point(&mut self, reach: f64) -> [f64; 3] {
        std::array::from_fn(|_| self.within(-reach, reach))
    }
}

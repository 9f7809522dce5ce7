//! Colours: 8-bit sRGB outside, linear light inside.

/// An 8-bit sRGB colour: red, green, blue.
pub type Rgb = [u8; 3];

/// A colour in linear light, 0 to 1 per channel: the only kind that may be added and mixed.
pub(super) type Light = [f32; 3];

/// `a + (b - a) t`.
pub(super) fn mix(a: Light, b: Light, t: f32) -> Light {
    std::array::from_fn(|i| a[i] + (b[i] - a[i]) * t)
}

/// `a s`.
pub(super) fn scale(a: Light, s: f32) -> Light {
    a.map(|channel| channel * s)
}

/// `a + b`.
pub(super) fn add(a: Light, b: Light) -> Light {
    std::array::from_fn(|i| a[i] + b[i])
}

/// `a b`, channel by channel.
pub(super) fn times(a: Light, b: Light) -> Light {
    std::array::from_fn(|i| a[i] * b[i])
}

/// 0 below `low`, 1 above `high`, smooth between.
pub(super) fn smoothstep(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Turns sRGB (IEC 61966-2-1) into linear light. By a table, as its inverse [`Encoder`] is: powers for
/// every pixel would cost more than the shading.
pub(super) struct Decoder {
    table: [f32; 256],
}

impl Decoder {
    pub(super) fn new() -> Self {
        let table = std::array::from_fn(|i| {
            let s = i as f64 / 255.0;
            let linear = if s <= 0.04045 { s / 12.92 } else { ((s + 0.055) / 1.055).powf(2.4) };
            linear as f32
        });
        Self { table }
    }

    pub(super) fn decode(&self, colour: Rgb) -> Light {
        colour.map(|channel| self.table[usize::from(channel)])
    }
}

/// Turns linear light into sRGB.
pub(super) struct Encoder {
    table: Vec<u8>,
}

impl Encoder {
    /// Finer than the smallest step of 8-bit sRGB near black (1/3294), by a factor of five.
    const STEPS: usize = 1 << 14;

    pub(super) fn new() -> Self {
        let table = (0..=Self::STEPS)
            .map(|i| {
                let x = i as f64 / Self::STEPS as f64;
                let s = if x <= 0.0031308 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 };
                (s * 255.0).round() as u8
            })
            .collect();
        Self { table }
    }

    pub(super) fn encode(&self, light: Light) -> Rgb {
        // A float cast saturates and sends NaN to zero: no index can leave the table.
        light.map(|x| self.table[((x * Self::STEPS as f32 + 0.5) as usize).min(Self::STEPS)])
    }
}

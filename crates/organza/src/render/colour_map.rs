//! Colours for numbers.

use super::Rgb;

/// A scale of colours for numbers, linear between equally spaced colours.
///
/// ```
/// use organza::render::VIRIDIS;
///
/// let stretch = [0.98, 1.0, 1.05];
/// let colours: Vec<_> = stretch.iter().map(|&s| VIRIDIS.colour_in(s, 0.95, 1.05)).collect();
/// assert_eq!(colours[2], [253, 231, 37]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ColourMap<'a> {
    /// Colours from the low end to the high end.
    pub stops: &'a [Rgb],
    /// Colour of numbers that are not finite.
    pub undefined: Rgb,
}

/// Dark violet over green to yellow; brightness grows evenly, so it also reads in grey and to colour
/// blind eyes. Eleven stops of the map "viridis" by Smith and van der Walt, which they placed in the
/// public domain (CC0).
pub const VIRIDIS: ColourMap<'static> = ColourMap {
    stops: &[
        [68, 1, 84],
        [72, 37, 118],
        [65, 68, 135],
        [53, 96, 141],
        [42, 120, 142],
        [33, 144, 140],
        [34, 168, 132],
        [67, 191, 113],
        [122, 209, 81],
        [187, 223, 39],
        [253, 231, 37],
    ],
    undefined: [200, 60, 160],
};

impl ColourMap<'_> {
    /// Colour at `t`; below 0 and above 1 the end colours.
    pub fn colour(&self, t: f64) -> Rgb {
        if t.is_nan() || self.stops.is_empty() {
            return self.undefined;
        }
        let last = self.stops.len() - 1;
        let place = t.clamp(0.0, 1.0) * last as f64;
        let low = (place as usize).min(last);
        let high = (low + 1).min(last);
        let part = place - low as f64;
        std::array::from_fn(|i| {
            let (a, b) = (f64::from(self.stops[low][i]), f64::from(self.stops[high][i]));
            (a + (b - a) * part).round() as u8
        })
    }

    /// Colour of `value` on a scale from `low` to `high`; where both are equal, the middle colour.
    pub fn colour_in(&self, value: f64, low: f64, high: f64) -> Rgb {
        if value.is_infinite() || !(high - low).is_finite() {
            return self.undefined;
        }
        self.colour(if high == low { 0.5 } else { (value - low) / (high - low) })
    }
}

//! Logarithmic axes.

/// Maps positive numbers to a range of pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Axis {
    /// Logarithms of the ends, base 10.
    low: f64,
    high: f64,
    /// Where the ends are drawn.
    from: f64,
    to: f64,
}

impl Axis {
    /// An axis on which all the numbers are, with some room around them; others than positive ones
    /// cannot be.
    pub(super) fn over(numbers: impl Iterator<Item = f64>, [from, to]: [f64; 2]) -> Option<Axis> {
        let logs = numbers.filter(|x| drawable(*x)).map(f64::log10);
        let (low, high) =
            logs.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
        if low > high {
            return None;
        }
        // A single number gets a decade.
        let room = (0.06 * (high - low)).max(if high - low < 0.3 { 0.3 } else { 0.05 });
        Some(Axis { low: low - room, high: high + room, from, to })
    }

    /// Where a positive number is drawn.
    pub(super) fn at(&self, x: f64) -> f64 {
        self.from + (self.to - self.from) * (x.log10() - self.low) / (self.high - self.low)
    }

    /// The numbers at the ends.
    pub(super) fn ends(&self) -> [f64; 2] {
        [10f64.powf(self.low), 10f64.powf(self.high)]
    }

    /// Round numbers on the axis, with what is written beside them.
    pub(super) fn ticks(&self) -> Vec<(f64, String)> {
        let decades = self.high - self.low;
        let steps: &[f64] = match decades {
            d if d < 1.0 => &[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0],
            d if d < 2.5 => &[1.0, 2.0, 5.0],
            _ => &[1.0],
        };
        // No more than about eight, however many decades there are.
        let every = (decades / 8.0).ceil().max(1.0) as i32;
        let mut ticks = Vec::new();
        for power in self.low.floor() as i32..=self.high.ceil() as i32 {
            if power.rem_euclid(every) != 0 {
                continue;
            }
            for step in steps {
                let x = step * 10f64.powi(power);
                if (self.low..=self.high).contains(&x.log10()) {
                    ticks.push((x, written(*step, power)));
                }
            }
        }
        ticks
    }
}

/// True for what a logarithmic axis can show.
pub(super) fn drawable(x: f64) -> bool {
    x.is_finite() && x > 0.0
}

fn written(step: f64, power: i32) -> String {
    if (-3..=4).contains(&power) {
        // Enough digits for 1.5 · 10^power, without zeros behind.
        let text = format!("{:.*}", (1 - power).max(0) as usize, step * 10f64.powi(power));
        let short = text.trim_end_matches('0').trim_end_matches('.');
        return if text.contains('.') { short.to_owned() } else { text };
    }
    format!("{step}e{power}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_between_the_ends() {
        let numbers = [0.01, 1.0, 0.0, f64::NAN, 10.0];
        let axis = Axis::over(numbers.into_iter(), [100.0, 0.0]).unwrap();
        let at = |x| axis.at(x);
        assert!(100.0 > at(0.01) && at(0.01) > at(1.0) && at(1.0) > at(10.0) && at(10.0) > 0.0);
        assert_eq!(Axis::over([0.0, -1.0].into_iter(), [0.0, 1.0]), None);
    }

    #[test]
    fn ticks_are_round_and_few() {
        for (low, high) in [(3.0, 3.0), (1.0, 9.0), (0.02, 0.9), (1e-6, 1e7), (1e-30, 1e30)] {
            let axis = Axis::over([low, high].into_iter(), [0.0, 1.0]).unwrap();
            let ticks = axis.ticks();
            assert!((2..=16).contains(&ticks.len()), "{low} {high}: {ticks:?}");
        }
        let words = [
            (1.0, 0, "1"),
            (1.5, -1, "0.15"),
            (2.0, 2, "200"),
            (1.0, -3, "0.001"),
            (5.0, -5, "5e-5"),
            (1.0, 6, "1e6"),
        ];
        for (step, power, text) in words {
            assert_eq!(written(step, power), text);
        }
    }
}

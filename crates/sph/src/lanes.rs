//! Four numbers at once, and formulas that serve one number as well as four.
//!
//! There are always four, whatever the processor has, and no product is fused with a sum: the bits of
//! a result are the same on every machine.

use pulp::{Simd, WithSimd};
use std::ops::{Add, Div, Mul, Sub};

/// Numbers that are done at once.
pub(crate) const LANES: usize = 4;

/// What formulas calculate with: one number or four.
pub(crate) trait Number:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<f64, Output = Self>
    + Mul<f64, Output = Self>
{
    /// The square root.
    fn root(self) -> Self;
    /// The larger of this and `bound`.
    fn at_least(self, bound: f64) -> Self;
    /// The smaller of this and `bound`.
    fn at_most(self, bound: f64) -> Self;
    /// `from` − this.
    fn subtracted_from(self, from: f64) -> Self;
}

impl Number for f64 {
    #[inline(always)]
    fn root(self) -> Self {
        self.sqrt()
    }

    #[inline(always)]
    fn at_least(self, bound: f64) -> Self {
        if self > bound { self } else { bound }
    }

    #[inline(always)]
    fn at_most(self, bound: f64) -> Self {
        if self < bound { self } else { bound }
    }

    #[inline(always)]
    fn subtracted_from(self, from: f64) -> Self {
        from - self
    }
}

/// Four numbers.
#[derive(Clone, Copy)]
pub(crate) struct Four<S: Simd> {
    simd: S,
    lanes: S::f64s,
}

impl<S: Simd> Four<S> {
    /// These four.
    #[inline(always)]
    pub(crate) fn new(simd: S, lanes: [f64; LANES]) -> Self {
        Four { simd, lanes: pulp::cast(lanes) }
    }

    /// Four times the same.
    #[inline(always)]
    pub(crate) fn splat(simd: S, number: f64) -> Self {
        Four { simd, lanes: simd.splat_f64s(number) }
    }

    /// As an array.
    #[inline(always)]
    pub(crate) fn array(self) -> [f64; LANES] {
        pulp::cast(self.lanes)
    }

    /// Their sum, in a fixed order.
    #[inline(always)]
    pub(crate) fn total(self) -> f64 {
        let [a, b, c, d] = self.array();
        (a + b) + (c + d)
    }
}

impl<S: Simd> Add for Four<S> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Four { simd: self.simd, lanes: self.simd.add_f64s(self.lanes, other.lanes) }
    }
}

impl<S: Simd> Sub for Four<S> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Four { simd: self.simd, lanes: self.simd.sub_f64s(self.lanes, other.lanes) }
    }
}

impl<S: Simd> Mul for Four<S> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Four { simd: self.simd, lanes: self.simd.mul_f64s(self.lanes, other.lanes) }
    }
}

impl<S: Simd> Div for Four<S> {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        Four { simd: self.simd, lanes: self.simd.div_f64s(self.lanes, other.lanes) }
    }
}

impl<S: Simd> Add<f64> for Four<S> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: f64) -> Self {
        self + Four::splat(self.simd, other)
    }
}

impl<S: Simd> Mul<f64> for Four<S> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: f64) -> Self {
        self * Four::splat(self.simd, other)
    }
}

impl<S: Simd> Number for Four<S> {
    #[inline(always)]
    fn root(self) -> Self {
        Four { simd: self.simd, lanes: self.simd.sqrt_f64s(self.lanes) }
    }

    #[inline(always)]
    fn at_least(self, bound: f64) -> Self {
        let bound = self.simd.splat_f64s(bound);
        Four { simd: self.simd, lanes: self.simd.max_f64s(self.lanes, bound) }
    }

    #[inline(always)]
    fn at_most(self, bound: f64) -> Self {
        let bound = self.simd.splat_f64s(bound);
        Four { simd: self.simd, lanes: self.simd.min_f64s(self.lanes, bound) }
    }

    #[inline(always)]
    fn subtracted_from(self, from: f64) -> Self {
        Four::splat(self.simd, from) - self
    }
}

/// Runs a task with registers that hold four numbers, if the processor has them.
#[inline(always)]
pub(crate) fn run<T: WithSimd>(task: T) -> T::Output {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    if let Some(simd) = pulp::x86::V3::try_new() {
        return Simd::vectorize(simd, task);
    }
    Simd::vectorize(pulp::Scalar256b, task)
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Formula([f64; LANES]);

    fn formula<N: Number>(x: N) -> N {
        ((x * x + 0.3).root() / x.at_least(0.1) - x.at_most(0.2)).subtracted_from(1.7) * 0.9
    }

    impl WithSimd for Formula {
        type Output = [f64; LANES];

        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) -> [f64; LANES] {
            formula(Four::new(simd, self.0)).array()
        }
    }

    #[test]
    fn four_have_the_bits_of_one() {
        let numbers = [-0.7, 0.0, 0.123_456_789, 1e5];
        let one = numbers.map(formula);
        assert_eq!(run(Formula(numbers)), one);
        assert_eq!(Simd::vectorize(pulp::Scalar256b, Formula(numbers)), one);
    }
}

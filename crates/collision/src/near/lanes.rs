//! Vectors of several triangles at a time, in single precision: loops that the compiler turns into
//! instructions for all of them.

/// A number for each of `N` triangles.
pub(super) type Row<const N: usize> = [f32; N];
/// A vector for each of them.
pub(super) type Vector<const N: usize> = [Row<N>; 3];

/// More than the rounding errors of a gap between points whose coordinates are at most 1: those of the
/// points are 2⁻²⁴ and less, and those of the some ten operations on them not much larger.
const SLACK: f32 = 4e-6;
/// More than the rounding errors of a length by its size (1).
const RELATIVE: f32 = 1e-5;
/// Vectors shorter than this have no direction, as the square of their length loses digits.
const SHORT: f32 = 1e-15;

/// A row of `of(0)`, `of(1)` and so on. By a loop and always inline, like all here: otherwise it is a
/// call for each number.
#[inline(always)]
pub(super) fn row<const N: usize>(of: impl Fn(usize) -> f32) -> Row<N> {
    let mut row = [0.0; N];
    for l in 0..N {
        row[l] = of(l);
    }
    row
}

/// How near things with these radii or rooms may be without coming into contact, with this square of
/// their relative motion, in units in which coordinates are at most 1. Any gap along an axis of
/// [`unit`] that is greater keeps them apart.
#[inline(always)]
pub(super) fn reach<const N: usize>(a: &Row<N>, b: &Row<N>, squared: &Row<N>) -> Row<N> {
    row(|l| (a[l] + b[l] + squared[l].sqrt()) * (1.0 + RELATIVE) + SLACK)
}

/// What certainly contains an interval, with room on both sides.
#[inline(always)]
pub(super) fn widened(lo: f32, hi: f32, room: f32) -> [f32; 2] {
    let room = room * (1.0 + RELATIVE) + SLACK;
    [lo - room, hi + room]
}

#[inline(always)]
pub(super) fn dot<const N: usize>(a: &Vector<N>, b: &Vector<N>) -> Row<N> {
    row(|l| a[0][l] * b[0][l] + a[1][l] * b[1][l] + a[2][l] * b[2][l])
}

#[inline(always)]
fn each<const N: usize>(of: impl Fn(usize, usize) -> f32) -> Vector<N> {
    [row(|l| of(0, l)), row(|l| of(1, l)), row(|l| of(2, l))]
}

#[inline(always)]
pub(super) fn minus<const N: usize>(a: &Vector<N>, b: &Vector<N>) -> Vector<N> {
    each(|k, l| a[k][l] - b[k][l])
}

/// `a` and a multiple of `b`.
#[inline(always)]
pub(super) fn plus<const N: usize>(a: &Vector<N>, by: &Row<N>, b: &Vector<N>) -> Vector<N> {
    each(|k, l| a[k][l] + by[l] * b[k][l])
}

#[inline(always)]
pub(super) fn cross<const N: usize>(a: &Vector<N>, b: &Vector<N>) -> Vector<N> {
    each(|k, l| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        a[i][l] * b[j][l] - a[j][l] * b[i][l]
    })
}

/// The greater one. If one is no number, the second.
#[inline(always)]
pub(super) fn upper<const N: usize>(a: &Row<N>, b: &Row<N>) -> Row<N> {
    row(|l| if a[l] > b[l] { a[l] } else { b[l] })
}

/// The lesser one. If one is no number, the second.
#[inline(always)]
pub(super) fn lower<const N: usize>(a: &Row<N>, b: &Row<N>) -> Row<N> {
    row(|l| if a[l] < b[l] { a[l] } else { b[l] })
}

/// The part of `a` across `b`.
#[inline(always)]
pub(super) fn rejected<const N: usize>(a: &Vector<N>, b: &Vector<N>) -> Vector<N> {
    let (along, squared) = (dot(a, b), dot(b, b));
    let share: Row<N> = row(|l| -along[l] / squared[l]);
    plus(a, &share, b)
}

/// The unit vectors: zero where vectors are too short, and no numbers where they are none, so that
/// nothing compares greater.
#[inline(always)]
pub(super) fn unit<const N: usize>(a: &Vector<N>) -> Vector<N> {
    let squared = dot(a, a);
    let by: Row<N> =
        std::array::from_fn(
            |l| {
                if squared[l] > SHORT * SHORT { 1.0 / squared[l].sqrt() } else { 0.0 }
            },
        );
    each(|k, l| a[k][l] * by[l])
}

/// For each of `N` triangles all bits, if something holds, or none.
pub(super) type Mask<const N: usize> = [u32; N];

/// Adds those for which `holds(0)`, `holds(1)` and so on.
#[inline(always)]
pub(super) fn mark<const N: usize>(mask: &mut Mask<N>, holds: impl Fn(usize) -> bool) {
    for l in 0..N {
        mask[l] |= if holds(l) { u32::MAX } else { 0 };
    }
}

/// A bit for each that is marked.
#[inline(always)]
pub(super) fn bits<const N: usize>(mask: &Mask<N>) -> u32 {
    let mut bits = 0;
    for l in 0..N {
        bits |= mask[l] & 1 << l;
    }
    bits
}

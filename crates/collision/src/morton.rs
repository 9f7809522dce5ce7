//! Sorting boxes along the Morton curve (Morton1966).

use crate::Aabb;

/// Most bits per axis of a code.
const BITS: u32 = 21;
/// Bits that one pass of the sort looks at.
const DIGIT_BITS: u32 = 11;

/// The bits of a 21-bit number with two zeros between neighbours.
fn spread(x: u64) -> u64 {
    let mut x = x & 0x1f_ffff;
    x = (x | (x << 32)) & 0x001f_0000_0000_ffff;
    x = (x | (x << 16)) & 0x001f_0000_ff00_00ff;
    x = (x | (x << 8)) & 0x100f_00f0_0f00_f00f;
    x = (x | (x << 4)) & 0x10c3_0c30_c30c_30c3;
    (x | (x << 2)) & 0x1249_2492_4924_9249
}

/// The indices of the boxes in the order of their centres along the curve; equal codes in the order
/// of their indices.
pub(crate) fn order(boxes: &[Aabb]) -> Vec<u32> {
    let all = boxes.iter().fold(Aabb::EMPTY, |all, b| all.union(b));
    let widest = (0..3).map(|k| all.hi[k] - all.lo[k]).fold(0.0, f64::max);
    // Some four cells per element on a surface, and more in a volume: finer ones sort no better.
    let bits = ((boxes.len().max(1).ilog2() + 2) / 2 + 1).min(BITS);
    // Twice the centre, from the corner of all: halves cancel, and sums of large numbers are avoided.
    let scale = if widest > 0.0 { 0.5 * f64::from((1u32 << bits) - 1) / widest } else { 0.0 };
    let cell = |b: &Aabb, k: usize| {
        // A cast of what is no number or out of range saturates.
        (((b.lo[k] - all.lo[k]) + (b.hi[k] - all.lo[k])) * scale) as u64
    };
    let code = |b: &Aabb| spread(cell(b, 0)) | spread(cell(b, 1)) << 1 | spread(cell(b, 2)) << 2;
    let mut keys: Vec<(u64, u32)> = (0..).zip(boxes).map(|(i, b)| (code(b), i)).collect();
    radix_sort(&mut keys, 3 * bits);
    keys.into_iter().map(|(_, i)| i).collect()
}

/// Sorts by the first number, of so many bits, keeping the order of equal ones. Passes in which all
/// digits agree are skipped.
fn radix_sort(keys: &mut Vec<(u64, u32)>, bits: u32) {
    if keys.len() < 1 << DIGIT_BITS {
        keys.sort_unstable();
        return;
    }
    let mut other = vec![(0, 0); keys.len()];
    let mut shift = 0;
    while shift < bits {
        let digit = |key: u64| (key >> shift) as usize & ((1 << DIGIT_BITS) - 1);
        let mut starts = vec![0usize; 1 << DIGIT_BITS];
        keys.iter().for_each(|&(key, _)| starts[digit(key)] += 1);
        if starts[digit(keys[0].0)] < keys.len() {
            let mut sum = 0;
            for start in &mut starts {
                sum += std::mem::replace(start, sum);
            }
            for &key in keys.iter() {
                let at = &mut starts[digit(key.0)];
                other[*at] = key;
                *at += 1;
            }
            std::mem::swap(keys, &mut other);
        }
        shift += DIGIT_BITS;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mesh_core::World3;

    #[test]
    fn spreading_keeps_every_bit() {
        for bit in 0..BITS {
            assert_eq!(spread(1 << bit), 1 << (3 * bit), "bit {bit}");
        }
    }

    #[test]
    fn the_two_sorts_agree() {
        let mut state = 1u64;
        let mut keys: Vec<(u64, u32)> = (0..5000)
            .map(|i| {
                state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                // Few values, so that many are equal.
                (((state >> 33) % 97) << 40 | (state >> 60), i)
            })
            .collect();
        let mut expected = keys.clone();
        expected.sort_unstable();
        radix_sort(&mut keys, 63);
        assert_eq!(keys, expected);
    }

    #[test]
    fn points_on_one_spot_keep_their_order_and_strange_ones_do_no_harm() {
        let spot = Aabb::around([&World3::new(3.0, 4.0, 5.0)]);
        assert_eq!(order(&[spot; 4]), [0, 1, 2, 3]);
        let nowhere = Aabb { lo: [f64::NAN; 3], hi: [f64::INFINITY; 3] };
        let mut sorted = order(&[spot, nowhere, Aabb::EMPTY, spot]);
        sorted.sort_unstable();
        assert_eq!(sorted, [0, 1, 2, 3]);
    }
}

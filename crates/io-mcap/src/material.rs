//! Material coordinates per triangle corner, packed without loss.
//!
//! Most corners at a point share their coordinates, so each distinct pair is stored once per
//! point. Away from seams that is one pair per point, and the points' own order says which
//! corner has which: then no list of corners is stored at all.

use crate::proto::GarmentMaterial;

/// Packs the coordinates of every corner. `triangles` and `material` are equally long, and
/// every index is below `n_points`.
pub(crate) fn pack(
    name: &str,
    n_points: usize,
    triangles: &[[u32; 3]],
    material: &[[[f64; 2]; 3]],
) -> GarmentMaterial {
    const NONE: u32 = u32::MAX;
    let mut pairs: Vec<[f64; 2]> = Vec::new();
    // Pairs of one point form a list: first[point], then next[pair].
    let mut first = vec![NONE; n_points];
    let mut next: Vec<u32> = Vec::new();
    let mut corners = Vec::with_capacity(3 * triangles.len());
    for (points, coordinates) in triangles.iter().zip(material) {
        for (&point, uv) in points.iter().zip(coordinates) {
            let mut pair = first[point as usize];
            while pair != NONE && !same_bits(pairs[pair as usize], *uv) {
                pair = next[pair as usize];
            }
            if pair == NONE {
                pair = pairs.len() as u32;
                pairs.push(*uv);
                next.push(std::mem::replace(&mut first[point as usize], pair));
            }
            corners.push(pair);
        }
    }
    if next.iter().all(|&p| p == NONE) {
        // One pair per point at most: store them in the order of the points. Points without a
        // triangle get zeros, which no corner reads.
        let coordinates = first
            .iter()
            .flat_map(|&p| if p == NONE { [0.0; 2] } else { pairs[p as usize] })
            .collect();
        return GarmentMaterial { name: name.into(), coordinates, corners: Vec::new() };
    }
    let coordinates = pairs.into_iter().flatten().collect();
    GarmentMaterial { name: name.into(), coordinates, corners }
}

/// The coordinates of every corner, or what is wrong with them.
pub(crate) fn unpack(
    packed: &GarmentMaterial,
    n_points: usize,
    triangles: &[[u32; 3]],
) -> Result<Vec<[[f64; 2]; 3]>, String> {
    let (pairs, rest) = packed.coordinates.as_chunks::<2>();
    if !rest.is_empty() {
        return Err(format!("an odd number of coordinates, {}", packed.coordinates.len()));
    }
    let lookup = |pair: u32| {
        pairs
            .get(pair as usize)
            .copied()
            .ok_or_else(|| format!("corner with pair {pair} of {}", pairs.len()))
    };
    let corners_of = |corners: &[u32; 3]| -> Result<[[f64; 2]; 3], String> {
        Ok([lookup(corners[0])?, lookup(corners[1])?, lookup(corners[2])?])
    };
    if packed.corners.is_empty() {
        if pairs.len() != n_points {
            return Err(format!("{} pairs for {n_points} points", pairs.len()));
        }
        return triangles.iter().map(corners_of).collect();
    }
    let (corners, rest) = packed.corners.as_chunks::<3>();
    if !rest.is_empty() || corners.len() != triangles.len() {
        return Err(format!("{} corners for {} triangles", packed.corners.len(), triangles.len()));
    }
    corners.iter().map(corners_of).collect()
}

fn same_bits(a: [f64; 2], b: [f64; 2]) -> bool {
    a.map(f64::to_bits) == b.map(f64::to_bits)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bits(material: &[[[f64; 2]; 3]]) -> Vec<u64> {
        material.as_flattened().as_flattened().iter().map(|x| x.to_bits()).collect()
    }

    #[test]
    fn without_a_seam_one_pair_per_point() {
        let triangles = [[0, 1, 2], [2, 1, 3]];
        let uv = [[0.0, -0.0], [1.0, 0.0], [0.0, 1.0], [1.0, f64::NAN], [9.0, 9.0]];
        let material = triangles.map(|t| t.map(|p| uv[p as usize]));
        let packed = pack("flag", 5, &triangles, &material);
        assert!(packed.corners.is_empty());
        assert_eq!(packed.coordinates.len(), 10);
        let back = unpack(&packed, 5, &triangles).unwrap();
        assert_eq!(bits(&back), bits(&material));
    }

    #[test]
    fn a_seam_keeps_both_sides() {
        let triangles = [[0, 1, 2], [2, 1, 3], [1, 0, 3]];
        let material = [
            [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
            [[5.0, 1.0], [6.0, 0.0], [6.0, 1.0]],
            [[1.0, 0.0], [0.0, 0.0], [6.0, 1.0]],
        ];
        let packed = pack("tube", 4, &triangles, &material);
        // Points 1 and 2 have two pairs each, 0 and 3 one.
        assert_eq!(packed.coordinates.len(), 12);
        assert_eq!(packed.corners.len(), 9);
        assert_eq!(bits(&unpack(&packed, 4, &triangles).unwrap()), bits(&material));
    }

    #[test]
    fn broken_packing_is_told() {
        let triangles = [[0, 1, 2]];
        let packed = |coordinates: &[f64], corners: &[u32]| GarmentMaterial {
            name: String::new(),
            coordinates: coordinates.to_vec(),
            corners: corners.to_vec(),
        };
        assert!(unpack(&packed(&[0.0; 5], &[]), 3, &triangles).is_err());
        assert!(unpack(&packed(&[0.0; 4], &[]), 3, &triangles).is_err());
        assert!(unpack(&packed(&[0.0; 6], &[0, 1]), 3, &triangles).is_err());
        assert!(unpack(&packed(&[0.0; 6], &[0, 1, 3]), 3, &triangles).is_err());
        assert!(unpack(&packed(&[0.0; 6], &[0, 1, 2]), 3, &triangles).is_ok());
    }
}

//! Wavefront OBJ with exact numbers.

use std::collections::BTreeMap;
use std::io::{self, Write};

use io_mcap::{OwnedGarment, OwnedObstacle, Particle};

use super::{check_finite, check_particles, check_points};

/// Writes garments as groups `g NAME` of one OBJ file: positions `v` (m), material coordinates `vt`
/// (m) for every corner, so that seams survive, and faces `f v/vt`. Numbers are the shortest that
/// read back as the same f64; equal material coordinates of a garment are written once. White space
/// in names becomes `_`.
///
/// # Errors
/// Those of `out`, and `InvalidInput`, before anything is written, for a coordinate that is not
/// finite.
pub fn write_obj(out: &mut impl Write, garments: &[OwnedGarment]) -> io::Result<()> {
    check_finite(garments)?;
    // OBJ counts from 1, through all groups.
    let (mut first_v, mut first_vt) = (1, 1);
    for OwnedGarment { name, points, triangles, material, .. } in garments {
        begin_group(out, name, points)?;
        let mut numbers = BTreeMap::new();
        let mut corners = Vec::with_capacity(3 * material.len());
        for [u, v] in material.as_flattened() {
            let next = numbers.len();
            let number = *numbers.entry([u.to_bits(), v.to_bits()]).or_insert(next);
            if number == next {
                writeln!(out, "vt {u:?} {v:?}")?;
            }
            corners.push(first_vt + number);
        }
        for (t, vt) in triangles.iter().zip(corners.chunks_exact(3)) {
            let [a, b, c] = t.map(|v| first_v + v as usize);
            writeln!(out, "f {a}/{} {b}/{} {c}/{}", vt[0], vt[1], vt[2])?;
        }
        first_v += points.len();
        first_vt += numbers.len();
    }
    Ok(())
}

/// Writes particles as points: `v` (m), then `p` for each.
///
/// # Errors
/// As for [`write_obj`].
pub fn write_fluid_obj(out: &mut impl Write, particles: &[Particle]) -> io::Result<()> {
    check_particles(particles)?;
    for Particle { position: [x, y, z], .. } in particles {
        writeln!(out, "v {x:?} {y:?} {z:?}")?;
    }
    (1..=particles.len()).try_for_each(|k| writeln!(out, "p {k}"))
}

/// Writes obstacles as groups `g NAME` of one OBJ file, with positions `v` (m) and faces `f v`;
/// numbers and names as those of garments.
///
/// # Errors
/// As for [`write_obj`].
pub fn write_obstacles_obj(out: &mut impl Write, obstacles: &[OwnedObstacle]) -> io::Result<()> {
    obstacles.iter().try_for_each(|o| check_points("obstacle", &o.name, &o.points))?;
    let mut first = 1;
    for OwnedObstacle { name, points, triangles, .. } in obstacles {
        begin_group(out, name, points)?;
        for t in triangles {
            let [a, b, c] = t.map(|v| first + v as usize);
            writeln!(out, "f {a} {b} {c}")?;
        }
        first += points.len();
    }
    Ok(())
}

/// The name and the positions of a group.
fn begin_group(out: &mut impl Write, name: &str, points: &[[f64; 3]]) -> io::Result<()> {
    let name: String = name.chars().map(|c| if is_plain(c) { c } else { '_' }).collect();
    writeln!(out, "g {name}")?;
    // Debug, unlike Display, falls back on exponents where plain digits would be many.
    points.iter().try_for_each(|[x, y, z]| writeln!(out, "v {x:?} {y:?} {z:?}"))
}

fn is_plain(c: char) -> bool {
    // A comment would cut the name, a backslash at its end would join the next line.
    !c.is_whitespace() && !c.is_control() && !['#', '\\'].contains(&c)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_name_changes_what_is_read_back() {
        let garments = ["plain", "a # b", "trailing\\", "\\", ""].map(|name| OwnedGarment {
            name: name.into(),
            points: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            triangles: vec![[0, 1, 2]],
            material: vec![[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]],
            color: [1.0; 4],
        });
        let mut bytes = Vec::new();
        write_obj(&mut bytes, &garments).unwrap();
        let file = mesh_core::obj::read(&bytes).unwrap();
        assert_eq!((file.positions.len(), file.triangles.len()), (15, 5));
        assert_eq!(file.groups, ["plain", "a___b", "trailing_", "_", ""]);
    }
}

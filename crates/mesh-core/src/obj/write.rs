//! Writing OBJ: the exact values, so that reading gives the same bits back.

use crate::geometry::{Material2, World3};
use std::collections::BTreeMap;
use std::io::{Error, ErrorKind, Result, Write};

/// Writes positions (m) and triangles as OBJ, with the material coordinates of the corners (m) as
/// texture coordinates if they are given. Numbers are the shortest that read back as the same f64;
/// equal texture coordinates are written once, in order of their first use.
///
/// # Errors
/// Those of `out`, and `InvalidInput`, before anything is written, if a number is not finite, a
/// triangle refers to a vertex that does not exist, or there is not one set of material coordinates
/// per triangle.
pub fn write(
    out: &mut impl Write,
    positions: &[World3],
    triangles: &[[u32; 3]],
    material: Option<&[[Material2; 3]]>,
) -> Result<()> {
    check(positions, triangles, material)?;
    for p in positions {
        writeln!(out, "v {} {} {}", Shortest(p.x), Shortest(p.y), Shortest(p.z))?;
    }
    let Some(material) = material else {
        return triangles
            .iter()
            .try_for_each(|[a, b, c]| writeln!(out, "f {} {} {}", a + 1, b + 1, c + 1));
    };
    let mut numbers = BTreeMap::new();
    let mut corners = Vec::with_capacity(3 * material.len());
    for u in material.iter().flatten() {
        let next = numbers.len() + 1;
        // By bits: zero and negative zero stay apart.
        let number = *numbers.entry((u.x.to_bits(), u.y.to_bits())).or_insert(next);
        if number == next {
            writeln!(out, "vt {} {}", Shortest(u.x), Shortest(u.y))?;
        }
        corners.push(number);
    }
    for (t, vt) in triangles.iter().zip(corners.chunks_exact(3)) {
        let [a, b, c] = t.map(|v| v + 1);
        writeln!(out, "f {a}/{} {b}/{} {c}/{}", vt[0], vt[1], vt[2])?;
    }
    Ok(())
}

fn check(
    positions: &[World3],
    triangles: &[[u32; 3]],
    material: Option<&[[Material2; 3]]>,
) -> Result<()> {
    let invalid = |text: String| Err(Error::new(ErrorKind::InvalidInput, text));
    if let Some(v) = positions.iter().position(|p| !p.iter().all(|c| c.is_finite())) {
        return invalid(format!("position of vertex {v} is not finite"));
    }
    let out_of_range = |t: &[u32; 3]| t.iter().any(|&v| v as usize >= positions.len());
    if let Some(t) = triangles.iter().position(out_of_range) {
        let (n, corners) = (positions.len(), triangles[t]);
        return invalid(format!("triangle {t} is {corners:?}, but there are {n} vertices"));
    }
    let Some(material) = material else { return Ok(()) };
    if material.len() != triangles.len() {
        let (n, m) = (triangles.len(), material.len());
        return invalid(format!("{n} triangles, but material coordinates of {m}"));
    }
    let not_finite = |u: &[Material2; 3]| u.iter().any(|p| !p.iter().all(|c| c.is_finite()));
    if let Some(t) = material.iter().position(not_finite) {
        return invalid(format!("material coordinates of triangle {t} are not finite"));
    }
    Ok(())
}

/// Shows a number with the fewest digits that read back as the same f64.
struct Shortest(f64);

impl std::fmt::Display for Shortest {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let size = self.0.abs();
        // Plain notation would write 300 zeros for the smallest numbers.
        if size == 0.0 || (1e-5..1e16).contains(&size) {
            write!(f, "{}", self.0)
        } else {
            write!(f, "{:e}", self.0)
        }
    }
}

//! Binary PLY.

use std::io::{self, Write};

use io_mcap::OwnedGarment;

use super::check_finite;

/// Writes garments as one binary little-endian PLY file: vertices `x y z` (double, m); faces with
/// `vertex_indices`, `texcoord` (float, six per triangle: the material coordinates of its corners,
/// m, by the name that MeshLab reads) and `garment`, the number of the garment in the comments of
/// the header.
///
/// # Errors
/// Those of `out`, and `InvalidInput`, before anything is written, for a coordinate that is not
/// finite.
pub fn write_ply(out: &mut impl Write, garments: &[OwnedGarment]) -> io::Result<()> {
    check_finite(garments)?;
    let n_points: usize = garments.iter().map(|g| g.points.len()).sum();
    let n_triangles: usize = garments.iter().map(|g| g.triangles.len()).sum();
    writeln!(out, "ply\nformat binary_little_endian 1.0")?;
    for (k, garment) in garments.iter().enumerate() {
        let name: String = garment.name.chars().filter(|c| !c.is_control()).collect();
        writeln!(out, "comment garment {k} {name}")?;
    }
    writeln!(out, "element vertex {n_points}")?;
    for axis in ["x", "y", "z"] {
        writeln!(out, "property double {axis}")?;
    }
    writeln!(out, "element face {n_triangles}")?;
    writeln!(out, "property list uchar int vertex_indices")?;
    writeln!(out, "property list uchar float texcoord")?;
    writeln!(out, "property int garment\nend_header")?;
    for x in garments.iter().flat_map(|g| g.points.as_flattened()) {
        out.write_all(&x.to_le_bytes())?;
    }
    let mut first = 0;
    for (k, garment) in (0i32..).zip(garments) {
        for (t, u) in garment.triangles.iter().zip(&garment.material) {
            out.write_all(&[3])?;
            for v in t {
                out.write_all(&(first + v).to_le_bytes())?;
            }
            out.write_all(&[6])?;
            for c in u.as_flattened() {
                out.write_all(&(*c as f32).to_le_bytes())?;
            }
            out.write_all(&k.to_le_bytes())?;
        }
        first += garment.points.len() as u32;
    }
    Ok(())
}

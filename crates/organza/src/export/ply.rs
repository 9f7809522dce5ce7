//! Binary PLY.

use std::io::{self, Write};

use io_mcap::{OwnedGarment, OwnedObstacle, Particle};

use super::{check_finite, check_particles, check_points};

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
    let parts: Vec<Part<'_>> =
        garments.iter().map(|g| (&*g.name, &*g.points, &*g.triangles)).collect();
    begin(out, "garment", &parts, "property list uchar float texcoord\n")?;
    let mut first = 0;
    for (k, garment) in (0i32..).zip(garments) {
        for (t, u) in garment.triangles.iter().zip(&garment.material) {
            corners(out, t, first)?;
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

/// Writes obstacles as one binary little-endian PLY file: as garments, but without `texcoord`, and
/// with `obstacle` in the place of `garment`.
///
/// # Errors
/// As for [`write_ply`].
pub fn write_obstacles_ply(out: &mut impl Write, obstacles: &[OwnedObstacle]) -> io::Result<()> {
    obstacles.iter().try_for_each(|o| check_points("obstacle", &o.name, &o.points))?;
    let parts: Vec<Part<'_>> =
        obstacles.iter().map(|o| (&*o.name, &*o.points, &*o.triangles)).collect();
    begin(out, "obstacle", &parts, "")?;
    let mut first = 0;
    for (k, obstacle) in (0i32..).zip(obstacles) {
        for t in &obstacle.triangles {
            corners(out, t, first)?;
            out.write_all(&k.to_le_bytes())?;
        }
        first += obstacle.points.len() as u32;
    }
    Ok(())
}

/// Writes particles as one binary little-endian PLY file of vertices: `x y z` (double, m), `vx vy vz`
/// and effective `speed` (float, m/s), `density` (float, kg/m³), `id` (uint), `state` (uchar: 0 moves
/// freely, 1 is in transition, 2 rests).
///
/// # Errors
/// As for [`write_ply`].
pub fn write_fluid_ply(out: &mut impl Write, particles: &[Particle]) -> io::Result<()> {
    check_particles(particles)?;
    writeln!(out, "ply\nformat binary_little_endian 1.0\nelement vertex {}", particles.len())?;
    for property in ["double x", "double y", "double z", "float vx", "float vy", "float vz"] {
        writeln!(out, "property {property}")?;
    }
    writeln!(out, "property float speed\nproperty float density")?;
    writeln!(out, "property uint id\nproperty uchar state\nend_header")?;
    for p in particles {
        p.position.iter().try_for_each(|x| out.write_all(&x.to_le_bytes()))?;
        let [vx, vy, vz] = p.velocity;
        let singles = [vx, vy, vz, p.speed, p.density];
        singles.iter().try_for_each(|x| out.write_all(&x.to_le_bytes()))?;
        out.write_all(&p.id.to_le_bytes())?;
        out.write_all(&[p.state])?;
    }
    Ok(())
}

/// Name, points and triangles of a part.
type Part<'a> = (&'a str, &'a [[f64; 3]], &'a [[u32; 3]]);

/// The header and the vertices of a file whose parts are each a `kind`; `more` are properties of
/// faces before the number of the part.
fn begin(out: &mut impl Write, kind: &str, parts: &[Part<'_>], more: &str) -> io::Result<()> {
    let n_points: usize = parts.iter().map(|(_, points, _)| points.len()).sum();
    let n_triangles: usize = parts.iter().map(|(.., triangles)| triangles.len()).sum();
    writeln!(out, "ply\nformat binary_little_endian 1.0")?;
    for (k, (name, ..)) in parts.iter().enumerate() {
        let name: String = name.chars().filter(|c| !c.is_control()).collect();
        writeln!(out, "comment {kind} {k} {name}")?;
    }
    writeln!(out, "element vertex {n_points}")?;
    for axis in ["x", "y", "z"] {
        writeln!(out, "property double {axis}")?;
    }
    writeln!(out, "element face {n_triangles}")?;
    writeln!(out, "property list uchar int vertex_indices")?;
    writeln!(out, "{more}property int {kind}\nend_header")?;
    for x in parts.iter().flat_map(|(_, points, _)| points.as_flattened()) {
        out.write_all(&x.to_le_bytes())?;
    }
    Ok(())
}

/// The vertices of a face, counted from `first` on.
fn corners(out: &mut impl Write, triangle: &[u32; 3], first: u32) -> io::Result<()> {
    out.write_all(&[3])?;
    triangle.iter().try_for_each(|v| out.write_all(&(first + v).to_le_bytes()))
}

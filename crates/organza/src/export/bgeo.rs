//! Houdini's classic binary geometry as Partio reads it, which SPlisHSPlasH loads particles from.

use std::io::{self, Write};

use io_mcap::Particle;

use super::check_particles;

/// Types of attributes.
const FLOAT: i32 = 0;
const INT: i32 = 1;
const VECTOR: i32 = 5;

/// Attributes besides the position: name, number of values, type.
const ATTRIBUTES: [(&str, u16, i32); 5] = [
    ("velocity", 3, VECTOR),
    ("id", 1, INT),
    ("density", 1, FLOAT),
    ("speed", 1, FLOAT),
    ("state", 1, INT),
];

/// Writes particles as a `bgeo` file of version 5, uncompressed, in single precision: positions (m),
/// `velocity` (m/s), `id`, `density` (kg/m³), effective `speed` (m/s) and `state` (0 moves freely, 1 is in
/// transition, 2 rests). Numbers above 2³¹ − 1 wrap around, as the format has no larger ones.
///
/// # Errors
/// Those of `out`, and `InvalidInput`, before anything is written, for a coordinate that is not
/// finite.
pub fn write_fluid_bgeo(out: &mut impl Write, particles: &[Particle]) -> io::Result<()> {
    check_particles(particles)?;
    let mut int = |n: i32| out.write_all(&n.to_be_bytes());
    int(i32::from_be_bytes(*b"Bgeo"))?;
    out.write_all(b"V")?;
    let mut int = |n: i32| out.write_all(&n.to_be_bytes());
    // Points; then primitives, groups of points and of primitives; attributes of points, vertices,
    // primitives and of the whole.
    int(5)?;
    int(particles.len() as i32)?;
    for n in [0, 0, 0, ATTRIBUTES.len() as i32, 0, 0, 0] {
        int(n)?;
    }
    for (name, size, kind) in ATTRIBUTES {
        out.write_all(&(name.len() as u16).to_be_bytes())?;
        out.write_all(name.as_bytes())?;
        out.write_all(&size.to_be_bytes())?;
        out.write_all(&kind.to_be_bytes())?;
        // Defaults, all of which are zero.
        out.write_all(&vec![0; 4 * usize::from(size)])?;
    }
    for p in particles {
        let [x, y, z] = p.position.map(|x| x as f32);
        let singles = |out: &mut dyn Write, list: &[f32]| {
            list.iter().try_for_each(|f| out.write_all(&f.to_be_bytes()))
        };
        singles(out, &[x, y, z, 1.0])?;
        singles(out, &p.velocity)?;
        out.write_all(&p.id.to_be_bytes())?;
        singles(out, &[p.density, p.speed])?;
        out.write_all(&i32::from(p.state).to_be_bytes())?;
    }
    // Nothing more follows.
    out.write_all(&[0x00, 0xff])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_as_long_and_as_ordered_as_its_header_says() {
        let particle = Particle {
            id: 9,
            position: [1.0, 2.0, -0.5],
            velocity: [0.25, 0.0, 0.0],
            speed: 0.125,
            density: 1000.0,
            state: 2,
        };
        let mut file = Vec::new();
        write_fluid_bgeo(&mut file, &[particle; 4]).unwrap();
        let attributes: usize = ATTRIBUTES.iter().map(|a| 8 + a.0.len() + 4 * a.1 as usize).sum();
        let (header, point) = (5 + 4 * 9, 4 * (4 + 7));
        assert_eq!(file.len(), header + attributes + 4 * point + 2);
        assert_eq!(&file[..9], b"BgeoV\0\0\0\x05");
        let at = header + attributes + 3 * point;
        let float = |k: usize| f32::from_be_bytes(file[at + 4 * k..][..4].try_into().unwrap());
        assert_eq!([0, 1, 2, 3, 4].map(float), [1.0, 2.0, -0.5, 1.0, 0.25]);
        assert_eq!(file[at + 28..][..4], 9u32.to_be_bytes());
        assert_eq!([float(8), float(9)], [1000.0, 0.125]);
        let broken = Particle { position: [f64::NAN; 3], ..particle };
        assert!(write_fluid_bgeo(&mut Vec::new(), &[particle, broken]).is_err());
    }
}

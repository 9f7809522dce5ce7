//! Particles of a fluid, packed into the points of a cloud.

use prost_types::Timestamp;

use crate::encode::WORLD;
use crate::frame::Particle;
use crate::proto::{Doubles, PackedElementField, PointCloud, Pose};

/// Types of numbers as `foxglove.PackedElementField` counts them, with their sizes (bytes).
const UINT8: (i32, u32) = (1, 1);
const UINT32: (i32, u32) = (5, 4);
const FLOAT32: (i32, u32) = (7, 4);
const FLOAT64: (i32, u32) = (8, 8);

/// Names and types of the numbers of a point, in the order in which they are packed.
const FIELDS: [(&str, (i32, u32)); 10] = [
    ("x", FLOAT64),
    ("y", FLOAT64),
    ("z", FLOAT64),
    ("vx", FLOAT32),
    ("vy", FLOAT32),
    ("vz", FLOAT32),
    ("speed", FLOAT32),
    ("density", FLOAT32),
    ("id", UINT32),
    ("state", UINT8),
];

/// Size of a point (bytes).
const STRIDE: usize = 49;

/// The fields as the message describes them.
fn fields() -> Vec<PackedElementField> {
    let mut offset = 0;
    let field = |&(name, (r#type, size)): &(&str, (i32, u32))| {
        offset += size;
        PackedElementField { name: name.into(), offset: offset - size, r#type }
    };
    FIELDS.iter().map(field).collect()
}

/// The cloud that shows `particles`.
pub(crate) fn pack(particles: &[Particle], timestamp: Timestamp) -> PointCloud {
    let mut data = Vec::with_capacity(STRIDE * particles.len());
    for p in particles {
        p.position.iter().for_each(|x| data.extend(x.to_le_bytes()));
        p.velocity.iter().for_each(|v| data.extend(v.to_le_bytes()));
        data.extend(p.speed.to_le_bytes());
        data.extend(p.density.to_le_bytes());
        data.extend(p.id.to_le_bytes());
        data.push(p.state);
    }
    let still = Pose {
        position: Some(Doubles([0.0; 3])),
        orientation: Some(Doubles([0.0, 0.0, 0.0, 1.0])),
    };
    PointCloud {
        timestamp: Some(timestamp),
        frame_id: WORLD.into(),
        pose: Some(still),
        point_stride: STRIDE as u32,
        fields: fields(),
        data,
    }
}

/// The particles of a cloud, or what is wrong with it.
pub(crate) fn unpack(cloud: &PointCloud) -> Result<Vec<Particle>, String> {
    if cloud.point_stride as usize != STRIDE || cloud.fields != fields() {
        return Err(format!(
            "points of {} bytes with other numbers than are written here",
            cloud.point_stride
        ));
    }
    let (points, rest) = cloud.data.as_chunks::<STRIDE>();
    if !rest.is_empty() {
        return Err(format!("{} bytes, not a multiple of {STRIDE}", cloud.data.len()));
    }
    Ok(points.iter().map(particle).collect())
}

fn particle(bytes: &[u8; STRIDE]) -> Particle {
    let f64_at = |at: usize| f64::from_le_bytes(std::array::from_fn(|k| bytes[at + k]));
    let u32_at = |at: usize| u32::from_le_bytes(std::array::from_fn(|k| bytes[at + k]));
    let f32_at = |at: usize| f32::from_bits(u32_at(at));
    Particle {
        position: [f64_at(0), f64_at(8), f64_at(16)],
        velocity: [f32_at(24), f32_at(28), f32_at(32)],
        speed: f32_at(36),
        density: f32_at(40),
        id: u32_at(44),
        state: bytes[48],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stride_is_the_sum_of_the_fields() {
        let size: u32 = FIELDS.iter().map(|(_, (_, size))| size).sum();
        assert_eq!(size as usize, STRIDE);
    }

    #[test]
    fn other_clouds_are_refused() {
        let particle = Particle { id: 7, state: 2, ..Particle::default() };
        let good = pack(&[particle; 3], Timestamp::default());
        assert_eq!(unpack(&good), Ok(vec![particle; 3]));
        let mut bad = good.clone();
        bad.data.pop();
        assert!(unpack(&bad).unwrap_err().contains("146 bytes"));
        let mut bad = good.clone();
        bad.fields[3].name = "intensity".into();
        assert!(unpack(&bad).is_err());
        let bad = PointCloud { point_stride: 0, ..good };
        assert!(unpack(&bad).is_err());
    }
}

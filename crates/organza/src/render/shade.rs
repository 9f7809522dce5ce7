//! Light on cloth.

use nalgebra::Vector3;

use super::backdrop;
use super::colour::{Decoder, Light, add, mix, scale, smoothstep, times};
use super::lens::Lens;
use super::project::Cloth;
use super::shadow::Shadow;

/// The lights of a picture, in eye space. They hang on the eye, so that every view is lit well.
pub(super) struct Lights {
    /// Directions towards the lights.
    key: Vector3<f64>,
    fill: Vector3<f64>,
    up: Vector3<f64>,
    shadow: Option<Shadow>,
}

/// Key: from the left, above and before the scene, so that it rakes across folds.
const KEY: [f64; 3] = [-0.70, 0.50, 0.46];
const FILL: [f64; 3] = [0.85, 0.10, 0.52];
const KEY_LIGHT: Light = [1.12, 1.07, 0.98];
const FILL_LIGHT: Light = [0.15, 0.17, 0.21];
const SKY_LIGHT: Light = [0.29, 0.32, 0.36];
const FLOOR_LIGHT: Light = [0.15, 0.14, 0.13];
/// Part of the key light that comes through the cloth.
const THROUGH: f32 = 0.16;
const RIM: f32 = 0.16;
/// Strength of the broad shine of woven cloth.
const SHINE: f32 = 0.07;
/// Width of drawn edges (px), and the part of the light they take.
const WIRE_PX: f64 = 1.0;
const WIRE_DARKNESS: f32 = 0.62;

impl Lights {
    /// Direction to the key light in eye space.
    pub(super) fn key() -> Vector3<f64> {
        Vector3::from(KEY).normalize()
    }

    pub(super) fn new(lens: &Lens, shadow: Option<Shadow>) -> Self {
        Self { key: Self::key(), fill: Vector3::from(FILL).normalize(), up: lens.up, shadow }
    }

    pub(super) fn shadow(&self) -> Option<&Shadow> {
        self.shadow.as_ref()
    }

    /// Light from triangle `t` of `cloth` at a place in the picture (px).
    pub(super) fn shade(
        &self,
        lens: &Lens,
        decoder: &Decoder,
        cloth: &Cloth<'_>,
        t: usize,
        at: [f64; 2],
    ) -> Light {
        let Some(corners) = cloth.corners(t) else { return backdrop::light(lens.size, at) };
        let spot = Spot::new(lens, corners, cloth.normals(t), at);
        let albedo = cloth.albedo(decoder, t, spot.weights, spot.front_seen);
        let (matt, shine) = self.gather(&spot);
        let light = add(times(albedo, matt), [shine; 3]);
        let light = scale(light, 1.0 - if cloth.surface.wireframe { spot.wire() } else { 0.0 });
        light.map(|x| x.clamp(0.0, 1.0))
    }

    /// Light that a white matt surface would send to the eye, and the shine on top of any colour.
    fn gather(&self, spot: &Spot) -> (Light, f32) {
        let n = &spot.normal;
        let key = n.dot(&self.key) as f32;
        let visible = match &self.shadow {
            Some(shadow) if key > 0.0 => shadow.lit(spot.lifted, &spot.face),
            _ => 1.0,
        };
        let direct = if key > 0.0 { key * visible } else { -key * THROUGH };
        let fill = (n.dot(&self.fill) as f32 * 0.6 + 0.4).max(0.0);
        let sky = n.dot(&self.up) as f32 * 0.5 + 0.5;
        let graze = 1.0 - (n.dot(&spot.to_eye) as f32).clamp(0.0, 1.0);
        let rim = RIM * graze * graze * graze * (0.35 + 0.65 * sky);
        let halfway = (self.key + spot.to_eye).normalize();
        let gloss = (n.dot(&halfway) as f32).max(0.0).powi(10);
        let shine = SHINE * gloss * visible * key.max(0.0) + 0.25 * rim;
        let mut light = mix(FLOOR_LIGHT, SKY_LIGHT, smoothstep(0.0, 1.0, sky));
        light = add(light, scale(KEY_LIGHT, direct));
        light = add(light, scale(FILL_LIGHT, fill));
        (add(light, [rim; 3]), shine)
    }
}

/// A place on a triangle as seen in one pixel.
struct Spot {
    /// Weights of the corners there, none negative.
    weights: [f64; 3],
    front_seen: bool,
    /// Unit normals of the smoothed surface and of the triangle on the side that is seen.
    normal: Vector3<f64>,
    face: Vector3<f64>,
    to_eye: Vector3<f64>,
    /// The place, moved onto the smooth surface (Hanika2021): a flat facet would throw its shadow on
    /// itself where the light grazes the smooth surface it stands for.
    lifted: Vector3<f64>,
    /// For each side: distance from the pixel's centre, and of the opposite corner (px).
    side_px: [f64; 3],
    height_px: [f64; 3],
}

impl Spot {
    fn new(
        lens: &Lens,
        corners: [Vector3<f64>; 3],
        normals: [Vector3<f64>; 3],
        [column, row]: [f64; 2],
    ) -> Self {
        let [a, b, c] = corners.map(|corner| lens.project(corner));
        // Sides as homogeneous lines of the picture: they need no clipping, and their values at a
        // pixel are the perspective weights of the opposite corners.
        let sides = [b.cross(&c), c.cross(&a), a.cross(&b)];
        let determinant = a.dot(&sides[0]);
        let here = Vector3::new(column, row, 1.0);
        let values = sides.map(|side| side.dot(&here) * determinant.signum());
        // Where only samples beside the centre are covered, the centre may lie outside.
        let inside = values.map(|value| value.max(0.0));
        let sum: f64 = inside.iter().sum();
        let weights = inside.map(|value| if sum > 0.0 { value / sum } else { 1.0 / 3.0 });
        let place = corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2];
        let to_eye = super::viewpoint::direction(-place).unwrap_or(Vector3::z());

        let face = (corners[1] - corners[0]).cross(&(corners[2] - corners[0]));
        let face = super::viewpoint::direction(face).unwrap_or(to_eye);
        let front_seen = face.dot(&(-corners[0])) >= 0.0;
        let turn = if front_seen { 1.0 } else { -1.0 };
        let face = face * turn;
        let smooth =
            (normals[0] * weights[0] + normals[1] * weights[1] + normals[2] * weights[2]) * turn;
        let smooth = super::viewpoint::direction(smooth).unwrap_or(face);
        // A smooth normal may lean away from the eye near an outline; the seen side does not.
        let lean = (0.05 - smooth.dot(&to_eye)).max(0.0);
        let normal = (smooth + to_eye * lean).normalize();

        let mut lifted = place;
        for i in 0..3 {
            let below = ((place - corners[i]).dot(&normals[i]) * turn).min(0.0);
            lifted -= normals[i] * (turn * below * weights[i]);
        }
        let length = sides.map(|side| (side.x * side.x + side.y * side.y).sqrt());
        let depths = [a.z, b.z, c.z];
        Self {
            weights,
            front_seen,
            normal,
            face,
            to_eye,
            lifted,
            side_px: std::array::from_fn(|i| values[i].abs() / length[i]),
            height_px: std::array::from_fn(|i| {
                if depths[i] > 0.0 {
                    determinant.abs() / (depths[i] * length[i])
                } else {
                    f64::INFINITY
                }
            }),
        }
    }

    /// Part of the light that the drawn edges take here.
    fn wire(&self) -> f32 {
        let nearest = self.side_px.iter().fold(f64::INFINITY, |a, &b| a.min(b));
        let height = self.height_px.iter().fold(f64::INFINITY, |a, &b| a.min(b));
        let cover = (WIRE_PX / 2.0 + 0.5 - nearest).clamp(0.0, 1.0) as f32;
        // Triangles of few pixels would be all edge: their edges fade, and the shading stays.
        WIRE_DARKNESS * cover * smoothstep(0.5, 6.0, height as f32)
    }
}

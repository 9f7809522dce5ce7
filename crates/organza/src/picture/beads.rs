//! Particles as beads.

use std::io::{Read, Seek};

use io_mcap::{Particle, Recording};
use mesh_core::generate;

use super::Colouring;
use crate::record::{FLUID_SPACING, RunError};
use crate::render::{Paint, Rgb, Surface, VIRIDIS};

/// Colours of particles that move freely, are in transition, and rest, as in Manteaux2013 Fig. 1.
const STATES: [Rgb; 3] = [[58, 116, 204], [64, 172, 96], [206, 66, 56]];
/// Particles above which beads have eight sides instead of twenty, to save memory.
const MANY: usize = 100_000;

/// What beads look like in a whole recording, so that its pictures fit together.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Beads {
    /// Half the distance of particles at rest (m).
    radius: f64,
    /// Greatest speed of a particle (m/s).
    fastest: f32,
}

/// A surface of beads.
#[derive(Debug, Default)]
pub(super) struct OwnedBeads {
    points: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
    colours: Vec<Rgb>,
}

impl Beads {
    /// Beads for the particles of a recording, those of no size where it has none.
    ///
    /// # Errors
    /// The recording does not tell the distance of particles.
    pub(super) fn of<R: Read + Seek>(recording: &Recording<R>) -> Result<Beads, RunError> {
        let spacing = recording.metadata().get(FLUID_SPACING);
        let radius = spacing.and_then(|text| text.parse::<f64>().ok()).map_or(0.0, |s| 0.5 * s);
        Ok(Beads { radius, fastest: 0.0 })
    }

    /// Takes note of the speeds of a frame.
    pub(super) fn note(&mut self, particles: &[Particle]) {
        self.fastest = particles.iter().map(|p| p.speed).fold(self.fastest, f32::max);
    }

    /// The particles of a frame.
    pub(super) fn draw(&self, particles: &[Particle], colouring: Colouring) -> OwnedBeads {
        let bead = if particles.len() > MANY { octahedron() } else { icosahedron() };
        let mut beads = OwnedBeads::default();
        for particle in particles {
            let first = beads.points.len() as u32;
            let [x, y, z] = particle.position;
            let r = self.radius;
            beads.points.extend(bead.0.iter().map(|p| [x + r * p[0], y + r * p[1], z + r * p[2]]));
            beads.triangles.extend(bead.1.iter().map(|t| t.map(|v| v + first)));
            let colour = match colouring {
                Colouring::Speed => {
                    VIRIDIS.colour_in(particle.speed.into(), 0.0, self.fastest.into())
                }
                _ => STATES[usize::from(particle.state).min(STATES.len() - 1)],
            };
            beads.colours.resize(beads.triangles.len(), colour);
        }
        beads
    }
}

impl OwnedBeads {
    pub(super) fn surface(&self) -> Surface<'_> {
        Surface {
            paint: Paint::Triangles(&self.colours),
            ..Surface::new(&self.points, &self.triangles)
        }
    }
}

type Shape = (Vec<[f64; 3]>, Vec<[u32; 3]>);

fn icosahedron() -> Shape {
    let unit = generate::sphere(1.0, 0).expect("a sphere of radius 1");
    (unit.positions.iter().map(|x| [x.x, x.y, x.z]).collect(), unit.triangles)
}

fn octahedron() -> Shape {
    let axis = |k: usize, sign: f64| std::array::from_fn(|i| if i == k { sign } else { 0.0 });
    let points = (0..3).flat_map(|k| [axis(k, 1.0), axis(k, -1.0)]).collect();
    // Corners 2k and 2k + 1 lie on axis k; a corner of each axis spans a face.
    let faces = (0..8u32).map(|bits| {
        let corner = |k: u32| 2 * k + (bits >> k & 1);
        let [a, b, c] = [corner(0), corner(1), corner(2)];
        // Every negative corner turns the face over.
        if bits.count_ones() % 2 == 0 { [a, b, c] } else { [a, c, b] }
    });
    (points, faces.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn beads_look_outside_and_have_their_colours() {
        for (points, triangles) in [icosahedron(), octahedron()] {
            for t in &triangles {
                let [a, b, c] = t.map(|v| nalgebra::Vector3::from(points[v as usize]));
                assert!((b - a).cross(&(c - a)).dot(&(a + b + c)) > 0.0, "{t:?}");
                assert!((a.norm() - 1.0).abs() < 1e-12);
            }
        }
        let particle = |state, speed| Particle { state, speed, ..Particle::default() };
        let particles = [particle(0, 2.0), particle(1, 0.5), particle(2, 0.0)];
        let mut beads = Beads { radius: 0.1, fastest: 0.0 };
        beads.note(&particles);
        let drawn = beads.draw(&particles, Colouring::Plain);
        assert_eq!((drawn.points.len(), drawn.triangles.len()), (36, 60));
        assert_eq!([0, 20, 40].map(|t| drawn.colours[t]), STATES);
        let by_speed = beads.draw(&particles, Colouring::Speed);
        assert_eq!(by_speed.colours[0], VIRIDIS.colour(1.0));
        assert_eq!(by_speed.colours[59], VIRIDIS.colour(0.0));
    }
}

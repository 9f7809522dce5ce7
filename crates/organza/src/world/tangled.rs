//! What the world does about cloth that passes through something.

use super::World;
use crate::contact::{Crossings, contour_length};
use mesh_core::World3;

/// How often in a frame obstacles let cloth through where it is caught.
const MAX_YIELDS: usize = 12;
/// Radius of the first such place in longest edges around it (1), and how it grows from one to the
/// next.
const YIELD_RADIUS: f64 = 1.5;
const YIELD_GROWTH: f64 = 1.3;

/// Cloth that passes through something.
#[derive(Debug, Default)]
pub(super) struct Tangled {
    /// Whether any did at the end of the last frame, or does since.
    pub(super) is_so: bool,
    /// Whether untangling was on in the last frame.
    pub(super) was_at_work: bool,
    /// Where obstacles let cloth through in this frame: centre and radius (m).
    pub(super) yielding: Vec<(World3, f64)>,
    /// What the user should know of this frame.
    pub(super) warnings: Vec<String>,
}

impl Tangled {
    /// Whether the contact has to know.
    pub(super) fn matters(&self) -> bool {
        self.is_so || !self.yielding.is_empty()
    }
}

/// A place in words.
fn at(place: &World3) -> String {
    format!("({:.4}, {:.4}, {:.4}) m", place.x, place.y, place.z)
}

impl World {
    /// Takes note of what passes through what at the end of the last frame. All that untangling knows
    /// follows from it.
    ///
    /// In the initial state, which was made by hand, vertices may lie exactly in other triangles; nothing
    /// passes through anything then, but where a contour is, it is no less tangled.
    pub(crate) fn note_tangles(&mut self) {
        if self.contact.is_some() {
            // As many obstacles as were counted when the world was built are not too many.
            let _ = self.bodies.update(&self.obstacles, self.time());
        }
        let crossings = self.crossings(self.frame);
        self.note_crossings(crossings.as_ref());
        if self.frame == 0 && self.contour_length(0) > 0.0 {
            self.tangled.is_so = true;
        }
    }

    /// The same, with what was found.
    pub(super) fn note_crossings(&mut self, crossings: Option<&Crossings>) {
        let (was, is_so) = (self.tangled.matters(), crossings.is_some());
        let yielded = !self.tangled.yielding.is_empty();
        if yielded || (is_so && !was) {
            self.prepared = None;
        }
        self.tangled.is_so = is_so;
        self.tangled.yielding.clear();
    }

    /// Warns of a tangle.
    pub(super) fn tangle_warning(what: &str, crossings: &Crossings) -> String {
        let with = if crossings.with_obstacle { " with an obstacle" } else { "" };
        format!(
            "{what}: {} edges pass through triangles, the first{with} at {}; they are led apart",
            crossings.n,
            at(&crossings.place)
        )
    }

    /// Lets cloth through obstacles around a place where it is caught (m), for the rest of the frame;
    /// false if that was done too often already, or there are none.
    pub(super) fn yield_at(&mut self, place: World3) -> bool {
        let n = self.tangled.yielding.len();
        if n == MAX_YIELDS || self.bodies.surface.is_none() {
            return false;
        }
        let mesh = &self.cloth.mesh;
        let x = &self.cloth.x;
        let distance = |t: &[u32; 3]| {
            let corners = t.iter().map(|&v| (x[v as usize] - place).norm());
            corners.fold(f64::INFINITY, f64::min)
        };
        let nearest = mesh.triangles().iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let Some(&[a, b, c]) = nearest else { return false };
        let length = |i: u32, j: u32| (x[i as usize] - x[j as usize]).norm();
        let longest = length(a, b).max(length(b, c)).max(length(c, a));
        let radius = longest * YIELD_RADIUS * YIELD_GROWTH.powi(n as i32);
        self.tangled.yielding.push((place, radius));
        self.tangled.warnings.push(format!(
            "cloth has no room between obstacles or handles at {}: obstacles let it through there",
            at(&place)
        ));
        self.prepared = None;
        true
    }

    /// Total length of the contours along which cloth passes through itself or through obstacles at
    /// the end of a frame (m); 0 without contact.
    pub fn contour_length(&self, frame: u64) -> f64 {
        let Some(settings) = self.contact else { return 0.0 };
        let time = frame as f64 * self.frame_s;
        let obstacles = self.bodies.surface.as_ref();
        contour_length(&self.cloth, obstacles, settings.self_contact, time).unwrap_or(0.0)
    }
}

//! The search for a separating direction: the walk of Gilbert1988 towards the point of a convex hull
//! that is nearest to the origin.
//!
//! Nothing here has to be right to the last digit. A bad direction fails its proof, and the interval
//! becomes shorter.

use mesh_core::World3;

/// Up to four points of the hull: the corners of the feature that is nearest to the origin.
pub(super) struct Simplex {
    corners: [World3; 4],
    n: usize,
    nearest: World3,
}

impl Simplex {
    /// The simplex of one point.
    pub(super) fn start(corner: World3) -> Simplex {
        Simplex { corners: [corner; 4], n: 1, nearest: corner }
    }

    /// The direction of its nearest point from the origin, unless that is the origin.
    #[inline]
    pub(super) fn direction(&self) -> Option<World3> {
        let largest = self.nearest.amax();
        (largest > 0.0 && largest.is_finite()).then_some(self.nearest)
    }

    /// Adds a corner and keeps what supports the nearest point. False if it is in already, or if the
    /// origin is now inside.
    pub(super) fn add(&mut self, corner: World3) -> bool {
        if self.corners[..self.n].contains(&corner) {
            return false;
        }
        self.corners[self.n] = corner;
        let [a, b, c, d] = self.corners;
        let feature = match self.n + 1 {
            2 => segment(a, b),
            3 => triangle(a, b, c),
            _ => match tetrahedron(a, b, c, d) {
                Some(feature) => feature,
                None => return false,
            },
        };
        self.corners = feature.corners;
        self.n = feature.n;
        self.nearest = feature.nearest;
        true
    }
}

/// The nearest feature of a simplex.
struct Feature {
    corners: [World3; 4],
    n: usize,
    nearest: World3,
}

fn vertex(a: World3) -> Feature {
    Feature { corners: [a; 4], n: 1, nearest: a }
}

fn segment(a: World3, b: World3) -> Feature {
    let e = b - a;
    let (from, to) = (-a.dot(&e), b.dot(&e));
    if from <= 0.0 {
        vertex(a)
    } else if to <= 0.0 {
        vertex(b)
    } else {
        // (e × a) × e: its error does not grow with the length of the edge.
        let nearest = e.cross(&a).cross(&e) / e.norm_squared();
        Feature { corners: [a, b, a, a], n: 2, nearest }
    }
}

fn triangle(a: World3, b: World3, c: World3) -> Feature {
    let normal = (b - a).cross(&(c - a));
    // Whether the origin lies on the inner side of an edge, within the plane.
    let inside = |p: &World3, q: &World3| p.cross(q).dot(&normal) > 0.0;
    if inside(&a, &b) && inside(&b, &c) && inside(&c, &a) {
        // Any corner gives the height; the nearest gives it best.
        let corner =
            [b, c].iter().fold(a, |s, p| if p.norm_squared() < s.norm_squared() { *p } else { s });
        let nearest = normal * (normal.dot(&corner) / normal.norm_squared());
        return Feature { corners: [a, b, c, a], n: 3, nearest };
    }
    nearest_of([segment(a, b), segment(b, c), segment(c, a)])
}

fn tetrahedron(a: World3, b: World3, c: World3, d: World3) -> Option<Feature> {
    let faces = [[a, b, c, d], [a, b, d, c], [a, c, d, b], [b, c, d, a]];
    let mut best: Option<Feature> = None;
    for [p, q, r, opposite] in faces {
        let normal = (q - p).cross(&(r - p));
        // Only faces that have the origin on their outer side.
        if normal.dot(&p) * normal.dot(&(opposite - p)) >= 0.0 {
            let feature = triangle(p, q, r);
            if best
                .as_ref()
                .is_none_or(|b| feature.nearest.norm_squared() < b.nearest.norm_squared())
            {
                best = Some(feature);
            }
        }
    }
    best
}

fn nearest_of(features: [Feature; 3]) -> Feature {
    let [first, second, third] = features;
    let nearer = |f: Feature, g: Feature| {
        if g.nearest.norm_squared() < f.nearest.norm_squared() { g } else { f }
    };
    nearer(nearer(first, second), third)
}

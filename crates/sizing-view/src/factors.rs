//! View factors of a whole cloth: Eq. (2)–(4), and what the picture resolves.

use crate::error::{ViewError, check};
use crate::frustum::{Frustum, Place};
use crate::screen::{dominates, most_pixels, screen_gradient, square};
use crate::settings::ViewSettings;
use crate::silhouette;
use crate::window::Sample;
use mesh_core::geometry::{gradient, inverse_edges};
use mesh_core::{ClothState, TriangleId, World3, par};
use nalgebra::Matrix2;

/// What one camera wants of a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Wish {
    triangle: u32,
    /// w ṽ.
    pub(crate) factor: f64,
    /// w S / ℓ_min: its square is the finest metric that the picture shows (1/m).
    pub(crate) finest: Matrix2<f64>,
}

/// Bounds nothing.
const UNBOUNDED: Matrix2<f64> = Matrix2::new(f64::INFINITY, 0.0, 0.0, f64::INFINITY);

impl Wish {
    /// True if this wish makes another one of the same triangle superfluous.
    fn covers(&self, other: &Wish) -> bool {
        let unbounded = !self.finest.sum().is_finite();
        self.factor >= other.factor && (unbounded || dominates(&self.finest, &other.finest))
    }
}

/// The view factor of every triangle of a cloth for the cameras of a [`window`](crate::window()),
/// with the metric that the picture resolves.
///
/// It belongs to the state of the mesh that it was made from: after an edit, make a new one.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewFactors {
    /// v of every triangle, after the silhouette rule.
    factors: Vec<f64>,
    /// The triangle's first wish.
    start: Vec<u32>,
    wishes: Vec<Wish>,
    /// Factor that the silhouette rule raises the wishes of a triangle by.
    raised: Vec<f64>,
    settings: ViewSettings,
    epoch: u64,
}

/// What a camera sees of a panel.
struct Panel {
    place: Place,
    /// Upper bound of the singular values of S where the place is `Away` (px/m).
    pixels: f64,
}

impl ViewFactors {
    /// Works out the view factors for some cameras: with the spatial smoothing of Koh2014 Eq. (3),
    /// the temporal one of Eq. (4) over the samples, the cloth held fixed, and the silhouette rule
    /// of §3.3. Normals that point at a camera, or across, face it.
    ///
    /// A panel's bounding ball that is farther from a frustum than the margin decides about all of
    /// its triangles at once. The cost is one pass over the mesh per other pair of panel and sample.
    ///
    /// # Errors
    /// If a setting or a weight is out of range or there is no sample.
    pub fn evaluate(
        cloth: &ClothState,
        samples: &[Sample],
        settings: &ViewSettings,
    ) -> Result<ViewFactors, ViewError> {
        settings.check()?;
        if samples.is_empty() {
            return Err(ViewError::NoCamera);
        }
        for sample in samples {
            check("the weight of a sample", sample.weight, "from 0 to 1", |w| {
                (0.0..=1.0).contains(&w)
            })?;
        }
        let frustums: Vec<Frustum> = samples.iter().map(|s| Frustum::new(&s.camera)).collect();
        let panels: Vec<Vec<Panel>> = balls(cloth)
            .into_iter()
            .map(|ball| {
                let pairs = samples.iter().zip(&frustums);
                pairs.map(|(s, frustum)| place(s, frustum, ball, settings)).collect()
            })
            .collect();
        let eye = Eye { cloth, samples, frustums: &frustums, settings };
        let mesh = &cloth.mesh;
        let wishes = par::collect(mesh.n_triangles(), |t, list| {
            eye.wishes(TriangleId(t as u32), &panels[mesh.panels()[t] as usize], list);
        });
        let mut start = vec![0; mesh.n_triangles() + 1];
        let mut plain = vec![0.0f64; mesh.n_triangles()];
        for wish in &wishes {
            let t = wish.triangle as usize;
            start[t + 1] += 1;
            plain[t] = plain[t].max(wish.factor);
        }
        for t in 0..mesh.n_triangles() {
            start[t + 1] += start[t];
        }
        let factors = silhouette::smoothed(mesh, &plain, settings.silhouette);
        // A factor of 0 cannot be raised by a factor; its wishes take the new one instead.
        let raised = factors.iter().zip(&plain).map(|(new, old)| new / old).collect();
        Ok(ViewFactors { factors, start, wishes, raised, settings: *settings, epoch: mesh.epoch() })
    }

    /// The view factor v of every triangle, from 0 to 1 (1).
    pub fn values(&self) -> &[f64] {
        &self.factors
    }

    /// The settings they were worked out with.
    pub fn settings(&self) -> &ViewSettings {
        &self.settings
    }

    /// Number of edits of the mesh when they were worked out.
    pub fn epoch(&self) -> u64 {
        self.epoch
    }

    /// The view factor and w S / ℓ_min of everything some camera wants of a triangle.
    pub(crate) fn wishes(&self, t: TriangleId) -> impl Iterator<Item = (f64, &Matrix2<f64>)> + '_ {
        let [from, to] = [t.index(), t.index() + 1].map(|i| self.start[i] as usize);
        let (raised, most) = (self.raised[t.index()], self.factors[t.index()]);
        self.wishes[from..to].iter().map(move |wish| {
            let factor = if raised == 1.0 {
                wish.factor
            } else if wish.factor > 0.0 {
                wish.factor * raised
            } else {
                most
            };
            (factor, &wish.finest)
        })
    }
}

/// What the triangles are looked at with.
struct Eye<'a> {
    cloth: &'a ClothState,
    samples: &'a [Sample],
    frustums: &'a [Frustum],
    settings: &'a ViewSettings,
}

impl Eye<'_> {
    /// Adds what the samples want of a triangle to the list, without what is covered by the rest.
    fn wishes(&self, t: TriangleId, panel: &[Panel], list: &mut Vec<Wish>) {
        let (first, triangle) = (list.len(), t.0);
        let corners = self.cloth.corners(t);
        let inverse = inverse_edges(self.cloth.mesh.material()[t.index()]);
        let size_px = self.settings.size_min_px;
        // All that is far outside together: the greatest of both numbers.
        let (mut away_factor, mut away_pixels) = (-1.0, 0.0f64);
        for ((sample, frustum), panel) in self.samples.iter().zip(self.frustums).zip(panel) {
            if panel.place == Place::Away {
                away_factor = f64::max(away_factor, sample.weight * self.settings.v_out);
                away_pixels = away_pixels.max(sample.weight * panel.pixels);
                continue;
            }
            let c = corners.map(|p| frustum.camera_space(p));
            let finest = if size_px > 0.0 {
                screen_gradient(&sample.camera, &c, &inverse) * (sample.weight / size_px)
            } else {
                UNBOUNDED
            };
            let mut wish = Wish { triangle, factor: sample.weight, finest };
            // Before the distance is worked out: what is visible earlier needs no more.
            if list[first..].iter().any(|old| old.covers(&wish)) {
                continue;
            }
            let distance = match panel.place {
                Place::Inside => 0.0,
                _ => frustum.distance_in_camera(&c, self.settings.margin),
            };
            wish.factor *=
                self.settings.smoothed(sample.factor(&corners, &c, self.settings), distance);
            add(list, first, wish);
        }
        if away_factor >= 0.0 {
            let finest = if size_px > 0.0 {
                square(&gradient(corners, &inverse)) * (away_pixels / size_px)
            } else {
                UNBOUNDED
            };
            add(list, first, Wish { triangle, factor: away_factor, finest });
        }
    }
}

/// Adds a wish unless an earlier one covers it.
fn add(list: &mut Vec<Wish>, first: usize, wish: Wish) {
    if !list[first..].iter().any(|old| old.covers(&wish)) {
        list.push(wish);
    }
}

/// Where a panel's ball lies for a sample.
fn place(
    sample: &Sample,
    frustum: &Frustum,
    (centre, radius): (World3, f64),
    settings: &ViewSettings,
) -> Panel {
    let place = frustum.place_of_ball(centre, radius, settings.margin);
    let pixels = match place {
        Place::Away => most_pixels(&sample.camera, frustum.camera_space(centre), radius),
        _ => 0.0,
    };
    Panel { place, pixels }
}

/// Centre and radius of a ball about the triangles of every panel (m).
fn balls(cloth: &ClothState) -> Vec<(World3, f64)> {
    let far = World3::repeat(f64::INFINITY);
    let mut boxes = vec![[far, -far]; cloth.densities().len()];
    for (triangle, &panel) in cloth.mesh.triangles().iter().zip(cloth.mesh.panels()) {
        let [low, high] = &mut boxes[panel as usize];
        for &v in triangle {
            let x = cloth.x[v as usize];
            *low = low.inf(&x);
            *high = high.sup(&x);
        }
    }
    boxes.into_iter().map(|[low, high]| ((low + high) * 0.5, (high - low).norm() * 0.5)).collect()
}

//! What need not be looked at: pairs of which nothing moves, because cloth sleeps and bodies stand
//! still. They keep the forces that they had in the last stage in which something did.

use super::touch::Touch;
use super::{SurfaceContact, pair::Sides};
use mesh_core::World3;

/// Who sleeps, and the forces among them.
#[derive(Default)]
pub(super) struct Sleep {
    /// Vertices of the cloth that the coming stage will not move, as told; absent if it may move all.
    told: Option<Vec<bool>>,
    /// Marks of vertices of the cloth and of the obstacles that move, by which candidates were last
    /// chosen; absent if all may.
    awake: Option<[Vec<bool>; 2]>,
    /// Contacts of pairs that sleep.
    touches: Vec<Touch>,
    /// Their gradient, by vertex in ascending order (N).
    gradient: Vec<(u32, World3)>,
}

impl Sleep {
    /// See [`Contact::rest`](cloth_dynamics::contact::Contact::rest).
    pub(super) fn tell(&mut self, sleepers: Option<&[bool]>) {
        self.told = sleepers.map(<[bool]>::to_vec);
    }

    /// Marks of vertices of the cloth and of the obstacles that move; absent if all may.
    pub(super) fn awake(&self) -> Option<[&[bool]; 2]> {
        self.awake.as_ref().map(|[cloth, obstacles]| [&cloth[..], &obstacles[..]])
    }

    /// Adds the gradient of contacts that sleep (N).
    pub(super) fn add_gradient(&self, gradient: &mut [World3]) {
        self.gradient.iter().for_each(|(i, g)| gradient[*i as usize] += g);
    }
}

impl SurfaceContact {
    /// At the start `x` of a stage, brings up to date which pairs sleep; obstacles have gone to it.
    pub(super) fn begin_sleep(&mut self, x: &[World3]) {
        let told = self.sleep.told.take().filter(|_| self.tangle.is_none());
        let awake = told.map(|asleep| {
            let cloth = asleep.iter().map(|asleep| !asleep).collect();
            let bodies = self.obstacles.as_ref().map_or_else(Vec::new, |moving| {
                let ways = moving.now.iter().zip(&moving.then);
                ways.map(|(now, then)| now != then).collect()
            });
            [cloth, bodies]
        });
        if awake == self.sleep.awake {
            return;
        }
        let old = std::mem::replace(&mut self.sleep.awake, awake);
        let moves = |marks: &Option<[Vec<bool>; 2]>, set: usize, i: usize| {
            marks.as_ref().is_none_or(|marks| marks[set][i])
        };
        let new = &self.sleep.awake;
        let n = [x.len(), self.obstacles.as_ref().map_or(0, |moving| moving.now.len())];
        let wakes = |set: usize| (0..n[set]).any(|i| moves(new, set, i) && !moves(&old, set, i));
        let sleeps = |sides: &Sides| {
            (0..4).all(|k| !moves(new, usize::from(!sides.is_cloth[k]), sides.vertices[k] as usize))
        };
        let mut touches = std::mem::take(&mut self.sleep.touches);
        // What was left out may matter now.
        let is_lacking = wakes(0) || wakes(1);
        touches.extend(self.touches.iter().copied());
        touches.retain(|touch| sleeps(&touch.sides));
        if is_lacking {
            self.candidates = super::Candidates::default();
        } else {
            self.candidates.pairs.retain(|sides| !sleeps(sides));
        }
        let mut gradient: Vec<(u32, World3)> = Vec::new();
        touches.iter().for_each(|touch| touch.collect_gradient(x, &mut gradient));
        // Stable, so that sums are in the order of the contacts.
        gradient.sort_by_key(|(i, _)| *i);
        gradient.dedup_by(|next, sum| {
            let is_same = next.0 == sum.0;
            if is_same {
                sum.1 += next.1;
            }
            is_same
        });
        (self.sleep.touches, self.sleep.gradient) = (touches, gradient);
    }
}

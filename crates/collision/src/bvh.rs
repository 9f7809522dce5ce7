//! A tree of boxes over the elements of a mesh: built along the Morton curve, refitted in linear
//! time.
//!
//! The tree is implicit, as the linear trees of Lauterbach2009 but with the shape of a heap: the
//! elements in the order of the curve are level 0, and node `i` of a level has the children `4 i` to
//! `4 i + 3` of the level below. So the tree is one array of boxes and one permutation; it has no
//! pointers, and refitting streams through it once. What a query returns, and in what order, does
//! not depend on the shape of the tree: a tree just built and one refitted many times answer alike.

use crate::{Aabb, morton};
use mesh_core::par;

/// Children of a node.
const WIDTH: usize = 4;
/// No more levels than this: 4¹⁷ > 2³².
const MOST_LEVELS: usize = 17;
/// How much longer the inner boxes may get against those of the elements before building anew pays.
const WORN: f64 = 1.5;

/// A bounding volume hierarchy.
#[derive(Clone, Debug)]
pub struct Bvh {
    /// The element at every place of level 0.
    order: Vec<u32>,
    /// All boxes, level by level from the elements up.
    boxes: Vec<Aabb>,
    /// Where each level begins, and where the last one ends.
    levels: Vec<usize>,
    /// [`Bvh::looseness`] when it was built.
    fresh: f64,
}

impl Bvh {
    /// Builds the tree over `n` elements with the boxes `of(0)` to `of(n − 1)`. O(n), single-threaded
    /// but for the boxes.
    pub fn build(n: usize, of: impl Fn(u32) -> Aabb + Sync) -> Bvh {
        let mut elements = vec![Aabb::EMPTY; n];
        par::fill(&mut elements, |i| of(i as u32));
        let order = morton::order(&elements);
        let mut levels = vec![0, n];
        let mut width = n;
        while width > 1 {
            width = width.div_ceil(WIDTH);
            levels.push(levels[levels.len() - 1] + width);
        }
        let boxes = vec![Aabb::EMPTY; levels[levels.len() - 1]];
        let mut tree = Bvh { order, boxes, levels, fresh: f64::INFINITY };
        tree.refit(|i| elements[i as usize]);
        tree.fresh = tree.looseness();
        tree
    }

    /// Gives the elements new boxes and keeps the shape of the tree. O(n), multi-threaded.
    pub fn refit(&mut self, of: impl Fn(u32) -> Aabb + Sync) {
        let order = &self.order;
        par::fill(&mut self.boxes[..order.len()], |i| of(order[i]));
        for level in 1..self.levels.len() - 1 {
            let (below, above) = self.boxes.split_at_mut(self.levels[level]);
            let below = &below[self.levels[level - 1]..];
            let above = &mut above[..self.levels[level + 1] - self.levels[level]];
            par::fill(above, |i| {
                let children = &below[i * WIDTH..below.len().min((i + 1) * WIDTH)];
                children.iter().fold(Aabb::EMPTY, |all, b| all.union(b))
            });
        }
    }

    /// Gives the elements new boxes as [`Bvh::refit`] does, and builds the tree anew if it has become
    /// loose or has another number of elements. Returns whether it did.
    pub fn update(&mut self, n: usize, of: impl Fn(u32) -> Aabb + Sync) -> bool {
        if n == self.len() {
            self.refit(&of);
            if !self.is_worn() {
                return false;
            }
        }
        *self = Bvh::build(n, of);
        true
    }

    /// Number of elements.
    pub fn len(&self) -> usize {
        self.order.len()
    }

    /// True if there are no elements.
    pub fn is_empty(&self) -> bool {
        self.order.is_empty()
    }

    /// The box around everything.
    pub fn bounds(&self) -> Aabb {
        self.boxes.last().copied().unwrap_or(Aabb::EMPTY)
    }

    /// Total extent of the inner boxes over that of the elements' (1): what a query pays for
    /// following the tree. Edge lengths and not areas, because cloth is flat.
    pub fn looseness(&self) -> f64 {
        let (elements, inner) = self.boxes.split_at(self.order.len());
        let total = |boxes: &[Aabb]| par::sum(boxes.len(), |i| boxes[i].extent());
        let (inner, elements) = (total(inner), total(elements));
        if elements > 0.0 { inner / elements } else { 0.0 }
    }

    /// True if the tree has become so loose by refitting that building it anew pays.
    pub fn is_worn(&self) -> bool {
        self.looseness() > WORN * self.fresh
    }

    /// Calls `found` with every element whose box overlaps `with`, in no order that a
    /// caller should rely on.
    pub fn for_each_overlap(&self, with: &Aabb, mut found: impl FnMut(u32)) {
        if self.is_empty() {
            return;
        }
        self.traverse(with, 0, |group| {
            for_each_hit(with, &self.boxes, self.places(group), |i| found(self.order[i]));
        });
    }

    /// The elements whose boxes overlap `with`, in ascending order.
    pub fn overlaps(&self, with: &Aabb) -> Vec<u32> {
        let mut all = Vec::new();
        self.for_each_overlap(with, |i| all.push(i));
        all.sort_unstable();
        all
    }

    /// All pairs `[a, b]`, `a < b`, of elements whose boxes overlap and for which `keep(a, b)` is true,
    /// in ascending order. The filter keeps, for instance, neighbours out.
    pub fn self_pairs(&self, keep: impl Fn(u32, u32) -> bool + Sync) -> Vec<[u32; 2]> {
        let pairs = par::collect(self.n_groups(), |group, pairs| {
            let own = self.places(group);
            let around = self.around(group);
            self.traverse(&around, group, |other| {
                for i in own.clone() {
                    let rest = self.places(other);
                    let rest = rest.start.max(i + 1)..rest.end;
                    for_each_hit(&self.boxes[i], &self.boxes, rest, |j| {
                        let (a, b) = (self.order[i], self.order[j]);
                        let (a, b) = (a.min(b), a.max(b));
                        if keep(a, b) {
                            pairs.push([a, b]);
                        }
                    });
                }
            });
        });
        sorted(pairs, self.len())
    }

    /// All pairs `[a, b]` of an element `a` of this tree and an element `b` of the other one whose
    /// boxes overlap and for which `keep(a, b)` is true, in ascending order.
    pub fn pairs_with(&self, other: &Bvh, keep: impl Fn(u32, u32) -> bool + Sync) -> Vec<[u32; 2]> {
        if other.is_empty() {
            return Vec::new();
        }
        let pairs = par::collect(self.n_groups(), |group, pairs| {
            let own = self.places(group);
            let around = self.around(group);
            other.traverse(&around, 0, |theirs| {
                for i in own.clone() {
                    for_each_hit(&self.boxes[i], &other.boxes, other.places(theirs), |j| {
                        let (a, b) = (self.order[i], other.order[j]);
                        if keep(a, b) {
                            pairs.push([a, b]);
                        }
                    });
                }
            });
        });
        sorted(pairs, self.len())
    }

    /// Number of groups of up to four elements: the nodes of level 1.
    pub(crate) fn n_groups(&self) -> usize {
        self.len().div_ceil(WIDTH)
    }

    /// The elements of a group.
    #[inline]
    pub(crate) fn elements_of(&self, group: usize) -> &[u32] {
        &self.order[self.places(group)]
    }

    /// All pairs `[g, h]`, `g ≤ h`, of groups whose boxes overlap.
    pub(crate) fn self_groups(&self) -> Vec<[u32; 2]> {
        par::collect(self.n_groups(), |group, pairs| {
            let with = self.around(group);
            self.traverse(&with, group, |other| pairs.push([group as u32, other as u32]));
        })
    }

    /// All pairs `[g, h]`, `g ≤ h`, of groups whose boxes overlap and of which one at least is `awake`.
    pub(crate) fn self_groups_awake(&self, awake: &[bool]) -> Vec<[u32; 2]> {
        par::collect(self.n_groups(), |group, pairs| {
            if awake[group] {
                let with = self.around(group);
                self.traverse(&with, 0, |other| {
                    if other >= group || !awake[other] {
                        pairs.push([group.min(other) as u32, group.max(other) as u32]);
                    }
                });
            }
        })
    }

    /// The same between this tree and another one, with the marks of both.
    pub(crate) fn groups_with_awake(
        &self,
        other: &Bvh,
        [own, theirs]: [&[bool]; 2],
    ) -> Vec<[u32; 2]> {
        if self.is_empty() || other.is_empty() {
            return Vec::new();
        }
        let mut pairs = par::collect(self.n_groups(), |group, pairs| {
            if own[group] {
                let with = self.around(group);
                other.traverse(&with, 0, |there| pairs.push([group as u32, there as u32]));
            }
        });
        pairs.extend(par::collect(other.n_groups(), |there, pairs| {
            if theirs[there] {
                let with = other.around(there);
                self.traverse(&with, 0, |group| {
                    if !own[group] {
                        pairs.push([group as u32, there as u32]);
                    }
                });
            }
        }));
        pairs
    }

    /// All pairs of a group of this tree and a group of the other one whose boxes overlap.
    pub(crate) fn groups_with(&self, other: &Bvh) -> Vec<[u32; 2]> {
        if other.is_empty() {
            return Vec::new();
        }
        par::collect(self.n_groups(), |group, pairs| {
            let with = self.around(group);
            other.traverse(&with, 0, |theirs| pairs.push([group as u32, theirs as u32]));
        })
    }

    /// The places of the elements under node `group` of level 1.
    #[inline]
    fn places(&self, group: usize) -> std::ops::Range<usize> {
        group * WIDTH..self.order.len().min((group + 1) * WIDTH)
    }

    /// The box of node `group` of level 1, which a tree of one element does not have.
    #[inline]
    pub(crate) fn around(&self, group: usize) -> Aabb {
        self.boxes[self.places(group)].iter().fold(Aabb::EMPTY, |all, b| all.union(b))
    }

    /// Calls `visit` with every node of level 1 from `first` on that overlaps `with`.
    #[inline]
    fn traverse(&self, with: &Aabb, first: usize, mut visit: impl FnMut(usize)) {
        let top = self.levels.len() - 2;
        if top <= 1 {
            return visit(0);
        }
        let mut stack = [(0u32, 0u32); MOST_LEVELS * WIDTH];
        stack[0] = (top as u32, 0);
        let mut height = 1;
        while height > 0 {
            height -= 1;
            let (level, node) = (stack[height].0 as usize - 1, stack[height].1 as usize);
            // The children, of level `level`, and the number of nodes of level 1 under each.
            let start = self.levels[level];
            let end = (self.levels[level + 1] - start).min((node + 1) * WIDTH);
            let under = 1usize << (2 * (level - 1));
            // Those that reach `first`.
            let children = (node * WIDTH).max(first / under)..end;
            for_each_hit(with, &self.boxes[start..], children, |child| {
                if level == 1 {
                    visit(child);
                } else {
                    stack[height] = (level as u32, child as u32);
                    height += 1;
                }
            });
        }
    }
}

/// Calls `visit` with every place in `range` whose box overlaps `with`. All are tested before any is
/// visited, because a branch per box would go wrong half of the time.
#[inline]
fn for_each_hit(
    with: &Aabb,
    boxes: &[Aabb],
    range: std::ops::Range<usize>,
    mut visit: impl FnMut(usize),
) {
    let start = range.start;
    let mut hits = 0u32;
    for (k, b) in boxes[range].iter().enumerate() {
        hits |= u32::from(b.overlaps(with)) << k;
    }
    while hits != 0 {
        visit(start + hits.trailing_zeros() as usize);
        hits &= hits - 1;
    }
}

/// The pairs in ascending order: by counting on the first, which is below `n`.
fn sorted(pairs: Vec<[u32; 2]>, n: usize) -> Vec<[u32; 2]> {
    let mut ends = vec![0u32; n + 1];
    pairs.iter().for_each(|p| ends[p[0] as usize + 1] += 1);
    for i in 0..n {
        ends[i + 1] += ends[i];
    }
    let mut out = vec![[0; 2]; pairs.len()];
    let mut at = ends.clone();
    for pair in pairs {
        let slot = &mut at[pair[0] as usize];
        out[*slot as usize] = pair;
        *slot += 1;
    }
    for i in 0..n {
        out[ends[i] as usize..ends[i + 1] as usize].sort_unstable();
    }
    out
}

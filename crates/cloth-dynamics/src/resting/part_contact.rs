//! The contact of the whole cloth, as a part of the cloth sees it.

use crate::contact::{Blocked, Contact};
use crate::force::Stage;
use crate::part::Part;
use crate::solver::{ABSENT, BlockMatrix, PatternBuilder, PatternError};
use mesh_core::World3;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Contact in the numbers of a part, while all else rests.
#[derive(Clone)]
pub(super) struct PartContact {
    part: Arc<Part>,
    shared: Arc<Mutex<Shared>>,
}

struct Shared {
    /// There while it is lent.
    whole: Option<Box<dyn Contact>>,
    /// Positions of the whole cloth; those of the part are put in when they are known (m).
    rest: Vec<World3>,
    /// What is held, by vertex of the whole.
    fixed: Vec<bool>,
    /// Vertices outside of the part that the contact had to move.
    pushed: Vec<u32>,
    work: Work,
}

/// Gradient and stiffness of the whole; the matrix is made anew when the touching pairs change.
#[derive(Default)]
struct Work {
    couples: Vec<[u32; 2]>,
    matrix: Option<BlockMatrix>,
    gradient: Vec<World3>,
}

impl PartContact {
    pub(super) fn new(
        whole: Box<dyn Contact>,
        part: Arc<Part>,
        rest: Vec<World3>,
        fixed: Vec<bool>,
    ) -> PartContact {
        let (whole, work) = (Some(whole), Work::default());
        let shared = Shared { whole, rest, fixed, pushed: Vec::new(), work };
        PartContact { part, shared: Arc::new(Mutex::new(shared)) }
    }

    /// Gives back the contact of the whole, and the vertices outside of the part that it moved.
    pub(super) fn end(&self) -> (Option<Box<dyn Contact>>, Vec<u32>) {
        let mut shared = self.shared();
        (shared.whole.take(), std::mem::take(&mut shared.pushed))
    }

    fn shared(&self) -> MutexGuard<'_, Shared> {
        self.shared.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn with<T>(&self, tell: impl FnOnce(&dyn Contact) -> T) -> T {
        tell(self.shared().whole.as_deref().expect("it is asked only while it is lent"))
    }
}

impl Shared {
    fn everywhere(&self, part: &Part, x: &[World3]) -> Vec<World3> {
        let mut all = self.rest.clone();
        for (&i, x) in part.vertices().iter().zip(x) {
            all[i as usize] = *x;
        }
        all
    }
}

impl Work {
    /// Gradient and stiffness at positions of the whole.
    fn fill(&mut self, contact: &dyn Contact, x: &[World3]) -> Result<(), PatternError> {
        let couples = contact.couples();
        if self.matrix.is_none() || couples != self.couples {
            let mut pattern = PatternBuilder::new(x.len());
            pattern.add(&couples)?;
            self.matrix = Some(BlockMatrix::new(Arc::new(pattern.build()?)));
            self.couples = couples;
        }
        self.gradient.clear();
        self.gradient.resize(x.len(), World3::zeros());
        if let Some(matrix) = &mut self.matrix {
            matrix.set_zero();
            contact.add_system(x, &mut self.gradient, matrix);
        }
        Ok(())
    }
}

/// Gradient of the contact of the whole cloth (N).
pub(super) fn gradient_of(contact: &dyn Contact, x: &[World3]) -> Vec<World3> {
    let mut gradient = vec![World3::zeros(); x.len()];
    contact.add_gradient(x, &mut gradient);
    gradient
}

impl Contact for PartContact {
    fn name(&self) -> &'static str {
        self.with(|whole| whole.name())
    }

    fn begin(&mut self, _: Stage<'_>, _: [f64; 2], _: &[f64], _: &[World3]) {
        // The whole has begun already.
    }

    fn couples(&self) -> Vec<[u32; 2]> {
        let place = |pair: [u32; 2]| pair.map(|i| self.part.place(i as usize));
        let here = |pair: &[u32; 2]| pair[0] != ABSENT && pair[1] != ABSENT;
        self.with(|whole| whole.couples()).into_iter().map(place).filter(here).collect()
    }

    fn energy(&self, x: &[World3]) -> f64 {
        let all = self.shared().everywhere(&self.part, x);
        self.with(|whole| whole.energy(&all))
    }

    fn add_gradient(&self, x: &[World3], gradient: &mut [World3]) {
        let all = self.shared().everywhere(&self.part, x);
        let whole = self.with(|whole| gradient_of(whole, &all));
        for (k, &i) in self.part.vertices().iter().enumerate() {
            gradient[k] += whole[i as usize];
        }
    }

    fn add_system(&self, x: &[World3], gradient: &mut [World3], stiffness: &mut BlockMatrix) {
        let mut shared = self.shared();
        let all = shared.everywhere(&self.part, x);
        let Shared { whole, work, .. } = &mut *shared;
        let whole = whole.as_deref().expect("it is asked only while it is lent");
        // There was room for the same pairs in the pattern of the part.
        work.fill(whole, &all).expect("the pairs of contact fit into a matrix");
        for (k, &i) in self.part.vertices().iter().enumerate() {
            gradient[k] += work.gradient[i as usize];
        }
        let Some(matrix) = &work.matrix else { return };
        let pattern = matrix.pattern();
        let place = |i: usize| self.part.place(i);
        for &j in self.part.vertices() {
            let j = j as usize;
            let slots = pattern.diagonal_slot(j)..pattern.column_starts()[j + 1] as usize;
            for slot in slots.filter(|&slot| place(pattern.rows()[slot] as usize) != ABSENT) {
                let row = place(pattern.rows()[slot] as usize) as usize;
                let to = stiffness.pattern().slot(row, place(j) as usize);
                stiffness.add(to.expect("there is room for contact"), matrix.block(slot));
            }
        }
    }

    fn look(&mut self, x: &[World3]) -> bool {
        let mut shared = self.shared();
        let all = shared.everywhere(&self.part, x);
        shared.whole.as_mut().is_some_and(|whole| whole.look(&all))
    }

    fn is_passed(&self, x: &[World3]) -> bool {
        let all = self.shared().everywhere(&self.part, x);
        self.with(|whole| whole.is_passed(&all))
    }

    fn secure(&mut self, x: &mut [World3], _: &[bool]) -> Result<usize, Blocked> {
        let mut shared = self.shared();
        let before = shared.everywhere(&self.part, x);
        let mut all = before.clone();
        let Shared { whole, fixed, pushed, .. } = &mut *shared;
        let whole = whole.as_mut().expect("it is asked only while it is lent");
        let n_moved = whole.secure(&mut all, fixed)?;
        for i in (0..all.len()).filter(|&i| all[i] != before[i]) {
            if self.part.answers(i) {
                x[self.part.place(i) as usize] = all[i];
            } else {
                pushed.push(i as u32);
            }
        }
        Ok(n_moved)
    }

    fn n_touches(&self) -> usize {
        self.with(|whole| whole.n_touches())
    }

    fn is_still(&self, times: [f64; 2]) -> bool {
        self.with(|whole| whole.is_still(times))
    }
}

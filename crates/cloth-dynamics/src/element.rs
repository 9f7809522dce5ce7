//! Energies that are sums over small stencils: the loop, the threads and the ordered sum live here
//! once, so that a new energy contains no parallel line.

use crate::force::{Force, Stage};
use crate::part::Part;
use crate::solver::{
    ABSENT, BlockMatrix, BlockPattern, PatternBuilder, PatternError, StencilSlots,
};
use mesh_core::{World3, par};
use nalgebra::Matrix3;

/// Gradient and stiffness of one element.
#[derive(Clone, Debug)]
pub struct ElementSystem<const N: usize> {
    /// Gradient of the energy at each corner (N).
    pub gradient: [World3; N],
    /// Stiffness blocks (N/m); only `[a][b]` with a ≥ b is read.
    pub stiffness: [[Matrix3<f64>; N]; N],
    /// False if everything is zero, so that nothing needs to be added.
    pub active: bool,
}

impl<const N: usize> ElementSystem<N> {
    /// All zero.
    pub fn zero() -> Self {
        ElementSystem {
            gradient: [World3::zeros(); N],
            stiffness: [[Matrix3::zeros(); N]; N],
            active: false,
        }
    }
}

/// Which second derivative is wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stiffness {
    /// The exact Hessian; may be indefinite.
    Exact,
    /// Positive semi-definite.
    Projected,
}

/// What a modeller writes: an energy on stencils of `N` vertices. Pure and serial.
pub trait ElementModel<const N: usize>: Send + Sync {
    /// A short name for reports.
    fn name(&self) -> &'static str;

    /// The vertices of every element; [`ABSENT`] where there is none.
    fn stencils(&self) -> &[[u32; N]];

    /// Takes what the energy lags from the start of the stage.
    fn begin(&mut self, stage: Stage<'_>);

    /// Takes what the projected stiffness lags from the linear prediction at `x + step` (m).
    fn predict(&mut self, x: &[World3], step: &[World3]);

    /// Energy of element `e` (J) with its corners at `x` (m). Absent corners are at the origin.
    fn energy(&self, e: usize, x: &[World3; N]) -> f64;

    /// Gradient at the corners (N).
    fn gradient(&self, e: usize, x: &[World3; N]) -> [World3; N];

    /// Gradient and stiffness into `out`, which may hold old values.
    fn system(&self, e: usize, x: &[World3; N], kind: Stiffness, out: &mut ElementSystem<N>);

    /// The model of some of the elements, ascending, whose corners have new numbers.
    #[must_use]
    fn part(&self, elements: &[u32], stencils: Vec<[u32; N]>) -> Self
    where
        Self: Sized;
}

/// A [`Force`] made of the elements of one model.
#[derive(Debug)]
pub struct Elements<M, const N: usize> {
    model: M,
    slots: Option<StencilSlots<N>>,
}

/// Elements whose systems are computed side by side before they are added in order: few enough to
/// stay in the cache, and for one thread in the innermost. The sum is the same for any number.
pub(crate) fn batch() -> usize {
    if par::n_threads() > 1 { 256 } else { 8 }
}

impl<M: ElementModel<N>, const N: usize> Elements<M, N> {
    /// All elements of a model.
    pub fn new(model: M) -> Self {
        Elements { model, slots: None }
    }

    fn corners(&self, e: usize, x: &[World3]) -> [World3; N] {
        self.model.stencils()[e].map(|i| if i == ABSENT { World3::zeros() } else { x[i as usize] })
    }

    fn scatter(&self, e: usize, from: &[World3; N], to: &mut [World3]) {
        for (&i, g) in self.model.stencils()[e].iter().zip(from) {
            if i != ABSENT {
                to[i as usize] += g;
            }
        }
    }
}

impl<M: ElementModel<N> + 'static, const N: usize> Force for Elements<M, N> {
    fn name(&self) -> &'static str {
        self.model.name()
    }

    fn couple(&self, pattern: &mut PatternBuilder) -> Result<(), PatternError> {
        pattern.add(self.model.stencils())
    }

    fn bind(&mut self, pattern: &BlockPattern) {
        self.slots = StencilSlots::new(pattern, self.model.stencils());
    }

    fn begin(&mut self, stage: Stage<'_>) {
        self.model.begin(stage);
    }

    fn predict(&mut self, x: &[World3], step: &[World3]) {
        self.model.predict(x, step);
    }

    fn energy(&self, x: &[World3]) -> f64 {
        let n = self.model.stencils().len();
        par::sum(n, |e| self.model.energy(e, &self.corners(e, x)))
    }

    fn add_gradient(&self, x: &[World3], gradient: &mut [World3]) {
        let n = self.model.stencils().len();
        let size = 8 * batch();
        let mut batch = vec![[World3::zeros(); N]; n.min(size)];
        for first in (0..n).step_by(size) {
            let count = (n - first).min(size);
            par::fill(&mut batch[..count], |k| {
                self.model.gradient(first + k, &self.corners(first + k, x))
            });
            for (k, g) in batch[..count].iter().enumerate() {
                self.scatter(first + k, g, gradient);
            }
        }
    }

    fn add_system(
        &self,
        x: &[World3],
        kind: Stiffness,
        gradient: &mut [World3],
        stiffness: &mut BlockMatrix,
    ) {
        let slots = self.slots.as_ref().expect("bind() comes before add_system()");
        let n = self.model.stencils().len();
        let size = batch();
        let mut batch = vec![ElementSystem::<N>::zero(); n.min(size)];
        for first in (0..n).step_by(size) {
            let count = (n - first).min(size);
            par::for_each(&mut batch[..count], |k, out| {
                let e = first + k;
                self.model.system(e, &self.corners(e, x), kind, out);
            });
            for (k, system) in batch[..count].iter().enumerate() {
                if system.active {
                    self.scatter(first + k, &system.gradient, gradient);
                    slots.scatter(first + k, &system.stiffness, stiffness);
                }
            }
        }
    }

    fn part(&self, part: &Part) -> Option<Box<dyn Force>> {
        let (elements, stencils) = part.elements(self.model.stencils());
        let some = !elements.is_empty();
        some.then(|| {
            Box::new(Elements::new(self.model.part(&elements, stencils))) as Box<dyn Force>
        })
    }
}

/// The entries of a list with one per element.
pub(crate) fn chosen<T: Clone>(list: &[T], elements: &[u32]) -> Vec<T> {
    elements.iter().map(|&e| list[e as usize].clone()).collect()
}

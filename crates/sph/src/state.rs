//! The particles, in separate arrays that are sorted together.

use crate::grid::Point;
use nalgebra::Vector3;

/// All that belongs to particles.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct State {
    /// Position (m) and P = p/ρ² as the accelerations have it.
    pub(crate) x: Vec<Point>,
    /// Effective velocity (m/s) and density ρ (kg/m³), as the accelerations have them.
    pub(crate) w: Vec<Point>,
    /// Momentum per mass (m/s); the fourth number is 0.
    pub(crate) u: Vec<Point>,
    /// Acceleration, with gravity (m/s²); the fourth number is 0.
    pub(crate) a: Vec<Point>,
    /// Density (kg/m³). For restrained fluid it may be ahead of what the accelerations have.
    pub(crate) density: Vec<f64>,
    /// Lasting number.
    pub(crate) id: Vec<u64>,
    /// What moving surfaces add to the acceleration (m/s²) and to the density (kg/m³); empty if there
    /// are none.
    pub(crate) by_sheets: Vec<Point>,
    /// Impulse that moving surfaces have yet to get from each particle (N s), and 0; empty as well.
    pub(crate) given: Vec<Point>,
}

impl State {
    pub(crate) fn len(&self) -> usize {
        self.id.len()
    }

    /// Density with what surfaces add (kg/m³).
    pub(crate) fn full_density(&self, i: usize) -> f64 {
        self.density[i] + self.by_sheets.get(i).map_or(0.0, |by| by[3])
    }

    /// Makes room for what moving surfaces do.
    pub(crate) fn meet_sheets(&mut self) {
        self.by_sheets.resize(self.len(), [0.0; 4]);
        self.given.resize(self.len(), [0.0; 4]);
    }

    /// Adds a particle that moves freely.
    pub(crate) fn push(&mut self, id: u64, x: &Vector3<f64>, v: &Vector3<f64>) {
        self.x.push([x.x, x.y, x.z, 0.0]);
        self.w.push([v.x, v.y, v.z, 0.0]);
        self.u.push([v.x, v.y, v.z, 0.0]);
        self.a.push([0.0; 4]);
        self.density.push(0.0);
        if !self.by_sheets.is_empty() {
            self.by_sheets.push([0.0; 4]);
            self.given.push([0.0; 4]);
        }
        self.id.push(id);
    }

    /// Keeps the particles for which `keep` is true, in their order.
    pub(crate) fn retain(&mut self, keep: impl Fn(&Point) -> bool) {
        let kept: Vec<bool> = self.x.iter().map(keep).collect();
        self.keep(&kept);
    }

    /// Keeps the particles that are marked.
    pub(crate) fn keep(&mut self, kept: &[bool]) {
        fn filter<T>(list: &mut Vec<T>, kept: &[bool]) {
            let mut at = kept.iter();
            list.retain(|_| *at.next().expect("as many as particles"));
        }
        filter(&mut self.x, kept);
        filter(&mut self.w, kept);
        filter(&mut self.u, kept);
        filter(&mut self.a, kept);
        filter(&mut self.density, kept);
        filter(&mut self.id, kept);
        if !self.by_sheets.is_empty() {
            filter(&mut self.by_sheets, kept);
            filter(&mut self.given, kept);
        }
    }

    /// Takes out a particle; the last one gets its place.
    pub(crate) fn swap_remove(&mut self, i: usize) {
        for list in [&mut self.x, &mut self.w, &mut self.u, &mut self.a] {
            list.swap_remove(i);
        }
        self.density.swap_remove(i);
        self.id.swap_remove(i);
        if !self.by_sheets.is_empty() {
            self.by_sheets.swap_remove(i);
            self.given.swap_remove(i);
        }
    }

    /// Puts the particles in an order, through `spare`, which holds nothing of use before or after.
    pub(crate) fn sort(&mut self, order: &[u32], spare: &mut Spare) {
        gather(&mut self.x, order, &mut spare.points);
        gather(&mut self.w, order, &mut spare.points);
        gather(&mut self.u, order, &mut spare.points);
        gather(&mut self.a, order, &mut spare.points);
        gather(&mut self.density, order, &mut spare.numbers);
        gather(&mut self.id, order, &mut spare.ids);
        if !self.by_sheets.is_empty() {
            gather(&mut self.by_sheets, order, &mut spare.points);
            gather(&mut self.given, order, &mut spare.points);
        }
    }
}

/// Memory for sorting.
#[derive(Clone, Debug, Default)]
pub(crate) struct Spare {
    points: Vec<Point>,
    numbers: Vec<f64>,
    ids: Vec<u64>,
}

fn gather<T: Copy>(list: &mut Vec<T>, order: &[u32], spare: &mut Vec<T>) {
    spare.clear();
    spare.extend(order.iter().map(|&i| list[i as usize]));
    std::mem::swap(list, spare);
}

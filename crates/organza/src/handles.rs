//! What holds vertices: pins, clamps and keyframed handles, in step with a changing mesh.

mod select;

use crate::build::Piece;
use crate::scene;
use crate::scene::format::Select;
use crate::scene::motion::Motion;
use cloth_dynamics::Constraints;
use mesh_core::{ClothState, Edit, Mesh, World3};
use nalgebra::Point3;

/// One handle on the running mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Handle {
    /// Its number in the scene.
    pub number: usize,
    /// Held vertices by lasting name, with where they were when the handle took hold (m).
    pub held: Vec<(u64, Option<World3>)>,
    /// Which vertices that appear between held ones are held too.
    extent: Extent,
    motion: Option<Motion>,
    start: f64,
    end: f64,
    /// How long springs take to fade after the end (s).
    fade: f64,
    stiffness: Option<f64>,
}

/// What a handle holds of the cloth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Extent {
    /// Single vertices.
    Points,
    /// A part of the border: new vertices on it are held.
    Border,
    /// An area: new vertices inside it are held.
    Area,
}

impl Handle {
    /// Share of the stiffness that is left at a time (s) (1).
    fn strength(&self, time: f64) -> f64 {
        let past = time - self.end;
        if past <= INSTANT { 1.0 } else { (1.0 - past / self.fade).max(0.0).powi(4) }
    }
}

/// All handles of a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Handles {
    handles: Vec<Handle>,
}

/// Slack in comparing times (s): steps add up with rounding.
const INSTANT: f64 = 1e-9;

impl Handles {
    /// Adds a handle on a cloth whose vertices start at `first_vertex` of the common mesh.
    ///
    /// # Errors
    /// If it selects a vertex that does not exist, or nothing at all.
    pub(crate) fn add(
        &mut self,
        number: usize,
        handle: &scene::Handle,
        piece: &Piece,
        first_vertex: u32,
    ) -> Result<(), String> {
        let mut chosen = select::select(&handle.select, piece)?;
        chosen.sort_unstable();
        chosen.dedup();
        if chosen.is_empty() {
            return Err("selects no vertex".into());
        }
        self.handles.push(Handle {
            number,
            held: chosen.iter().map(|v| (u64::from(v.0 + first_vertex), None)).collect(),
            extent: match handle.select {
                Select::Vertices(_) | Select::Corners(_) => Extent::Points,
                Select::Sides(_) | Select::Borders(_) | Select::Boundary => Extent::Border,
                Select::Panels(_) | Select::Box(_) | Select::All => Extent::Area,
            },
            motion: handle.motion.clone(),
            start: handle.start_s,
            end: handle.end_s,
            fade: handle.fade_s,
            stiffness: handle.stiffness_n_per_m,
        });
        Ok(())
    }

    /// The handles.
    pub fn list(&self) -> &[Handle] {
        &self.handles
    }

    /// The handles, for restoring a checkpoint.
    pub fn list_mut(&mut self) -> &mut [Handle] {
        &mut self.handles
    }

    /// Names of all vertices that must not be removed.
    pub fn names(&self) -> Vec<u64> {
        self.handles.iter().flat_map(|h| h.held.iter().map(|&(uid, _)| uid)).collect()
    }

    /// Handles that take hold at or before `time` (s) note where their vertices are now.
    pub fn take_hold(&mut self, cloth: &ClothState, names: &[(u64, u32)], time: f64) {
        for handle in self.handles.iter_mut().filter(|h| h.start <= time + INSTANT) {
            for (uid, home) in handle.held.iter_mut().filter(|(_, home)| home.is_none()) {
                *home = lookup(names, *uid).map(|i| cloth.x[i as usize]);
            }
        }
    }

    /// What is held where at `time` (s); `names` maps lasting names to vertices, see [`by_name`].
    pub fn constraints(&self, names: &[(u64, u32)], time: f64) -> Constraints {
        let mut out = Constraints::default();
        for handle in &self.handles {
            if time < handle.start - INSTANT || time > handle.end + handle.fade + INSTANT {
                continue;
            }
            let strength = handle.strength(time);
            let moved = handle.motion.as_ref().map(|m| m.at(time) * m.at(handle.start).inverse());
            for &(uid, home) in &handle.held {
                let (Some(i), Some(home)) = (lookup(names, uid), home) else { continue };
                let x = moved.map_or(home, |m| m.transform_point(&Point3::from(home)).coords);
                match handle.stiffness {
                    None => out.fixed.push((i, x)),
                    Some(k) => out.springs.push((i, x, k * strength)),
                }
            }
        }
        out
    }

    /// Follows the edits of a remeshing call: `before` are the names before it.
    pub fn follow(&mut self, before: &[u64], mut next_uid: u64, edits: &[Edit]) {
        if self.handles.iter().all(|h| h.extent == Extent::Points) {
            return;
        }
        let mut names = before.to_vec();
        for edit in edits {
            match *edit {
                Edit::Split { a, b, parents, .. } => {
                    let (a, b) = (names[a.index()], names[b.index()]);
                    let on_border = parents[1].is_none();
                    let grows = |h: &&mut Handle| match h.extent {
                        Extent::Points => false,
                        Extent::Border => on_border,
                        Extent::Area => true,
                    };
                    for handle in self.handles.iter_mut().filter(grows) {
                        // Sorted by name: they start so, and new names are larger than all others.
                        let held = &handle.held;
                        let find = |uid| held.binary_search_by_key(&uid, |&(u, _)| u).ok();
                        if let (Some(a), Some(b)) = (find(a), find(b)) {
                            let home = held[a].1.zip(held[b].1).map(|(a, b)| (a + b) * 0.5);
                            handle.held.push((next_uid, home));
                        }
                    }
                    names.push(next_uid);
                    next_uid += 1;
                }
                Edit::Flip { .. } => {}
                Edit::Collapse { removed, .. } => {
                    names.swap_remove(removed.index());
                }
            }
        }
    }
}

/// Names of a mesh's vertices with their indices, sorted.
pub fn by_name(mesh: &Mesh) -> Vec<(u64, u32)> {
    let mut names: Vec<(u64, u32)> = mesh.uids().iter().copied().zip(0..).collect();
    names.sort_unstable();
    names
}

fn lookup(names: &[(u64, u32)], uid: u64) -> Option<u32> {
    names.binary_search_by_key(&uid, |&(u, _)| u).ok().map(|k| names[k].1)
}

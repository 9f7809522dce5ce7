//! What a run leaves out because its scene does not need it.

use super::World;
use crate::remeshing::Remeshing;

impl World {
    /// Stages that this scene does not need, and why.
    pub fn skipped(&self) -> Vec<String> {
        let mut skipped = Vec::new();
        if !self.has_cloth() {
            skipped.push("cloth: none in the scene".to_string());
            let is_free = self.fluid.as_ref().is_some_and(|water| !water.is_restrained);
            if is_free {
                skipped.push("restraint: none in the scene".to_string());
            } else if self.eyes.is_none() {
                skipped.push("view: who rests does not depend on a camera".to_string());
            }
            return skipped;
        }
        let mut note = |absent: bool, text: &str| {
            if absent {
                skipped.push(text.to_string());
            }
        };
        note(self.remeshing.is_none(), "sizing, remeshing: all meshes are fixed");
        let looks = self.remeshing.as_ref().is_some_and(Remeshing::looks);
        note(!looks, "view: mesh sizes do not depend on a camera");
        let follows = self.remeshing.as_ref().is_some_and(Remeshing::follows_obstacles);
        let is_bound = follows && !self.obstacles.is_empty();
        note(!is_bound, "sizing by obstacles: no mesh size depends on them");
        note(self.environment.wind.is_none(), "wind: none in the scene");
        let limits = self.fabrics.iter().any(|f| f.strain_limits.is_some());
        note(!limits, "strain limits: none in the scene");
        let fields = self.fabrics.iter().any(|f| f.tension_field);
        note(!fields, "tension field: all cloth resists compression");
        note(self.fabrics.iter().all(|f| f.bending.is_none()), "bending: no fabric resists it");
        note(self.handles.list().is_empty(), "handles: none in the scene");
        note(self.fluid.is_none(), "fluid: none in the scene");
        note(self.contact.is_none(), "contact: none in the scene");
        note(self.restraints.is_none(), "restraint: all of the cloth always moves");
        let is_free = self.contact.is_some() && !self.tangled.was_at_work;
        note(is_free, "untangling: nothing passes through anything");
        skipped
    }
}

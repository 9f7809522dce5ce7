//! The remeshing policy of a world: a sizing field, and limits for the whole mesh.

use crate::build::Garment;
use crate::scene::Scene;
use mesh_core::{ClothState, Mesh};
use remesh::{
    CornerMetrics, PerPanel, PhysicalSizing, RemeshError, RemeshReport, RemeshSettings,
    SizingField, adapt,
};
use std::time::Instant;

/// Principal stretches that edits may leave in cloth without strain limits (1): more strain than this
/// would be seen to spring back.
const HARDLY_STRAINED: [f64; 2] = [0.9, 1.1];

/// What a world wants of the remesher.
pub struct Remeshing {
    sizing: Box<dyn SizingField>,
    fixed_panels: Vec<u32>,
    stretch_limits: Vec<[f64; 2]>,
    aspect_min: f64,
    hysteresis: f64,
    max_vertices: usize,
}

impl Remeshing {
    /// The policy of a scene, sized by [`PhysicalSizing`] panel by panel; `None` if every mesh of
    /// the scene is fixed.
    pub fn new(scene: &Scene, garments: &[Garment], mesh: &Mesh) -> Option<Remeshing> {
        let mut fields = Vec::new();
        let (mut fixed_panels, mut stretch_limits) = (Vec::new(), Vec::new());
        let mut max_vertices = 0;
        let (mut aspect_min, mut hysteresis) = (1.0, 0.0);
        for (cloth, garment) in scene.cloths.iter().zip(garments) {
            let field = match &cloth.remeshing {
                None => {
                    fixed_panels.extend(garment.panels.clone());
                    PhysicalSizing::default()
                }
                Some(wish) => {
                    aspect_min = f64::min(aspect_min, wish.aspect_min);
                    hysteresis = f64::max(hysteresis, wish.hysteresis);
                    max_vertices += wish.max_vertices as usize;
                    PhysicalSizing {
                        refine_angle: wish.refine_angle.unwrap_or(f64::INFINITY),
                        refine_velocity: wish.refine_velocity.unwrap_or(f64::INFINITY),
                        refine_compression: wish.refine_compression.unwrap_or(f64::INFINITY),
                        size_min: wish.size_m.min,
                        size_max: wish.size_m.max,
                        aspect_min: wish.aspect_min,
                    }
                }
            };
            let limits = cloth.strain_limits.unwrap_or(HARDLY_STRAINED);
            stretch_limits.extend(garment.panels.clone().map(|_| limits));
            fields.extend(garment.panels.clone().map(|_| field));
        }
        // The limit is one for the whole mesh, of which fixed cloths have their part already.
        max_vertices += n_vertices_of(mesh, &fixed_panels);
        let sizing = Box::new(PerPanel { fields });
        let policy = Remeshing {
            sizing,
            fixed_panels,
            stretch_limits,
            aspect_min,
            hysteresis,
            max_vertices,
        };
        scene.cloths.iter().any(|c| c.remeshing.is_some()).then_some(policy)
    }

    /// The same policy with another sizing field, made from the one it had.
    pub fn sized_by<S: SizingField + 'static>(
        self,
        field: impl FnOnce(Box<dyn SizingField>) -> S,
    ) -> Remeshing {
        Remeshing { sizing: Box::new(field(self.sizing)), ..self }
    }

    /// Remeshes, around the vertices `hold` by splits alone; returns what was done and the seconds
    /// spent on sizing and on edits.
    ///
    /// # Errors
    /// If a setting is out of range.
    pub fn run(
        &self,
        cloth: &mut ClothState,
        keep: &[u64],
        hold: &[u64],
    ) -> Result<(RemeshReport, [f64; 2]), RemeshError> {
        let settings = RemeshSettings {
            aspect_min: self.aspect_min,
            hysteresis: self.hysteresis,
            max_vertices: self.max_vertices,
            keep,
            fixed_panels: &self.fixed_panels,
            stretch_limits: &self.stretch_limits,
            hold,
            obstacle: None,
        };
        let clock = Instant::now();
        let mut metrics = CornerMetrics::evaluate(cloth, &*self.sizing, &settings)?;
        let sizing = clock.elapsed().as_secs_f64();
        let report = adapt(cloth, &mut metrics, &settings)?;
        Ok((report, [sizing, clock.elapsed().as_secs_f64() - sizing]))
    }
}

/// Number of vertices on some panels, given in rising order.
fn n_vertices_of(mesh: &Mesh, panels: &[u32]) -> usize {
    let mut on = vec![false; mesh.n_vertices()];
    for (t, panel) in mesh.triangles().iter().zip(mesh.panels()) {
        if panels.binary_search(panel).is_ok() {
            t.iter().for_each(|&v| on[v as usize] = true);
        }
    }
    on.into_iter().filter(|&on| on).count()
}

#[cfg(test)]
mod tests {
    use crate::scene::{LoadOptions, from_sources, parse};
    use crate::world::World;

    /// A sheet of 4 vertices that wants many more, beside a fixed one of 121.
    #[test]
    fn fixed_cloths_do_not_use_up_the_limit_of_others() {
        let text = "{frames: 1, substeps: 1, gravity: [0, 0, 0], cloths: [
            {fabric: 'denim', mesh: {grid: {size_m: [1, 1], cells: [10, 10]}}},
            {fabric: 'denim', mesh: {grid: {size_m: [1, 1], cells: [1, 1]}},
             remeshing: {size_m: {min: 0.01, max: 0.02}, max_vertices: 50}}]}";
        let loaded = parse(text, "s", &LoadOptions::default(), &from_sources(&[])).unwrap();
        let mut world = World::new(&loaded).unwrap();
        let report = world.advance().unwrap();
        assert_eq!(report.vertices, 121 + 50);
        assert!(report.remesh.unwrap().limit_reached);
    }
}

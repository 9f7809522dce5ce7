//! The remeshing policy of a world: a sizing field, and limits for the whole mesh.

use crate::build::Garment;
use crate::scene::Scene;
use mesh_core::ClothState;
use remesh::{
    CornerMetrics, PerPanel, PhysicalSizing, RemeshError, RemeshReport, RemeshSettings,
    SizingField, adapt,
};
use std::time::Instant;

/// What a world wants of the remesher.
pub struct Remeshing {
    sizing: Box<dyn SizingField>,
    fixed_panels: Vec<u32>,
    aspect_min: f64,
    hysteresis: f64,
    max_vertices: usize,
}

impl Remeshing {
    /// The policy of a scene, sized by [`PhysicalSizing`] panel by panel; `None` if every mesh of
    /// the scene is fixed.
    pub fn new(scene: &Scene, garments: &[Garment]) -> Option<Remeshing> {
        let mut fields = Vec::new();
        let (mut fixed_panels, mut max_vertices) = (Vec::new(), 0);
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
            fields.extend(garment.panels.clone().map(|_| field));
        }
        let sizing = Box::new(PerPanel { fields });
        let policy = Remeshing { sizing, fixed_panels, aspect_min, hysteresis, max_vertices };
        scene.cloths.iter().any(|c| c.remeshing.is_some()).then_some(policy)
    }

    /// The same policy with another sizing field, made from the one it had.
    pub fn sized_by<S: SizingField + 'static>(
        self,
        field: impl FnOnce(Box<dyn SizingField>) -> S,
    ) -> Remeshing {
        Remeshing { sizing: Box::new(field(self.sizing)), ..self }
    }

    /// Remeshes; returns what was done and the seconds spent on sizing and on edits.
    ///
    /// # Errors
    /// If a setting is out of range.
    pub fn run(
        &self,
        cloth: &mut ClothState,
        keep: &[u64],
    ) -> Result<(RemeshReport, [f64; 2]), RemeshError> {
        let settings = RemeshSettings {
            aspect_min: self.aspect_min,
            hysteresis: self.hysteresis,
            max_vertices: self.max_vertices,
            keep,
            fixed_panels: &self.fixed_panels,
            obstacle: None,
        };
        let clock = Instant::now();
        let mut metrics = CornerMetrics::evaluate(cloth, &*self.sizing, &settings)?;
        let sizing = clock.elapsed().as_secs_f64();
        let report = adapt(cloth, &mut metrics, &settings)?;
        Ok((report, [sizing, clock.elapsed().as_secs_f64() - sizing]))
    }
}

//! The remeshing policy of a scene: sizing per panel, limits for the whole mesh.

use crate::build::Garment;
use crate::scene::Scene;
use mesh_core::ClothState;
use remesh::{
    CornerMetrics, PerPanel, PhysicalSizing, RemeshError, RemeshReport, RemeshSettings, adapt,
};
use std::time::Instant;

/// What a scene wants of the remesher.
#[derive(Clone, Debug)]
pub struct Remeshing {
    sizing: PerPanel<PhysicalSizing>,
    fixed_panels: Vec<u32>,
    stretch_limits: Vec<[f64; 2]>,
    aspect_min: f64,
    hysteresis: f64,
    max_vertices: usize,
}

impl Remeshing {
    /// The policy; `None` if every mesh of the scene is fixed.
    pub fn new(scene: &Scene, garments: &[Garment]) -> Option<Remeshing> {
        let mut policy = Remeshing {
            sizing: PerPanel { fields: Vec::new() },
            fixed_panels: Vec::new(),
            stretch_limits: Vec::new(),
            aspect_min: 1.0,
            hysteresis: 0.0,
            max_vertices: 0,
        };
        for (cloth, garment) in scene.cloths.iter().zip(garments) {
            let field = match &cloth.remeshing {
                None => {
                    policy.fixed_panels.extend(garment.panels.clone());
                    PhysicalSizing::default()
                }
                Some(wish) => {
                    policy.aspect_min = policy.aspect_min.min(wish.aspect_min);
                    policy.hysteresis = policy.hysteresis.max(wish.hysteresis);
                    policy.max_vertices += wish.max_vertices as usize;
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
            let limits = cloth.strain_limits.unwrap_or([0.9,1.1]);
            policy.stretch_limits.extend(garment.panels.clone().map(|_| limits));
            policy.sizing.fields.extend(garment.panels.clone().map(|_| field));
        }
        scene.cloths.iter().any(|c| c.remeshing.is_some()).then_some(policy)
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
            stretch_limits: &self.stretch_limits,
            obstacle: None,
        };
        let clock = Instant::now();
        let mut metrics = CornerMetrics::evaluate(cloth, &self.sizing, &settings)?;
        let sizing = clock.elapsed().as_secs_f64();
        let report = adapt(cloth, &mut metrics, &settings)?;
        Ok((report, [sizing, clock.elapsed().as_secs_f64() - sizing]))
    }
}

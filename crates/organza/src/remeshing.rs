//! The remeshing policy of a world: a sizing field, and limits for the whole mesh.

use crate::build::Garment;
use crate::contact::Obstacles;
use crate::eyes::Eyes;
use crate::obstacle::Obstacle;
use crate::obstacle_sizing;
use crate::report::ViewSummary;
use crate::scene::Scene;
use mesh_core::{ClothState, Material2, Mesh};
use remesh::{
    CornerMetrics, PerPanel, PhysicalSizing, RemeshError, RemeshReport, RemeshSettings,
    SizingField, adapt,
};
use sizing_view::{ViewFactors, ViewSizing, shift_metrics};
use std::time::Instant;

/// Principal stretches that edits may leave in cloth without strain limits (1): more strain than this
/// would be seen to spring back.
const HARDLY_STRAINED: [f64; 2] = [0.9, 1.1];

/// The same where a camera decides on sizes (1). Its coarse triangles are many times as large as those
/// that a fold calls for; springing back from more strain they pull at what shows.
const UNSEEN_STRAINED: [f64; 2] = [0.98, 1.02];

/// How long edges may get that no camera needs, in mean widths of their panel (1). Longer ones lie across
/// the leg or the arm in it, and are caught where these move.
const SHARE_OF_PANEL: f64 = 0.5;

/// How far off obstacles are followed, in units of the distance that cloth keeps from them (1).
const OBSTACLE_REACH: f64 = 4.0;

/// What a world wants of the remesher.
pub struct Remeshing {
    sizing: Box<dyn SizingField>,
    view: Option<Eyes>,
    /// How long edges may get that no camera needs, by panel (m); empty without a view.
    unseen_max: Vec<f64>,
    /// What obstacles may turn across an edge, by panel (rad); absent where it is nowhere bounded.
    obstacle_angles: Option<Vec<f64>>,
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
        let mut obstacle_angles = Vec::new();
        let mut max_vertices = 0;
        let (mut aspect_min, mut hysteresis) = (1.0, 0.0);
        let view = scene.view.as_ref().and_then(|view| Eyes::new(scene, view));
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
            let mut limits = cloth.strain_limits.unwrap_or(HARDLY_STRAINED);
            if view.is_some() {
                limits = [limits[0].max(UNSEEN_STRAINED[0]), limits[1].min(UNSEEN_STRAINED[1])];
            }
            stretch_limits.extend(garment.panels.clone().map(|_| limits));
            fields.extend(garment.panels.clone().map(|_| field));
            let angle = cloth.remeshing.as_ref().and_then(|wish| wish.refine_obstacle);
            obstacle_angles.extend(garment.panels.clone().map(|_| angle.unwrap_or(f64::INFINITY)));
        }
        // The limit is one for the whole mesh, of which fixed cloths have their part already.
        max_vertices += n_vertices_of(mesh, &fixed_panels);
        let mut unseen_max = Vec::new();
        if view.is_some() {
            let longest = |panel: usize| fields[panel].size_max;
            let widths = mean_widths(mesh).into_iter().enumerate();
            unseen_max.extend(widths.map(|(p, width)| longest(p).max(SHARE_OF_PANEL * width)));
        }
        let sizing = Box::new(PerPanel { fields });
        let policy = Remeshing {
            sizing,
            view,
            unseen_max,
            obstacle_angles: obstacle_angles
                .iter()
                .any(|a| a.is_finite())
                .then_some(obstacle_angles),
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

    /// True if sizes depend on what a camera sees.
    pub fn looks(&self) -> bool {
        self.view.is_some()
    }

    /// True if sizes depend on obstacles nearby.
    pub fn follows_obstacles(&self) -> bool {
        self.obstacle_angles.is_some()
    }

    /// Remeshes for the frame at `time` (s), around the vertices `hold` by splits alone. `obstacles` are
    /// in the way of cameras; `bodies` are those that cloth keeps a distance (m) from.
    ///
    /// # Errors
    /// If a setting is out of range.
    pub fn run(
        &self,
        cloth: &mut ClothState,
        time: f64,
        obstacles: &[Obstacle],
        keep: &[u64],
        hold: &[u64],
        bodies: Option<(&Obstacles, f64)>,
    ) -> Result<Remeshed, RemeshError> {
        let mut clock = Instant::now();
        let mut lap = || std::mem::replace(&mut clock, Instant::now()).elapsed().as_secs_f64();
        let obstacle = self.obstacle_angles.as_ref().zip(bodies).map(|(angles, (bodies, room))| {
            let angle = |panel: u32| angles[panel as usize];
            obstacle_sizing::metrics(cloth, bodies, time, OBSTACLE_REACH * room, angle)
        });
        let obstacle_s = if obstacle.is_some() { lap() } else { 0.0 };
        let samples = self.view.as_ref().map(|eyes| eyes.samples(cloth, time, obstacles));
        let seen = self.view.as_ref().zip(samples.as_deref());
        let shift = seen.map(|(eyes, samples)| shift_metrics(cloth, samples, eyes.settings()));
        let settings = RemeshSettings {
            aspect_min: self.aspect_min,
            hysteresis: self.hysteresis,
            max_vertices: self.max_vertices,
            keep,
            fixed_panels: &self.fixed_panels,
            stretch_limits: &self.stretch_limits,
            hold,
            shift: shift.as_deref().unwrap_or_default(),
            obstacle: obstacle.as_deref(),
        };
        let factors = seen.map(|(eyes, samples)| {
            let factors = ViewFactors::evaluate(cloth, samples, eyes.settings());
            factors.expect("a window has its camera, and the scene's settings have been checked")
        });
        let view_s = if factors.is_some() { lap() } else { 0.0 };
        let mut metrics = match &factors {
            None => CornerMetrics::evaluate(cloth, &*self.sizing, &settings)?,
            Some(factors) => {
                let field = ViewSizing::new(&*self.sizing, factors).with_limits(&self.unseen_max);
                CornerMetrics::evaluate(cloth, &field, &settings)?
            }
        };
        let sizing_s = obstacle_s + lap();
        let report = adapt(cloth, &mut metrics, &settings)?;
        let view = factors.as_ref().map(ViewSummary::of);
        Ok(Remeshed { report, view, view_s, sizing_s, edits_s: lap() })
    }
}

/// What a remeshing did.
pub struct Remeshed {
    /// The edits.
    pub report: RemeshReport,
    /// What the camera saw, if it was asked.
    pub view: Option<ViewSummary>,
    /// Time spent on view factors (s).
    pub view_s: f64,
    /// Time spent on the sizing field (s).
    pub sizing_s: f64,
    /// Time spent on edits (s).
    pub edits_s: f64,
}

/// Area over longest side of every panel (m).
fn mean_widths(mesh: &Mesh) -> Vec<f64> {
    let n = mesh.panels().iter().max().map_or(0, |panel| *panel as usize + 1);
    let none = Material2::repeat(f64::INFINITY);
    let mut extents = vec![(none, -none, 0.0); n];
    for t in mesh.triangle_ids() {
        let (low, high, area) = &mut extents[mesh.panels()[t.index()] as usize];
        *area += mesh.area(t);
        for u in &mesh.material()[t.index()] {
            (*low, *high) = (low.inf(u), high.sup(u));
        }
    }
    extents.into_iter().map(|(low, high, area)| area / (high - low).max()).collect()
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
    use mesh_core::World3;

    use super::Remeshing;

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

    /// The largest change of length along the edges of a sheet that was rolled up without strain and then
    /// remeshed (1), and its triangles.
    fn rolled(more: &str) -> (f64, usize) {
        let text = format!(
            "{{frames: 1, camera: {{position: [0, -3, 0], target: [0, -4, 0]}}, cloths: [
            {{fabric: 'denim', mesh: {{grid: {{size_m: [0.5, 0.5], cells: [20, 20]}}}},
              remeshing: {{size_m: {{min: 0.2, max: 0.4}}}}}}]{more}}}"
        );
        let loaded = parse(&text, "s", &LoadOptions::default(), &from_sources(&[])).unwrap();
        let world = World::new(&loaded).unwrap();
        let mut cloth = world.cloth.clone();
        const RADIUS: f64 = 0.2;
        for x in &mut cloth.x {
            let angle = x.x / RADIUS;
            *x = World3::new(RADIUS * angle.sin(), x.y, RADIUS * angle.cos());
        }
        let policy = Remeshing::new(&loaded.scene, &world.garments, &cloth.mesh).unwrap();
        policy.run(&mut cloth, 0.0, &[], &[], &[], None).unwrap();
        let strains = cloth.mesh.triangle_ids().flat_map(|t| {
            let (u, x) = (cloth.mesh.material()[t.index()], cloth.corners(t));
            [0, 1, 2].map(|k| {
                let l = (k + 1) % 3;
                ((x[l] - x[k]).norm() / (u[l] - u[k]).norm() - 1.0).abs()
            })
        });
        (strains.fold(0.0, f64::max), cloth.mesh.n_triangles())
    }

    #[test]
    fn what_a_camera_has_no_need_of_is_coarsened_without_much_strain() {
        let (strain, triangles) = rolled(", view: {}");
        assert!(strain < 0.02, "{strain}");
        assert!(triangles < 800, "{triangles}");
        let (strain, _) = rolled("");
        assert!(strain > 0.02, "without a view edits may strain more: {strain}");
    }

    #[test]
    fn edges_out_of_the_picture_are_shorter_than_their_panel_is_wide() {
        let text = "{frames: 12, substeps: 1, gravity: [0, 0, 0],
            camera: {position: [0, -3, 0], target: [0, -4, 0]}, view: {size_max_m: 2}, cloths: [
            {fabric: 'denim', mesh: {grid: {size_m: [0.3, 1.2], cells: [8, 32]}},
             remeshing: {size_m: {min: 0.02, max: 0.05}}}]}";
        let loaded = parse(text, "s", &LoadOptions::default(), &from_sources(&[])).unwrap();
        let mut world = World::new(&loaded).unwrap();
        for _ in 0..6 {
            world.advance().unwrap();
        }
        let mesh = &world.cloth.mesh;
        let longest =
            mesh.material().iter().flat_map(|u| [0, 1, 2].map(|k| (u[(k + 1) % 3] - u[k]).norm()));
        let longest = longest.fold(0.0, f64::max);
        assert!(longest > 0.1 && longest <= 0.15 * (1.0 + 1e-12), "{longest}");
    }
}

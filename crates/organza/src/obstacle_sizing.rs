//! How fine cloth has to be to follow the obstacles that are near it.
//!
//! Cloth that comes to lie on a body will bend as the body does. So where a body is near, its normals
//! take the place of those of the cloth in the curvature criterion of Narain2012 §4.1: across an edge
//! they turn by no more than an angle. The cloth is fine enough before it touches, and a body smaller
//! than a triangle does not slip into it.

use crate::contact::Obstacles;
use collision::{Aabb, Bvh, distance};
use mesh_core::{ClothState, Material2, World3, par};
use nalgebra::Matrix3x2;
use remesh::Metric;

/// Least cosine between the normals of faces of an obstacle that are one smooth surface, and between
/// that of an obstacle and that of cloth which may come to lie on it.
const SAME_SIDE: f64 = 0.5;
/// Samples that spread less in one direction than this share of the other say nothing of it.
const FLAT: f64 = 1e-3;

/// The metric of every triangle of the cloth (1/m²) with which the normals of obstacles within `reach`
/// (m) turn by at most `angle` of its panel (rad) across an edge; zero where no obstacle is near.
/// An infinite angle asks for nothing.
pub(crate) fn metrics(
    cloth: &ClothState,
    obstacles: &Obstacles,
    time: f64,
    reach: f64,
    angle: impl Fn(u32) -> f64 + Sync,
) -> Vec<Metric> {
    let mesh = &cloth.mesh;
    let mut metrics = vec![Metric::ZERO; mesh.triangles().len()];
    let x = (obstacles.motion)(time);
    let near_cloth = Aabb::around(&cloth.x).grown(reach);
    if !near_cloth.overlaps(&Aabb::around(&x)) {
        return metrics;
    }
    let body = Body::new(obstacles, x);
    let of_cloth = |t: u32| mesh.triangles()[t as usize].map(|v| cloth.x[v as usize]);
    let tree = obstacles.surface.tree(&body.x);
    let of_body = |t: u32| obstacles.surface.corners(&body.x, t);
    let mut at_vertices = vec![None; cloth.x.len()];
    par::fill(&mut at_vertices, |i| {
        let (t, weights) = nearest(&cloth.x[i], &tree, of_body, reach)?;
        let of_corners = body.corner_normals[t as usize];
        Some((0..3).map(|k| of_corners[k] * weights[k]).sum::<World3>())
    });
    let cloth_tree = Bvh::build(mesh.triangles().len(), |t| Aabb::around(&of_cloth(t)));
    let on_cloth = par::collect(body.x.len(), |i, found| {
        let x = &body.x[i];
        if near_cloth.overlaps(&Aabb::around([x])) {
            found.extend(
                nearest(x, &cloth_tree, of_cloth, reach).map(|(t, weights)| (t, i, weights)),
            );
        }
    });
    let mut samples: Vec<Vec<(Material2, World3)>> = vec![Vec::new(); metrics.len()];
    for (t, i, weights) in on_cloth {
        let corners = &mesh.material()[t as usize];
        let u = (0..3).map(|k| corners[k] * weights[k]).sum();
        samples[t as usize].push((u, body.vertex_normals[i]));
    }
    par::fill(&mut metrics, |t| {
        let angle = angle(mesh.panels()[t]);
        let (corners, material) = (mesh.triangles()[t], &mesh.material()[t]);
        let at_corners =
            (0..3).filter_map(|k| Some((material[k], at_vertices[corners[k] as usize]?)));
        let normal = normal(&of_cloth(t as u32));
        let sided = |(u, n): (Material2, World3)| {
            let (length, along) = (n.norm() * normal.norm(), n.dot(&normal));
            let is_facing = along.abs() >= SAME_SIDE * length && length > 0.0;
            is_facing.then(|| (u, n * (along.signum() / n.norm())))
        };
        let all: Vec<_> = samples[t].iter().copied().chain(at_corners).filter_map(sided).collect();
        if angle.is_finite() { Metric::of_gradient(&gradient(&all), angle) } else { Metric::ZERO }
    });
    metrics
}

/// The obstacles, with all their vertices at `x` (m).
struct Body {
    x: Vec<World3>,
    /// Sum of the area vectors of the triangles around each vertex (m²).
    vertex_normals: Vec<World3>,
    /// Unit normals at the corners of each triangle, smooth but for creases.
    corner_normals: Vec<[World3; 3]>,
}

impl Body {
    fn new(obstacles: &Obstacles, x: Vec<World3>) -> Body {
        let triangles = obstacles.surface.triangles();
        let areas: Vec<World3> =
            (0..).zip(triangles).map(|(t, _)| normal(&obstacles.surface.corners(&x, t))).collect();
        let mut around = vec![Vec::new(); x.len()];
        let mut vertex_normals = vec![World3::zeros(); x.len()];
        for (corners, area) in triangles.iter().zip(&areas) {
            for &v in corners {
                around[v as usize].push(*area);
                vertex_normals[v as usize] += area;
            }
        }
        let mut corner_normals = vec![[World3::zeros(); 3]; triangles.len()];
        par::fill(&mut corner_normals, |t| {
            triangles[t].map(|v| {
                let is_smooth =
                    |n: &&World3| n.dot(&areas[t]) >= SAME_SIDE * n.norm() * areas[t].norm();
                let sum: World3 = around[v as usize].iter().filter(is_smooth).sum();
                sum.try_normalize(0.0).unwrap_or_default()
            })
        });
        Body { x, vertex_normals, corner_normals }
    }
}

/// Twice the area vector of a triangle (m²).
fn normal([a, b, c]: &[World3; 3]) -> World3 {
    (b - a).cross(&(c - a))
}

/// The triangle of a tree that is nearest to a point and within reach (m), with the weights of its
/// corners in the nearest point; of those at the same distance the first.
fn nearest(
    x: &World3,
    tree: &Bvh,
    corners: impl Fn(u32) -> [World3; 3],
    reach: f64,
) -> Option<(u32, [f64; 3])> {
    let mut best = (reach * reach, u32::MAX, [0.0; 3]);
    tree.for_each_overlap(&Aabb::around([x]).grown(reach), |t| {
        let [a, b, c] = corners(t);
        let closest = distance::vertex_triangle(&[*x, a, b, c]);
        if (closest.squared, t) < (best.0, best.1) {
            let [_, p, q, r] = closest.weights;
            best = (closest.squared, t, [-p, -q, -r]);
        }
    });
    (best.1 != u32::MAX).then_some((best.1, best.2))
}

/// The gradient of a vector in material space (1/m) that fits samples of it best, least squares; zero in
/// directions in which they do not spread.
fn gradient(samples: &[(Material2, World3)]) -> Matrix3x2<f64> {
    let mut gradient = Matrix3x2::zeros();
    if samples.len() < 2 {
        return gradient;
    }
    let share = 1.0 / samples.len() as f64;
    let (mut u_mean, mut n_mean) = (Material2::zeros(), World3::zeros());
    for (u, n) in samples {
        u_mean += u * share;
        n_mean += n * share;
    }
    let mut spread = Metric::ZERO;
    for (u, _) in samples {
        let d = u - u_mean;
        spread = spread + Metric::new(d.x * d.x, d.x * d.y, d.y * d.y);
    }
    let (sizes, directions) = spread.eigen();
    for (size, direction) in sizes.into_iter().zip(directions) {
        if size > FLAT * FLAT * sizes[0] {
            let along = |(u, n): &(Material2, World3)| (n - n_mean) * (u - u_mean).dot(&direction);
            let turn: World3 = samples.iter().map(along).sum();
            gradient += turn * direction.transpose() / size;
        }
    }
    gradient
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build::build;
    use crate::scene::{LoadOptions, from_sources, parse};

    /// Sizes that a sheet of 2 × 2 cells over a body is asked for (m).
    fn sizes(body: &str, height: f64) -> Vec<[f64; 2]> {
        let text = format!(
            "{{frames: 1, substeps: 1, cloths: [{{fabric: 'denim',
                mesh: {{grid: {{size_m: [0.4, 0.4], cells: [2, 2]}}}},
                transform: {{translate: [-0.2, -0.2, {height}]}}}}],
              obstacles: [{{mesh: {{{body}}}}}]}}"
        );
        let loaded = parse(&text, "s", &LoadOptions::default(), &from_sources(&[])).unwrap();
        let built = build(&loaded).unwrap();
        let obstacles = Obstacles::new(&built.obstacles).unwrap().unwrap();
        let metrics = metrics(&built.cloth, &obstacles, 0.0, 0.02, |_| 0.3);
        metrics.iter().map(|m| m.eigenvalues().map(|e| 1.0 / e.sqrt())).collect()
    }

    /// Across an edge of length ℓ the normal of a sphere of radius r turns by ℓ/r.
    #[test]
    fn on_a_sphere_edges_turn_by_the_angle() {
        let sizes = sizes("sphere: {radius_m: 2, detail: 5}", 2.005);
        assert_eq!(sizes.len(), 8);
        for [small, large] in sizes {
            assert!((small / 0.6 - 1.0).abs() < 0.05, "{small}");
            assert!((large / 0.6 - 1.0).abs() < 0.05, "{large}");
        }
    }

    #[test]
    fn a_small_body_under_a_large_triangle_counts() {
        let sizes = sizes("sphere: {radius_m: 0.05, detail: 3}", 0.055);
        let least = sizes.iter().map(|[small, _]| *small).fold(f64::INFINITY, f64::min);
        assert!((0.01..0.02).contains(&least), "{least}");
    }

    #[test]
    fn what_is_flat_or_far_asks_for_nothing() {
        for (body, height) in [("box: {size_m: [2, 2, 2]}", 1.01), ("sphere: {radius_m: 0.5}", 0.7)]
        {
            for [small, _] in sizes(body, height) {
                assert!(small > 1e3, "{body}: {small}");
            }
        }
    }
}

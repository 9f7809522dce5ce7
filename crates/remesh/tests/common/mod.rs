//! Meshes and checks that several test files share.
#![allow(dead_code, unreachable_pub)]

use mesh_core::generate::{self, Diagonal};
use mesh_core::{ClothState, HalfEdge, Material2, Mesh, World3};
use remesh::{
    CornerMetrics, MeshQuality, Metric, RemeshReport, RemeshSettings, SizingContext, SizingField,
};

/// A fixed 64-bit generator (Knuth's MMIX constants): the same numbers on every machine.
pub struct Numbers(pub u64);

impl Numbers {
    pub fn bits(&mut self) -> u32 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as u32
    }

    /// In [0, 1).
    pub fn unit(&mut self) -> f64 {
        f64::from(self.bits()) / f64::from(1u32 << 31)
    }
}

/// A number in [0, 1) that depends on nothing but its arguments.
pub fn noise(seed: u64, at: u64) -> f64 {
    let mut numbers =
        Numbers(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ at.wrapping_mul(0xD1B5_4A32_D192_ED03));
    numbers.bits();
    numbers.unit()
}

pub fn rest(sheet: generate::Sheet) -> ClothState {
    let n_panels = *sheet.mesh.panels().iter().max().unwrap() as usize + 1;
    let density = (0..n_panels).map(|p| 0.15 + 0.05 * p as f64).collect();
    ClothState::at_rest(sheet.mesh, sheet.positions, density).unwrap()
}

pub fn grid(size: [f64; 2], cells: [usize; 2], diagonal: Diagonal) -> ClothState {
    rest(generate::grid(size, cells, diagonal).unwrap())
}

/// Flat cloth from points and triangles, world = material.
pub fn flat(points: &[[f64; 2]], triangles: &[[u32; 3]]) -> ClothState {
    let u: Vec<Material2> = points.iter().map(|p| Material2::from(*p)).collect();
    let material = triangles.iter().map(|t| t.map(|i| u[i as usize])).collect();
    let mesh = Mesh::new(u.len(), triangles.to_vec(), material, vec![0; triangles.len()]).unwrap();
    let x = u.iter().map(|u| World3::new(u.x, u.y, 0.0)).collect();
    ClothState::at_rest(mesh, x, vec![0.2]).unwrap()
}

/// Two panels sewn along one edge; the second was cut elsewhere on the bolt, turned by `angle`.
pub fn sewn(cells: [usize; 2], angle: f64) -> ClothState {
    let sheet = generate::grid([2.0, 1.0], cells, Diagonal::Alternating).unwrap();
    let mut material = sheet.mesh.material().to_vec();
    let mut panels = vec![0; material.len()];
    let turn = nalgebra::Rotation2::new(angle);
    for (corners, panel) in material.iter_mut().zip(&mut panels) {
        if corners.iter().all(|u| u.x >= 1.0) {
            *panel = 1;
            *corners = corners.map(|u| turn * u + Material2::new(5.0, -3.0));
        }
    }
    let triangles = sheet.mesh.triangles().to_vec();
    let mesh = Mesh::new(sheet.positions.len(), triangles, material, panels).unwrap();
    ClothState::at_rest(mesh, sheet.positions, vec![0.2, 0.3]).unwrap()
}

/// Cloths that have nothing to do with each other, in one mesh, panel after panel.
pub fn together(cloths: &[ClothState]) -> ClothState {
    let (mut triangles, mut material, mut panels) = (vec![], vec![], vec![]);
    let (mut x, mut density) = (vec![], vec![]);
    for cloth in cloths {
        let first = x.len() as u32;
        triangles.extend(cloth.mesh.triangles().iter().map(|t| t.map(|i| i + first)));
        material.extend_from_slice(cloth.mesh.material());
        panels.extend(cloth.mesh.panels().iter().map(|p| p + density.len() as u32));
        x.extend_from_slice(&cloth.x);
        density.extend_from_slice(cloth.densities());
    }
    ClothState::at_rest(Mesh::new(x.len(), triangles, material, panels).unwrap(), x, density)
        .unwrap()
}

/// Meshes of every kind, by number.
pub const N_KINDS: usize = 14;

pub fn kind(number: usize) -> ClothState {
    match number % N_KINDS {
        0 => flat(&[[0.0, 0.0], [1.0, 0.0], [0.3, 0.8]], &[[0, 1, 2]]),
        1 => flat(&[[0.0, 0.0], [1.0, 0.0], [0.9, 1.1], [0.0, 0.7]], &[[0, 1, 2], [0, 2, 3]]),
        2 => grid([2.0, 0.05], [40, 1], Diagonal::One),
        3 => sewn([6, 3], std::f64::consts::FRAC_PI_2),
        4 => sewn([6, 3], 2.1),
        5 => rest(generate::disc(0.5, 4).unwrap()),
        6 => together(&[
            grid([1.0, 0.5], [4, 2], Diagonal::Alternating),
            flat(&[[0.0, 0.0], [0.2, 0.0], [0.0, 0.3]], &[[0, 1, 2]]),
            rest(generate::disc(0.3, 2).unwrap()),
        ]),
        7 => fan(24),
        8 => needles(),
        9 => rest(generate::tube(0.2, 0.7, 8, 5).unwrap()),
        10 => grid([1.0, 1.0], [6, 6], Diagonal::One),
        11 => cap(),
        12 => kite_strip(),
        _ => grid([1.0, 1.0], [8, 8], Diagonal::Alternating),
    }
}

/// Triangles that hang together in one boundary vertex only by each other's sides.
fn fan(n: u32) -> ClothState {
    let mut points = vec![[0.0, 0.0]];
    for k in 0..=n {
        let angle = 5.0 * f64::from(k) / f64::from(n);
        let r = 0.5 + 0.3 * f64::from(k % 3);
        points.push([r * angle.cos(), r * angle.sin()]);
    }
    let triangles: Vec<_> = (1..=n).map(|k| [0, k, k + 1]).collect();
    flat(&points, &triangles)
}

/// A strip of very thin triangles between two wide ones.
fn needles() -> ClothState {
    let (mut points, mut triangles) = (vec![], vec![]);
    let heights = [0.0, 0.3, 0.3001, 0.3002, 0.3004, 0.30041, 0.7];
    for y in heights {
        points.extend([[0.0, y], [1.0, y]]);
    }
    for k in 0..heights.len() as u32 - 1 {
        let [a, b, c, d] = [2 * k, 2 * k + 1, 2 * k + 3, 2 * k + 2];
        triangles.extend([[a, b, c], [a, c, d]]);
    }
    flat(&points, &triangles)
}

/// A vertex very close to the middle of a long boundary edge, and one of degree three.
fn cap() -> ClothState {
    flat(
        &[[0.0, 0.0], [1.0, 0.0], [0.5, 1e-5], [0.5, 0.9], [0.5, 0.3]],
        &[[0, 1, 2], [1, 3, 4], [3, 0, 4], [0, 2, 4], [2, 1, 4]],
    )
}

/// Kites that all want to be flipped.
fn kite_strip() -> ClothState {
    let (mut points, mut triangles) = (vec![[0.0, 0.0]], vec![]);
    for k in 0..12u32 {
        let x = f64::from(k);
        points.extend([[x + 0.5, -0.06], [x + 0.5, 0.06], [x + 1.0, 0.0]]);
        let [a, c, d, b] = [3 * k, 3 * k + 1, 3 * k + 2, 3 * k + 3];
        triangles.extend([[a, b, d], [a, c, b]]);
        if k > 0 {
            triangles.extend([[a, d, a - 1], [a, a - 2, c]]);
        }
    }
    flat(&points, &triangles)
}

/// Gives every vertex a velocity and bends the cloth a little.
pub fn stir(mut cloth: ClothState) -> ClothState {
    for (x, v) in cloth.x.iter_mut().zip(&mut cloth.v) {
        *v = World3::new(3.0 * x.y, -2.0 * x.x + x.y * x.y, (5.0 * x.x).sin());
        x.z += 0.05 * (4.0 * x.x).sin() * (3.0 * x.y).cos();
    }
    cloth
}

/// What no edit may change.
pub struct Conserved {
    area: f64,
    euler: i64,
    mass: f64,
    momentum: World3,
    /// Sum of m |v|: what the momentum is compared with.
    motion: f64,
}

impl Conserved {
    pub fn of(cloth: &ClothState) -> Self {
        Conserved {
            area: cloth.mesh.total_area(),
            euler: cloth.mesh.euler_characteristic(),
            mass: cloth.total_mass(),
            momentum: cloth.momentum(),
            motion: cloth.m.iter().zip(&cloth.v).map(|(m, v)| m * v.norm()).sum(),
        }
    }

    pub fn check(&self, cloth: &ClothState) {
        cloth.mesh.validate().unwrap();
        assert_eq!(cloth.mesh.euler_characteristic(), self.euler);
        let area = cloth.mesh.total_area();
        assert!((area / self.area - 1.0).abs() < 1e-12, "area {area} was {}", self.area);
        let mass = cloth.total_mass();
        assert!((mass / self.mass - 1.0).abs() < 1e-12, "mass {mass} was {}", self.mass);
        let drift = (cloth.momentum() - self.momentum).norm();
        assert!(drift <= 1e-12 * self.motion, "momentum drifted by {drift} of {}", self.motion);
    }
}

/// Remeshes with the usual settings and checks what must be conserved.
pub fn run<S: SizingField + ?Sized>(cloth: &mut ClothState, field: &S) -> RemeshReport {
    let conserved = Conserved::of(cloth);
    let report = remesh::remesh(cloth, field, &RemeshSettings::default()).unwrap();
    conserved.check(cloth);
    report
}

/// The triangles of a panel as the lasting names of their corners.
pub fn panel_by_names(cloth: &ClothState, panel: u32) -> Vec<[u64; 3]> {
    let mesh = &cloth.mesh;
    let mut rows: Vec<_> = (0..mesh.n_triangles())
        .filter(|&t| mesh.panels()[t] == panel)
        .map(|t| mesh.triangles()[t].map(|v| mesh.uids()[v as usize]))
        .collect();
    rows.sort_unstable();
    rows
}

/// A sizing field from a function of the place in material space (m).
pub struct At<F>(pub F);

impl<F: Fn(Material2) -> Metric + Send + Sync> SizingField for At<F> {
    fn metric(&self, context: &SizingContext<'_>, at: mesh_core::TriangleId) -> Metric {
        self.0(context.centroid(at))
    }
}

/// All corners around a vertex hold the same metric up to the next feature edge.
pub fn check_sectors(mesh: &Mesh, metrics: &CornerMetrics) {
    let of = |h: HalfEdge| metrics.at(h.triangle())[h.corner()];
    for h in mesh.edges().filter(|&h| !mesh.is_feature(h)) {
        let g = mesh.twin(h).unwrap();
        assert_eq!((of(h), of(h.next())), (of(g.next()), of(g)));
    }
}

/// Share of the edges with a size in [low, high], which must be ends of bins.
pub fn share(quality: &MeshQuality, low: f64, high: f64) -> f64 {
    let start = |k: usize| if k == 0 { 0.0 } else { remesh::SIZE_BINS[k - 1] };
    let end = |k: usize| remesh::SIZE_BINS.get(k).copied().unwrap_or(f64::INFINITY);
    let inside = (0..quality.sizes.len()).filter(|&k| start(k) >= low && end(k) <= high);
    f64::from(inside.map(|k| quality.sizes[k]).sum::<u32>()) / quality.n_edges as f64
}

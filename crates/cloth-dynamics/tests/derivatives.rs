//! Finite-difference checks of every energy: gradient and exact Hessian at random, degenerate and
//! inverted configurations, and the projected stiffness.

use cloth_dynamics::law::{Bending, Law, MeasuredBending, MeasuredMembrane, Membrane, Quadratic};
use cloth_dynamics::{
    BendingModel, Damping, ElementModel, ElementSystem, Fabric, HingeModel, MembraneModel,
    RestTriangle, ShapeOperatorModel, Stage, Stiffness, StrainLimitModel, StrainLimits, Wind,
    WindModel,
};
use mesh_core::generate::{Diagonal, grid};
use mesh_core::{ClothState, World3};
use nalgebra::{DMatrix, Vector3};
use std::sync::Arc;

/// Wang2011-like table with the defects of the published ones: negative shear and coupling.
const STRETCH: [[f64; 4]; 6] = [
    [31.0, 16.0, 67.0, 40.0],
    [47.0, 7.0, 44.0, -29.0],
    [76.0, 61.0, 75.0, 21.0],
    [89.0, 71.0, 114.0, 44.0],
    [121.0, 87.0, 238.0, 42.0],
    [144.0, -9.0, 268.0, 22.0],
];
const BEND: [[f64; 5]; 3] = [
    [30e-6, 26e-6, 32e-6, 35e-6, 49e-6],
    [21e-6, 12e-6, 16e-6, 23e-6, 19e-6],
    [18e-6, 10e-6, 14e-6, 25e-6, 13e-6],
];

/// A fixed generator of numbers in (−1, 1).
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
    fn vector(&mut self, scale: f64) -> World3 {
        World3::new(self.next(), self.next(), self.next()) * scale
    }
}

fn measured() -> Fabric {
    Fabric {
        density: 0.2,
        membrane: Membrane::Measured(MeasuredMembrane::new(&STRETCH, 1.0)),
        bending: Some(Bending::Measured(MeasuredBending::new(&BEND, 1.0))),
        bending_model: BendingModel::ShapeOperator,
        tension_field: false,
        strain_limits: Some(StrainLimits { min: 0.95, max: 1.05 }),
        damping: Damping { mass: 0.0, stiffness: 2e-3 },
    }
}

fn orthotropic() -> Fabric {
    Fabric {
        membrane: Membrane::Orthotropic(Quadratic::orthotropic(900.0, 120.0, 400.0, 70.0).unwrap()),
        bending: Some(Bending::Orthotropic(
            Quadratic::orthotropic(4e-5, 3e-6, 1e-5, 8e-6).unwrap(),
        )),
        damping: Damping::default(),
        ..measured()
    }
}

/// An irregular sheet with inner and boundary triangles.
fn sheet() -> ClothState {
    let sheet = grid([0.09, 0.07], [3, 3], Diagonal::Alternating).unwrap();
    let mut material = sheet.mesh.material().to_vec();
    let mut noise = Noise(3);
    let shift: Vec<_> = (0..16).map(|_| noise.vector(0.005)).collect();
    for (corners, u) in sheet.mesh.triangles().iter().zip(&mut material) {
        for (i, u) in corners.iter().zip(u) {
            *u += shift[*i as usize].xy();
        }
    }
    let triangles = sheet.mesh.triangles().to_vec();
    let panels = vec![0; triangles.len()];
    let mesh = mesh_core::Mesh::new(16, triangles, material, panels).unwrap();
    let shifted = |(x, s): (&World3, &World3)| World3::new(x.x + s.x, x.y + s.y, 0.0);
    let positions = sheet.positions.iter().zip(&shift).map(shifted).collect();
    ClothState::at_rest(mesh, positions, vec![0.2]).unwrap()
}

/// Positions to test at: near rest, strongly deformed, crumpled, inverted, collapsed to a plane.
fn poses(cloth: &ClothState) -> Vec<(&'static str, Vec<World3>)> {
    let mut noise = Noise(11);
    let mut moved = |scale: f64, map: &dyn Fn(World3) -> World3| -> Vec<World3> {
        cloth.x.iter().map(|x| map(*x) + noise.vector(scale)).collect()
    };
    let turn = nalgebra::Rotation3::from_euler_angles(0.4, -1.1, 2.0);
    vec![
        ("near rest", moved(4e-4, &|x| x)),
        ("turned", moved(1e-3, &|x| turn * x + World3::new(3.0, -2.0, 1.0))),
        ("stretched", moved(2e-3, &|x| World3::new(1.3 * x.x, 0.8 * x.y, 0.0))),
        ("strong", moved(1e-2, &|x| x)),
        ("crumpled", moved(3e-2, &|x| x * 0.1)),
        ("mirrored", moved(2e-3, &|x| World3::new(-x.x, x.y, 0.0))),
        ("nearly flattened to a line", moved(1e-4, &|x| World3::new(x.x, 0.05 * x.y, 0.0))),
    ]
}

fn gather<const N: usize>(stencil: &[u32; N], x: &[World3]) -> [World3; N] {
    stencil.map(|i| if i == u32::MAX { World3::zeros() } else { x[i as usize] })
}

/// Checks one model at one pose; `kinks` is the share of elements that may sit on a kink of a
/// piecewise law, where differences across it disagree.
fn check<const N: usize>(model: &mut impl ElementModel<N>, cloth: &ClothState, kinks: f64) {
    let base: Vec<World3> = cloth.x.iter().map(|x| x + World3::new(0.001, 0.0, -0.002)).collect();
    model.begin(Stage { x_t0: &cloth.x, base: &base, h: 0.005 });
    let (mut bad, mut total) = (0usize, 0usize);
    for (pose, x) in poses(cloth) {
        for e in 0..model.stencils().len() {
            let stencil = model.stencils()[e];
            let corners = gather(&stencil, &x);
            let mut system = ElementSystem::<N>::zero();
            model.system(e, &corners, Stiffness::Exact, &mut system);
            let gradient = model.gradient(e, &corners);
            let scale_g = gradient.iter().map(|g| g.norm()).fold(0.0, f64::max);
            for (a, b) in gradient.iter().zip(&system.gradient) {
                assert!((a - b).norm() <= 1e-9 * scale_g, "{pose}: gradient() and system() differ");
            }
            let scale_k = system.stiffness.iter().flatten().map(|k| k.norm()).fold(0.0, f64::max);
            let step = 2e-7;
            for j in (0..N).filter(|&j| stencil[j] != u32::MAX) {
                for axis in 0..3 {
                    let moved = |by: f64| {
                        let mut moved = corners;
                        moved[j][axis] += by;
                        moved
                    };
                    // Central differences at two steps, extrapolated (Richardson).
                    let slope = |h: f64| {
                        (model.energy(e, &moved(h)) - model.energy(e, &moved(-h))) / (2.0 * h)
                    };
                    let slope = (4.0 * slope(0.5 * step) - slope(step)) / 3.0;
                    let column = |h: f64| {
                        let (plus, minus) =
                            (model.gradient(e, &moved(h)), model.gradient(e, &moved(-h)));
                        std::array::from_fn::<World3, N, _>(|i| (plus[i] - minus[i]) / (2.0 * h))
                    };
                    let (coarse, fine) = (column(step), column(0.5 * step));
                    total += 1;
                    // Rounding of the energy and of the gradient limits what differences can tell.
                    let energy_floor = 1e-15 * model.energy(e, &corners).abs() / step;
                    let gradient_floor = 1e-15 * scale_g / step;
                    let mut ok = (slope - gradient[j][axis]).abs()
                        <= 1e-6 * scale_g + 10.0 * energy_floor + 1e-8 * scale_k * step;
                    for i in j..N {
                        let fd = (fine[i] * 4.0 - coarse[i]) / 3.0;
                        let exact = system.stiffness[i][j].column(axis).into_owned();
                        ok &= (fd - exact).norm() <= 1e-6 * scale_k + 10.0 * gradient_floor;
                    }
                    bad += usize::from(!ok);
                    assert!(
                        ok || kinks > 0.0,
                        "{} element {e}, {pose}, corner {j} axis {axis}: energy slope {slope}, \
                         gradient {}, scales {scale_g} {scale_k}",
                        model.name(),
                        gradient[j][axis]
                    );
                }
            }
            projected_is_positive(model, e, &corners);
        }
    }
    assert!(bad as f64 <= kinks * total as f64, "{}: {bad} of {total} disagree", model.name());
}

fn dense<const N: usize>(system: &ElementSystem<N>) -> DMatrix<f64> {
    DMatrix::from_fn(3 * N, 3 * N, |r, c| {
        let (i, j) = (r / 3, c / 3);
        if i >= j {
            system.stiffness[i][j][(r % 3, c % 3)]
        } else {
            system.stiffness[j][i][(c % 3, r % 3)]
        }
    })
}

fn projected_is_positive<const N: usize>(model: &impl ElementModel<N>, e: usize, x: &[World3; N]) {
    let mut system = ElementSystem::<N>::zero();
    model.system(e, x, Stiffness::Projected, &mut system);
    let eigenvalues = dense(&system).symmetric_eigenvalues();
    let largest = eigenvalues.amax();
    assert!(
        eigenvalues.min() >= -1e-9 * largest,
        "{}: projected stiffness has the eigenvalues {eigenvalues}",
        model.name()
    );
}

/// Where the exact Hessian is positive the projected one must be the same.
fn exact_where_flat<const N: usize>(model: &mut impl ElementModel<N>, cloth: &ClothState) {
    let x: Vec<World3> = cloth.x.iter().map(|x| x * 1.001).collect();
    model.begin(Stage { x_t0: &x, base: &cloth.x, h: 0.005 });
    for e in 0..model.stencils().len() {
        let corners = gather(&model.stencils()[e], &x);
        let [mut exact, mut projected] = [ElementSystem::<N>::zero(), ElementSystem::<N>::zero()];
        model.system(e, &corners, Stiffness::Exact, &mut exact);
        model.system(e, &corners, Stiffness::Projected, &mut projected);
        let (exact, projected) = (dense(&exact), dense(&projected));
        assert!((&exact - projected).norm() <= 1e-9 * exact.norm(), "{} {e}", model.name());
    }
}

fn parts(fabric: Fabric) -> (ClothState, Arc<Vec<RestTriangle>>, Arc<Vec<Fabric>>) {
    let cloth = sheet();
    let rest = Arc::new(RestTriangle::all(&cloth));
    (cloth, rest, Arc::new(vec![fabric]))
}

#[test]
fn membrane_orthotropic() {
    let (cloth, rest, fabrics) = parts(orthotropic());
    let mut model = MembraneModel::new(cloth.mesh.triangles(), rest, fabrics);
    check(&mut model, &cloth, 0.0);
    exact_where_flat(&mut model, &cloth);
}

#[test]
fn membrane_measured_and_damped() {
    let (cloth, rest, fabrics) = parts(measured());
    let mut model = MembraneModel::new(cloth.mesh.triangles(), rest, fabrics);
    check(&mut model, &cloth, 0.002);
}

/// Triangles that buckle within: taut ones, folded ones, slack ones.
#[test]
fn membrane_with_a_tension_field() {
    for fabric in [orthotropic(), measured()] {
        let (cloth, rest, fabrics) = parts(Fabric { tension_field: true, ..fabric });
        let mut model = MembraneModel::new(cloth.mesh.triangles(), rest, fabrics);
        check(&mut model, &cloth, 0.01);
    }
}

#[test]
fn bending_orthotropic() {
    let (cloth, rest, fabrics) = parts(orthotropic());
    let mut model = ShapeOperatorModel::new(&cloth.mesh, rest, fabrics).unwrap();
    check(&mut model, &cloth, 0.0);
    exact_where_flat(&mut model, &cloth);
}

#[test]
fn bending_measured_and_damped() {
    let (cloth, rest, fabrics) = parts(measured());
    let mut model = ShapeOperatorModel::new(&cloth.mesh, rest, fabrics).unwrap();
    check(&mut model, &cloth, 0.002);
}

#[test]
fn hinges() {
    let fabric = Fabric { bending_model: BendingModel::Hinge, ..orthotropic() };
    let (cloth, _, fabrics) = parts(fabric);
    let mut model = HingeModel::new(&cloth.mesh, &fabrics).unwrap();
    check(&mut model, &cloth, 0.0);
    exact_where_flat(&mut model, &cloth);
}

#[test]
fn strain_limits() {
    let (cloth, rest, fabrics) = parts(measured());
    let mut model = StrainLimitModel::new(cloth.mesh.triangles(), rest, fabrics).unwrap();
    check(&mut model, &cloth, 0.0);
}

#[test]
fn wind() {
    let cloth = sheet();
    let wind = Wind { velocity: World3::new(10.0, 1.0, -2.0), density: 1.2, drag: 0.3 };
    let mut model = WindModel::new(cloth.mesh.triangles(), wind);
    check(&mut model, &cloth, 0.0);
}

/// Laws on their own: stress and tangent against differences of the energy.
fn check_law(law: &dyn Law, a: Vector3<f64>) {
    let at = law.response(&a);
    assert!((at.energy - law.energy(&a)).abs() <= 1e-13 * at.energy.abs().max(1e-12));
    let step = 1e-6 * a.norm().max(1e-3);
    for k in 0..3 {
        let d = Vector3::ith(k, step);
        let (plus, minus) = (law.response(&(a + d)), law.response(&(a - d)));
        let slope = (plus.energy - minus.energy) / (2.0 * step);
        let scale = at.tangent.norm() * a.norm();
        assert!((slope - at.stress[k]).abs() <= 1e-6 * scale, "{a:?}: {slope} {}", at.stress[k]);
        let column = (plus.stress - minus.stress) / (2.0 * step);
        let error = (column - at.tangent.column(k)).norm();
        assert!(error <= 1e-5 * at.tangent.norm(), "{a:?} {k}: {error}");
    }
}

#[test]
fn laws() {
    let membrane = MeasuredMembrane::new(&STRETCH, 2.0);
    let bending = MeasuredBending::new(&BEND, 1.0);
    assert_eq!(membrane.repaired_rows(), 1);
    let mut noise = Noise(5);
    for k in 0..400 {
        let a = noise.vector([1e-3, 0.03, 0.2, 1.0][k % 4]);
        check_law(&membrane, a);
        check_law(&bending, a * [3e3, 300.0, 120.0, 14.0][k % 4]);
    }
}

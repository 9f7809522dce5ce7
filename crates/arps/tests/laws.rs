//! The laws: derivatives against finite differences, conjugates against their definition, values
//! against independent tables.

mod common;

use arps::{Held, Law, Matrix3, Vector3};
use common::{reference, table};
use proptest::prelude::*;

const CONVEX: [Law; 4] = [Law::Ramp, Law::Soft, Law::Exact, Law::Smooth];

fn any_law() -> impl Strategy<Value = Law> {
    prop::sample::select(Law::ALL.to_vec())
}

fn convex_law() -> impl Strategy<Value = Law> {
    prop::sample::select(CONVEX.to_vec())
}

/// Mass, p_r, and p_f far enough above for every law.
fn thresholds() -> impl Strategy<Value = [f64; 3]> {
    (0.01..10.0f64, 0.05..5.0f64, 2.1..30.0f64).prop_map(|(m, p_r, ratio)| [m, p_r, ratio * p_r])
}

/// A momentum norm in the ball, the transition or beyond, not within a difference of a corner of φ′.
fn norm(held: &Held, at: f64) -> f64 {
    let (p_r, p_f) = (held.p_r(), if held.p_f() < 1e9 { held.p_f() } else { 3.0 * held.p_r() });
    let r = at * 1.5 * p_f;
    let corners = [0.0, p_r, p_f - p_r, p_f];
    let near = corners.iter().any(|corner| (r - corner).abs() < 1e-3 * p_f);
    if near { r + 3e-3 * p_f } else { r }
}

fn direction(a: f64, z: f64) -> Vector3 {
    let across = (1.0 - z * z).sqrt();
    Vector3::new(across * a.cos(), across * a.sin(), z)
}

proptest! {
    #[test]
    fn slopes_are_derivatives(law in any_law(), [m, p_r, p_f] in thresholds(), at in 0.0..1.0f64) {
        let held = Held::new(law, m, p_r, p_f).unwrap();
        let r = norm(&held, at);
        let e = 1e-5 * p_f;
        let by_difference = |f: &dyn Fn(f64) -> f64| (f(r + e) - f(r - e)) / (2.0 * e);
        let scale = 1.0 + held.ddphi(r).abs();
        prop_assert!((by_difference(&|r| held.phi(r)) - held.dphi(r)).abs() < 1e-6 * p_f * scale);
        prop_assert!((by_difference(&|r| held.dphi(r)) - held.ddphi(r)).abs() < 1e-4 * scale);
    }

    #[test]
    fn velocity_and_r_are_derivatives(
        law in any_law(), [m, p_r, p_f] in thresholds(), at in 0.0..1.0f64, a in 0.0..6.0f64, z in -1.0..1.0f64,
    ) {
        let held = Held::new(law, m, p_r, p_f).unwrap();
        let p = norm(&held, at) * direction(a, z);
        let e = 1e-5 * p_f;
        let mut gradient = Vector3::zeros();
        let mut r = Matrix3::zeros();
        for k in 0..3 {
            let step = Vector3::ith(k, e);
            let (up, down) = (p + step, p - step);
            gradient[k] = (held.kinetic_energy(&up) - held.kinetic_energy(&down)) / (2.0 * e);
            r.set_column(k, &((held.velocity(&up) - held.velocity(&down)) * (m / (2.0 * e))));
        }
        let expected = held.r_matrix(&p);
        let scale = 1.0 + expected.norm();
        prop_assert!((gradient - held.velocity(&p)).norm() < 1e-6 * p_f / m * scale);
        prop_assert!((r - expected).norm() < 1e-4 * scale, "{r} {expected}");
        prop_assert!((held.s(&p) - m * held.velocity(&p)).norm() <= 1e-14 * p.norm() * scale);
    }

    #[test]
    fn the_convex_laws_are_convex(law in convex_law(), [m, p_r, p_f] in thresholds()) {
        let held = Held::new(law, m, p_r, p_f).unwrap();
        let mut last = 0.0;
        for i in 0..=300 {
            let carried = held.dphi(1.5 * p_f * f64::from(i) / 300.0);
            prop_assert!(carried >= last);
            last = carried;
        }
        prop_assert!(held.conjugate().is_ok());
    }

    #[test]
    fn the_conjugate_is_the_supremum(law in convex_law(), [m, p_r, p_f] in thresholds(), at in 0.0..1.5f64) {
        let held = Held::new(law, m, p_r, p_f).unwrap();
        let conjugate = held.conjugate().unwrap();
        let speed = at * p_f / m;
        let psi = conjugate.psi(speed);
        let scale = p_f * p_f / m;
        // Fenchel's inequality for a grid of momenta, and equality at its slope.
        for i in 0..=200 {
            let r = 2.0 * p_f * f64::from(i) / 200.0;
            prop_assert!(r * speed - held.phi(r) / m <= psi + 1e-12 * scale);
        }
        let r = conjugate.dpsi(speed);
        prop_assert!((r * speed - held.phi(r) / m - psi).abs() < 1e-12 * scale);
        prop_assert!((held.dphi(r) / m - speed).abs() < 1e-12 * p_f / m);
    }

    #[test]
    fn slopes_of_the_conjugate(law in convex_law(), [m, p_r, p_f] in thresholds(), at in 0.02..1.5f64) {
        let conjugate = Held::new(law, m, p_r, p_f).unwrap().conjugate().unwrap();
        // Away from the corner at full speed.
        let at = if (at - 1.0).abs() < 1e-3 { 1.01 } else { at };
        let (speed, e) = (at * p_f / m, 1e-6 * p_f / m);
        let by_difference = |f: &dyn Fn(f64) -> f64| (f(speed + e) - f(speed - e)) / (2.0 * e);
        prop_assert!((by_difference(&|v| conjugate.psi(v)) - conjugate.dpsi(speed)).abs() < 1e-7 * p_f);
        let ddpsi = conjugate.ddpsi(speed);
        prop_assert!((by_difference(&|v| conjugate.dpsi(v)) - ddpsi).abs() < 1e-4 * (m + ddpsi));
        let v = speed * direction(1.0, 0.3);
        let mut mass = Matrix3::zeros();
        for k in 0..3 {
            let step = Vector3::ith(k, e);
            mass.set_column(k, &((conjugate.momentum(&(v + step)) - conjugate.momentum(&(v - step))) / (2.0 * e)));
        }
        let expected = conjugate.effective_mass(&v);
        prop_assert!((mass - expected).norm() < 1e-4 * expected.norm());
    }

    #[test]
    fn the_proximal_map_is_a_minimum(
        law in convex_law(), [m, p_r, p_f] in thresholds(), at in 0.0..3.0f64, stiff in -3.0..8.0f64, h in 1e-3..0.1f64,
    ) {
        let conjugate = Held::new(law, m, p_r, p_f).unwrap().conjugate().unwrap();
        let lambda = m / h * 10f64.powf(stiff);
        let c = at * p_f * (1.0 + lambda * h / m) * direction(0.4, -0.2);
        let d = conjugate.proximal(&c, lambda, h);
        // Optimality: c − λ d is a momentum that goes with the velocity d/h.
        let p = c - lambda * d;
        let rounding = 1e-12 * (c.norm() + p_f);
        if d.norm() == 0.0 {
            prop_assert!(p.norm() <= p_r + rounding && (p_r == 0.0 || c.norm() <= p_r));
        } else {
            let held = conjugate.held();
            prop_assert!((held.velocity(&p) * h - d).norm() * (m / h) <= rounding * (1.0 + held.ddphi(p.norm())),
                "{} {}", held.velocity(&p) * h, d);
        }
    }
}

/// The table has the thresholds 0.05 J and 1 J, and 0.01 kg.
#[test]
fn r_against_the_table() {
    // Three rows of arps_R_cases.csv: K, p, rho, s, R by rows.
    const CASES: &str = "\
0.536230543465,0.0540031794938,0.0217189127062,-0.0856536998893,0.47784271271,0.085288524631,0.0343012029785,-0.135274955312,2.66780722775,0.437764397201,-1.72642805868,0.437764397201,1.7553835209,-0.694332086583,-1.72642805868,-0.694332086583,4.31758792047
0.177339612385,-0.0199388581446,-0.0533082647658,-0.0175346254948,0.980499155472,-0.00189327362671,-0.00506183107553,-0.00166498220524,0.168604662696,0.196911523005,0.0647698781167,0.196911523005,0.621413981715,0.173167880851,0.0647698781167,0.173167880851,0.151913873947
0.860001196557,-0.0767070824797,-0.00808847311165,-0.106068958849,0.0253463891872,-0.107652368684,-0.0113515370597,-0.148859457235,-0.991056903049,-0.252488734365,-3.31103495128,-0.252488734365,1.37679751245,-0.349136172429,-3.31103495128,-0.349136172429,-3.17500879238";
    let whole = reference("arps_R_cases.csv");
    for row in table(CASES).into_iter().chain(whole) {
        let m = 0.01;
        let root = |energy: f64| (2.0 * m * energy).sqrt();
        let held = Held::new(Law::Spline, m, root(0.05), root(1.0)).unwrap();
        let p = Vector3::from_column_slice(&row[1..4]);
        assert!((p.norm_squared() / (2.0 * m) - row[0]).abs() < 1e-10);
        assert!((held.rho(p.norm()) - row[4]).abs() < 1e-9);
        assert!((held.s(&p) - Vector3::from_column_slice(&row[5..8])).norm() < 1e-10);
        assert!((held.r_matrix(&p) - Matrix3::from_row_slice(&row[8..17])).norm() < 1e-8);
    }
}

/// Least and greatest slope over the transition.
fn range(held: &Held) -> [f64; 2] {
    let n = 200_000;
    let slope = |i: i32| {
        let t = f64::from(i) / f64::from(n);
        held.ddphi(held.p_r() + t * (held.p_f() - held.p_r()))
    };
    (1..n)
        .map(slope)
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], s| [low.min(s), high.max(s)])
}

#[test]
fn no_thresholds_make_the_spline_convex() {
    // arps_R_eigen_range.csv and arps_R_range_by_family.csv: ε_f/ε_r, then least and greatest radial
    // eigenvalue of R with ρ in the energy, then in the momentum norm.
    const RANGES: [[f64; 5]; 4] = [
        [6.0, -8.465637798, 7.681767197, -3.93173024, 5.798831893],
        [20.0, -5.831139608, 5.799937437, -1.518933328, 3.528117098],
        [100.0, -5.158086368, 5.330953841, -0.7320270986, 2.791670319],
        [400.0, -5.04197076, 5.250520506, -0.50778034, 2.580471946],
    ];
    for [ratio, low, high, low_norm, high_norm] in RANGES {
        let spline = |law| range(&Held::new(law, 1.0, 1.0, f64::sqrt(ratio)).unwrap());
        let close = |[a, b]: [f64; 2], c: f64, d: f64| (a - c).abs() < 1e-5 && (b - d).abs() < 1e-5;
        assert!(close(spline(Law::Spline), low, high), "{:?}", spline(Law::Spline));
        assert!(close(spline(Law::MomentumSpline), low_norm, high_norm));
        let error =
            Held::new(Law::Spline, 1.0, 1.0, f64::sqrt(ratio)).unwrap().conjugate().unwrap_err();
        assert!(error.to_string().contains("not convex"), "{error}");
    }
}

#[test]
fn slope_of_the_default() {
    // The slope 1.29 at a ratio of energies of 20.
    let held = Held::new(Law::Ramp, 1.0, 1.0, f64::sqrt(20.0)).unwrap();
    assert!((held.ddphi(2.0) - 1.288).abs() < 5e-4);
}

//! The bound by pixels: against tables, in its limits, and as a property.

mod common;

use common::reference;
use nalgebra::Matrix2;
use proptest::prelude::*;
use remesh::Metric;
use sizing_view::bounded;

/// Rows of sizing_clamp_reference.csv of the reference tables, one per ratio of singular values from
/// 1 to 1e-16: M (xx, xy, yy), S row by row, ℓ_min, result (xx, xy, yy). Computed in high precision
/// from the paper's form.
#[rustfmt::skip]
#[allow(clippy::excessive_precision)] // As in the table.
const CLAMPED: [[f64; 11]; 9] = [
    [2902.1101025829935, 2440.280063144708, 2855.7323127112172, -0.050659882448894522, 0.63407248208345879, -0.63407248208345879, -0.050659882448894508, 0.0025964641834624646, 2902.1101025829935, 2440.280063144708, 2855.7323127112172],
    [1188.2210372837917, 620.29374313624987, 328.41491955756067, -0.43651125371385546, 0.72321352596917365, -0.066701366959531758, 0.093861653262663353, 0.082857522240967346, 0.98090660193069168, -1.6020685561019758, 2.655714990943927],
    [838.87871153735796, -473.78225727847939, 1998.6155295806338, 0.71734600403685, -0.56674203448747806, 3.381286033433816, -2.6686952097036984, 0.016189175719092699, 818.87651323807347, -646.33004120454757, 510.1422481782509],
    [162.99960185702466, 817.04971580876111, 4158.7639838321775, 1.7783755453997303, 1.7983934783848887, 0.99772557182243837, 1.0089610018098278, 0.0053145781293683853, 3.8558899514898655, 3.8992975374354986, 3.943194385480413],
    [370.07839360805121, 497.4049437279424, 678.55755781228322, 3.9064321653341412, 1.0800227038831665, 2.4333471561317541, 0.67275464972304744, 0.0022111384567233779, 8.5867296642930562, 2.3739982735526932, 0.6563462490938532],
    [1475.8683477047616, -2639.1109789457682, 4723.4224457629716, 0.84946769000621936, 0.24102708891961361, -2.1347355597626709, -0.60570767207007548, 0.035788606329207509, 0.98470675971030219, 0.27939968323406106, 0.079276578759609556],
    [1785.7244739259147, -931.26732593088661, 506.09872911525207, 0.25739791623298269, 0.7427485018050588, -0.69938540141270844, -2.0181494344664577, 0.0021098249349516718, 1.7587624168310394, 5.0750921733896917, 14.644707165627185],
    [53.010571606299507, -0.22980914644636052, 71.429591350966888, -0.2229632475256666, 0.74784409865648471, 0.19947070502584377, -0.66904743837328806, 0.002088749005124309, 5.6831632728976142, -19.061976188917125, 63.936036812396829],
    [6597.6503293614887, 1252.4573364723997, 1958.6927501080447, -1.3131378025041169, 1.4448041117916239, 2.4058916250604701, -2.6471266806756191, 0.0090728665540192269, 893.89675080211236, -983.52640416961538, 1082.1430851279113],
];

/// Largest error of a row by the largest entry of the result.
fn error(row: &[f64]) -> f64 {
    let m = Metric::new(row[0], row[1], row[2]);
    let s = Matrix2::new(row[3], row[4], row[5], row[6]);
    let got = bounded(m, &(s / row[7])).entries();
    let errors = got.iter().zip(&row[8..11]).map(|(a, b)| (a - b).abs());
    errors.fold(0.0, f64::max) / row[8].max(row[10])
}

#[test]
fn agrees_with_the_paper_where_that_can_be_computed() {
    for row in &CLAMPED {
        assert!(error(row) < 1e-11, "error {:e} of {row:?}", error(row));
    }
}

#[test]
fn agrees_with_the_whole_table() {
    let Some(rows) = reference("sizing_clamp_reference.csv") else { return };
    let worst = rows.iter().map(|row| error(&row[1..])).fold(0.0, f64::max);
    assert_eq!(rows.len(), 54);
    assert!(worst < 1e-11, "error {worst:e}");
}

#[test]
fn limits_are_exact() {
    let (one, zero, line) = (Metric::uniform(1.0), Metric::ZERO, Metric::new(4.0, 0.0, 0.0));
    let along_x = Matrix2::new(2.0, 0.0, 0.0, 0.0);
    let nothing = Matrix2::zeros();
    assert_eq!(bounded(one, &Matrix2::new(f64::INFINITY, 0.0, 0.0, f64::INFINITY)), one);
    assert_eq!(bounded(one, &Matrix2::new(f64::NAN, 0.0, 0.0, 1.0)), one);
    assert_eq!(bounded(one, &nothing), zero);
    assert_eq!(bounded(line, &nothing), zero);
    assert_eq!(bounded(zero, &Matrix2::identity()), zero);
    // Of two lines only what they share is left.
    assert_eq!(bounded(one, &along_x), Metric::new(1.0, 0.0, 0.0));
    assert_eq!(bounded(line, &along_x), line);
    assert_eq!(bounded(line, &Matrix2::identity()), Metric::new(1.0, 0.0, 0.0));
    assert_eq!(bounded(line, &Matrix2::new(0.0, 0.0, 0.0, 2.0)), zero);
    // A broken wish stays broken.
    assert!(!bounded(Metric::new(f64::NAN, 0.0, 1.0), &Matrix2::identity()).is_valid());
    assert!(!bounded(Metric::new(1.0, 0.0, f64::NAN), &Matrix2::identity()).is_valid());
}

/// Eigenvalues over eight decades, sometimes zero, at any angle.
fn any_metric() -> impl Strategy<Value = Metric> {
    let lambda = || prop_oneof![4 => (-4.0..4.0f64).prop_map(|e| 10f64.powf(e)), 1 => Just(0.0)];
    (lambda(), lambda(), 0.0..std::f64::consts::TAU).prop_map(|(p, q, angle)| {
        let (s, c) = angle.sin_cos();
        Metric::new(p * c * c + q * s * s, (p - q) * s * c, p * s * s + q * c * c)
    })
}

/// Pictures of any size and shape, some of them edge-on.
fn any_screen() -> impl Strategy<Value = Matrix2<f64>> {
    let entries =
        prop::array::uniform4(-1.0..1.0f64).prop_map(|[a, b, c, d]| Matrix2::new(a, b, c, d));
    let edge_on = prop::array::uniform4(-1.0..1.0f64)
        .prop_map(|[a, b, c, d]| Matrix2::new(a * c, b * c, a * d, b * d));
    (prop_oneof![entries, edge_on], -2.0..2.0f64).prop_map(|(s, e)| s * 10f64.powf(e))
}

proptest! {
    #[test]
    fn is_below_both(m in any_metric(), r in any_screen(), angle in 0.0..std::f64::consts::TAU) {
        let (least, n) = (bounded(m, &r), Metric::of_gradient(&r, 1.0));
        prop_assert!(least.is_valid());
        let u = nalgebra::Vector2::new(angle.cos(), angle.sin());
        let size = least.size_squared(u);
        let rounding = 1e-9 * (m.trace() + n.trace());
        prop_assert!(size <= m.size_squared(u) + rounding, "{size} > {}", m.size_squared(u));
        prop_assert!(size <= n.size_squared(u) + rounding, "{size} > {}", n.size_squared(u));
    }

    /// Least and greatest on the common basis have the same sum as the two.
    #[test]
    fn complements_the_maximum(m in any_metric(), r in any_screen()) {
        let n = Metric::of_gradient(&r, 1.0);
        let sum = m + n;
        prop_assume!(sum.determinant() > 1e-8 * sum.trace().powi(2));
        let error = bounded(m, &r) + m.max(n) + sum * -1.0;
        let size = error.entries().into_iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        prop_assert!(size < 1e-7 * sum.trace(), "{size:e} of {}", sum.trace());
    }
}

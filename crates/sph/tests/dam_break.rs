//! The front of a dam break against the experiment of Martin1952.

mod common;

use nalgebra::Vector3;
use sph::{Bounds, Fluid, FluidSettings, Open, Walls, scenes};

/// Front position over column width at times t √(2 g / a), for columns twice as high as wide
/// (n² = 2, a = 2.25 in): Martin1952 Table 2.
const MEASURED: [(f64, f64); 12] = [
    (0.84, 1.22),
    (1.19, 1.44),
    (1.43, 1.67),
    (1.63, 1.89),
    (1.83, 2.11),
    (1.98, 2.33),
    (2.20, 2.56),
    (2.32, 2.78),
    (2.51, 3.00),
    (2.65, 3.22),
    (2.83, 3.44),
    (3.11, 3.89),
];

#[test]
fn front_moves_as_measured() {
    // A column of 16 by 32 spacings between side walls four spacings apart.
    let (wide, high) = (16, 32);
    let width = 0.4;
    let spacing = width / wide as f64;
    let basin = Bounds::new(Vector3::zeros(), Vector3::new(5.0 * width, 4.0 * spacing, 1.0));
    let mut walls = Walls::none();
    walls.add_box(&basin, Open::TOP, spacing).unwrap();
    let water = FluidSettings::water(spacing, 2.0 * width, basin.grown(1.0));
    let settings = FluidSettings { wall_viscosity: 0.0, ..water };
    let x = scenes::block([wide, 4, high], Vector3::zeros(), spacing, 0);
    let mut fluid = Fluid::new(settings, walls, &x, &vec![Vector3::zeros(); x.len()]).unwrap();
    let unit = (width / (2.0 * 9.81)).sqrt();
    let mut lags = Vec::new();
    let (mut time, mut last) = (0.0, 1.0);
    let mut measured = MEASURED.iter().peekable();
    while let Some(&&(at, z)) = measured.peek() {
        fluid.advance(0.02 * unit).unwrap();
        let mut fronts: Vec<f64> = fluid.particles().map(|p| p.position.x).collect();
        // A few drops may run ahead.
        fronts.sort_by(f64::total_cmp);
        let front = (fronts[fronts.len() - 6] + 0.5 * spacing) / width;
        while measured.peek().is_some_and(|&&(_, z)| front >= z) {
            let &(at, z) = measured.next().unwrap();
            lags.push(at - (time + 0.02 * (z - last) / (front - last)));
        }
        (time, last) = (time + 0.02, front);
        assert!(time < at + 1.0, "the front needs more than {time} to get to {z}");
    }
    // The experiment starts late: the film that held the water takes time to melt away.
    let mean = lags.iter().sum::<f64>() / lags.len() as f64;
    let spread = lags.iter().map(|lag| (lag - mean).abs()).fold(0.0, f64::max);
    assert!((0.0..0.5).contains(&mean), "ahead of the experiment by {mean}: {lags:?}");
    assert!(spread < 0.15, "{lags:?}");
}

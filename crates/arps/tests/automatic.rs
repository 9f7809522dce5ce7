//! Thresholds from an acceptable error: the bound that they promise, against unrestrained runs.

use arps::{Automatic, Explicit, Now, Particles, Scheme, Vector3};
use proptest::prelude::*;

/// A linear net: springs of random stiffness between all pairs and to where they are.
fn spring_net(stiffness: &[f64], x0: &[Vector3], now: Now<'_>, f: &mut [Vector3]) {
    let mut k = stiffness.iter().cycle();
    for i in 0..x0.len() {
        f[i] -= *k.next().unwrap() * (now.x[i] - x0[i]);
        for j in 0..i {
            let pull = *k.next().unwrap() * ((now.x[i] - x0[i]) - (now.x[j] - x0[j]));
            f[i] -= pull;
            f[j] += pull;
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn linear_systems_keep_to_the_bound(
        list in prop::collection::vec((prop::array::uniform3(-0.2..0.2f64), 0.1..2.0f64), 2..6),
        stiffness in prop::collection::vec(0.0..50.0f64, 5..20),
        error in 0.001..0.3f64,
    ) {
        let x0: Vec<Vector3> = (0..list.len()).map(|i| Vector3::x() * i as f64).collect();
        let v: Vec<Vector3> = list.iter().map(|(v, _)| Vector3::from(*v)).collect();
        let masses: Vec<f64> = list.iter().map(|(_, m)| *m).collect();
        let mut free = Particles::new(x0.clone(), &v, masses.clone()).unwrap();
        let mut restrained = free.clone();
        let duration = 4.0;
        let automatic = Automatic::for_error(error, duration).unwrap();
        let mut plain = Explicit::new((), Scheme::StormerVerlet);
        let mut stepper = Explicit::new(automatic.speed, Scheme::StormerVerlet);
        let h = 1e-3;
        let total: f64 = masses.iter().sum();
        for _ in 0..4000 {
            plain.step(&mut free, h, |now, f| spring_net(&stiffness, &x0, now, f)).unwrap();
            stepper.step(&mut restrained, h, |now, f| spring_net(&stiffness, &x0, now, f)).unwrap();
            let square = |i: usize| masses[i] * (free.x[i] - restrained.x[i]).norm_squared();
            let rms = ((0..list.len()).map(square).sum::<f64>() / total).sqrt();
            // The step adds an error of its own to both, of order h².
            let bound = error * free.time / duration;
            prop_assert!(rms <= bound + 1e-4, "{rms} > {bound} at {}", free.time);
        }
    }

    #[test]
    fn thrown_particles_keep_to_the_bound(
        v in prop::array::uniform3(-1.0..1.0f64), push in prop::array::uniform3(-1.0..1.0f64), error in 0.01..2.0f64,
    ) {
        let start = || Particles::new(vec![Vector3::zeros()], &[Vector3::from(v)], vec![0.3]).unwrap();
        let (mut free, mut restrained) = (start(), start());
        let automatic = Automatic::for_error(error, 3.0).unwrap();
        let mut plain = Explicit::new((), Scheme::SymplecticEuler);
        let mut stepper = Explicit::new(automatic.speed, Scheme::SymplecticEuler);
        for _ in 0..300 {
            let force = |now: Now<'_>, f: &mut [Vector3]| f[0] += (5.0 * now.time).cos() * Vector3::from(push);
            plain.step(&mut free, 0.01, force).unwrap();
            stepper.step(&mut restrained, 0.01, force).unwrap();
            let off = (free.x[0] - restrained.x[0]).norm();
            prop_assert!(off <= error * free.time / 3.0 * (1.0 + 1e-12), "{off}");
        }
    }
}

/// The bound is not too large: drifting just below v_r reaches it.
#[test]
fn the_bound_is_reached() {
    let automatic = Automatic::for_error(0.02, 5.0).unwrap();
    assert!((automatic.speed.v_r() - 0.004).abs() < 1e-15);
    let v = 0.9999 * automatic.speed.v_r() * Vector3::y();
    let mut particles = Particles::new(vec![Vector3::zeros()], &[v], vec![1.0]).unwrap();
    let mut stepper = Explicit::new(automatic.speed, Scheme::SymplecticEuler);
    for _ in 0..500 {
        stepper.step(&mut particles, 0.01, |_, _| ()).unwrap();
    }
    let off = (particles.x[0] - 5.0 * v).norm();
    assert!((0.9998 * 0.02..=0.02).contains(&off), "{off}");
}

#[test]
fn what_is_reported_and_refused() {
    let automatic = Automatic::for_error(0.01, 2.0).unwrap();
    assert!((automatic.slope - 1.288).abs() < 1e-3);
    assert!((automatic.explicit_step - 0.881).abs() < 1e-3);
    assert_eq!((automatic.error, automatic.duration), (0.01, 2.0));
    // None at all: nothing may rest. Any: everything may.
    let none = Automatic::for_error(0.0, 2.0).unwrap();
    assert_eq!([none.slope, none.explicit_step, none.speed.v_f()], [1.0, 1.0, 0.0]);
    assert_eq!(Automatic::for_error(f64::INFINITY, 2.0).unwrap().speed.v_r(), f64::INFINITY);
    for error in [-1.0, f64::NAN] {
        assert!(Automatic::for_error(error, 1.0).unwrap_err().to_string().contains("error"));
    }
    for duration in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let message = Automatic::for_error(0.1, duration).unwrap_err().to_string();
        assert!(message.contains("duration"), "{message}");
    }
}

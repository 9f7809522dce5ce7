//! Nets without outer forces: momentum, angular momentum and energy; bleeding; refusals.

use arps::{
    Explicit, Held, Kinetic, Law, Moved, Now, Particles, Scheme, Speed, StepError, Vector3,
};
use proptest::prelude::*;

/// Springs of stiffness 10 N/m and length 0.8 m between all pairs.
fn springs(now: Now<'_>, f: &mut [Vector3]) {
    for i in 0..now.x.len() {
        for j in 0..i {
            let d = now.x[i] - now.x[j];
            let pull = d * (10.0 * (1.0 - 0.8 / d.norm().max(1e-3)));
            f[i] -= pull;
            f[j] += pull;
        }
    }
}

fn vector(size: f64) -> impl Strategy<Value = Vector3> {
    prop::array::uniform3(-size..size).prop_map(Vector3::from)
}

fn system() -> impl Strategy<Value = Particles> {
    prop::collection::vec((vector(1.0), vector(0.5), 0.1..2.0f64), 2..7).prop_map(|list| {
        let x = list.iter().map(|(x, _, _)| *x).collect();
        let v: Vec<Vector3> = list.iter().map(|(_, v, _)| *v).collect();
        Particles::new(x, &v, list.iter().map(|(_, _, m)| *m).collect()).unwrap()
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn momenta_are_conserved(
        start in system(), law in prop::sample::select(Law::ALL.to_vec()),
        scheme in prop::sample::select(vec![Scheme::SymplecticEuler, Scheme::StormerVerlet]),
        v_r in 0.0..0.5f64,
    ) {
        let mut particles = start.clone();
        let mut stepper = Explicit::new(Speed::with_law(law, v_r, 3.0 * v_r).unwrap(), scheme);
        for _ in 0..500 {
            stepper.step(&mut particles, 2e-3, springs).unwrap();
        }
        prop_assert!((particles.linear_momentum() - start.linear_momentum()).norm() < 1e-12);
        prop_assert!((particles.angular_momentum() - start.angular_momentum()).norm() < 1e-12);
    }

    #[test]
    fn thresholds_of_zero_are_as_none_to_the_bit(start in system()) {
        let (mut a, mut b) = (start.clone(), start);
        let mut none = Explicit::new((), Scheme::StormerVerlet);
        let mut zero = Explicit::new(Kinetic::new(0.0, 0.5).unwrap(), Scheme::StormerVerlet);
        for _ in 0..100 {
            let moved = none.step(&mut a, 2e-3, springs).unwrap();
            prop_assert_eq!(moved, zero.step(&mut b, 2e-3, springs).unwrap());
            prop_assert_eq!(moved.n_full, a.len());
        }
        prop_assert_eq!(a, b);
    }

    #[test]
    fn none_is_the_plain_scheme_to_the_bit(start in system()) {
        let mut particles = start.clone();
        let mut stepper = Explicit::new((), Scheme::SymplecticEuler);
        let (mut x, mut p) = (start.x.clone(), start.p.clone());
        for _ in 0..100 {
            stepper.step(&mut particles, 2e-3, springs).unwrap();
            let mut f = vec![Vector3::zeros(); x.len()];
            springs(Now { time: 0.0, x: &x, v: &x }, &mut f);
            for i in 0..x.len() {
                p[i] += 2e-3 * f[i];
                x[i] += 2e-3 * (p[i] / start.masses()[i]);
            }
        }
        prop_assert_eq!((particles.x, particles.p), (x, p));
    }
}

/// A push below p_r/τ never moves a particle that bleeds, one above does, whatever the step; the
/// report accounts for what is missing.
#[test]
fn bleeding_is_static_friction() {
    let tau = 0.1;
    for h in [1e-3, 1e-2, 1.0] {
        for (push, moves) in [(0.99, false), (1.01, true)] {
            let mut particles =
                Particles::new(vec![Vector3::zeros()], &[Vector3::zeros()], vec![2.0]).unwrap();
            let policy = Speed::new(0.05, 0.2).unwrap();
            let mut stepper =
                Explicit::new(policy, Scheme::SymplecticEuler).with_bleeding(tau).unwrap();
            let force = Vector3::new(0.0, push * 2.0 * 0.05 / tau, 0.0);
            let mut bled = Vector3::zeros();
            let mut rested = 0;
            for _ in 0..1000 {
                let moved = stepper.step(&mut particles, h, |_, f| f[0] += force).unwrap();
                bled += moved.bled;
                rested += moved.n_rest;
            }
            assert_eq!(particles.x[0] != Vector3::zeros(), moves, "{h}");
            assert_eq!(rested < 1000, moves);
            let missing = 1000.0 * h * force - particles.p[0];
            assert!((missing - bled).norm() < 1e-11 * missing.norm(), "{missing} {bled}");
        }
    }
    let explicit = || Explicit::new((), Scheme::SymplecticEuler);
    for tau in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(explicit().with_bleeding(tau).is_err());
    }
}

/// Bleeding leaves the restrained energy exactly as it is while particles rest.
#[test]
fn bleeding_costs_no_energy() {
    let held = Held::new(Law::Ramp, 1.0, 0.1, 0.4).unwrap();
    let p = Vector3::new(0.05, 0.07, 0.0);
    let left = arps::bleeding_kick(&p, &Vector3::zeros(), 0.02, 0.1);
    assert_eq!(held.kinetic_energy(&p), held.kinetic_energy(&left));
    assert!((left - p * (-0.2f64).exp()).norm() < 1e-16);
}

#[test]
fn refusals_leave_the_state_as_it_was() {
    let one = || Particles::new(vec![Vector3::zeros()], &[Vector3::x()], vec![1.0]).unwrap();
    let mut particles = one();
    let mut stepper = Explicit::new((), Scheme::StormerVerlet);
    for h in [0.0, -0.1, f64::NAN, f64::INFINITY] {
        let error = stepper.step(&mut particles, h, |_, _| ()).unwrap_err();
        assert!(matches!(error, StepError::Time { .. }), "{error}");
    }
    let error = stepper.step(&mut particles, 0.1, |_, f| f[0].y = f64::NAN).unwrap_err();
    assert_eq!(error, StepError::NotFinite { particle: 0 });
    assert_eq!(particles, one());
    assert_eq!(stepper.step(&mut particles, 0.1, |_, _| ()).unwrap().n_full, 1);
    let mut none = Particles::new(vec![], &[], vec![]).unwrap();
    assert_eq!(stepper.step(&mut none, 0.1, |_, _| ()).unwrap(), Moved::default());
}

#[test]
fn states_are_checked() {
    let zero = Vector3::zeros();
    let message = |x: Vec<Vector3>, v: Vec<Vector3>, m: Vec<f64>| {
        Particles::new(x, &v, m).unwrap_err().to_string()
    };
    assert!(message(vec![zero], vec![], vec![1.0]).contains("1 positions, 0 velocities"));
    assert!(message(vec![zero; 2], vec![zero; 2], vec![1.0, 0.0]).contains("particle 1 is 0 kg"));
    let infinite = Vector3::new(0.0, f64::INFINITY, 0.0);
    assert!(message(vec![infinite], vec![zero], vec![1.0]).contains("particle 0 is not finite"));
}

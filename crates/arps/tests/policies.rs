//! Policies at the ends of what their thresholds may be.

use arps::{Held, Kinetic, Law, Motion, Particle, Restraint, Speed, ThresholdError, Vector3};

const INFINITY: f64 = f64::INFINITY;

fn particle(mass: f64) -> Particle {
    Particle { index: 0, mass, x: Vector3::zeros(), time: 0.0 }
}

#[test]
fn none_is_p_over_m_to_the_bit() {
    for policy in
        [&() as &dyn Restraint, &Speed::new(0.0, 0.0).unwrap(), &Speed::new(0.0, 0.3).unwrap()]
    {
        let held = policy.at(&particle(0.3));
        assert!(held.is_free());
        for p in [Vector3::new(0.1, -0.2, 0.7), Vector3::new(1e-200, 0.0, 0.0), Vector3::zeros()] {
            assert_eq!(held.velocity(&p), p / 0.3);
            assert_eq!(held.motion(&p), Motion::Full);
        }
    }
}

#[test]
fn energies_and_speeds_mean_the_same() {
    for law in Law::ALL {
        let (v_r, v_f, m) = (0.1, 0.5, 0.02);
        let a = Speed::with_law(law, v_r, v_f).unwrap().at(&particle(m));
        let energy = |v: f64| 0.5 * m * v * v;
        let b = Kinetic::with_law(law, energy(v_r), energy(v_f)).unwrap().at(&particle(m));
        assert!((a.p_r() - b.p_r()).abs() < 1e-15, "{law:?}");
        assert!(law == Law::Soft || (a.p_f() - b.p_f()).abs() < 1e-15, "{law:?}");
    }
}

#[test]
fn limits() {
    let p = Vector3::new(0.0, 3.0, 4.0);
    for law in Law::ALL {
        // Rest for ever.
        let frozen = Held::new(law, 2.0, INFINITY, INFINITY).unwrap();
        assert_eq!(frozen.velocity(&(1e100 * p)), Vector3::zeros());
        assert_eq!(frozen.kinetic_energy(&p), 0.0);
        assert_eq!(frozen.scaled(0.5).motion(&p), Motion::Rest);
        if let Ok(conjugate) = frozen.conjugate() {
            assert_eq!([conjugate.psi(0.0), conjugate.psi(1.0)], [0.0, INFINITY]);
            assert_eq!([conjugate.dpsi(1.0), conjugate.ddpsi(1.0)], [INFINITY; 2]);
            assert_eq!(conjugate.proximal(&p, 1.0, 0.01), Vector3::zeros());
        }
        // No restraint.
        let free = Held::new(law, 2.0, 0.0, 0.0).unwrap();
        assert_eq!(free.velocity(&p), p / 2.0);
        assert!(free.is_free() && free.conjugate().is_ok());
        assert_eq!(free.conjugate().unwrap().momentum(&(p / 2.0)), p);
    }
    // Full dynamics never: `Ramp` and `Exact` become `Soft`, others would never move.
    for law in [Law::Ramp, Law::Exact] {
        let soft = Held::new(law, 2.0, 1.0, INFINITY).unwrap();
        assert_eq!(soft, Held::new(Law::Soft, 2.0, 1.0, 5.0).unwrap());
        assert_eq!(soft.velocity(&p), p * (4.0 / 10.0));
    }
    for law in [Law::Smooth, Law::Spline, Law::MomentumSpline] {
        assert_eq!(Held::new(law, 2.0, 1.0, INFINITY), Err(ThresholdError::NeverFull { law }));
    }
}

#[test]
fn refused_with_a_reason() {
    let says = |result: Result<Speed, ThresholdError>, what: &str| {
        let message = result.unwrap_err().to_string();
        assert!(message.contains(what), "{message}");
    };
    says(Speed::new(f64::NAN, 1.0), "the rest threshold is NaN m/s");
    says(Speed::new(0.1, f64::NAN), "the full threshold is NaN m/s");
    says(Speed::new(-0.1, 1.0), "the rest threshold is -0.1 m/s");
    says(Speed::new(0.1, -1.0), "the full threshold is -1 m/s");
    says(Speed::new(2.0, 1.0), "inverted: rest up to 2 m/s, but full dynamics from 1 m/s");
    says(Speed::new(INFINITY, 1.0), "inverted");
    for law in [Law::Ramp, Law::Exact, Law::Smooth, Law::Spline, Law::MomentumSpline] {
        says(Speed::with_law(law, 1.0, 1.0), "needs more room");
    }
    says(Speed::with_law(Law::Exact, 1.0, 2.0), "above 2");
    assert!(Speed::with_law(Law::Exact, 1.0, 2.1).is_ok());
    let message = Kinetic::with_law(Law::Exact, 1.0, 3.9).unwrap_err().to_string();
    assert!(message.contains("3.9 J"), "{message}");
    assert!(Kinetic::new(f64::NAN, 1.0).is_err() && Kinetic::new(-1.0, 1.0).is_err());
    // `Soft` has one threshold.
    assert!(Speed::with_law(Law::Soft, 1.0, f64::NAN).is_ok());
    assert!(Speed::with_law(Law::Soft, f64::NAN, 1.0).is_err());
    for mass in [0.0, -1.0, INFINITY, f64::NAN] {
        assert!(matches!(Held::new(Law::Ramp, mass, 0.1, 1.0), Err(ThresholdError::Mass { .. })));
    }
}

#[test]
fn thresholds_that_rounding_makes_equal_are_harmless() {
    let above = f64::from_bits(0.1f64.to_bits() + 1);
    let held = Speed::new(0.1, above).unwrap().at(&particle(3e-4));
    for v in [0.05, 0.1, above, 0.2] {
        let p = Vector3::new(v * 3e-4, 0.0, 0.0);
        let velocity = held.velocity(&p).x;
        assert!((0.0..=v * 1.0001).contains(&velocity), "{velocity}");
        assert!(held.conjugate().unwrap().dpsi(v).is_finite());
    }
}

#[test]
fn scaled() {
    let held = Held::new(Law::Exact, 2.0, 1.0, 5.0).unwrap();
    assert_eq!(held.scaled(2.0), Held::new(Law::Exact, 2.0, 2.0, 10.0).unwrap());
    assert_eq!(held.scaled(INFINITY).p_r(), INFINITY);
    for factor in [0.0, -1.0, f64::NAN] {
        assert!(held.scaled(factor).is_free(), "{factor}");
    }
    assert_eq!(Held::free(1.0).scaled(INFINITY), Held::free(1.0));
}

/// A policy of one's own: what is farther away than 10 m rests sooner.
struct Far(Speed);

impl Restraint for Far {
    fn at(&self, particle: &Particle) -> Held {
        self.0.at(particle).scaled(particle.x.norm() / 10.0)
    }
}

#[test]
fn a_policy_of_ones_own_plugs_in_boxed_or_not() {
    let far = Far(Speed::new(0.1, 0.4).unwrap());
    let at = Particle { x: Vector3::new(20.0, 0.0, 0.0), ..particle(1.0) };
    let boxed: Box<dyn Restraint> = Box::new(Far(Speed::new(0.1, 0.4).unwrap()));
    assert_eq!(far.at(&at).p_r(), 0.2);
    assert_eq!(boxed.at(&at), Restraint::at(&&far, &at));
}

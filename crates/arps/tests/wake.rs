//! The wake queue against stepping.

use arps::{Explicit, Particles, Rest, Scheme, Speed, Vector3, WakeQueue};
use proptest::prelude::*;

fn vector() -> impl Strategy<Value = Vector3> {
    prop::array::uniform3(-1.0..1.0f64).prop_map(Vector3::from)
}

/// Particles at rest under constant forces, some of which are zero: p (in units of p_r) and f.
fn resting() -> impl Strategy<Value = Vec<(Vector3, Vector3)>> {
    let force = prop_oneof![4 => vector(), 1 => Just(Vector3::zeros())];
    let inside = |p: Vector3| if p.norm() > 1.0 { 0.99 * p / p.norm() } else { p };
    prop::collection::vec((vector().prop_map(inside), force), 1..30)
}

proptest! {
    /// Particles wake in the step in which stepping them all would have moved them.
    #[test]
    fn as_stepping_finds(list in resting(), tau in prop::option::of(0.05..5.0f64)) {
        let (v_r, h, n_steps) = (0.1, 0.01, 300);
        let v: Vec<Vector3> = list.iter().map(|(p, _)| v_r * p).collect();
        let mut particles =
            Particles::new(vec![Vector3::zeros(); list.len()], &v, vec![1.0; list.len()]).unwrap();
        let mut stepper = Explicit::new(Speed::new(v_r, 4.0 * v_r).unwrap(), Scheme::SymplecticEuler);
        if let Some(tau) = tau {
            stepper = stepper.with_bleeding(tau).unwrap();
        }
        let mut queue = WakeQueue::new();
        for (i, (p, f)) in list.iter().enumerate() {
            queue.rest(i, Rest { since: 0.0, p: v_r * p, f: *f, p_r: v_r, bleeding: tau });
        }
        let mut awake = vec![None; list.len()];
        for step in 1..=n_steps {
            let time = f64::from(step) * h;
            stepper.step(&mut particles, h, |_, f| {
                for (f, (_, constant)) in f.iter_mut().zip(&list) {
                    *f += constant;
                }
            }).unwrap();
            let mut last = 0.0;
            while let Some((i, rest)) = queue.wake(time) {
                prop_assert!(rest.wakes_at() >= last);
                last = rest.wakes_at();
                awake[i] = Some(step);
            }
            for i in 0..list.len() {
                let moved = particles.x[i] != Vector3::zeros();
                // Never late; early by no more than rounding.
                prop_assert!(!moved || awake[i].is_some(), "particle {i} in step {step}");
                if awake[i] == Some(step) && !moved {
                    let p = particles.p[i].norm();
                    prop_assert!((p - v_r).abs() < 1e-12, "particle {i} woke at {p}");
                }
                if let Some(rest) = queue.get(i) {
                    let p = rest.momentum_at(time);
                    prop_assert!((p - particles.p[i]).norm() < 1e-12);
                }
            }
        }
        prop_assert_eq!(queue.len(), awake.iter().filter(|a| a.is_none()).count());
    }

    /// Any sequence of putting in, changing, taking out and waking gives what a plain list gives.
    #[test]
    fn as_a_plain_list(actions in prop::collection::vec((0..4u8, 0..12usize, vector(), 0.0..2.0f64), 1..400)) {
        let mut queue = WakeQueue::new();
        let mut list: Vec<Option<Rest>> = vec![None; 12];
        for (action, i, f, t) in actions {
            let rest = Rest { since: t, p: Vector3::zeros(), f, p_r: 1.0, bleeding: None };
            match action {
                0 | 1 => {
                    queue.rest(i, rest);
                    list[i] = Some(rest);
                }
                2 => prop_assert_eq!(queue.take(i), list[i].take()),
                _ => {
                    let first = (0..12)
                        .filter_map(|i| list[i].map(|rest| (rest.wakes_at(), i)))
                        .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
                    let due = first.filter(|(time, _)| *time <= t + 1.0).map(|(_, i)| i);
                    prop_assert_eq!(queue.next_time(), first.map_or(f64::INFINITY, |(time, _)| time));
                    prop_assert_eq!(queue.wake(t + 1.0), due.map(|i| (i, list[i].take().unwrap())));
                }
            }
            prop_assert_eq!(queue.len(), list.iter().flatten().count());
            prop_assert_eq!(queue.is_empty(), list.iter().flatten().next().is_none());
        }
    }
}

#[test]
fn edges() {
    let rest = Rest { since: 3.0, p: Vector3::x(), f: Vector3::x(), p_r: 1.0, bleeding: None };
    // At the border, pushed out, in and along it.
    assert_eq!(rest.wakes_at(), 3.0);
    let inward = Rest { f: -Vector3::x(), ..rest };
    assert!((inward.wakes_at() - 5.0).abs() < 1e-13);
    assert_eq!(Rest { f: Vector3::y(), ..rest }.wakes_at(), 3.0);
    // Nothing pushes; never restrained; rest for ever; bleeding that just holds.
    assert_eq!(Rest { f: Vector3::zeros(), ..rest }.wakes_at(), f64::INFINITY);
    assert_eq!(Rest { p_r: 0.5, ..rest }.wakes_at(), 3.0);
    assert_eq!(Rest { p_r: f64::INFINITY, ..rest }.wakes_at(), f64::INFINITY);
    let holds = Rest { p: Vector3::zeros(), bleeding: Some(0.99), ..rest };
    assert_eq!(holds.wakes_at(), f64::INFINITY);
    assert_eq!(Rest { f: f64::NAN * Vector3::x(), ..rest }.wakes_at(), 3.0);
    // A force so small that the plain formula would cancel to nothing.
    let creeps = Rest { p: 0.5 * Vector3::y(), f: Vector3::new(1e-12, 1e-9, 0.0), ..rest };
    assert!((creeps.momentum_at(creeps.wakes_at()).norm() - 1.0).abs() < 1e-12);
    assert!(WakeQueue::new().is_empty() && WakeQueue::new().next_time() == f64::INFINITY);
}

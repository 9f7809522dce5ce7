//! Small nets of springs with a convex energy, kicked now and then: what implicit schemes are tried
//! on.

use arps::{
    Held, Implicit, Law, Matrix3, Particle, Particles, Restraint, SparseBlocks, Speed, StepError,
    Vector3, paper,
};

/// Springs between particles of 10 g, convex: each pulls with k (‖d‖ − l) once it is longer than l
/// and never pushes. With l = 0 the forces are linear.
pub(crate) struct Net {
    pub(crate) x: Vec<Vector3>,
    springs: Vec<Spring>,
    pins: Vec<usize>,
}

struct Spring {
    ends: [usize; 2],
    stiffness: f64,
    length: f64,
}

/// Mass of a particle (kg), stiffness of the softest spring (N/m).
const MASS: f64 = 0.01;
const SOFTEST: f64 = 1.0;

/// Reproducible numbers in [0, 1): splitmix64.
pub(crate) struct Dice(pub(crate) u64);

impl Dice {
    pub(crate) fn roll(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn vector(&mut self) -> Vector3 {
        Vector3::from_fn(|_, _| 2.0 * self.roll() - 1.0)
    }
}

impl Net {
    /// A chain of 12 with linear springs, every other one `ratio` times as stiff.
    pub(crate) fn chain(ratio: f64) -> Net {
        let x = (0..12).map(|i| Vector3::new(0.1 * f64::from(i), 0.0, 0.0)).collect();
        let stiffness = |i: usize| if i.is_multiple_of(2) { SOFTEST } else { SOFTEST * ratio };
        let spring = |i| Spring { ends: [i, i + 1], stiffness: stiffness(i), length: 0.0 };
        Net { x, springs: (0..11).map(spring).collect(), pins: vec![0, 11] }
    }

    /// A net of 6 × 6 with linear springs whose stiffnesses are spread over the ratio at random.
    pub(crate) fn square(ratio: f64) -> Net {
        Net::woven(ratio, 0.0)
    }

    /// The same with springs of 10 cm that only pull, 2 % stretched to begin with: their stiffness
    /// jumps where they go slack.
    pub(crate) fn slack(ratio: f64) -> Net {
        Net::woven(ratio, 0.1)
    }

    fn woven(ratio: f64, length: f64) -> Net {
        let mut dice = Dice(1);
        let at = |i: usize, j: usize| Vector3::new(0.102 * i as f64, 0.102 * j as f64, 0.0);
        let x = (0..36).map(|v| at(v / 6, v % 6)).collect();
        let mut springs = Vec::new();
        for v in 0..36 {
            let right = (v % 6 < 5).then_some(v + 1);
            let up = (v < 30).then_some(v + 6);
            for w in right.into_iter().chain(up) {
                let stiffness = SOFTEST * ratio.powf(dice.roll());
                springs.push(Spring { ends: [v, w], stiffness, length });
            }
        }
        Net { x, springs, pins: vec![0, 5, 30, 35] }
    }

    pub(crate) fn pattern(&self) -> SparseBlocks {
        SparseBlocks::new(self.x.len(), self.springs.iter().map(|spring| spring.ends)).unwrap()
    }

    pub(crate) fn particles(&self) -> Particles {
        let n = self.x.len();
        Particles::new(self.x.clone(), &vec![Vector3::zeros(); n], vec![MASS; n]).unwrap()
    }

    /// Energy; adds forces and stiffness.
    pub(crate) fn evaluate(&self, x: &[Vector3], f: &mut [Vector3], l: &mut SparseBlocks) -> f64 {
        let mut energy = 0.0;
        for &Spring { ends: [i, j], stiffness: k, length } in &self.springs {
            let d = x[j] - x[i];
            let norm = d.norm();
            if norm <= length {
                continue;
            }
            let slack = if length == 0.0 { 0.0 } else { length / norm };
            let pull = k * (1.0 - slack) * d;
            f[i] += pull;
            f[j] -= pull;
            let mut block = Matrix3::from_diagonal_element(k * (1.0 - slack));
            if slack > 0.0 {
                block += k * slack / (norm * norm) * d * d.transpose();
            }
            l.add_spring(i, j, &block);
            energy += 0.5 * k * (norm - length) * (norm - length);
        }
        energy
    }

    pub(crate) fn potential(&self, x: &[Vector3]) -> f64 {
        self.springs
            .iter()
            .map(|s| {
                0.5 * s.stiffness
                    * ((x[s.ends[1]] - x[s.ends[0]]).norm() - s.length).max(0.0).powi(2)
            })
            .sum()
    }

    /// How far rounding of the positions moves the energy in a step (J), times 16: the potential
    /// energy by force times ε ‖x‖, the kinetic by velocity times the momentum h k ε ‖x‖.
    fn rounding(&self, particles: &Particles, h: f64) -> f64 {
        let one = |s: &Spring| {
            let [a, b] = s.ends;
            let x = &particles.x;
            let stretch = ((x[b] - x[a]).norm() - s.length).max(0.0);
            let moved = f64::EPSILON * (x[a].norm() + x[b].norm());
            let v = (particles.p[a].norm() + particles.p[b].norm()) / MASS;
            s.stiffness * moved * (stretch + moved + h * v)
        };
        16.0 * self.springs.iter().map(one).sum::<f64>()
    }
}

/// The scheme to try.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Method {
    /// The implicit step without restraint.
    Free,
    /// The convex step.
    Convex(Law),
    /// The paper's Algorithm 1.
    Paper(Law),
}

/// What a run saw.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Outcome {
    /// Greatest gain of restrained energy in a step, in units of the energy that kicks put in (1).
    pub(crate) gain: f64,
    /// Greatest gain of restrained energy in a step, in units of what rounding explains (1).
    pub(crate) gain_by_rounding: f64,
    /// Linear systems per step (1), and the most in a step.
    pub(crate) solves: f64,
    pub(crate) most_solves: usize,
    /// Share of particles that rested (1).
    pub(crate) rest: f64,
    /// Steps that did not converge.
    pub(crate) unconverged: usize,
    /// The step at which the energy had grown to a thousand times what kicks put in, or the state
    /// ceased to be finite.
    pub(crate) blew_up: Option<usize>,
}

/// Thresholds of speed; the corners or ends of the net are held for ever.
struct Pinned {
    speed: Speed,
    pins: Vec<usize>,
}

impl Restraint for Pinned {
    fn at(&self, particle: &Particle) -> Held {
        let held = self.speed.at(particle);
        if self.pins.contains(&particle.index) { held.scaled(f64::INFINITY) } else { held }
    }
}

/// Restrained particles under kicks: every 50 steps one of them gets up to 2 m/s, mostly little.
pub(crate) fn run(net: &Net, method: Method, h: f64, n_steps: usize) -> Outcome {
    let (law, v_r) = match method {
        Method::Free => (Law::Ramp, 0.0),
        Method::Convex(law) | Method::Paper(law) => (law, 0.2),
    };
    let speed = Speed::with_law(law, v_r, v_r * 20f64.sqrt()).unwrap();
    let policy = Pinned { speed, pins: net.pins.clone() };
    let mut implicit = Implicit::new(&policy, net.pattern());
    let mut pattern = net.pattern();
    let mut particles = net.particles();
    let mut dice = Dice(7);
    let mut outcome = Outcome::default();
    let n = particles.len();
    let energy =
        |particles: &Particles| particles.hamiltonian(&policy, net.potential(&particles.x));
    let mut given = energy(&particles);
    let mut n_rest = 0;
    let mut steps = 0;
    while steps < n_steps {
        if steps % 50 == 0 {
            let before = energy(&particles);
            let i = ((dice.roll() * n as f64) as usize).min(n - 1);
            particles.p[i] += 2.0 * dice.roll().powi(4) * MASS * dice.vector();
            given += (energy(&particles) - before).abs();
        }
        steps += 1;
        let before = energy(&particles);
        let result: Result<(), StepError> = match method {
            Method::Free | Method::Convex(_) => {
                let evaluate =
                    |x: &[Vector3], f: &mut [Vector3], l: &mut SparseBlocks| net.evaluate(x, f, l);
                implicit
                    .step(&mut particles, h, evaluate, |system, out| system.solve_dense(out))
                    .map(|report| {
                        outcome.solves += report.n_solves as f64;
                        outcome.most_solves = outcome.most_solves.max(report.n_solves);
                        outcome.unconverged += usize::from(!report.converged);
                        n_rest += report.moved.n_rest;
                    })
            }
            Method::Paper(_) => {
                let evaluate =
                    |x: &[Vector3], f: &mut [Vector3], l: &mut SparseBlocks| net.evaluate(x, f, l);
                paper::algorithm_1(&mut particles, &policy, &mut pattern, h, 0.0, evaluate).map(
                    |_| {
                        outcome.solves += 1.0;
                        outcome.most_solves = 1;
                    },
                )
            }
        };
        let after = energy(&particles);
        if result.is_err() || after > 1e3 * given || after.is_nan() {
            outcome.blew_up = Some(steps);
            break;
        }
        let gain = after - before;
        outcome.gain = outcome.gain.max(gain / given);
        let rounding = 1e-14 * (before + after) + net.rounding(&particles, h);
        outcome.gain_by_rounding = outcome.gain_by_rounding.max(gain / rounding);
    }
    outcome.solves /= steps as f64;
    outcome.rest = n_rest as f64 / (steps * n) as f64;
    outcome
}

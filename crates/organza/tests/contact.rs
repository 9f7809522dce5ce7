//! Contact of cloth with a body and with itself: nothing passes through anything.

use cloth_dynamics::law::{Bending, Membrane, Quadratic};
use cloth_dynamics::solver::{Auto, LinearSettings};
use cloth_dynamics::{
    BendingModel, Constraints, Damping, Environment, Fabric, ImplicitEuler, NewtonSettings,
    SolveError, SolveReport, Step, System, TimeIntegrator,
};
use collision::{Surface, intersect};
use mesh_core::generate::{self, Diagonal};
use mesh_core::{ClothState, World3};
use organza::contact::{ContactSettings, Obstacles, SurfaceContact};
use std::sync::Arc;

const THICKNESS: f64 = 0.005;

fn cotton() -> Fabric {
    Fabric {
        density: 0.15,
        membrane: Membrane::Orthotropic(Quadratic::isotropic(400.0, 0.2).unwrap()),
        bending: Some(Bending::Orthotropic(Quadratic::isotropic(1e-5, 0.0).unwrap())),
        bending_model: BendingModel::ShapeOperator,
        tension_field: false,
        strain_limits: None,
        damping: Damping { mass: 0.0, stiffness: 1e-3 },
    }
}

/// A sheet with its corner at `corner` (m).
fn sheet(size: f64, cells: usize, corner: World3) -> ClothState {
    let sheet = generate::grid([size, size], [cells, cells], Diagonal::Alternating).unwrap();
    let x = sheet.positions.iter().map(|x| x + corner).collect();
    ClothState::at_rest(sheet.mesh, x, vec![cotton().density]).unwrap()
}

/// A sphere about the origin that moves by `way(time)`.
fn ball(
    radius: f64,
    friction: f64,
    way: impl Fn(f64) -> World3 + Send + Sync + 'static,
) -> Obstacles {
    let (rings, sectors) = (16, 24);
    let mut x = vec![World3::new(0.0, 0.0, radius), World3::new(0.0, 0.0, -radius)];
    for i in 1..rings {
        let (s, c) = (std::f64::consts::PI * i as f64 / rings as f64).sin_cos();
        for j in 0..sectors {
            let (t, u) = (std::f64::consts::TAU * j as f64 / sectors as f64).sin_cos();
            x.push(World3::new(s * u, s * t, c) * radius);
        }
    }
    let at = |i: usize, j: usize| match i {
        0 => 0,
        i if i == rings => 1,
        i => (2 + (i - 1) * sectors + j % sectors) as u32,
    };
    let mut triangles = Vec::new();
    for i in 0..rings {
        for j in 0..sectors {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            triangles.extend((b != c).then_some([a, b, c]));
            triangles.extend((a != d).then_some([a, c, d]));
        }
    }
    let surface = Surface::new(x.len(), &triangles).unwrap();
    Obstacles {
        moves: true,
        surface,
        friction: vec![friction; x.len()],
        thickness: vec![None; x.len()],
        motion: Arc::new(move |t| x.iter().map(|x| x + way(t)).collect()),
    }
}

struct Run {
    cloth: ClothState,
    system: System,
    obstacles: Option<Obstacles>,
    surface: Surface,
    time: f64,
    report: SolveReport,
    tolerance: f64,
}

impl Run {
    fn new(cloth: ClothState, obstacles: Option<Obstacles>, friction: f64) -> Run {
        let environment = Environment { gravity: World3::new(0.0, 0.0, -9.81), wind: None };
        let mut system =
            System::new(&cloth, &Arc::new(vec![cotton()]), &environment, 0.01).unwrap();
        let settings = ContactSettings { thickness: THICKNESS, friction, self_contact: true };
        let contact = SurfaceContact::new(&cloth, obstacles.as_ref(), settings).unwrap();
        system.set_contact(Box::new(contact));
        let surface = Surface::new(cloth.mesh.n_vertices(), cloth.mesh.triangles()).unwrap();
        Run {
            cloth,
            system,
            obstacles,
            surface,
            time: 0.0,
            report: SolveReport::default(),
            tolerance: 1e-2,
        }
    }

    fn steps(&mut self, n: usize, h: f64, held: &dyn Fn(f64) -> Constraints) {
        let mut solver = Auto::new(LinearSettings::default());
        let newton = NewtonSettings { max_iterations: 40, tolerance: self.tolerance };
        for _ in 0..n {
            let step = Step { time: self.time, h };
            let report = ImplicitEuler
                .advance(&mut self.cloth, &mut self.system, &mut solver, held, &newton, step)
                .unwrap();
            self.report.add(&report);
            self.time += h;
            assert_eq!(self.n_crossings(), 0, "at {} s", self.time);
        }
    }

    /// Edges through triangles, of the cloth with itself and with the obstacles.
    fn n_crossings(&self) -> usize {
        let x = &self.cloth.x;
        let own = intersect::within(&self.surface, x, &self.surface.tree(x)).len();
        let with = self.obstacles.as_ref().map_or(0, |o| {
            let y = (o.motion)(self.time);
            let (a, b) = (self.surface.tree(x), o.surface.tree(&y));
            intersect::between((&self.surface, x, &a), (&o.surface, &y, &b)).len()
        });
        own + with
    }
}

fn free(_: f64) -> Constraints {
    Constraints::default()
}

#[test]
fn a_sheet_drapes_over_a_ball_and_nothing_crosses() {
    let cloth = sheet(0.5, 20, World3::new(-0.25, -0.25, 0.11));
    let mut run = Run::new(cloth, Some(ball(0.1, 0.5, |_| World3::zeros())), 0.3);
    run.steps(100, 0.01, &free);
    let x = &run.cloth.x;
    let (low, high) =
        x.iter().map(|x| x.z).fold((1.0, -1.0), |(l, h): (f64, f64), z| (l.min(z), h.max(z)));
    assert!(low < 0.0 && low > -0.3, "the corners hang down: {low} m");
    assert!(high > 0.1 && high < 0.1 + 2.0 * THICKNESS, "the top rests on the ball: {high} m");
}

/// A ball that swings through a hanging sheet at up to 5 m/s: it takes the sheet along.
#[test]
fn a_fast_ball_does_not_pass_through_a_hanging_sheet() {
    let sheet = generate::grid([0.6, 0.6], [16, 16], Diagonal::Alternating).unwrap();
    // Upright in the plane x = 0, the upper edge held at both ends.
    let x: Vec<World3> =
        sheet.positions.iter().map(|p| World3::new(0.0, p.x - 0.3, p.y - 0.3)).collect();
    let corner =
        |y: f64| x.iter().position(|x| x.z > 0.299 && (x.y - y).abs() < 1e-9).unwrap() as u32;
    let corners = [corner(-0.3), corner(0.3)];
    let fixed: Vec<(u32, World3)> = corners.iter().map(|&i| (i, x[i as usize])).collect();
    let cloth = ClothState::at_rest(sheet.mesh, x, vec![cotton().density]).unwrap();
    let way = |t: f64| World3::new(-0.5 * (10.0 * t).cos(), 0.0, -0.05);
    let mut run = Run::new(cloth, Some(ball(0.1, 0.3, way)), 0.3);
    let held = move |_: f64| Constraints { fixed: fixed.clone(), springs: Vec::new() };
    run.steps(120, 0.005, &held);
}

/// A ball that goes through a sheet whose middle is held: that nothing can be done about it is an error,
/// however far the cloth around gives way.
#[test]
fn what_cannot_give_way_is_caught() {
    let cloth = sheet(0.4, 16, World3::new(-0.2, -0.2, 0.0));
    let middle = (0..).zip(&cloth.x).filter(|(_, x)| x.x.hypot(x.y) < 0.04);
    let fixed: Vec<(u32, World3)> = middle.map(|(i, x)| (i, *x)).collect();
    assert!(fixed.len() > 4);
    let held = move |_: f64| Constraints { fixed: fixed.clone(), springs: Vec::new() };
    let way = |t: f64| World3::new(0.003, 0.002, 2.0 * t - 0.13);
    let mut run = Run::new(cloth, Some(ball(0.1, 0.3, way)), 0.3);
    let mut solver = Auto::new(LinearSettings::default());
    let newton = NewtonSettings { max_iterations: 40, tolerance: run.tolerance };
    for _ in 0..30 {
        let step = Step { time: run.time, h: 0.005 };
        let made = ImplicitEuler.advance(
            &mut run.cloth,
            &mut run.system,
            &mut solver,
            &held,
            &newton,
            step,
        );
        match made {
            Ok(_) => run.time += step.h,
            Err(SolveError::Caught { place, .. }) => {
                assert!(place.norm() < 0.1, "{place}");
                return;
            }
            Err(error) => panic!("{error}"),
        }
        assert_eq!(run.n_crossings(), 0, "at {} s", run.time);
    }
    panic!("the ball has gone through");
}

/// A sheet laid double in mid air, one half above the other, falls on a ball: layers stay apart.
#[test]
fn layers_of_one_sheet_do_not_cross() {
    let sheet = generate::grid([0.3, 0.6], [12, 24], Diagonal::Alternating).unwrap();
    // Bent round a half circle of 1 cm radius about the middle line.
    let r = 0.01;
    let half = 0.3 - 0.5 * std::f64::consts::PI * r;
    let x = sheet.positions.iter().map(|p| {
        let s = p.y;
        let (y, z) = if s < half {
            (half - s, 0.0)
        } else if s > 0.6 - half {
            (s - (0.6 - half), 2.0 * r)
        } else {
            let a = (s - half) / r;
            (-r * a.sin(), r * (1.0 - a.cos()))
        };
        World3::new(p.x - 0.15, y - 0.1, z + 0.11)
    });
    let cloth = ClothState::at_rest(sheet.mesh, x.collect(), vec![cotton().density]).unwrap();
    let mut run = Run::new(cloth, Some(ball(0.1, 0.5, |_| World3::zeros())), 0.3);
    run.steps(100, 0.01, &free);
}

/// An inclined plane: cloth slides where tan θ > μ and stays where tan θ < μ.
#[test]
fn cloth_slips_on_an_incline_where_the_angle_of_friction_is_passed() {
    for mu in [0.1, 0.3, 0.5, 1.0] {
        for (share, slides) in [(0.98, false), (1.02, true)] {
            let theta = f64::atan(mu * share);
            let turn = nalgebra::Rotation3::from_axis_angle(&nalgebra::Vector3::y_axis(), theta);
            let corners = [[-5.0, -5.0], [5.0, -5.0], [5.0, 5.0], [-5.0, 5.0]];
            let plane: Vec<World3> =
                corners.iter().map(|[x, y]| turn * World3::new(*x, *y, 0.0)).collect();
            let obstacles = Obstacles {
                moves: true,
                surface: Surface::new(4, &[[0, 1, 2], [0, 2, 3]]).unwrap(),
                friction: vec![mu; 4],
                thickness: vec![None; 4],
                motion: Arc::new(move |_| plane.clone()),
            };
            let mut cloth = sheet(0.1, 2, World3::new(-0.05, -0.05, 0.9 * THICKNESS));
            for x in &mut cloth.x {
                *x = turn * *x;
            }
            let mut run = Run::new(cloth, Some(obstacles), 0.0);
            run.tolerance = 1e-5;
            let centre = |run: &Run| run.cloth.x.iter().sum::<World3>() / run.cloth.x.len() as f64;
            run.steps(300, 0.01, &free);
            let (start, n) = (centre(&run), 50);
            run.steps(n, 0.01, &free);
            let way = (centre(&run) - start).norm();
            let speed = way / (n as f64 * 0.01);
            // Creep below the sticking speed is what smoothed friction has instead of rest.
            assert_eq!(speed > 2e-3, slides, "μ {mu}, tan θ/μ {share}: {speed} m/s");
        }
    }
}

/// A cylinder of radius `r` about the y axis, without its ends.
fn cylinder(r: f64, friction: f64) -> Obstacles {
    let n = 96u32;
    let x: Vec<World3> = (0..n)
        .flat_map(|i| {
            let (s, c) = (std::f64::consts::TAU * f64::from(i) / f64::from(n)).sin_cos();
            [-0.1, 0.1].map(|y| World3::new(r * c, y, r * s))
        })
        .collect();
    let triangles: Vec<[u32; 3]> = (0..n)
        .flat_map(|i| {
            let [a, b] = [2 * i, 2 * ((i + 1) % n)];
            [[a, b, a + 1], [b, b + 1, a + 1]]
        })
        .collect();
    Obstacles {
        moves: true,
        surface: Surface::new(x.len(), &triangles).unwrap(),
        friction: vec![friction; x.len()],
        thickness: vec![None; x.len()],
        motion: Arc::new(move |_| x.clone()),
    }
}

/// A strip over a cylinder with weights at its ends: the heavier one goes down if it is more than
/// e^(μπ) times the other (capstan.csv).
#[test]
fn weights_hold_each_other_over_a_cylinder_up_to_the_capstan_ratio() {
    let (r, width, hanging) = (0.05, 0.02, 0.06);
    let (half, out) = (std::f64::consts::FRAC_PI_2, r + 0.9 * THICKNESS);
    for mu in [0.1, 0.3] {
        for (share, slides) in [(0.95, false), (1.05, true)] {
            let length = 2.0 * (half * out + hanging);
            let cells = (length / 0.005).round() as usize;
            let strip = generate::grid([length, width], [cells, 2], Diagonal::Alternating).unwrap();
            let x: Vec<World3> = strip
                .positions
                .iter()
                .map(|p| {
                    let s = p.x - 0.5 * length;
                    let angle = (s / out).clamp(-half, half);
                    let down = (s.abs() - half * out).max(0.0);
                    World3::new(out * angle.sin(), p.y - 0.5 * width, out * angle.cos() - down)
                })
                .collect();
            let mut cloth = ClothState::at_rest(strip.mesh, x, vec![0.02]).unwrap();
            let far = |x: &World3, sign: f64| sign * x.x > 0.0 && x.z < 1e-9 - hanging + 1e-6;
            let ratio = share * (mu * std::f64::consts::PI).exp();
            for (sign, weight) in [(-1.0, 0.004), (1.0, 0.004 * ratio)] {
                let end: Vec<usize> =
                    (0..cloth.x.len()).filter(|&i| far(&cloth.x[i], sign)).collect();
                assert_eq!(end.len(), 3);
                end.iter().for_each(|&i| cloth.m[i] += weight / 3.0);
            }
            let mut run = Run::new(cloth, Some(cylinder(r, mu)), 0.0);
            run.tolerance = 1e-4;
            run.steps(60, 0.005, &free);
            let middle = |run: &Run| run.cloth.x.iter().map(|x| x.z * x.x.signum()).sum::<f64>();
            let (start, n) = (middle(&run) / run.cloth.x.len() as f64, 20);
            run.steps(n, 0.005, &free);
            let way = (middle(&run) / run.cloth.x.len() as f64 - start).abs();
            let speed = way / (n as f64 * 0.005);
            assert_eq!(speed > 5e-3, slides, "μ {mu}, {share} of the ratio: {speed} m/s");
        }
    }
}

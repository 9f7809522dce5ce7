//! Phase portraits of a restrained oscillator, as SVG, after Figures 2, 3 and 5 of Manteaux2013:
//! `cargo run -p arps --example phase_portraits -- FOLDER`.
//!
//! A particle of 1 kg on a spring of 1 N/m, released at rest from 1 m, with the thresholds 0.03 J and
//! 0.15 J; grey lines are their momenta. Drawn are the paper's law in black, the default law in blue
//! and, dotted red, the unrestrained oscillator. Prints what the paper says of the figures, measured.

use arps::{
    Explicit, Held, Implicit, Kinetic, Law, Now, Particles, Restraint, Scheme, SparseBlocks,
    Vector3, paper,
};
use plotters::prelude::*;
use std::error::Error;
use std::path::Path;

type Curve = Vec<(f64, f64)>;

const ENERGY_R: f64 = 0.03;
const ENERGY_F: f64 = 0.15;

fn policy(law: Law) -> Kinetic {
    Kinetic::with_law(law, ENERGY_R, ENERGY_F).expect("the thresholds are in order")
}

fn released() -> Particles {
    Particles::new(vec![Vector3::x()], &[Vector3::zeros()], vec![1.0]).expect("one particle")
}

fn spring(x: &[Vector3], f: &mut [Vector3], stiffness: &mut SparseBlocks) -> f64 {
    f[0] -= x[0];
    stiffness.add_diagonal(0, &arps::Matrix3::identity());
    0.5 * x[0].norm_squared()
}

fn point(particles: &Particles) -> (f64, f64) {
    (particles.x[0].x, particles.p[0].x)
}

/// Explicit steps with a damping coefficient (kg/s).
fn explicit(law: Option<Law>, gamma: f64, duration: f64) -> Result<Curve, Box<dyn Error>> {
    let restraint: Box<dyn Restraint> = match law {
        Some(law) => Box::new(policy(law)),
        None => Box::new(()),
    };
    let mut stepper = Explicit::new(restraint, Scheme::StormerVerlet);
    let mut particles = released();
    let mut curve = vec![point(&particles)];
    while particles.time < duration {
        let force = |now: Now<'_>, f: &mut [Vector3]| f[0] -= now.x[0] + gamma * now.v[0];
        stepper.step(&mut particles, 0.005, force)?;
        curve.push(point(&particles));
    }
    Ok(curve)
}

/// Implicit steps of h: the paper's scheme for its own law, the convex one otherwise.
fn implicit(law: Option<Law>, h: f64, duration: f64) -> Result<Curve, Box<dyn Error>> {
    let mut stiffness = SparseBlocks::new(1, [])?;
    let ramp = Kinetic::new(if law.is_some() { ENERGY_R } else { 0.0 }, ENERGY_F)?;
    let mut convex = Implicit::new(ramp, stiffness.clone());
    let mut particles = released();
    let mut curve = vec![point(&particles)];
    while particles.time < duration {
        if law == Some(Law::Spline) {
            paper::algorithm_1(
                &mut particles,
                &policy(Law::Spline),
                &mut stiffness,
                h,
                0.0,
                spring,
            )?;
        } else {
            convex.step(&mut particles, h, spring, |system, out| system.solve_dense(out))?;
        }
        curve.push(point(&particles));
    }
    Ok(curve)
}

fn draw(file: &Path, caption: &str, curves: &[Curve; 3]) -> Result<(), Box<dyn Error>> {
    let root = SVGBackend::new(file, (720, 640)).into_drawing_area();
    root.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&root)
        .caption(caption, ("sans-serif", 18))
        .margin(12)
        .x_label_area_size(44)
        .y_label_area_size(56)
        .build_cartesian_2d(-1.15..1.15, -1.15..1.15)?;
    chart
        .configure_mesh()
        .disable_mesh()
        .x_desc("position (m)")
        .y_desc("momentum (kg m/s)")
        .draw()?;
    let held: Held = policy(Law::Spline).at(&released().particle(0));
    for level in [held.p_r(), -held.p_r(), held.p_f(), -held.p_f()] {
        chart.draw_series(LineSeries::new(
            [(-1.15, level), (1.15, level)],
            RGBColor(190, 190, 190),
        ))?;
    }
    let [classical, spline, ramp] = curves;
    chart.draw_series(LineSeries::new(ramp.iter().copied(), BLUE.stroke_width(1)))?;
    chart.draw_series(LineSeries::new(spline.iter().copied(), BLACK.stroke_width(2)))?;
    chart.draw_series(dots(classical).into_iter().map(|at| Circle::new(at, 1, RED.filled())))?;
    root.present()?;
    Ok(())
}

/// Points of a curve a little apart.
fn dots(curve: &Curve) -> Curve {
    let mut dots = vec![curve[0]];
    for &(q, p) in curve {
        let (a, b) = dots[dots.len() - 1];
        if (q - a).hypot(p - b) > 0.02 {
            dots.push((q, p));
        }
    }
    dots
}

/// Share of a curve that stands still.
fn still(curve: &Curve) -> f64 {
    let still = curve.windows(2).filter(|pair| pair[0].0 == pair[1].0).count();
    still as f64 / (curve.len() - 1) as f64
}

fn main() -> Result<(), Box<dyn Error>> {
    let Some(folder) = std::env::args_os().nth(1) else {
        eprintln!("usage: phase_portraits FOLDER");
        std::process::exit(2);
    };
    let folder = Path::new(&folder);
    std::fs::create_dir_all(folder)?;
    let laws = [None, Some(Law::Spline), Some(Law::Ramp)];
    let all = |make: &dyn Fn(Option<Law>) -> Result<Curve, Box<dyn Error>>| -> Result<[Curve; 3], Box<dyn Error>> {
        Ok([make(laws[0])?, make(laws[1])?, make(laws[2])?])
    };

    let turn = all(&|law| explicit(law, 0.0, 6.4))?;
    draw(
        &folder.join("figure_2.svg"),
        "Figure 2: black Spline, blue Ramp, red unrestrained",
        &turn,
    )?;
    let held = policy(Law::Spline).at(&released().particle(0));
    let off = |curve: &Curve| {
        let full = curve.iter().filter(|(_, p)| p.abs() >= held.p_f());
        let energy = full.map(|(q, p)| 0.5 * (q * q + p * p));
        let (low, high) = energy.fold((f64::MAX, 0.0f64), |(a, b), e| (a.min(e), b.max(e)));
        [low, high]
    };
    for (name, curve) in [("Spline", &turn[1]), ("Ramp", &turn[2])] {
        let last = 0.5 * curve.iter().map(|(q, _)| q.abs()).fold(0.0, f64::max).powi(2);
        let [low, high] = off(curve);
        println!(
            "figure 2, {name}: stands still {:.1} % of the time; with full dynamics its energy is from \
             {low:.6} J to {high:.6} J (an ellipse); turns at an energy of {last:.6} J",
            100.0 * still(curve)
        );
    }

    let damped = all(&|law| explicit(law, 0.1, 60.0))?;
    draw(
        &folder.join("figure_3.svg"),
        "Figure 3, damped: black Spline, blue Ramp, red unrestrained",
        &damped,
    )?;
    for gamma in [0.0, 0.05, 0.1, 0.2] {
        let share = |law| explicit(Some(law), gamma, 12.8).map(|curve| 100.0 * still(&curve));
        println!(
            "figure 3, damping {gamma} kg/s: stands still {:.1} % (Spline), {:.1} % (Ramp) of two turns",
            share(Law::Spline)?,
            share(Law::Ramp)?
        );
    }

    let numerical = all(&|law| implicit(law, 0.02, 120.0))?;
    draw(
        &folder.join("figure_5.svg"),
        "Figure 5, implicit: black Algorithm 1, blue convex, red unrestrained",
        &numerical,
    )?;
    for (name, curve) in [("Algorithm 1", &numerical[1]), ("convex", &numerical[2])] {
        let widths: Vec<f64> = curve
            .windows(2)
            .filter(|pair| pair[0].1 < 0.0 && pair[1].1 >= 0.0)
            .map(|pair| pair[0].0.abs())
            .collect();
        let shown: Vec<String> = widths.iter().step_by(4).map(|w| format!("{w:.3}")).collect();
        println!("figure 5, {name}: amplitude (m) after every fourth turn: {}", shown.join(", "));
    }
    Ok(())
}

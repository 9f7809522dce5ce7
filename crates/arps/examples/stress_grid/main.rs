//! The convex step and the paper's scheme on a grid of stiffness ratios and steps:
//! `cargo run --release -p arps --example stress_grid -- [STEPS] [NET]` (100000 if not given, and all nets:
//! chain, square, slack).
//!
//! For the convex step: greatest gain of restrained energy in a step, as a share of the energy that
//! kicks put in, and in units of what rounding explains; linear systems per step. For the paper's:
//! whether it blew up, and in which step, or else its greatest gain.

mod net;

use arps::Law;
use net::{Method, Net, run};

fn main() {
    let n_steps = std::env::args().nth(1).map_or(Ok(100_000), |text| text.parse());
    let Ok(n_steps) = n_steps else {
        eprintln!("usage: stress_grid [STEPS] [NET]");
        std::process::exit(2);
    };
    let only = std::env::args().nth(2);
    println!(
        "net     ratio  1/h   convex: gain  /rounding  solves most  rest  bad | free: solves | paper \
         Spline, MomentumSpline, Ramp"
    );
    let mut n_runs = 0;
    let mut blow_ups = [0; 3];
    let (mut gain, mut solves) = (0.0f64, 0.0);
    for (name, make) in
        [("chain", Net::chain as fn(f64) -> Net), ("square", Net::square), ("slack", Net::slack)]
    {
        if only.as_ref().is_some_and(|only| only != name) {
            continue;
        }
        for ratio in [1.0, 1e2, 1e4, 1e6, 1e8] {
            for rate in [1000.0, 200.0, 25.0] {
                let net = make(ratio);
                let convex = run(&net, Method::Convex(Law::Ramp), 1.0 / rate, n_steps);
                let free = run(&net, Method::Free, 1.0 / rate, n_steps);
                let laws = [Law::Spline, Law::MomentumSpline, Law::Ramp];
                let papers = laws.map(|law| run(&net, Method::Paper(law), 1.0 / rate, n_steps));
                let told = papers.map(|paper| match paper.blew_up {
                    Some(step) => format!("blew up at {step}"),
                    None => format!("gain {:.1e}", paper.gain),
                });
                println!(
                    "{name:6} {ratio:6.0e} {rate:4}  {:13.1e} {:10.2} {:7.2} {:4} {:5.2} {:4} | {:6.2} | {}{}",
                    convex.gain,
                    convex.gain_by_rounding,
                    convex.solves,
                    convex.most_solves,
                    convex.rest,
                    convex.unconverged,
                    free.solves,
                    told.join(", "),
                    convex
                        .blew_up
                        .map_or(String::new(), |step| format!(", CONVEX BLEW UP AT {step}")),
                );
                n_runs += 1;
                gain = gain.max(convex.gain_by_rounding);
                solves += convex.solves;
                for (count, paper) in blow_ups.iter_mut().zip(papers) {
                    *count += usize::from(paper.blew_up.is_some());
                }
            }
        }
    }
    println!(
        "{n_runs} runs of {n_steps} steps. Convex: greatest gain {gain:.2} of rounding, {:.2} solves per \
         step. Paper's scheme blew up in {blow_ups:?} runs (Spline, MomentumSpline, Ramp).",
        solves / f64::from(n_runs)
    );
}

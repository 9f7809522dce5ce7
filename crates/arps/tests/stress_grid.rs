//! A short version of `examples/stress_grid`: the convex step never gains energy, at any stiffness, the
//! paper's scheme does.

#[path = "../examples/stress_grid/net.rs"]
mod net;

use arps::Law;
use net::{Method, Net, run};

#[test]
fn the_convex_step_never_gains_energy() {
    let mut blow_ups = 0;
    for make in [Net::chain, Net::square, Net::slack] {
        for (ratio, rate) in [(1.0, 1000.0), (1e2, 25.0), (1e4, 200.0), (1e6, 25.0), (1e8, 200.0)] {
            let net = make(ratio);
            let free = run(&net, Method::Free, 1.0 / rate, 60);
            let convex = run(&net, Method::Convex(Law::Ramp), 1.0 / rate, 60);
            for outcome in [free, convex] {
                assert_eq!(outcome.unconverged, 0, "{ratio} {rate} {outcome:?}");
                assert!(outcome.gain_by_rounding <= 1.0, "{ratio} {rate} {outcome:?}");
                assert!(outcome.gain < 1e-12 && outcome.blew_up.is_none());
            }
            let paper = run(&net, Method::Paper(Law::Spline), 1.0 / rate, 60);
            blow_ups += usize::from(paper.blew_up.is_some());
        }
    }
    assert!(blow_ups >= 6, "{blow_ups}");
}

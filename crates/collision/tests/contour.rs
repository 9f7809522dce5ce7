//! Contours of tangled surfaces: how they hang together, and their length's gradient.

use collision::contour::{Contours, End};
use collision::{Surface, intersect};
use mesh_core::{World3, par};

/// A sheet of `n × n` squares with positions by `at(s, t)` of [0, 1]².
fn sheet(n: u32, at: impl Fn(f64, f64) -> World3) -> (Surface, Vec<World3>) {
    let mut triangles = Vec::new();
    let vertex = |i: u32, j: u32| j * (n + 1) + i;
    for j in 0..n {
        for i in 0..n {
            let [a, b, c, d] =
                [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)];
            triangles.extend(if (i + j).is_multiple_of(2) {
                [[a, b, c], [a, c, d]]
            } else {
                [[a, b, d], [b, c, d]]
            });
        }
    }
    let part = |i: u32| f64::from(i) / f64::from(n);
    let x = (0..(n + 1) * (n + 1)).map(|v| at(part(v % (n + 1)), part(v / (n + 1)))).collect();
    (Surface::new((n as usize + 1).pow(2), &triangles).unwrap(), x)
}

fn crumpled(n: u32, seed: f64) -> (Surface, Vec<World3>) {
    sheet(n, |s, t| {
        let wave = |a: f64, b: f64| (a * s + b * t + seed).sin();
        World3::new(wave(4.0, 1.0), wave(1.3, 5.0), wave(6.0, -3.0)) * 0.5
    })
}

fn joined(a: (Surface, Vec<World3>), b: (Surface, Vec<World3>)) -> (Surface, Vec<World3>) {
    (a.0.joined(&b.0), a.1.into_iter().chain(b.1).collect())
}

fn find(surface: &Surface, x: &[World3]) -> Contours {
    Contours::find(surface, x, &surface.tree(x), |_, _| true)
}

/// A bump through a plane, a bit askew so that no edge meets an edge.
fn bump() -> (Surface, Vec<World3>) {
    let plane =
        sheet(5, |s, t| World3::new(3.0 * s - 1.513, 3.0 * t - 1.467, 0.3 + 0.05 * s + 0.02 * t));
    let bump = sheet(12, |s, t| {
        let (x, y) = (2.0 * s - 1.0, 2.0 * t - 1.0);
        World3::new(x, y, (-3.0 * (x * x + y * y)).exp())
    });
    joined(plane, bump)
}

#[test]
fn a_bump_through_a_plane_is_one_closed_contour() {
    let (surface, x) = bump();
    let all = find(&surface, &x);
    assert_eq!((all.contours.len(), all.n_gaps), (1, 0));
    let contour = &all.contours[0];
    assert!(contour.is_closed && contour.ends.len() == contour.segments.len());
    assert_eq!(contour.segments.len(), all.segments.len());
    // A circle of radius √(ln(1/0.335)/3), but for the mesh.
    let circle = std::f64::consts::TAU * ((1.0f64 / 0.335).ln() / 3.0).sqrt();
    assert!((contour.length / circle - 1.0).abs() < 0.02, "{} {circle}", contour.length);
    assert!((all.length() - contour.length).abs() < 1e-12);
    for c in &all.crossings {
        let sum: World3 = (0..3).map(|k| surface.corners(&x, c.triangle)[k] * c.weights[k]).sum();
        assert!((sum - c.x).norm() < 1e-14 && c.along > 0.0 && c.along < 1.0);
        assert!(c.weights.iter().all(|&w| w > 0.0));
    }
}

#[test]
fn a_contour_ends_at_boundaries() {
    // A plane stands on edge halfway through another, which is wider.
    let lying = sheet(4, |s, t| World3::new(4.0 * s - 2.03, 4.0 * t - 2.01, 0.0));
    let standing = sheet(3, |s, t| World3::new(2.0 * s - 1.0, 0.1 * s, t - 0.45));
    let (surface, x) = joined(lying, standing);
    let all = find(&surface, &x);
    assert_eq!((all.contours.len(), all.n_gaps), (1, 0));
    let contour = &all.contours[0];
    assert!(!contour.is_closed && contour.ends.len() == contour.segments.len() + 1);
    assert!((contour.length - 4.01f64.sqrt()).abs() < 1e-14);
    for end in [contour.ends[0], contour.ends[contour.ends.len() - 1]] {
        let End::Crossing(i) = end else { panic!("ends at {end:?}") };
        assert_eq!(surface.triangles_at(all.crossings[i as usize].edge).len(), 1);
    }
}

#[test]
fn a_contour_ends_at_a_shared_vertex() {
    // A fan around vertex 0 whose last triangle turns back through the first.
    let x = [
        [0.0, 0.0, 0.0],
        [1.0, -0.5, 0.0],
        [1.0, 0.5, 0.0],
        [0.5, 1.0, 1.0],
        [1.1, 0.1, 0.5],
        [1.1, -0.1, -0.5],
    ]
    .map(World3::from);
    let surface = Surface::new(6, &[[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]]).unwrap();
    let all = find(&surface, &x);
    assert_eq!((all.contours.len(), all.n_gaps, all.segments.len()), (1, 0, 1));
    assert_eq!(all.segments[0].triangles, [0, 3]);
    assert!(all.contours[0].ends.contains(&End::Vertex(0)));
    assert!((all.length() - 1.0).abs() < 0.2);
    check_gradient(&surface, &x, 1e-7);
}

#[test]
fn tangles_hang_together() {
    let (surface, x) = joined(crumpled(15, 0.3), crumpled(10, 2.0));
    let all = find(&surface, &x);
    assert!(all.contours.len() > 5 && all.n_gaps == 0, "{} contours", all.contours.len());
    // Every segment is in one contour, and neighbours meet.
    let mut seen: Vec<u32> = all.contours.iter().flat_map(|c| c.segments.clone()).collect();
    seen.sort_unstable();
    assert!(seen.iter().copied().eq(0..all.segments.len() as u32));
    for c in &all.contours {
        for (k, &s) in c.segments.iter().enumerate() {
            let next = c.ends[(k + 1) % c.ends.len()];
            let ends = all.segments[s as usize].ends;
            assert!(ends == [c.ends[k], next] || ends == [next, c.ends[k]]);
        }
        let inner = if c.is_closed { &c.ends[..] } else { &c.ends[1..c.ends.len() - 1] };
        assert!(inner.iter().all(|e| matches!(e, End::Crossing(_))));
    }
    assert!(all.contours.iter().any(|c| c.is_closed) && all.contours.iter().any(|c| !c.is_closed));
    assert_eq!(all.crossings.len(), intersect::within_brute_force(&surface, &x).len());
}

/// Compares the gradient with central differences of step `h` wherever the same edges cross the same
/// triangles at both of its ends. Returns how many components were compared.
fn check_gradient(surface: &Surface, x: &[World3], h: f64) -> usize {
    let all = find(surface, x);
    let gradient = all.gradient(surface, x);
    let same = |other: &Contours| {
        let key =
            |c: &Contours| -> Vec<_> { c.crossings.iter().map(|c| (c.edge, c.triangle)).collect() };
        key(other) == key(&all)
    };
    let mut n = 0;
    for v in 0..x.len() {
        for k in 0..3 {
            let slope_at = |h: f64| {
                let moved = |by: f64| {
                    let mut y = x.to_vec();
                    y[v][k] += by;
                    find(surface, &y)
                };
                let (plus, minus) = (moved(h), moved(-h));
                (same(&plus) && same(&minus)).then(|| (plus.length() - minus.length()) / (2.0 * h))
            };
            if let (Some(slope), Some(coarse)) = (slope_at(h), slope_at(2.0 * h)) {
                let error = (slope - gradient[v][k]).abs();
                // Beside the error of the difference, a third of what doubling the step changes,
                // lengths have rounding errors.
                let allowed = (slope - coarse).abs() + 1e-14 / h;
                assert!(error <= allowed, "vertex {v}: {error:e} of {slope:e}, not {allowed:e}");
                n += usize::from(slope != 0.0);
            }
        }
    }
    n
}

#[test]
fn the_gradient_is_that_of_the_length() {
    let (surface, x) = bump();
    let n = check_gradient(&surface, &x, 1e-6);
    assert!(n > 150, "{n}");
    let (surface, x) = joined(crumpled(9, 0.3), crumpled(6, 2.0));
    let n = check_gradient(&surface, &x, 1e-7);
    assert!(n > 150, "{n}");
}

#[test]
fn moving_everything_together_changes_no_length() {
    let (surface, x) = joined(crumpled(15, 0.3), crumpled(10, 2.0));
    let gradient = find(&surface, &x).gradient(&surface, &x);
    let largest = gradient.iter().map(|g| g.norm()).fold(0.0, f64::max);
    let sum: World3 = gradient.iter().sum();
    let turn: World3 = x.iter().zip(&gradient).map(|(x, g)| x.cross(g)).sum();
    assert!(sum.norm() < 1e-12 * largest && turn.norm() < 1e-12 * largest, "{sum} {turn}");
    // Growing everything grows the length alike (Euler): Σ x · g = length.
    let grow: f64 = x.iter().zip(&gradient).map(|(x, g)| x.dot(g)).sum();
    let length = find(&surface, &x).length();
    assert!((grow - length).abs() < 1e-11 * largest, "{grow} {length}");
}

#[test]
fn descending_untangles() {
    // Steepest descent of single vertices, with a line search: the worst way to use the gradient, but
    // every step that is taken shortens the contour.
    let (surface, mut x) = bump();
    let mut all = find(&surface, &x);
    let start = all.length();
    let mut rounds = 0;
    while !all.is_empty() && rounds < 400 {
        let gradient = all.gradient(&surface, &x);
        let largest = gradient.iter().map(|g| g.norm()).fold(0.0, f64::max);
        let mut step = 0.05 / largest;
        loop {
            let y: Vec<World3> = x.iter().zip(&gradient).map(|(x, g)| x - g * step).collect();
            let then = find(&surface, &y);
            if then.length() < all.length() {
                (x, all) = (y, then);
                break;
            }
            step *= 0.5;
            assert!(step * largest > 1e-9, "no way down at {} of {start}", all.length());
        }
        rounds += 1;
    }
    assert!(all.is_empty(), "{} of {start} left", all.length());
    assert!(intersect::within_brute_force(&surface, &x).is_empty());
}

#[test]
fn pushes_part_two_bodies() {
    // Each round moves the whole bump against the plane by the mean of what the crossings ask.
    let (surface, mut x) = bump();
    let n_plane = 36;
    let mut rounds = 0;
    loop {
        let all = find(&surface, &x);
        if all.is_empty() {
            break;
        }
        let ask = |push: collision::contour::Push| {
            let of_bump = push.vertices[0] >= n_plane;
            push.displacement(0.02, 1.0) * if of_bump { 1.0 } else { -1.0 }
        };
        let pushes = all.pushes(&surface, &x);
        assert_eq!(pushes.len(), all.crossings.len());
        let mean = pushes.iter().copied().map(ask).sum::<World3>() / pushes.len() as f64;
        assert!(mean.z < 0.0 && mean.norm() <= 0.02, "{mean}");
        x[n_plane as usize..].iter_mut().for_each(|x| *x += mean);
        rounds += 1;
        assert!(rounds < 400, "{} left", all.length());
    }
    assert!(rounds > 30);
    assert!(intersect::within_brute_force(&surface, &x).is_empty());
}

#[test]
fn bodies_move_against_each_other() {
    let (surface, x) = bump();
    let all = find(&surface, &x);
    // As rigid bodies: the sum over the vertices of the bump.
    let gradient = all.gradient(&surface, &x);
    let direct: World3 = gradient[36..].iter().sum();
    let h = 1e-6;
    let length = |by: World3| {
        let mut y = x.clone();
        y[36..].iter_mut().for_each(|x| *x += by);
        find(&surface, &y).length()
    };
    for k in 0..3 {
        let mut by = World3::zeros();
        by[k] = h;
        let slope = (length(by) - length(-by)) / (2.0 * h);
        assert!((slope - direct[k]).abs() < 1e-6 * direct.norm());
    }
    for push in all.pushes(&surface, &x) {
        let sum: World3 = (0..5).map(|k| x[push.vertices[k] as usize] * push.weights[k]).sum();
        assert!(sum.norm() < 1e-14, "the points of edge and triangle are not the same");
        let d = push.displacement(0.5, 2.0);
        assert!(d.dot(&push.gradient) < 0.0 && d.norm() < 0.5);
    }
}

#[test]
fn the_same_bits_at_any_number_of_threads() {
    let (surface, x) = joined(crumpled(40, 0.3), crumpled(30, 2.0));
    let run = || {
        let all = find(&surface, &x);
        let gradient = all.gradient(&surface, &x);
        (all, gradient)
    };
    let (one, two) = (par::with_threads(1, run).unwrap(), par::with_threads(2, run).unwrap());
    assert!(one.0.segments.len() > 500 && one == two);
}

#[test]
fn what_touches_leaves_a_gap_and_what_is_filtered_nothing() {
    // A triangle whose tip lies on another: no crossing. Moved on, so that its side passes exactly
    // through a vertex: one crossing, and no segment.
    let flat = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]];
    let surface = Surface::new(6, &[[0, 1, 2], [3, 4, 5]]).unwrap();
    let at =
        |x: [[f64; 3]; 3]| -> Vec<World3> { flat.into_iter().chain(x).map(World3::from).collect() };
    let tip = at([[0.5, 0.5, 0.0], [0.5, 0.5, 1.0], [0.5, 1.0, 1.0]]);
    assert!(find(&surface, &tip).is_empty());
    let through = at([[0.5, 0.5, -1.0], [0.5, 0.5, 1.0], [-0.5, -0.5, 1.0]]);
    let all = find(&surface, &through);
    assert_eq!((all.crossings.len(), all.segments.len(), all.n_gaps), (1, 0, 1));
    let none = Contours::find(&surface, &through, &surface.tree(&through), |_, t| t != 0);
    assert!(none.is_empty() && none.n_gaps == 0);
}

//! Which pixels and samples a triangle covers, and which triangle is in front.

use super::super::raster::{NOBODY, Prim, Strip};
use super::*;

const SIZE: Size = Size::new(64, 64);
const BLACK: Rgb = [0, 0, 0];

#[test]
fn a_known_triangle_covers_its_pixels() {
    let corners = [[10.25, 9.5], [50.0, 14.0], [17.5, 55.75]];
    let points = corners.map(|[x, y]| seen_at(x, y, 0.0, SIZE));
    let image = plain(&[painted(&points, &[[0, 1, 2]], BLACK)], &FACING, SIZE);
    let empty = plain(&[], &FACING, SIZE);
    // Distance to the nearest side, positive inside (px).
    let depth_inside = |x: f64, y: f64| {
        (0..3)
            .map(|k| {
                let ([ax, ay], [bx, by]) = (corners[k], corners[(k + 1) % 3]);
                let (dx, dy) = (bx - ax, by - ay);
                (dx * (y - ay) - dy * (x - ax)) / dx.hypot(dy)
            })
            .fold(f64::INFINITY, f64::min)
    };
    let (mut n_inside, mut covered, mut area) = (0, 0.0, 0.0);
    for y in 0..SIZE.height {
        for x in 0..SIZE.width {
            let (seen, behind) = (image.pixel(x, y).unwrap(), empty.pixel(x, y).unwrap());
            let depth = depth_inside(f64::from(x) + 0.5, f64::from(y) + 0.5);
            if depth > 0.75 {
                n_inside += 1;
                assert!(brightness(seen) < 250, "({x}, {y}) inside is {seen:?}");
            } else if depth < -0.75 {
                assert_eq!(seen, behind, "({x}, {y}) outside");
            }
            let linear = |c: Rgb| (f64::from(c[1]) / 255.0).powf(2.2);
            covered += 1.0 - linear(seen) / linear(behind);
        }
    }
    for k in 0..3 {
        let ([ax, ay], [bx, by]) = (corners[k], corners[(k + 1) % 3]);
        area += (ax * by - bx * ay) / 2.0;
    }
    assert!(n_inside > 600, "{n_inside} pixels inside");
    // Black still shines a little, hence the lower bound.
    assert!((0.93..1.01).contains(&(covered / area)), "covered {covered} of {area} pixels");
}

const PATTERN: [[i64; 2]; 4] = [[64, 64], [192, 64], [64, 192], [128, 128]];

#[test]
fn triangles_with_a_common_side_share_no_sample_and_miss_none() {
    let mut random = Random(1);
    let flat = [0.0, 0.0, 1.0];
    for _ in 0..200 {
        // Corners on the grid of samples, so that many samples lie exactly on a side.
        let mut grid = |n: f64| (random.unit() * n).floor() / 2.0 + 0.25;
        let middle = [6.0 + grid(60.0), 6.0 + grid(60.0)];
        let frame = [[4.25, 4.25], [40.25, 4.25], [40.25, 40.25], [4.25, 40.25]];
        let mut times = vec![[0; 4]; 48 * 48];
        for k in 0..4 {
            let mut strip = Strip::<4>::new(&PATTERN, 48, 48, 0.0);
            let corners = [frame[k], frame[(k + 1) % 4], middle];
            if let Some(prim) = Prim::new(corners, flat, [1.0, 1.0], 0) {
                strip.fill(&prim);
            }
            for (times, owner) in times.iter_mut().zip(&strip.owner) {
                (0..4).for_each(|s| times[s] += i32::from(owner[s] != NOBODY));
            }
        }
        for (i, times) in times.iter().enumerate() {
            for s in 0..4 {
                let place = [(i % 48) as i64 * 256, (i / 48) as i64 * 256];
                let at: [i64; 2] = std::array::from_fn(|k| place[k] + PATTERN[s][k]);
                let inside = at.iter().all(|&x| x > 4 * 256 + 64 && x < 40 * 256 + 64);
                let outside = at.iter().any(|x| !(4 * 256 + 64..=40 * 256 + 64).contains(x));
                if inside {
                    assert_eq!(times[s], 1, "sample {s} of pixel {i}, middle {middle:?}");
                } else if outside {
                    assert_eq!(times[s], 0, "sample {s} of pixel {i}, middle {middle:?}");
                }
            }
        }
    }
}

/// The blocks that let large hidden triangles be passed over must not change any sample.
#[test]
fn many_large_triangles_match_a_sample_by_sample_search() {
    let mut random = Random(2);
    let (width, height) = (53, 37);
    let corners: Vec<[[f64; 2]; 3]> = (0..400)
        .map(|_| std::array::from_fn(|_| [random.within(-40.0, 90.0), random.within(-40.0, 80.0)]))
        .collect();
    let planes: Vec<[f64; 3]> = corners
        .iter()
        .map(|_| [random.within(-0.01, 0.01), random.within(-0.01, 0.01), random.within(2.0, 4.0)])
        .collect();
    let value = |plane: &[f64; 3], [x, y]: [f64; 2]| plane[0] * x + plane[1] * y + plane[2];
    // Two strips, one below the other, as pictures are drawn.
    for (top, rows) in [(0, 16), (16, 21)] {
        let mut strip = Strip::<4>::new(&PATTERN, width, rows, 0.0);
        strip.restart(top, 0.0);
        let mut best = vec![[(0.0, NOBODY); 4]; width * rows];
        for (i, (corners, plane)) in corners.iter().zip(&planes).enumerate() {
            let values = corners.map(|at| value(plane, at));
            let range = [
                values.iter().copied().fold(f64::INFINITY, f64::min),
                values.iter().copied().fold(0.0, f64::max),
            ];
            let owner = i as u32;
            let Some(prim) = Prim::new(*corners, *plane, range, owner) else { continue };
            strip.fill(&prim);
            // Alone in a strip of its own, nothing can be passed over.
            let mut alone = Strip::<4>::new(&PATTERN, width, rows, 0.0);
            alone.restart(top, 0.0);
            alone.fill(&prim);
            for (best, (nearness, owners)) in
                best.iter_mut().zip(alone.nearness.iter().zip(&alone.owner))
            {
                for s in 0..4 {
                    if owners[s] == owner && nearness[s] > best[s].0 {
                        best[s] = (nearness[s], owner);
                    }
                }
            }
        }
        let found: Vec<_> = best.iter().map(|cell| cell.map(|(_, owner)| owner)).collect();
        assert_eq!(strip.owner[..width * rows], found, "rows from {top}");
        assert!(found.iter().flatten().filter(|&&o| o != NOBODY).count() > width * rows);
    }
    assert_eq!(16 + 21, height);
}

#[test]
fn the_nearer_triangle_is_seen_whatever_the_order() {
    let red = [200, 40, 40];
    let green = [40, 200, 40];
    let square = |z: f64| {
        [[8.0, 8.0], [56.0, 8.0], [56.0, 56.0], [8.0, 56.0]].map(|[x, y]| seen_at(x, y, z, SIZE))
    };
    let (near, far) = (square(0.2), square(0.1));
    let quad = [[0, 1, 2], [0, 2, 3]];
    let layers = [painted(&near, &quad, red), painted(&far, &quad, green)];
    let image = plain(&layers, &FACING, SIZE);
    let [r, g, _] = image.pixel(32, 30).unwrap();
    assert!(r > 2 * g, "the nearer, red square is hidden: {:?}", image.pixel(32, 30));
    assert_eq!(image, plain(&[layers[1], layers[0]], &FACING, SIZE));
}

#[test]
fn of_equally_near_triangles_the_first_stays() {
    let points = [[-0.5, -0.5, 0.0], [0.5, -0.5, 0.0], [0.0, 0.5, 0.0]];
    let layer = |colour| painted(&points, &[[0, 1, 2]], colour);
    let (red, green) = (layer([200, 40, 40]), layer([40, 200, 40]));
    let alone = plain(&[red], &FACING, SIZE);
    assert_eq!(plain(&[red, green], &FACING, SIZE), alone);
    assert_ne!(plain(&[green, red], &FACING, SIZE), alone);
}

#[test]
fn triangles_that_cross_meet_where_their_depths_are_equal() {
    let quad = [[0, 1, 2], [0, 2, 3]];
    // Heights that change from left to right, equal in the plane x = 0.
    let slanted =
        |s: f64| [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]].map(|[x, y]| [x, y, s * x]);
    let (rising, falling) = (slanted(0.6), slanted(-0.6));
    let layers = [painted(&rising, &quad, [200, 20, 20]), painted(&falling, &quad, [20, 200, 20])];
    let image = plain(&layers, &FACING, SIZE);
    for row in 24..40 {
        for column in 20..44 {
            let [r, g, _] = image.pixel(column, row).unwrap();
            if column != 31 && column != 32 {
                assert_eq!(r > g, column > 32, "({column}, {row}): {r} {g}");
            }
        }
    }
}

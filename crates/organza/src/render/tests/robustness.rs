//! Broken, huge, tiny and empty input; geometry behind and across the eye.

use super::super::{Lines, RenderError, draw};
use super::*;

const SIZE: Size = Size::new(80, 60);
const UP: [f64; 3] = [0.0, 0.0, 1.0];

fn surface<'a>(points: &'a [[f64; 3]], triangles: &'a [[u32; 3]]) -> [Layer<'a>; 1] {
    [Layer::Surface(Surface { wireframe: true, ..Surface::new(points, triangles) })]
}

#[test]
fn a_plane_through_the_near_plane_ends_at_the_horizon() {
    // The eye stands 1 m above a plane that runs from far behind to far ahead.
    let viewpoint =
        Viewpoint { eye: [0.0, 0.0, 1.0], target: [0.0, 1.0, 1.0], up: UP, vertical_fov: 1.0 };
    let r = 1e7;
    let points = [[-r, -r, 0.0], [r, -r, 0.0], [r, r, 0.0], [-r, r, 0.0]];
    let black = [0, 0, 0];
    for triangles in [&[[0, 1, 2], [0, 2, 3]], &[[1, 2, 3], [1, 3, 0]]] {
        let image = plain(&[painted(&points, triangles, black)], &viewpoint, SIZE);
        let empty = plain(&[], &viewpoint, SIZE);
        for y in 0..SIZE.height {
            for x in 0..SIZE.width {
                let seen = image.pixel(x, y).unwrap();
                if y < 30 {
                    assert_eq!(Some(seen), empty.pixel(x, y), "({x}, {y}) above the horizon");
                } else {
                    assert!(brightness(seen) < 400, "({x}, {y}) on the plane is {seen:?}");
                }
            }
        }
    }
}

#[test]
fn what_lies_behind_the_eye_is_not_drawn() {
    let behind = [[-1.0, 0.0, 2.0], [1.0, 0.0, 2.0], [0.0, 1.0, 5.0]];
    let ends = [[[0.0, -1.0, 2.0], [0.0, 1.0, 7.0]]];
    let layers = [painted(&behind, &[[0, 1, 2]], [0; 3]), Layer::Lines(Lines::new(&ends))];
    assert_eq!(plain(&layers, &FACING, SIZE), plain(&[], &FACING, SIZE));
    // A line from behind the eye to the middle of the picture enters it from the side.
    let ends = [[[4.0, 0.0, 3.0], [0.0, 0.0, 0.0]]];
    let image = plain(&[Layer::Lines(Lines { width_px: 4.0, ..Lines::new(&ends) })], &FACING, SIZE);
    let empty = plain(&[], &FACING, SIZE);
    assert_eq!(image.pixel(60, 30), Some(Lines::new(&ends).colour));
    assert_eq!(image.pixel(20, 30), empty.pixel(20, 30));
}

#[test]
fn what_is_nearer_than_the_near_plane_is_not_drawn() {
    let empty = plain(&[], &FACING, SIZE);
    // The near plane lies at a thousandth of the distance to the target, here 1 mm.
    for (depth, drawn) in [(0.9e-3, false), (1.1e-3, true)] {
        let points = [[-2.0, -2.0], [2.0, -2.0], [0.0, 4.0]];
        let points = points.map(|[x, y]| [x * depth, y * depth, 1.0 - depth]);
        let image = plain(&[painted(&points, &[[0, 1, 2]], [0; 3])], &FACING, SIZE);
        assert_eq!(image != empty, drawn, "depth {depth}");
    }
    // A sheet that rises past the eye fills the picture below its lower side, and that alone.
    let points = [[-1.0, -0.3, 0.5], [1.0, -0.3, 0.5], [0.0, 0.1, 1.5]];
    let image = plain(&[painted(&points, &[[0, 1, 2]], [0; 3])], &FACING, SIZE);
    assert!(brightness(image.pixel(40, 58).unwrap()) < 300);
    assert_eq!(image.pixel(40, 46), empty.pixel(40, 46));
    assert_eq!(image.pixel(40, 1), empty.pixel(40, 1));
}

#[test]
fn broken_points_take_only_their_triangles_away() {
    let sound = [[-0.4, -0.4, 0.0], [0.4, -0.4, 0.0], [0.0, 0.4, 0.0]];
    let expected = draw(&surface(&sound, &[[0, 1, 2]]), &FACING, SIZE).unwrap();
    for broken in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e200, -1e300] {
        for k in 0..3 {
            let mut bad = [0.1, 0.2, 0.3];
            bad[k] = broken;
            let points = [sound[0], sound[1], sound[2], bad];
            let triangles = [[0, 1, 2], [1, 3, 2], [3, 3, 3]];
            let image = draw(&surface(&points, &triangles), &FACING, SIZE).unwrap();
            assert_eq!(image, expected, "{bad:?}");
            let ends = [[bad, sound[0]], [sound[1], bad]];
            let layers = [surface(&sound, &[[0, 1, 2]])[0], Layer::Lines(Lines::new(&ends))];
            assert_eq!(draw(&layers, &FACING, SIZE).unwrap(), expected, "{bad:?}");
        }
    }
}

#[test]
fn degenerate_triangles_cover_nothing() {
    let p = [[0.0, 0.0, 0.0], [0.3, 0.0, 0.0], [0.6, 0.0, 0.0], [0.0, 0.0, 0.9], [1e-9, 1e-9, 0.0]];
    let triangles = [[0, 0, 0], [0, 1, 1], [0, 1, 2], [0, 3, 3], [0, 4, 0]];
    let image = draw(&surface(&p, &triangles), &FACING, SIZE).unwrap();
    assert_eq!(image, draw(&[], &FACING, SIZE).unwrap());
    let ends = [[p[1], p[1]]];
    let image = draw(&[Layer::Lines(Lines::new(&ends))], &FACING, SIZE).unwrap();
    assert_eq!(image, draw(&[], &FACING, SIZE).unwrap());
}

#[test]
fn random_scenes_of_any_size_are_drawn() {
    let mut random = Random(7);
    for _ in 0..150 {
        let reach = 10_f64.powf(random.within(-40.0, 40.0));
        let points: Vec<[f64; 3]> = (0..30)
            .map(|_| {
                let mut p = random.point(reach);
                if random.unit() < 0.2 {
                    let far = 10_f64.powf(random.within(0.0, 55.0));
                    p = p.map(|x| x * far);
                }
                if random.unit() < 0.1 {
                    p[1] = f64::NAN;
                }
                p
            })
            .collect();
        let mut index = || (random.unit() * 30.0) as u32;
        let triangles: Vec<[u32; 3]> = (0..40).map(|_| [index(), index(), index()]).collect();
        let ends: Vec<[[f64; 3]; 2]> =
            (0..20).map(|_| [points[index() as usize], points[index() as usize]]).collect();
        let line = Lines { width_px: random.within(-10.0, 100.0), ..Lines::new(&ends) };
        let layers = [surface(&points, &triangles)[0], Layer::Lines(line)];
        let viewpoint = Viewpoint {
            eye: random.point(reach),
            target: random.point(reach),
            up: random.point(1.0),
            vertical_fov: random.within(0.01, 3.1),
        };
        let style = Style { shadows: true, floor: Some(random.within(-reach, reach)) };
        let image = draw_with(&layers, &viewpoint, SIZE, &style).unwrap();
        assert_eq!(image.pixels.len(), 80 * 60);
        assert_eq!(image, draw_with(&layers, &viewpoint, SIZE, &style).unwrap());
    }
}

#[test]
fn small_and_odd_sizes_are_drawn() {
    let points = [[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 18.0, 0.0]];
    for size in [Size::new(1, 1), Size::new(17, 1), Size::new(1, 33), Size::new(16384, 3)] {
        let image = draw(&surface(&points, &[[0, 1, 2]]), &FACING, size).unwrap();
        assert_eq!(image.pixels.len(), (size.width * size.height) as usize);
        assert_ne!(image, draw(&[], &FACING, size).unwrap(), "{size:?}");
    }
    assert_eq!(Size::new(0, 4).aspect(), 1.0);
}

#[test]
fn bad_input_is_named() {
    let points = [[0.0; 3]; 3];
    let message = |layers: &[Layer<'_>], viewpoint: &Viewpoint, size| {
        draw(layers, viewpoint, size).unwrap_err().to_string()
    };
    let error = message(&surface(&points, &[[0, 1, 2], [0, 1, 3]]), &FACING, SIZE);
    assert_eq!(error, "layer 0, triangle 1 uses point 3, but there are 3 points");
    for (paint, what) in
        [(Paint::Triangles(&[[1, 2, 3]]), "triangles"), (Paint::Points(&[]), "points")]
    {
        let layer = Layer::Surface(Surface { paint, ..Surface::new(&points, &[]) });
        let error = message(&[Layer::Lines(Lines::new(&[])), layer], &FACING, SIZE);
        assert!(error.starts_with("layer 1 has ") && error.ends_with(what), "{error}");
    }
    for (width, height) in [(0, 9), (9, 0), (16385, 9), (9, u32::MAX)] {
        let error = draw(&[], &FACING, Size::new(width, height)).unwrap_err();
        assert!(matches!(error, RenderError::Size { .. }), "{error}");
    }
    let nan = f64::NAN;
    for viewpoint in [
        Viewpoint { eye: [nan, 0.0, 0.0], ..FACING },
        Viewpoint { eye: FACING.target, ..FACING },
        Viewpoint { target: [f64::INFINITY, 0.0, 0.0], ..FACING },
        Viewpoint { up: [0.0, nan, 0.0], ..FACING },
        Viewpoint { vertical_fov: 0.0, ..FACING },
        Viewpoint { vertical_fov: 3.2, ..FACING },
        Viewpoint { vertical_fov: nan, ..FACING },
        Viewpoint { eye: [0.0, 0.0, 1e-320], ..FACING },
    ] {
        let error = draw(&[], &viewpoint, SIZE).unwrap_err();
        assert!(matches!(error, RenderError::Viewpoint(_)), "{error}");
    }
    // Looking along up is no error.
    assert!(draw(&[], &Viewpoint { up: UP, ..FACING }, SIZE).is_ok());
    assert!(draw(&[], &Viewpoint { up: [0.0; 3], ..FACING }, SIZE).is_ok());
}

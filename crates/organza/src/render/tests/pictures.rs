//! What pictures show: sides, paint, wireframe, lines, shadows, and the same bits every time.

use super::super::{Bounds, Lines, draw};
use super::*;

const SIZE: Size = Size::new(96, 96);
const QUAD: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

/// A square facing the eye, counter-clockwise as seen, between two places of the picture (px).
fn square(low: f64, high: f64, z: f64) -> [[f64; 3]; 4] {
    [[low, high], [high, high], [high, low], [low, low]].map(|[x, y]| seen_at(x, y, z, SIZE))
}

fn ripples(n: u32) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let mut points = Vec::new();
    let mut triangles = Vec::new();
    for j in 0..=n {
        for i in 0..=n {
            let (x, y) = (f64::from(i) / f64::from(n), f64::from(j) / f64::from(n));
            points.push([x, y, 0.08 * (12.0 * x + 5.0 * y).sin()]);
            if i < n && j < n {
                let a = j * (n + 1) + i;
                triangles.extend([[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]);
            }
        }
    }
    (points, triangles)
}

#[test]
fn each_side_has_its_colour() {
    let paint = Paint::Sides { front: [20, 60, 220], back: [220, 60, 20] };
    let points = square(10.0, 80.0, 0.0);
    let turned = QUAD.map(|[a, b, c]| [a, c, b]);
    for (triangles, blue) in [(QUAD, true), (turned, false)] {
        let surface = Surface { paint, ..Surface::new(&points, &triangles) };
        let image = plain(&[Layer::Surface(surface)], &FACING, SIZE);
        let [r, _, b] = image.pixel(45, 45).unwrap();
        assert_eq!(b > r, blue, "{r} {b}");
        assert_eq!(r > b, !blue, "{r} {b}");
    }
}

#[test]
fn triangles_and_points_have_their_colours() {
    let points = square(8.0, 88.0, 0.0);
    let per_triangle = [[220, 10, 10], [10, 220, 10]];
    let surface =
        Surface { paint: Paint::Triangles(&per_triangle), ..Surface::new(&points, &QUAD) };
    let image = plain(&[Layer::Surface(surface)], &FACING, SIZE);
    // The diagonal runs from the lower left to the upper right.
    let [r, g, _] = image.pixel(70, 70).unwrap();
    assert!(r > g, "first triangle: {r} {g}");
    let [r, g, _] = image.pixel(26, 26).unwrap();
    assert!(g > r, "second triangle: {r} {g}");

    let per_point = [[220, 10, 10], [10, 220, 10], [10, 220, 10], [220, 10, 10]];
    let surface = Surface { paint: Paint::Points(&per_point), ..Surface::new(&points, &QUAD) };
    let image = plain(&[Layer::Surface(surface)], &FACING, SIZE);
    let reds: Vec<u8> = (10..86).map(|x| image.pixel(x, 40).unwrap()[0]).collect();
    assert!(reds.windows(2).all(|w| w[0] >= w[1]), "red fades to the right: {reds:?}");
    assert!(reds[0] > reds[75] + 100, "{reds:?}");
}

/// Darkness that the edge through the middle of a square at height `z` takes, in pixels of full
/// darkness across it.
fn edge_width(z: f64) -> f64 {
    let points = square(8.0, 88.0, z);
    // Split by an upright edge, so that a row crosses it at a right angle.
    let middle = [seen_at(47.3, 88.0, z, SIZE), seen_at(47.3, 8.0, z, SIZE)];
    let points = [points[0], points[1], points[2], points[3], middle[0], middle[1]];
    let triangles = [[0, 4, 5], [0, 5, 3], [4, 1, 5], [1, 2, 5]];
    let bare = Surface::new(&points, &triangles);
    let wired = Surface { wireframe: true, ..bare };
    let [bare, wired] = [bare, wired].map(|s| plain(&[Layer::Surface(s)], &FACING, SIZE));
    let linear = |c: Rgb| (f64::from(c[1]) / 255.0).powf(2.2);
    // A row away from the slanted edges, near the upright one.
    (38..57)
        .map(|x| 1.0 - linear(wired.pixel(x, 80).unwrap()) / linear(bare.pixel(x, 80).unwrap()))
        .sum()
}

#[test]
fn drawn_edges_have_one_width_at_any_depth() {
    let (near, far) = (edge_width(0.5), edge_width(-20.0));
    assert!((0.4..0.9).contains(&near), "an edge takes {near} pixels of darkness");
    assert!((near - far).abs() < 0.05 * near, "near {near}, far {far}");
}

#[test]
fn wireframe_darkens_edges_alone() {
    let points = square(8.0, 88.0, 0.0);
    let bare = Surface::new(&points, &QUAD);
    let wired = Surface { wireframe: true, ..bare };
    let [bare, wired] = [bare, wired].map(|s| plain(&[Layer::Surface(s)], &FACING, SIZE));
    let mut n_dark = 0;
    for y in 0..96_u32 {
        for x in 0..96_u32 {
            let (a, b) = (bare.pixel(x, y).unwrap(), wired.pixel(x, y).unwrap());
            // Distance from the diagonal x + y = 96 and from the sides (px).
            let (px, py) = (f64::from(x) + 0.5, f64::from(y) + 0.5);
            let diagonal = (px + py - 96.0).abs() / 2_f64.sqrt();
            let side = [px, py].map(|p| (p - 8.0).abs().min((p - 88.0).abs()));
            let distance = diagonal.min(side[0]).min(side[1]);
            if distance > 1.01 {
                assert_eq!(a, b, "({x}, {y}) is {distance} px from any edge");
            } else if distance < 0.3 && (9..88).contains(&x) && (9..88).contains(&y) {
                n_dark += 1;
                assert!(brightness(b) < brightness(a) - 60, "({x}, {y}): {a:?} {b:?}");
            }
        }
    }
    assert!(n_dark > 70, "{n_dark}");
}

#[test]
fn hidden_edges_and_lines_are_not_drawn() {
    let front = square(4.0, 92.0, 0.1);
    let behind = square(20.0, 76.0, -0.1);
    let cover = Layer::Surface(Surface::new(&front, &QUAD));
    let hidden = Surface { wireframe: true, ..Surface::new(&behind, &QUAD) };
    let alone = plain(&[cover], &FACING, SIZE);
    assert_eq!(alone, plain(&[Layer::Surface(hidden), cover], &FACING, SIZE));

    let segment = |z: f64| [[seen_at(20.0, 47.5, z, SIZE), seen_at(76.0, 47.5, z, SIZE)]];
    let (far, near) = (segment(-0.1), segment(0.2));
    let lines = |segments| Layer::Lines(Lines { colour: [255, 0, 0], ..Lines::new(segments) });
    assert_eq!(alone, plain(&[lines(&far), cover], &FACING, SIZE));
    let image = plain(&[lines(&near), cover], &FACING, SIZE);
    assert_eq!(image.pixel(48, 47), Some([255, 0, 0]));
    // In the plane of the surface a line is seen, too.
    let image = plain(&[cover, lines(&segment(0.1))], &FACING, SIZE);
    assert_eq!(image.pixel(48, 47), Some([255, 0, 0]));
    assert_eq!(image.pixel(48, 52), alone.pixel(48, 52));
    assert_eq!(image.pixel(10, 47), alone.pixel(10, 47));
}

#[test]
fn surfaces_throw_shadows() {
    // The key light comes from the upper left, before the picture: a flap there shades the sheet.
    let sheet = square(4.0, 92.0, 0.0);
    let flap = square(24.0, 56.0, 0.12);
    let layers = [painted(&sheet, &QUAD, [200; 3]), painted(&flap, &QUAD, [200; 3])];
    let bright = plain(&layers, &FACING, SIZE);
    let image = draw(&layers, &FACING, SIZE).unwrap();
    let shade =
        |x, y| brightness(bright.pixel(x, y).unwrap()) - brightness(image.pixel(x, y).unwrap());
    let darkest = (58..92).map(|x| shade(x, 58)).max().unwrap();
    assert!(darkest > 100, "no shadow to the right of the flap: {darkest}");
    // No surface shades itself, and no shadow falls towards the light.
    assert_eq!(shade(40, 40), 0);
    assert_eq!(shade(10, 20), 0);
    assert_eq!(shade(88, 10), 0);
}

#[test]
fn a_lit_wavy_sheet_does_not_shade_itself_in_spots() {
    // Waves too low to throw shadows: the picture must be that without shadows.
    let (mut points, triangles) = ripples(40);
    points.iter_mut().for_each(|p| p[2] *= 0.25);
    let size = Size::new(240, 160);
    let viewpoint = Viewpoint::fit(points.iter().copied(), [0.0, 0.0, 1.0], size);
    let layers = [Layer::Surface(Surface::new(&points, &triangles))];
    let with = draw(&layers, &viewpoint, size).unwrap();
    let without = plain(&layers, &viewpoint, size);
    let worst = with
        .pixels
        .iter()
        .zip(&without.pixels)
        .map(|(&a, &b)| (brightness(a) - brightness(b)).abs())
        .max();
    assert!(worst < Some(12), "{worst:?}");
}

#[test]
fn the_floor_shows_a_soft_shadow_below_alone() {
    let (points, triangles) = ripples(20);
    let size = Size::new(160, 120);
    let up = [0.0, 0.0, 1.0];
    let bounds = Bounds::of(points.iter().copied());
    let viewpoint = Viewpoint::fit(bounds.corners(), up, size);
    let layers = [Layer::Surface(Surface::new(&points, &triangles))];
    let floor = Style { floor: bounds.lowest(up).map(|h| h - 0.1), ..Style::default() };
    let with = draw_with(&layers, &viewpoint, size, &floor).unwrap();
    let without = draw(&layers, &viewpoint, size).unwrap();
    let darker = |a: &Image| {
        a.pixels
            .iter()
            .zip(&without.pixels)
            .filter(|(a, b)| brightness(**a) < brightness(**b) - 20)
            .count()
    };
    assert!(darker(&with) > 150, "{} pixels of shadow", darker(&with));
    assert_eq!(with.pixels[..160 * 10], without.pixels[..160 * 10], "no shadow above");
    // A floor above the eye is not seen.
    let floor = Style { floor: Some(100.0), ..Style::default() };
    let above = draw_with(&layers, &viewpoint, size, &floor).unwrap();
    assert_eq!(darker(&above), 0);
}

#[test]
fn the_same_input_gives_the_same_bits() {
    let (points, triangles) = ripples(30);
    let size = Size::new(200, 150);
    let viewpoint = Viewpoint::fit(points.iter().copied(), [0.0, 0.0, 1.0], size);
    let surface = Surface { wireframe: true, ..Surface::new(&points, &triangles) };
    let style = Style { floor: Some(-0.2), ..Style::default() };
    let image = || draw_with(&[Layer::Surface(surface)], &viewpoint, size, &style).unwrap();
    let first = image();
    assert_eq!(first, image());
    assert_eq!(first.encode_png().unwrap(), image().encode_png().unwrap());
    // The size of the world does not matter: powers of two only move the exponents.
    let larger: Vec<_> = points.iter().map(|p| p.map(|x| x * 1024.0)).collect();
    let viewpoint = Viewpoint {
        eye: viewpoint.eye.map(|x| x * 1024.0),
        target: viewpoint.target.map(|x| x * 1024.0),
        ..viewpoint
    };
    let style = Style { floor: Some(-0.2 * 1024.0), ..style };
    let surface = Surface { points: &larger, ..surface };
    let scaled = draw_with(&[Layer::Surface(surface)], &viewpoint, size, &style).unwrap();
    assert_eq!(first, scaled);
}

#[test]
fn png_holds_the_pixels() {
    let (points, triangles) = ripples(10);
    let size = Size::new(61, 43);
    let viewpoint = Viewpoint::fit(points.iter().copied(), [0.0, 1.0, 0.0], size);
    let image =
        draw(&[Layer::Surface(Surface::new(&points, &triangles))], &viewpoint, size).unwrap();
    let bytes = image.encode_png().unwrap();
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
    let mut decoded = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut decoded).unwrap();
    assert_eq!((info.width, info.height, info.color_type), (61, 43, png::ColorType::Rgb));
    assert_eq!(decoded, image.pixels.as_flattened());

    let wrong = Image { size: Size::new(61, 44), pixels: image.pixels.clone() };
    assert!(wrong.encode_png().is_err());
    assert_eq!(wrong.pixel(0, 43), None);
    let error = image.write_png("/a/folder/that/is/not/there.png").unwrap_err();
    assert!(error.to_string().contains("/a/folder/that/is/not/there.png"), "{error}");
}

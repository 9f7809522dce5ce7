//! Motion files of ARCSim: where rigid bodies are in every frame.
//!
//! The first line is `NumFrames: n`. For each body follow a headline, n lines with a position
//! (m), another headline, and n lines with a quaternion, its real part first. Empty lines mean
//! nothing.

use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};

use crate::scene::limits::{MAX_COORDINATE_M, MAX_OBSTACLES};

/// Reads the places of all bodies in all frames: by body, then by frame.
///
/// # Errors
/// A sentence that names the line.
pub(super) fn read(bytes: &[u8]) -> Result<Vec<Vec<Isometry3<f64>>>, String> {
    let text = std::str::from_utf8(bytes).map_err(|e| format!("is not text: {e}"))?;
    let lines = text.lines().enumerate().map(|(k, line)| (k + 1, line.trim()));
    let mut lines = lines.filter(|(_, line)| !line.is_empty()).peekable();
    let (number, first) = lines.next().ok_or("is empty")?;
    let n_frames = match first.split_whitespace().collect::<Vec<_>>()[..] {
        [word, n] if word.ends_with(':') => n.parse::<usize>().ok().filter(|&n| n > 0),
        _ => None,
    };
    let n_frames =
        n_frames.ok_or_else(|| format!("line {number}: expected `NumFrames:` and a number"))?;
    let mut bodies = Vec::new();
    while lines.peek().is_some() {
        if bodies.len() == MAX_OBSTACLES {
            return Err(format!("has more than {MAX_OBSTACLES} bodies"));
        }
        let positions = block::<3>(&mut lines, n_frames)?;
        let turns = block::<4>(&mut lines, n_frames)?;
        let mut poses = Vec::with_capacity(positions.len());
        for ((_, x), (line, [w, i, j, k])) in positions.into_iter().zip(turns) {
            let turn = UnitQuaternion::try_new(Quaternion::new(w, i, j, k), 1e-6);
            let turn = turn.ok_or_else(|| format!("line {line}: the quaternion is zero"))?;
            poses.push(Isometry3::from_parts(Translation3::from(x), turn));
        }
        bodies.push(poses);
    }
    if bodies.is_empty() { Err("has no bodies".into()) } else { Ok(bodies) }
}

/// A headline and as many lines of `N` numbers as there are frames, with the numbers of the lines.
fn block<'t, const N: usize>(
    lines: &mut impl Iterator<Item = (usize, &'t str)>,
    n_frames: usize,
) -> Result<Vec<(usize, [f64; N])>, String> {
    let what = if N == 3 { "position" } else { "orientation" };
    let cut = || format!("ends before the last {what}; each body has {n_frames}");
    let (line, headline) = lines.next().ok_or_else(cut)?;
    if numbers::<N>(headline).is_some() {
        return Err(format!("line {line}: expected a headline such as `body[0] {what}`"));
    }
    // Nothing is reserved: the number of frames is only what the file claims.
    let mut block = Vec::new();
    for _ in 0..n_frames {
        let (line, text) = lines.next().ok_or_else(cut)?;
        let numbers = numbers(text)
            .ok_or_else(|| format!("line {line}: expected {N} numbers of {what}, got `{text}`"))?;
        if let Some(c) = numbers.iter().find(|c| c.is_nan() || c.abs() > MAX_COORDINATE_M) {
            return Err(format!("line {line}: {c} is beyond the limit of {MAX_COORDINATE_M:e}"));
        }
        block.push((line, numbers));
    }
    Ok(block)
}

/// The numbers of a line, if it has exactly so many and nothing else.
fn numbers<const N: usize>(line: &str) -> Option<[f64; N]> {
    let numbers: Option<Vec<f64>> = line.split_whitespace().map(|word| word.parse().ok()).collect();
    numbers?.try_into().ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    const GOOD: &str = "NumFrames: 2\nbody[0] position\n1 2 3\n4e-1 5 6\n\nbody[0] orientation\n\
                        1 0 0 0\n0 0 0 2\n\nbody[1] position\n0 0 0\n0 0 0\n\n\
                        body[1] orientation\n1 0 0 0\n0.6 0.8 0 0\n\n";

    #[test]
    fn bodies_and_frames() {
        for text in [GOOD.to_owned(), GOOD.replace('\n', "\r\n"), GOOD.replace("\n\n", "\n")] {
            let bodies = read(text.as_bytes()).unwrap();
            assert_eq!(bodies.iter().map(Vec::len).collect::<Vec<_>>(), [2, 2]);
            assert_eq!(bodies[0][1].translation.vector, Vector3::new(0.4, 5.0, 6.0));
            // Half a turn about z, and about x by 2 acos 0.6.
            let turned = bodies[0][1].rotation * Vector3::x();
            assert!((turned + Vector3::x()).norm() < 1e-15);
            let angle = bodies[1][1].rotation.angle();
            assert!((angle - 2.0 * 0.6f64.acos()).abs() < 1e-15);
        }
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        let cases = [
            (String::new(), "is empty"),
            ("NumFrames: 2\n".into(), "has no bodies"),
            (GOOD.replace(": 2", ": 0"), "line 1: expected `NumFrames:` and a number"),
            (GOOD.replace("NumFrames: 2", "2"), "line 1: expected `NumFrames:` and a number"),
            (
                GOOD.replace(": 2", ": 3"),
                "line 6: expected 3 numbers of position, got `body[0] orientation`",
            ),
            (GOOD.replace("5 6", "5"), "line 4: expected 3 numbers of position, got `4e-1 5`"),
            (GOOD.replace("0 0 0 2", "0 0 0 0"), "line 8: the quaternion is zero"),
            (GOOD.replace("4e-1", "nan"), "line 4: NaN is beyond the limit of 1e6"),
            (GOOD.replace("4e-1", "4e9"), "line 4: 4000000000 is beyond the limit of 1e6"),
            (
                GOOD.replace("body[1] position\n", ""),
                "line 10: expected a headline such as `body[0] position`",
            ),
            (
                GOOD.replace("0.6 0.8 0 0\n", ""),
                "ends before the last orientation; each body has 2",
            ),
            (
                GOOD.replace("NumFrames: 2", "NumFrames: 99999999999999"),
                "line 6: expected 3 numbers of position, got `body[0] orientation`",
            ),
        ];
        for (text, expected) in cases {
            assert_eq!(read(text.as_bytes()).unwrap_err(), expected, "{text}");
        }
        assert!(read(b"NumFrames: \xff").unwrap_err().starts_with("is not text"));
    }
}

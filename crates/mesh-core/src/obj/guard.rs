//! The guard in front of the library parser: reads the lines, rejects what the library would let
//! pass or mend in silence, and writes the text that the library reads as we mean it.
//!
//! Left alone, `tobj` accepts faces of one and two corners, invents texture coordinates for corners
//! without any, divides by a fourth coordinate, stumbles over a byte-order mark, a comment behind
//! numbers and lines continued by `\`, numbers vertices by first use and starts again with every
//! group. So the text it gets holds no groups, only numbers that count, absolute indices, and in
//! front of the faces one single corner per vertex in file order, which fixes the numbering and
//! keeps vertices that no face uses.

use super::ObjError;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Limit of vertices and of triangles: half-edges are 32-bit numbers, and files of more than this
/// are mistakes.
const LIMIT: usize = 1 << 28;

/// Clean text for the library parser, and where its parts come from.
#[derive(Default)]
pub(super) struct Guarded {
    /// The text.
    pub(super) text: String,
    /// Source line of every line of `text` that holds coordinates: the first ones.
    lines: Vec<u32>,
    /// Source line of every `v`.
    pub(super) vertex_lines: Vec<u32>,
    /// Source line of every `vt`.
    pub(super) texture_lines: Vec<u32>,
    /// Source line of every face.
    pub(super) face_lines: Vec<u32>,
    /// Face of every triangle of the fans.
    pub(super) face_of: Vec<u32>,
    /// Names of the groups that have faces, in order of their first ones.
    pub(super) groups: Vec<String>,
    /// Group of every face.
    pub(super) group_of_face: Vec<u32>,
    /// Number of single corners in front of the faces.
    pub(super) n_numbering: usize,
    /// True if the corners have texture coordinates.
    pub(super) faces_have_texture: bool,
}

impl Guarded {
    /// The source line of the last line of `read`, a beginning of `text`, if it holds coordinates.
    pub(super) fn source_line(&self, read: &str) -> Option<usize> {
        let at = read.lines().count().checked_sub(1)?;
        self.lines.get(at).map(|&line| line as usize)
    }

    fn coordinates(
        &mut self,
        line: usize,
        keyword: &'static str,
        words: &[&str],
    ) -> Result<(), ObjError> {
        let got = words.len();
        // After x y z there may be a weight, a colour, or both; after u v a third coordinate.
        let (kept, expected, fine) = match keyword {
            "v" => (3, "3", matches!(got, 3 | 4 | 6 | 7)),
            _ => (2, "2", matches!(got, 2 | 3)),
        };
        if !fine {
            return Err(ObjError::Coordinates { line, keyword, expected, got });
        }
        self.text.push_str(keyword);
        for word in &words[..kept] {
            self.text.push(' ');
            self.text.push_str(word);
        }
        self.text.push('\n');
        self.lines.push(line as u32);
        let list = if keyword == "v" { &mut self.vertex_lines } else { &mut self.texture_lines };
        list.push(line as u32);
        Ok(())
    }

    fn check_limit(&self, line: usize) -> Result<(), ObjError> {
        let largest = self.vertex_lines.len().max(self.texture_lines.len()).max(self.face_of.len());
        let too_many = largest > LIMIT || line > u32::MAX as usize;
        if too_many { Err(ObjError::TooMany { line, limit: LIMIT }) } else { Ok(()) }
    }
}

/// One corner of a face: indices from 1, as the file has them or resolved if they were relative.
type Corner = (i64, Option<i64>);

/// Checks an OBJ file and rewrites it.
pub(super) fn guard(bytes: &[u8]) -> Result<Guarded, ObjError> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut out = Guarded::default();
    // Faces wait until all vertices are known: they may refer to later ones.
    let mut corners: Vec<Corner> = Vec::new();
    let mut face_ends: Vec<usize> = Vec::new();
    // What a group is called before the first is named is part of the format.
    let (mut name, mut group, mut number_of) = ("default".to_owned(), None, BTreeMap::new());
    let mut lines = bytes.split(|&b| b == b'\n').enumerate();
    while let Some((at, first)) = lines.next() {
        let line = at + 1;
        let mut content = Cow::Borrowed(without_comment(first));
        while content.ends_with(b"\\") {
            let joined = content.to_mut();
            joined.pop();
            joined.push(b' ');
            joined.extend(lines.next().map_or(&b""[..], |(_, next)| without_comment(next)));
        }
        if content.contains(&0) {
            return Err(ObjError::Binary { line });
        }
        let text = String::from_utf8_lossy(&content);
        // The library splits like this: at any white space of Unicode.
        let mut words = text.split_whitespace();
        match words.next() {
            Some("v") => out.coordinates(line, "v", &words.collect::<Vec<_>>())?,
            Some("vt") => out.coordinates(line, "vt", &words.collect::<Vec<_>>())?,
            Some("g" | "o") => {
                name = words.collect::<Vec<_>>().join(" ");
                group = None;
            }
            Some("f") => {
                let begin = corners.len();
                for word in words {
                    let corner = corner(word, line, &out)?;
                    let has = corner.1.is_some();
                    if corners.first().is_some_and(|(_, vt)| vt.is_some() != has) {
                        return Err(ObjError::MixedTexture { line, has });
                    }
                    corners.push(corner);
                }
                let got = corners.len() - begin;
                if got < 3 {
                    return Err(ObjError::Corners { line, got });
                }
                let face = out.face_lines.len() as u32;
                out.face_of.extend(std::iter::repeat_n(face, got - 2));
                out.face_lines.push(line as u32);
                // Groups without faces do not count.
                let number = *group.get_or_insert_with(|| {
                    *number_of.entry(name.clone()).or_insert_with(|| {
                        out.groups.push(name.clone());
                        out.groups.len() as u32 - 1
                    })
                });
                out.group_of_face.push(number);
                face_ends.push(corners.len());
            }
            _ => {}
        }
        out.check_limit(line)?;
    }
    out.faces_have_texture = corners.first().is_some_and(|(_, vt)| vt.is_some());
    out.append_faces(&corners, &face_ends)?;
    Ok(out)
}

impl Guarded {
    /// Appends the numbering corners and the faces, whose indices must now all exist.
    fn append_faces(&mut self, corners: &[Corner], face_ends: &[usize]) -> Result<(), ObjError> {
        let (n_v, n_vt) = (self.vertex_lines.len(), self.texture_lines.len());
        if n_v == 0 {
            return Err(ObjError::NoVertices);
        }
        if face_ends.is_empty() {
            return Err(ObjError::NoFaces);
        }
        self.n_numbering = n_v.max(n_vt);
        for i in 1..=self.n_numbering {
            self.append_corner("f ", (i.min(n_v) as i64, (n_vt > 0).then(|| i.min(n_vt) as i64)));
            self.text.push('\n');
        }
        let mut begin = 0;
        for (face, &end) in face_ends.iter().enumerate() {
            let line = self.face_lines[face] as usize;
            self.text.push('f');
            for &(v, vt) in &corners[begin..end] {
                let listed = [("v", Some(v), n_v), ("vt", vt, n_vt)];
                for (keyword, index, count) in listed {
                    if let Some(index) = index.filter(|&i| i < 1 || i as usize > count) {
                        return Err(ObjError::Index { line, keyword, index, count });
                    }
                }
                self.append_corner(" ", (v, vt));
            }
            self.text.push('\n');
            begin = end;
        }
        Ok(())
    }

    fn append_corner(&mut self, before: &str, (v, vt): Corner) {
        let written = match vt {
            Some(vt) => write!(self.text, "{before}{v}/{vt}"),
            None => write!(self.text, "{before}{v}"),
        };
        debug_assert!(written.is_ok(), "writing to a string does not fail");
    }
}

/// The line up to a comment, without white space at its end.
fn without_comment(line: &[u8]) -> &[u8] {
    line.split(|&b| b == b'#').next().unwrap_or_default().trim_ascii_end()
}

/// Reads `v`, `v/vt`, `v//vn` or `v/vt/vn`; the normal must be a number but is not used.
fn corner(word: &str, line: usize, sofar: &Guarded) -> Result<Corner, ObjError> {
    let garbage = || ObjError::corner(line, word);
    let mut parts = word.split('/');
    let mut index = |keyword: &'static str, before: usize| -> Result<Option<i64>, ObjError> {
        match parts.next() {
            None | Some("") => Ok(None),
            Some(part) => {
                let index: i64 = part.parse().map_err(|_| garbage())?;
                let resolved = if index < 0 { before as i64 + 1 + index } else { index };
                // Relative to what stands before the face, so it must exist already.
                if resolved < 1 {
                    return Err(ObjError::Index { line, keyword, index, count: before });
                }
                Ok(Some(resolved))
            }
        }
    };
    let v = index("v", sofar.vertex_lines.len())?.ok_or_else(garbage)?;
    let vt = index("vt", sofar.texture_lines.len())?;
    match (parts.next(), parts.next()) {
        (normal, None) if normal.is_none_or(|n| n.is_empty() || n.parse::<i64>().is_ok()) => {
            Ok((v, vt))
        }
        _ => Err(garbage()),
    }
}

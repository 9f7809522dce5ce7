//! Bad scenes and what they must be answered with, for the tests of both kinds.

// Each test file uses its part of this.
#![allow(dead_code)]

use organza::scene::{LoadOptions, SceneErrors, Source, from_sources, parse};

/// Files that scenes of these tests may name.
pub(crate) fn attached() -> Vec<Source> {
    let row = "[9, 1, 9, 3]";
    let good_rows = [row; 6].join(", ");
    let bend = "[1e-5, 1e-5, 1e-5, 1e-5, 1e-5]";
    let material = |density: &str, stretching: &str, bending: &str| {
        format!(
            "{{\n\"density\": {density},\n\"stretching\": [{stretching}],\n\"bending\": [{bending}]\n}}"
        )
    };
    let good_bend = [bend; 3].join(", ");
    [
        ("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".to_owned()),
        ("good.json", material("0.2", &good_rows, &good_bend)),
        ("light.json", material("-0.2", &good_rows, &good_bend)),
        ("short.json", material("0.2", row, &good_bend)),
        ("narrow.json", material("0.2", &good_rows, "[1, 2], [1, 2], [1, 2]")),
        ("nan.json", material("0.2", &good_rows.replacen('3', "NaN", 1), &good_bend)),
        ("stiff.json", material("0.2", &good_rows.replacen('9', "1e13", 1), &good_bend)),
        ("typo.json", material("0.2", &good_rows, &good_bend).replace("density", "densty")),
        ("cut.json", "{\"density\": 0.2,".to_owned()),
    ]
    .into_iter()
    .map(|(name, text)| Source { name: name.to_owned(), bytes: text.into_bytes() })
    .collect()
}

pub(crate) fn errors_of(text: &[u8], sets: &[&str]) -> SceneErrors {
    let options = LoadOptions {
        sets: sets.iter().map(|set| (*set).to_owned()).collect(),
        allow_unsupported: false,
    };
    match parse(text, "s.json5", &options, &from_sources(&attached())) {
        Ok(loaded) => panic!("{:?} is accepted: {:?}", String::from_utf8_lossy(text), loaded.scene),
        Err(errors) => errors,
    }
}

/// Asserts that the complaints are exactly these lines.
#[track_caller]
pub(crate) fn complains(text: &str, sets: &[&str], expected: &[&str]) {
    let errors = errors_of(text.as_bytes(), sets);
    let got: Vec<String> = errors.issues().iter().map(ToString::to_string).collect();
    assert_eq!(got, expected, "\nscene: {text}\nsets: {sets:?}");
}

/// Line 1: the scene with `scene` added; line 2: its cloth with `cloth` added.
pub(crate) fn with(scene: &str, cloth: &str) -> String {
    format!(
        "{{frames: 2, {scene} cloths: [\n{{mesh: {{obj: 'a.obj'}}, fabric: 'swim', {cloth}}}]}}"
    )
}

#[track_caller]
pub(crate) fn scene_complains(scene: &str, expected: &str) {
    complains(&with(scene, ""), &[], &expected.split('\n').collect::<Vec<_>>());
}

#[track_caller]
pub(crate) fn cloth_complains(cloth: &str, expected: &str) {
    complains(&with("", cloth), &[], &[expected]);
}

/// A scene whose only cloth is all of `cloth`.
#[track_caller]
pub(crate) fn whole_cloth_complains(cloth: &str, expected: &[&str]) {
    complains(&format!("{{frames: 1, cloths: [\n{{{cloth}}}]}}"), &[], expected);
}

//! JSON value to typed data, with errors for people: all unknown keys, each with a suggestion, and
//! plain words for wrong types.

use serde::Deserialize;
use serde_json::Value;

use super::issue::IssueKind;
use super::limits;
use super::locate::Part;
use super::path::{Segment, ValuePath};
use super::strict::Strict;

/// A complaint about one place of a file, before its line and column are looked up.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Complaint {
    pub(crate) kind: IssueKind,
    pub(crate) path: ValuePath,
    pub(crate) part: Part,
    pub(crate) message: String,
}

/// Reads `value` as a `T`.
///
/// What is wrong is complained of, taken out and passed over, so that one reading finds all
/// unknown keys and wrong types. Unknown keys alone do not keep the rest from being read; nothing
/// is returned where a type does not fit or a key is missing.
pub(crate) fn read<T>(value: &mut Value, complaints: &mut Vec<Complaint>) -> Option<T>
where
    T: for<'de> Deserialize<'de>,
{
    let before = complaints.len();
    // Values taken out for their type, and keys that were probably meant by unknown ones: both
    // would be missed in what follows, and have been complained of.
    let (mut removed, mut meant) = (Vec::<ValuePath>::new(), Vec::<ValuePath>::new());
    loop {
        let error = match serde_path_to_error::deserialize::<_, T>(Strict(value)) {
            Ok(read) => return removed.is_empty().then_some(read),
            Err(error) => error,
        };
        // Each complaint takes another reading; what has so many is no scene.
        if complaints.len() - before >= limits::MAX_ISSUES {
            return None;
        }
        let path = ValuePath::from(error.path());
        let message = error.inner().to_string();
        let mut complain = |path: &ValuePath, part, message| {
            let (kind, path) = (IssueKind::Structure, path.clone());
            complaints.push(Complaint { kind, path, part, message });
        };
        if let Some((key_path, key, known)) = unknown_field(&message, &path) {
            let known: Vec<&str> = known.iter().map(String::as_str).collect();
            meant.extend(nearest(&key, &known).map(|best| key_path.parent().key(best)));
            let message = format!("unknown key `{key}`{}", suggestion(&key, &known));
            complain(&key_path, Part::Key, message);
            if !remove(value, &key_path) {
                return None;
            }
            continue;
        }
        if let Some(key) = missing_field(&message) {
            let missing = path.key(key);
            if !removed.contains(&missing) && !meant.contains(&missing) {
                complain(&path, Part::Value, format!("key `{key}` is missing"));
            }
        } else if !removed.iter().any(|removed| removed.starts_with(&path)) {
            // Unlike here, what encloses a value taken out may be wrong only because of that.
            complain(&path, Part::Value, plain_words(&message));
        }
        // A list that lacks an element is wrong too, so the whole list goes.
        let mut whole = path;
        while matches!(whole.last(), Some(Segment::Index(_))) {
            whole = whole.parent();
        }
        if !remove(value, &whole) {
            return None;
        }
        removed.push(whole);
    }
}

fn missing_field(message: &str) -> Option<&str> {
    Some(message.strip_prefix("missing field ")?.trim_matches('`'))
}

/// Path, name and known neighbours of the key that a serde message calls unknown.
fn unknown_field(message: &str, path: &ValuePath) -> Option<(ValuePath, String, Vec<String>)> {
    let rest = message.strip_prefix("unknown field ")?;
    // The key may hold back-quotes of its own; what follows the last `, expected` does not.
    let (key, known) = match rest.rsplit_once(", expected ") {
        Some((key, known)) => (key, quoted(known)),
        None => (rest.rsplit_once(", ").map_or(rest, |(key, _)| key), Vec::new()),
    };
    let key = key.trim_matches('`').to_owned();
    let path = match path.last() {
        Some(Segment::Key(last)) if *last == key => path.clone(),
        _ => path.key(&key),
    };
    Some((path, key, known))
}

/// The words between back-quotes.
fn quoted(text: &str) -> Vec<String> {
    text.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}

fn remove(value: &mut Value, path: &ValuePath) -> bool {
    let Some((Segment::Key(key), parents)) = path.0.split_last() else { return false };
    let parent = parents.iter().try_fold(value, |value, segment| match segment {
        Segment::Key(key) => value.get_mut(key),
        Segment::Index(index) => value.get_mut(index),
    });
    parent.and_then(Value::as_object_mut).is_some_and(|object| object.remove(key).is_some())
}

/// `, did you mean …` with the nearest known word, or the list of all where none is near.
pub(crate) fn suggestion<S: AsRef<str>>(word: &str, known: &[S]) -> String {
    let known: Vec<&str> = known.iter().map(AsRef::as_ref).collect();
    match nearest(word, &known) {
        Some(best) => format!(", did you mean `{best}`?"),
        None if known.is_empty() => String::new(),
        None => format!(", expected one of {}", known.join(", ")),
    }
}

fn nearest<'k>(word: &str, known: &[&'k str]) -> Option<&'k str> {
    // Comparing takes time and memory with the product of the lengths.
    if word.len() > 100 {
        return None;
    }
    // Names carry their unit at the end: `density` should find `density_kg_per_m2`.
    let named = |candidate: &&&str| word.len() > 2 && candidate.starts_with(word);
    if let Some(candidate) = known.iter().find(named) {
        return Some(candidate);
    }
    let score = |candidate: &str| strsim::normalized_damerau_levenshtein(word, candidate);
    let scored = known.iter().map(|candidate| (score(candidate), *candidate));
    // Of equal scores the first wins.
    let mut nearest = (0.0, None);
    for (score, candidate) in scored {
        if score > nearest.0 {
            nearest = (score, Some(candidate));
        }
    }
    nearest.1.filter(|_| nearest.0 >= 0.6)
}

/// Rewords serde's messages.
fn plain_words(message: &str) -> String {
    for start in ["invalid type: ", "invalid value: ", "invalid length "] {
        if let Some((got, expected)) =
            message.strip_prefix(start).and_then(|rest| rest.rsplit_once(", expected "))
        {
            let got = if start == "invalid length " {
                format!("a list of {got}")
            } else {
                got.replace("floating point ", "")
                    .replace("integer ", "")
                    .replace("string ", "text ")
                    .replace("boolean ", "")
                    .replace("null", "nothing (null)")
                    .replace("sequence", "a list")
                    .replace("map", "an object")
                    .replace("unit variant", "a name alone")
            };
            return format!("expected {}, got {got}", expected_words(expected));
        }
    }
    if let Some(rest) = message.strip_prefix("unknown variant ")
        && let Some((got, known)) = rest.rsplit_once(", expected ")
    {
        let got = got.trim_matches('`');
        let known = quoted(known);
        let list = known.join(", ");
        return match nearest(got, &known.iter().map(String::as_str).collect::<Vec<_>>()) {
            Some(best) => format!("unknown choice `{got}`, did you mean `{best}`? (one of {list})"),
            None => format!("unknown choice `{got}`, expected one of {list}"),
        };
    }
    message.to_owned()
}

fn expected_words(expected: &str) -> String {
    let words = match expected {
        "f64" | "f32" => "a number",
        "u8" | "u16" | "u32" | "u64" | "usize" => "a whole number of at least 0",
        "i32" | "i64" => "a whole number",
        "a string" | "a borrowed string" => "a text",
        "a sequence" => "a list",
        "a boolean" => "true or false",
        "string or map" | "map with a single key" => {
            "the name of a choice, or an object with one key"
        }
        "unit" => "a name alone, without a value",
        "newtype variant" => "an object with one key",
        _ if expected.starts_with("struct ") => "an object",
        _ if expected.starts_with("enum ") => "the name of a choice, or an object with one key",
        _ if expected.starts_with("an array of length ") => {
            return format!("a list of {}", expected.trim_start_matches("an array of length "));
        }
        _ => expected,
    };
    words.to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn suggestions_know_units_and_typing_errors() {
        let known = ["density_kg_per_m2", "substeps", "size_m", "frames"];
        assert_eq!(suggestion("substep", &known), ", did you mean `substeps`?");
        assert_eq!(suggestion("density", &known), ", did you mean `density_kg_per_m2`?");
        assert_eq!(suggestion("size_mm", &known), ", did you mean `size_m`?");
        assert!(suggestion("colour", &known).starts_with(", expected one of density_kg_per_m2"));
        assert_eq!(suggestion::<&str>("colour", &[]), "");
    }
}

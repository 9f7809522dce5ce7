//! `--set PATH=VALUE`: replaces values of a scene before it is checked.

use serde_json::{Map, Value};

use super::issue::{Issue, IssueKind, Origin};
use super::path::{Segment, ValuePath};
use super::text::{TextProblem, read_value};

/// One `PATH=VALUE`, applied.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Override {
    pub(crate) path: ValuePath,
    pub(crate) argument: String,
}

/// Applies `argument` to `scene`.
///
/// Objects on the way are made where missing, so that `cloths[0].remeshing.size_m.min=0.01` works
/// on a cloth without remeshing; list elements are not. The value is read as JSON5, and taken as
/// text where it is not JSON5.
///
/// # Errors
/// When the path cannot be read, leads into a missing element or through a plain value, or when
/// the value is a number that is not finite.
pub(crate) fn apply(scene: &mut Value, argument: &str) -> Result<Override, Issue> {
    let fail = |path: String, message: String| Issue {
        kind: IssueKind::Structure,
        origin: Origin::Set { argument: argument.to_owned() },
        path,
        message,
    };
    let (path, value) = argument
        .split_once('=')
        .ok_or_else(|| fail(String::new(), "expected PATH=VALUE".to_owned()))?;
    let path = ValuePath::parse(path.trim()).map_err(|e| fail(String::new(), e.to_string()))?;
    let value = match read_value(value) {
        Ok(value) => value,
        Err(problems) => match problems.into_iter().next() {
            Some(TextProblem::Value { message, .. }) => {
                return Err(fail(path.to_string(), message));
            }
            _ => Value::from(value),
        },
    };
    *slot(scene, &path).map_err(|message| fail(path.to_string(), message))? = value;
    Ok(Override { path, argument: argument.to_owned() })
}

/// The value at `path`, made where it may be made.
fn slot<'v>(scene: &'v mut Value, path: &ValuePath) -> Result<&'v mut Value, String> {
    let mut value = scene;
    let mut so_far = ValuePath::default();
    for segment in &path.0 {
        let here = || {
            let place = so_far.to_string();
            if place.is_empty() { "the scene".to_owned() } else { format!("`{place}`") }
        };
        match segment {
            Segment::Key(key) => {
                if value.is_null() {
                    *value = Value::Object(Map::new());
                }
                let kind = kind_of(value);
                let object = value
                    .as_object_mut()
                    .ok_or_else(|| format!("{} is {kind}, not an object", here()))?;
                value = object.entry(key.clone()).or_insert(Value::Null);
                so_far = so_far.key(key);
            }
            Segment::Index(index) => {
                let kind = kind_of(value);
                let list = value
                    .as_array_mut()
                    .ok_or_else(|| format!("{} is {kind}, not a list", here()))?;
                let len = list.len();
                value = list
                    .get_mut(*index)
                    .ok_or_else(|| format!("{} has {len} elements, no element {index}", here()))?;
                so_far = so_far.index(*index);
            }
        }
    }
    Ok(value)
}

/// What a JSON value is, as a noun.
fn kind_of(value: &Value) -> &'static str {
    match value {
        Value::Null => "absent",
        Value::Bool(_) => "a truth value",
        Value::Number(_) => "a number",
        Value::String(_) => "a text",
        Value::Array(_) => "a list",
        Value::Object(_) => "an object",
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn values_are_json5_or_text_and_objects_are_made() {
        let mut scene = json!({"cloths": [{"fabric": "denim"}]});
        for argument in [
            "cloths[0].remeshing.size_m={min: 0.1, max: .5}",
            "cloths[0].fabric=knit-light",
            "cloths[0].name='a=b'",
            "frames=0x10",
        ] {
            apply(&mut scene, argument).unwrap();
        }
        assert_eq!(
            scene,
            json!({"frames": 16, "cloths": [{"fabric": "knit-light", "name": "a=b",
                "remeshing": {"size_m": {"min": 0.1, "max": 0.5}}}]})
        );
    }

    #[test]
    fn wrong_paths_say_what_stands_in_the_way() {
        let mut scene = json!({"frames": 3, "cloths": []});
        for (argument, message) in [
            ("frames", "--set frames: expected PATH=VALUE"),
            ("frames.x=1", "--set frames.x=1: frames.x: `frames` is a number, not an object"),
            ("cloths[0].name=a", "cloths[0].name: `cloths` has 0 elements, no element 0"),
            ("frames[0]=1", "frames[0]: `frames` is a number, not a list"),
            ("a..b=1", "a key is empty"),
            ("a[x]=1", "an index is not a whole number"),
            ("a[1=1", "a `[` is not closed"),
            ("frames=NaN", "--set frames=NaN: frames: must be a finite number, got NaN"),
        ] {
            let issue = apply(&mut scene, argument).unwrap_err().to_string();
            assert!(issue.contains(message), "{issue}");
        }
    }
}

//! Keys of scene files that name things this version does not simulate.

use serde_json::Value;

use super::issue::IssueKind;
use super::locate::Part;
use super::path::ValuePath;
use super::typed::Complaint;

/// Keys of the scene, and what they stand for.
const SCENE: [(&str, &str); 2] = [("cameras", "several cameras"), ("morphs", "morphs")];

/// Keys of each cloth.
const CLOTH: [(&str, &str); 5] = [
    ("plasticity", "plastic deformation"),
    ("fracture", "fracture"),
    ("tearing", "tearing"),
    ("self_contact", "contact of single cloths; see `contact` of the scene"),
    ("friction", "friction of single cloths; see `contact` of the scene"),
];

/// Takes the unsupported keys out of a scene and complains of each that asks for something.
pub(super) fn take(scene: &mut Value, complaints: &mut Vec<Complaint>) {
    let top = ValuePath::default();
    take_from(scene, &top, &SCENE, complaints);
    if let Some(cloths) = scene.get_mut("cloths").and_then(Value::as_array_mut) {
        for (i, cloth) in cloths.iter_mut().enumerate() {
            take_from(cloth, &top.key("cloths").index(i), &CLOTH, complaints);
        }
    }
}

fn take_from(
    value: &mut Value,
    at: &ValuePath,
    keys: &[(&str, &str)],
    complaints: &mut Vec<Complaint>,
) {
    let Some(object) = value.as_object_mut() else { return };
    for (key, thing) in keys {
        if object.remove(*key).is_some_and(|value| asks(&value)) {
            complaints.push(unsupported(at.key(key), *thing));
        }
    }
}

/// A complaint about something that is not simulated.
pub(crate) fn unsupported(path: ValuePath, what: impl Into<String>) -> Complaint {
    Complaint { kind: IssueKind::Unsupported, path, part: Part::Key, message: what.into() }
}

/// False for the ways to say "none of it".
pub(crate) fn asks(value: &Value) -> bool {
    match value {
        Value::Null | Value::Bool(false) => false,
        Value::Array(list) => !list.is_empty(),
        _ => true,
    }
}

//! JSON5 text to a JSON value, with the guards that parsers leave out: nesting, numbers that are
//! not finite, keys given twice.

use std::cell::RefCell;
use std::fmt;

use serde::Deserialize;
use serde::de::{DeserializeSeed, Deserializer, Error, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Number, Value};

use super::issue::Position;
use super::path::{Segment, ValuePath};

/// Deepest nesting of lists and objects that is read.
pub const MAX_DEPTH: usize = 64;

/// Why a text gives no value.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum TextProblem {
    /// The text is not JSON5.
    Syntax { position: Position, message: String },
    /// The text is JSON5, and a value in it is refused.
    Value { path: ValuePath, message: String },
}

/// Reads one JSON5 value.
///
/// # Errors
/// Bad syntax and too deep nesting give one problem; non-finite numbers and keys given twice give
/// one problem each.
pub(crate) fn read_value(text: &str) -> Result<Value, Vec<TextProblem>> {
    match json5::from_str::<Checked>(text) {
        Ok(Checked { value, problems }) if problems.is_empty() => Ok(value),
        Ok(Checked { problems, .. }) => Err(problems),
        Err(error) => Err(vec![syntax_problem(text, &error)]),
    }
}

fn syntax_problem(text: &str, error: &json5::Error) -> TextProblem {
    let message = error.code().map(|code| code.to_string());
    let cut = message.as_ref().is_some_and(|message| message.starts_with("EOF"));
    // Where the text ends too early, the parser names the start of what it was reading.
    let named = error.position().filter(|_| !cut);
    let from_zero = named.unwrap_or_else(|| json5::Position::from_offset(text.len(), text));
    let position = Position { line: from_zero.line + 1, column: from_zero.column + 1 };
    let message = match message {
        Some(_) if error.code() == Some(json5::ErrorCode::EofParsingValue) => {
            "the text ends where a value is expected; is the file empty or cut short?".to_owned()
        }
        Some(message) => format!("not JSON5: {}", message.replace("EOF", "the text ends while")),
        // The parser appends the place, which is already in front of the message.
        None => match error.to_string().rsplit_once(" at line ") {
            Some((message, _)) => message.to_owned(),
            None => error.to_string(),
        },
    };
    TextProblem::Syntax { position, message }
}

/// A value together with what was found wrong while reading it.
struct Checked {
    value: Value,
    problems: Vec<TextProblem>,
}

impl<'de> Deserialize<'de> for Checked {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let reader = Reader::default();
        let value = Seed(&reader).deserialize(deserializer)?;
        Ok(Self { value, problems: reader.problems.into_inner() })
    }
}

/// Where the reading stands and what it has found.
#[derive(Default)]
struct Reader {
    path: RefCell<Vec<Segment>>,
    problems: RefCell<Vec<TextProblem>>,
}

impl Reader {
    fn refuse(&self, message: String) {
        let path = ValuePath(self.path.borrow().clone());
        self.problems.borrow_mut().push(TextProblem::Value { path, message });
    }

    /// Reads a part of the current value; the depth limit lives here because every level of
    /// nesting passes through.
    fn enter<T, E: Error>(
        &self,
        segment: Segment,
        read: impl FnOnce() -> Result<T, E>,
    ) -> Result<T, E> {
        if self.path.borrow().len() >= MAX_DEPTH {
            return Err(E::custom(format!("nested deeper than {MAX_DEPTH} levels")));
        }
        self.path.borrow_mut().push(segment);
        let result = read();
        self.path.borrow_mut().pop();
        result
    }
}

#[derive(Clone, Copy)]
struct Seed<'r>(&'r Reader);

impl<'de> DeserializeSeed<'de> for Seed<'_> {
    type Value = Value;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Value, D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Seed<'_> {
    type Value = Value;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a JSON5 value")
    }

    fn visit_unit<E: Error>(self) -> Result<Value, E> {
        Ok(Value::Null)
    }

    fn visit_bool<E: Error>(self, value: bool) -> Result<Value, E> {
        Ok(Value::Bool(value))
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<Value, E> {
        Ok(Value::from(value))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Value, E> {
        Ok(Value::from(value))
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Value, E> {
        let number = Number::from_f64(value);
        if number.is_none() {
            self.0.refuse(format!("must be a finite number, got {value}"));
        }
        Ok(number.map_or(Value::Null, Value::Number))
    }

    fn visit_str<E: Error>(self, value: &str) -> Result<Value, E> {
        Ok(Value::from(value))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Value, A::Error> {
        let mut values = Vec::new();
        loop {
            let index = Segment::Index(values.len());
            match self.0.enter(index, || list.next_element_seed(self))? {
                Some(value) => values.push(value),
                None => return Ok(Value::Array(values)),
            }
        }
    }

    fn visit_map<A: MapAccess<'de>>(self, mut object: A) -> Result<Value, A::Error> {
        let mut members = Map::new();
        while let Some(key) = object.next_key::<String>()? {
            let repeated = members.contains_key(&key);
            let value = self.0.enter(Segment::Key(key.clone()), || {
                if repeated {
                    self.0.refuse(format!("key `{key}` is given twice"));
                }
                object.next_value_seed(self)
            })?;
            members.insert(key, value);
        }
        Ok(Value::Object(members))
    }
}

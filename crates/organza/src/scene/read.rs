//! Bytes of a JSON5 file to a value, together with what is needed to point into the file.

use serde_json::Value;

use super::issue::{Issue, IssueKind, Origin};
use super::limits::{MAX_ISSUES, MAX_TEXT_BYTES};
use super::locate::{Part, position_of};
use super::places::Places;
use super::text::{TextProblem, read_value};
use super::typed::Complaint;

/// A parsed file.
pub(crate) struct Document {
    pub(crate) value: Value,
    pub(crate) places: Places,
}

/// Parses a file; `name` is for messages.
///
/// # Errors
/// When the file is too large, not UTF-8, or not JSON5; see also the text guards.
pub(crate) fn read_document(name: &str, bytes: &[u8]) -> Result<Document, Vec<Issue>> {
    let syntax = |position, message: String| Issue {
        kind: IssueKind::Syntax,
        origin: Origin::File { name: name.to_owned(), position },
        path: String::new(),
        message,
    };
    if bytes.len() as u64 > MAX_TEXT_BYTES {
        let message = format!("{} bytes, beyond the limit of {MAX_TEXT_BYTES}", bytes.len());
        return Err(vec![syntax(None, message)]);
    }
    let text = std::str::from_utf8(bytes).map_err(|error| {
        let good = &bytes[..error.valid_up_to()];
        let position = std::str::from_utf8(good).ok().map(|text| position_of(text, text.len()));
        let at = error.valid_up_to();
        vec![syntax(position, format!("not UTF-8 text: byte {:#04x} at offset {at}", bytes[at]))]
    })?;
    let places = Places::new(name, text);
    match read_value(text) {
        Ok(value) => Ok(Document { value, places }),
        Err(problems) => Err(problems
            .into_iter()
            .take(MAX_ISSUES)
            .map(|problem| match problem {
                TextProblem::Syntax { position, message } => syntax(Some(position), message),
                TextProblem::Value { path, message } => places.resolve(Complaint {
                    kind: IssueKind::Value,
                    path,
                    part: if message.starts_with("key ") { Part::Key } else { Part::Value },
                    message,
                }),
            })
            .collect()),
    }
}

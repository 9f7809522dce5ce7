//! Range checks that collect complaints instead of stopping at the first.

use std::cell::RefCell;

use super::issue::IssueKind;
use super::limits;
use super::locate::Part;
use super::path::ValuePath;
use super::typed::Complaint;

/// All complaints of one file.
#[derive(Debug, Default)]
pub(crate) struct Complaints(RefCell<Vec<Complaint>>);

impl Complaints {
    pub(crate) fn at_top(&self) -> At<'_> {
        At { path: ValuePath::default(), all: self }
    }

    pub(crate) fn into_vec(self) -> Vec<Complaint> {
        self.0.into_inner()
    }

    pub(crate) fn extend(&self, complaints: Vec<Complaint>) {
        self.0.borrow_mut().extend(complaints);
    }
}

/// A place in the file, at which values are checked.
#[derive(Debug, Clone)]
pub(crate) struct At<'a> {
    pub(crate) path: ValuePath,
    all: &'a Complaints,
}

impl<'a> At<'a> {
    /// The place of a key below this one. Dots separate several keys.
    pub(crate) fn key(&self, keys: &str) -> At<'a> {
        keys.split('.').fold(self.clone(), |at, key| at.member(key))
    }

    /// The place of a key that may hold dots itself.
    pub(crate) fn member(&self, key: &str) -> At<'a> {
        At { path: self.path.key(key), all: self.all }
    }

    pub(crate) fn index(&self, index: usize) -> At<'a> {
        At { path: self.path.index(index), all: self.all }
    }

    pub(crate) fn complain(&self, message: impl Into<String>) {
        self.report(IssueKind::Value, message);
    }

    pub(crate) fn report(&self, kind: IssueKind, message: impl Into<String>) {
        let (path, message) = (self.path.clone(), message.into());
        self.all.0.borrow_mut().push(Complaint { kind, path, part: Part::Value, message });
    }

    /// Greater than zero, at most `limit`.
    pub(crate) fn positive(&self, x: f64, limit: f64, unit: &str) {
        if !(x > 0.0 && x.is_finite()) {
            self.complain(format!("must be positive and finite, got {x}"));
        } else if x > limit {
            self.complain(beyond(x, limit, unit));
        }
    }

    /// A length of a generated mesh (m).
    pub(crate) fn size(&self, x: f64) {
        if x > 0.0 && x < limits::MIN_SIZE_M {
            let limit = limits::MIN_SIZE_M;
            self.complain(format!("{x:e} m is below the limit of {limit:e} m"));
        } else {
            self.positive(x, limits::MAX_COORDINATE_M, "m");
        }
    }

    /// Zero or more, at most `limit`.
    pub(crate) fn not_negative(&self, x: f64, limit: f64, unit: &str) {
        if !(x >= 0.0 && x.is_finite()) {
            self.complain(format!("must be zero or more and finite, got {x}"));
        } else if x > limit {
            self.complain(beyond(x, limit, unit));
        }
    }

    /// Between 1/`MAX_FACTOR` and `MAX_FACTOR`.
    pub(crate) fn factor(&self, x: f64) {
        if !(x > 0.0 && x.is_finite()) {
            self.complain(format!("must be positive and finite, got {x}"));
        } else if !(1.0 / limits::MAX_FACTOR..=limits::MAX_FACTOR).contains(&x) {
            let limit = limits::MAX_FACTOR;
            self.complain(format!("must lie between 1/{limit:e} and {limit:e}, got {x:e}"));
        }
    }

    /// At most `limit` in size.
    pub(crate) fn bounded(&self, x: f64, limit: f64, unit: &str) {
        if !x.is_finite() {
            self.complain(format!("must be finite, got {x}"));
        } else if x.abs() > limit {
            self.complain(beyond(x, limit, unit));
        }
    }

    /// Every component at most `limit` in size.
    pub(crate) fn vector(&self, x: &[f64], limit: f64, unit: &str) {
        for (i, x) in x.iter().enumerate() {
            self.index(i).bounded(*x, limit, unit);
        }
    }

    /// A point or an offset (m).
    pub(crate) fn coordinates(&self, x: &[f64]) {
        self.vector(x, limits::MAX_COORDINATE_M, "m");
    }

    /// At least `min`.
    pub(crate) fn at_least(&self, x: u32, min: u32) {
        if x < min {
            self.complain(format!("must be at least {min}, got {x}"));
        }
    }
}

/// The message for a number beyond a limit.
pub(crate) fn beyond(x: f64, limit: f64, unit: &str) -> String {
    let space = if unit.is_empty() { "" } else { " " };
    format!("{x:e}{space}{unit} is beyond the limit of {limit:e}{space}{unit}")
}

//! Clothes that fit the mannequin.

mod belt;
mod panel;
mod skirt;
mod top;
mod trousers;

use crate::error::{MannequinError, check};
use mesh_core::generate::Sheet;

/// A piece of clothing. All start around the body at rest, clear of it and of each other by more than
/// 8 mm, except that dress, skirt and trousers are for the same place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Garment {
    /// A dress without sleeves, cut at the waist: `front`, `back`, `skirt-front`, `skirt-back`.
    /// Borders: `hem`, `neck`, `right-armhole`, `left-armhole`.
    Dress,
    /// A skirt that rests on the hips, its waist too narrow to slide over them: `front`, `back`.
    /// Borders: `hem`, `waist`.
    Skirt,
    /// Wide trousers with a waist too narrow to slide over the hips: `front-right`, `front-left`,
    /// `back-right`, `back-left`. Borders: `waist`, `right-hem`, `left-hem`.
    Trousers,
    /// A jacket that is open in front, the side x < 0 over the other, with wide sleeves: `back`,
    /// `front-right`, `front-left`, `right-sleeve`, `left-sleeve`. Borders: `hem`, `opening`,
    /// `right-cuff`, `left-cuff`.
    Jacket,
    /// An elastic belt around the jacket: one strip, a fourth shorter in its pattern than it starts.
    /// Borders: `lower`, `upper`.
    Belt,
}

impl Garment {
    /// Shortest length of edges (m).
    pub const MIN_CELL: f64 = 0.004;
    /// Greatest length of edges (m).
    pub const MAX_CELL: f64 = 0.06;

    /// Names of its panels, in order. Right is x > 0: the right as seen from the front.
    pub fn panels(self) -> &'static [&'static str] {
        match self {
            Garment::Dress => &["front", "back", "skirt-front", "skirt-back"],
            Garment::Skirt => &["front", "back"],
            Garment::Trousers => &["front-right", "front-left", "back-right", "back-left"],
            Garment::Jacket => {
                &["back", "front-right", "front-left", "right-sleeve", "left-sleeve"]
            }
            Garment::Belt => &["belt"],
        }
    }

    /// The garment around the body at rest, with mesh edges of about `cell` (m). Its patterns are the
    /// flat pieces that come nearest to the shape it starts in; more than nine tenths of the cloth is
    /// strained by less than 5 %, the rest of it at armholes and crotch by more.
    ///
    /// # Errors
    /// If the length of edges is out of range.
    pub fn sheet(self, cell: f64) -> Result<Sheet, MannequinError> {
        check("the length of edges", cell, "from 0.004 to 0.06 (m)", |cell| {
            (Garment::MIN_CELL..=Garment::MAX_CELL).contains(&cell)
        })?;
        let sheet = match self {
            Garment::Dress => top::dress(cell),
            Garment::Skirt => skirt::skirt(cell),
            Garment::Trousers => trousers::trousers(cell),
            Garment::Jacket => top::jacket(cell),
            Garment::Belt => belt::belt(cell),
        };
        Ok(sheet?)
    }
}

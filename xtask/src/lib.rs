//! Chores of the project, one `cargo xtask` command each.
//!
//! A command is a [`command::Command`] listed in [`command::COMMANDS`]; nothing else has to be
//! touched to add one.

#![warn(missing_docs)]
#![forbid(unsafe_code)]

pub mod bench;
pub mod ci;
pub mod command;
pub mod tidy;

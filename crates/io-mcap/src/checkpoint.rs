//! Exact state to continue from: named columns of numbers, closed by a CRC of their own.
//!
//! On the wire a checkpoint is an `organza.Checkpoint`. Its last five bytes are the field
//! `crc32`, the CRC-32 of all bytes before them: checked whichever way the message was found.

use prost::Message as _;

use crate::proto::{
    CheckpointBody, ColumnValues, DoubleList, Fixed32List, Fixed64List, NamedColumn,
};

/// The exact state of a simulation at the end of one frame. What the columns mean is up to the
/// caller.
#[derive(Clone, Debug, PartialEq)]
pub struct Checkpoint {
    /// Frame after which the state was taken.
    pub frame: u64,
    /// Simulated time (s).
    pub time_s: f64,
    /// Named columns, in the order given.
    pub columns: Vec<(String, Column)>,
}

/// One column of a [`Checkpoint`]. Every bit is kept: NaN payloads, -0.0, subnormals.
#[derive(Clone, Debug, PartialEq)]
pub enum Column {
    /// Doubles.
    F64(Vec<f64>),
    /// Unsigned 32-bit integers.
    U32(Vec<u32>),
    /// Unsigned 64-bit integers.
    U64(Vec<u64>),
    /// One text.
    Text(String),
}

impl Checkpoint {
    /// The first column called `name`.
    pub fn column(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|(n, _)| n == name).map(|(_, column)| column)
    }
}

/// Where a checkpoint lies, as listed by [`crate::Recording::checkpoints`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CheckpointInfo {
    /// See [`Checkpoint::frame`].
    pub frame: u64,
    /// See [`Checkpoint::time_s`] (s).
    pub time_s: f64,
}

/// Key of field 15 with wire type 5 (four bytes): one byte.
const CRC_KEY: u8 = (15 << 3) | 5;

/// The message, with its CRC. The columns are copied once on the way.
pub(crate) fn encode(checkpoint: &Checkpoint) -> Vec<u8> {
    let body = CheckpointBody {
        frame: checkpoint.frame,
        time_s: Some(checkpoint.time_s),
        columns: checkpoint
            .columns
            .iter()
            .map(|(name, column)| NamedColumn {
                name: name.clone(),
                values: Some(match column {
                    Column::F64(values) => ColumnValues::F64(DoubleList { values: values.clone() }),
                    Column::U32(values) => {
                        ColumnValues::U32(Fixed32List { values: values.clone() })
                    }
                    Column::U64(values) => {
                        ColumnValues::U64(Fixed64List { values: values.clone() })
                    }
                    Column::Text(text) => ColumnValues::Text(text.clone()),
                }),
            })
            .collect(),
    };
    let mut bytes = body.encode_to_vec();
    let crc = crc32fast::hash(&bytes);
    bytes.push(CRC_KEY);
    bytes.extend(crc.to_le_bytes());
    bytes
}

/// The checkpoint in `bytes`, or what is wrong with them.
pub(crate) fn decode(bytes: &[u8]) -> Result<Checkpoint, String> {
    let Some((body, [CRC_KEY, crc @ ..])) = bytes.split_last_chunk::<5>() else {
        return Err(format!("a checkpoint of {} bytes does not end with its CRC", bytes.len()));
    };
    let (stored, computed) = (u32::from_le_bytes(*crc), crc32fast::hash(body));
    if stored != computed {
        return Err(format!("checkpoint CRC {computed:08x}, but {stored:08x} was written"));
    }
    let body = CheckpointBody::decode(body).map_err(|e| format!("checkpoint: {e}"))?;
    let columns = body
        .columns
        .into_iter()
        .map(|column| {
            let values = match column.values {
                Some(ColumnValues::F64(list)) => Column::F64(list.values),
                Some(ColumnValues::U32(list)) => Column::U32(list.values),
                Some(ColumnValues::U64(list)) => Column::U64(list.values),
                Some(ColumnValues::Text(text)) => Column::Text(text),
                None => return Err(format!("checkpoint column {:?} has no values", column.name)),
            };
            Ok((column.name, values))
        })
        .collect::<Result<_, _>>()?;
    Ok(Checkpoint { frame: body.frame, time_s: body.time_s.unwrap_or_default(), columns })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> Checkpoint {
        Checkpoint {
            frame: 7,
            time_s: -0.0,
            columns: vec![
                ("x".into(), Column::F64(vec![f64::MIN_POSITIVE / 4.0, -0.0, f64::INFINITY])),
                ("empty".into(), Column::F64(vec![])),
                ("faces".into(), Column::U32(vec![0, 1, u32::MAX])),
                ("uid".into(), Column::U64(vec![u64::MAX, 0])),
                ("note".into(), Column::Text("naïve ⟂".into())),
            ],
        }
    }

    #[test]
    fn every_flipped_bit_is_seen() {
        let bytes = encode(&sample());
        assert_eq!(decode(&bytes).unwrap(), sample());
        assert!(decode(&bytes).unwrap().time_s.is_sign_negative());
        for bit in 0..8 * bytes.len() {
            let mut flipped = bytes.clone();
            flipped[bit / 8] ^= 1 << (bit % 8);
            assert!(decode(&flipped).is_err(), "bit {bit}");
        }
        for len in 0..bytes.len() {
            assert!(decode(&bytes[..len]).is_err(), "cut at {len}");
        }
    }

    #[test]
    fn columns_are_found_by_name() {
        assert_eq!(sample().column("uid"), Some(&Column::U64(vec![u64::MAX, 0])));
        assert_eq!(sample().column("v"), None);
    }
}

//! A weld: it has no freedom. The element moves as a part of its carrier, but keeps its name.
//!
//! R and d are those of the carrier;   H has no column

use crate::description::joint::JointWord;
use crate::model::Joint;
use crate::model::resolve::joint::Word;

/// `joint: weld`; an empty list means the same.
pub(crate) const WORD: Word = Word {
    written: JointWord {
        word: "weld",
        has_axes: false,
    },
    joint: |_, _| Joint::Freedoms(Vec::new()),
};

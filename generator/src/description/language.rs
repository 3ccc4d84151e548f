//! The kinds of joints as the language knows them. Whoever reads a text hands them in, so that reading asks for no kind by
//! its name; only the mirror images of lists (`expand/axes.rs`) name theirs.

use super::joint::{JointKey, JointWord};

/// The kinds that a text may name.
#[derive(Debug)]
pub struct Language {
    /// The keys of a joint that stand for degrees of freedom, in the order of the reference page.
    pub joint_keys: &'static [JointKey],
    /// The words for joints that need no keys.
    pub joint_words: &'static [JointWord],
}

impl Language {
    /// True if a joint has axes: for a word with axes, and for everything that is no known word.
    pub fn has_axes(&self, word: Option<&str>) -> bool {
        let mut words = self.joint_words.iter();
        let known = words.find(|known| word == Some(known.word));
        known.is_none_or(|known| known.has_axes)
    }
}

//! The parts of the language that are handed in by whoever reads a text: the kinds of joints and the force laws.
//! Reading asks for no kind by its name; only the mirror images of lists (`expand/axes.rs`) name kinds of joints.

use super::force::LawKeys;
use super::joint::{JointKey, JointWord};
use super::tree::Node;

/// The kinds that a text may name.
#[derive(Debug)]
pub struct Language {
    /// The keys of a joint that stand for freedoms, in the order of the reference page.
    pub joint_keys: &'static [JointKey],
    /// The words for joints that need no keys.
    pub joint_words: &'static [JointWord],
    /// The force laws, in the order of the reference page.
    pub laws: &'static [LawKeys],
}

impl Language {
    /// The law of a force and its name: the first key that says so.
    pub fn law_and_name<'n>(&self, force: &'n Node) -> Option<(&'static LawKeys, &'n str)> {
        let mut laws = self.laws.iter();
        laws.find_map(|law| Some((law, force.word(law.key)?)))
    }

    /// The key of the law of a force, and its name.
    pub fn kind_and_name<'n>(&self, force: &'n Node) -> Option<(&'static str, &'n str)> {
        self.law_and_name(force).map(|(law, name)| (law.key, name))
    }

    /// True if a joint has axes: for a word with axes, and for everything that is no known word.
    pub fn has_axes(&self, word: Option<&str>) -> bool {
        let mut words = self.joint_words.iter();
        let known = words.find(|known| word == Some(known.word));
        known.is_none_or(|known| known.has_axes)
    }
}

//! A ball joint: the element turns about it at will. In the plane it is a hinge about y.

use super::Joint;
use super::written::Word;

/// `joint: ball`, the default.
pub(crate) const WORD: Word = Word {
    word: "ball",
    has_axes: false,
    joint: |resolver, at| {
        if resolver.planar {
            resolver.problems.add(at.problem(
                "in the plane there is no ball joint",
                "write `joint: hinge`, or leave the key out, which means the same",
            ));
        }
        Joint::Ball
    },
};

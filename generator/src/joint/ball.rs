//! A ball joint: the element turns freely about it, and its orientation has coordinates of its own
//! ([`motion::ball`](crate::motion::ball)). In the plane it is a hinge about y.

use crate::description::joint::JointWord;
use crate::model::Joint;
use crate::model::resolve::joint::Word;

/// `joint: ball`, the default.
pub(crate) const WORD: Word = Word {
    written: JointWord {
        word: "ball",
        has_axes: false,
    },
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

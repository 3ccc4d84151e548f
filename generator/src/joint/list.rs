//! A joint of several freedoms, one after the other from the carrier outwards, without mass between them: an
//! ordered list, or a word that stands for one.
//!
//! | written | stands for |
//! |---|---|
//! | `universal: [a, b]` | a hinge about a, then one about b |
//! | `cylinder: a` | a slider along a and a hinge about it |
//! | `planar: n` | sliders along the two other axes of the frame, then a hinge about n |
//! | `translation` | sliders along x, y and z; in the plane along x and z |
//! | `free` | the same sliders, then hinges about x, y and z; in the plane about y |
//!
//! The equations of such a joint treat its freedoms as one block of velocities: D = Hᵀ I H has a row for each
//! of them.

use crate::description::joint::{Axis, Coordinate, JointKey, JointWord};
use crate::description::shape::Key;
use crate::model::resolve::joint::{Direction, Made, Spelling, Word, joint_of_made};
use crate::model::{FreedomKind, Number};

/// Two hinges.
pub(crate) const UNIVERSAL: Spelling = Spelling {
    written: JointKey {
        key: Key::of::<Option<Vec<Axis>>>(
            "universal",
            "",
            "in space: two axes that it turns about, the second after the first",
        ),
        keys: &[],
        handed: &[],
        coordinates: &[Coordinate::Angle, Coordinate::Angle],
    },
    read: |reader| {
        if reader.planar() {
            reader.problem_with_value("in the plane all turns are about y", TWO_AXES);
            return None;
        }
        let axes = reader.several_turning()?;
        if axes.len() != 2 {
            reader.problem_with_value("a universal joint has two axes", TWO_AXES);
            return None;
        }
        let hinges = axes
            .into_iter()
            .map(|axis| Made::new(FreedomKind::HINGE, axis));
        Some(hinges.collect())
    },
};

const TWO_AXES: &str = "in space write two axes: `universal: [x, y]`";

/// A slider and a hinge with the same axis.
pub(crate) const CYLINDER: Spelling = Spelling {
    written: JointKey {
        key: Key::of::<Option<Axis>>(
            "cylinder",
            "",
            "in space: axis that it slides along and turns about",
        ),
        keys: &[],
        handed: &[],
        coordinates: &[Coordinate::Length, Coordinate::Angle],
    },
    read: |reader| {
        if reader.leads_out_of_plane("write `slider: x`, or a list of a slider and a hinge") {
            return None;
        }
        let axis = reader.turning()?;
        Some(vec![
            Made::new(FreedomKind::SLIDER, axis.clone()),
            Made::new(FreedomKind::HINGE, axis),
        ])
    },
};

/// Two sliders in a plane and a hinge about its normal.
pub(crate) const PLANAR: Spelling = Spelling {
    written: JointKey {
        key: Key::of::<Option<Axis>>(
            "planar",
            "",
            "`x`, `y` or `z`: it slides along the two other axes and turns about this one",
        ),
        keys: &[],
        handed: &[],
        coordinates: &[Coordinate::Length, Coordinate::Length, Coordinate::Angle],
    },
    read: |reader| {
        let normal = reader.turning()?;
        let Some(along) = across(&normal.axis) else {
            reader.problem_with_value(
                "the normal of a planar joint is one of the axes x, y, z",
                "write `planar: z`, or a list of two sliders and a hinge, whose axes you choose",
            );
            return None;
        };
        let mut made = sliders(&along);
        made.push(Made::new(FreedomKind::HINGE, normal));
        Some(made)
    },
};

/// A slider along each axis of the frame.
pub(crate) const TRANSLATION: Word = Word {
    written: JointWord {
        word: "translation",
        has_axes: true,
    },
    joint: |resolver, at| {
        let axes: &[usize] = if resolver.planar { &[0, 2] } else { &[0, 1, 2] };
        joint_of_made(resolver, sliders(axes), at)
    },
};

/// A slider along each axis of the frame, then a hinge about each; in the plane two sliders and a hinge.
pub(crate) const FREE: Word = Word {
    written: JointWord {
        word: "free",
        has_axes: true,
    },
    joint: |resolver, at| {
        let (along, about): (&[usize], &[usize]) = match resolver.planar {
            true => (&[0, 2], &[1]),
            false => (&[0, 1, 2], &[0, 1, 2]),
        };
        let mut made = sliders(along);
        made.extend(
            about
                .iter()
                .map(|&axis| Made::new(FreedomKind::HINGE, Direction::along(axis))),
        );
        joint_of_made(resolver, made, at)
    },
};

fn sliders(axes: &[usize]) -> Vec<Made> {
    let slider = |&axis: &usize| Made::new(FreedomKind::SLIDER, Direction::along(axis));
    axes.iter().map(slider).collect()
}

/// The two axes of the frame perpendicular to the given one.
fn across(normal: &[Number; 3]) -> Option<[usize; 2]> {
    let axis = (0..3).find(|&axis| *normal == Direction::along(axis).axis)?;
    Some(match axis {
        0 => [1, 2],
        1 => [0, 2],
        _ => [0, 1],
    })
}

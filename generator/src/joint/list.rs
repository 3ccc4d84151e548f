//! A joint of several degrees of freedom, one after the other from the carrier outwards, without mass between them: an
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
//! The equations of such a joint treat its degrees of freedom as one block of velocities: D = Hᵀ I H has a row for each
//! of them.

use super::hinge::Hinge;
use super::slider::Slider;
use super::written::{Direction, Made, Reader, Spelling, Word, key};
use super::{Coordinate, Freedom, Joint, SPELLINGS, WORDS};
use crate::description::joint::{Axis, Freedom as Written, Joint as WrittenJoint};
use crate::description::place::At;
use crate::description::quantity::{OneOrThree, Quantity};
use crate::diagnostic::quoted;
use crate::model::Number;
use crate::model::resolve::{Resolver, name::Style, quantity::Expected};

/// The largest number of degrees of freedom of one joint: those of a free body.
const MOST: usize = 6;

/// Two hinges.
pub(crate) const UNIVERSAL: Spelling = Spelling {
    key: key::<Vec<Axis>>("universal"),
    keys: &[],
    handed: &[],
    coordinates: &[Coordinate::Angle, Coordinate::Angle],
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
        let hinges = axes.into_iter().map(|axis| Made::new(Hinge, axis));
        Some(hinges.collect())
    },
};

const TWO_AXES: &str = "in space write two axes: `universal: [x, y]`";

/// A slider and a hinge with the same axis.
pub(crate) const CYLINDER: Spelling = Spelling {
    key: key::<Axis>("cylinder"),
    keys: &[],
    handed: &[],
    coordinates: &[Coordinate::Length, Coordinate::Angle],
    read: |reader| {
        if reader.leads_out_of_plane("write `slider: x`, or a list of a slider and a hinge") {
            return None;
        }
        let axis = reader.turning()?;
        Some(vec![
            Made::new(Slider, axis.clone()),
            Made::new(Hinge, axis),
        ])
    },
};

/// Two sliders in a plane and a hinge about its normal.
pub(crate) const PLANAR: Spelling = Spelling {
    key: key::<Axis>("planar"),
    keys: &[],
    handed: &[],
    coordinates: &[Coordinate::Length, Coordinate::Length, Coordinate::Angle],
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
        made.push(Made::new(Hinge, normal));
        Some(made)
    },
};

/// A slider along each axis of the frame.
pub(crate) const TRANSLATION: Word = Word {
    word: "translation",
    has_axes: true,
    joint: |resolver, at| {
        let axes: &[usize] = if resolver.planar { &[0, 2] } else { &[0, 1, 2] };
        let list = sliders(axes).into_iter().map(Listed::plain).collect();
        named(resolver, list, at)
    },
};

/// A slider along each axis of the frame, then a hinge about each; in the plane two sliders and a hinge.
pub(crate) const FREE: Word = Word {
    word: "free",
    has_axes: true,
    joint: |resolver, at| {
        let (along, about): (&[usize], &[usize]) = match resolver.planar {
            true => (&[0, 2], &[1]),
            false => (&[0, 1, 2], &[0, 1, 2]),
        };
        let mut made = sliders(along);
        made.extend(
            about
                .iter()
                .map(|&axis| Made::new(Hinge, Direction::along(axis))),
        );
        named(resolver, made.into_iter().map(Listed::plain).collect(), at)
    },
};

fn sliders(axes: &[usize]) -> Vec<Made> {
    let slider = |&axis: &usize| Made::new(Slider, Direction::along(axis));
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

/// A degree of freedom with its keys in the list.
struct Listed<'w> {
    made: Made,
    name: Option<&'w str>,
    zero: Number,
    armature: Number,
}

impl Listed<'_> {
    fn plain(made: Made) -> Self {
        Listed {
            made,
            name: None,
            zero: Number::ZERO,
            armature: Number::ZERO,
        }
    }
}

/// The joint of an element, from its written form.
pub(crate) fn joint_of(
    resolver: &Resolver<'_>,
    written: Option<&WrittenJoint>,
    at: At<'_>,
) -> Joint {
    let Some(written) = written else {
        return Joint::Ball;
    };
    if let WrittenJoint::Word(word) = written {
        let known = WORDS.iter().find(|known| known.word == word);
        return known.map_or(Joint::Ball, |known| (known.joint)(resolver, at));
    }
    let each = written.each(at).into_iter();
    let listed = each
        .flat_map(|(one, at)| listed(resolver, one, at))
        .collect();
    named(resolver, listed, at)
}

/// The degrees of freedom for which one written joint stands.
fn listed<'w>(resolver: &Resolver<'_>, written: &'w Written, at: At<'w>) -> Vec<Listed<'w>> {
    let there = written.spellings();
    let [spelling] = there[..] else {
        not_one_kind(resolver, &there, at);
        return Vec::new();
    };
    check_keys(resolver, written, spelling, at);
    let number = |value: Option<&Quantity>, key, expected: fn(Coordinate) -> Expected| {
        match (value, spelling.coordinates) {
            (Some(value), [one]) => resolver.number(value, at.key(key), expected(*one)),
            // a joint of several degrees of freedom refuses this key
            _ => Number::ZERO,
        }
    };
    let zero = number(written.zero.as_ref(), "zero", Coordinate::value);
    let armature = number(written.armature.as_ref(), "armature", Coordinate::inertia);
    let made = (spelling.read)(&Reader::new(resolver, written, spelling, at));
    let listed = |made| Listed {
        made,
        name: written.name.as_deref(),
        zero: zero.clone(),
        armature: armature.clone(),
    };
    made.into_iter().flatten().map(listed).collect()
}

/// Reports a joint that has no kind, or more than one.
fn not_one_kind(resolver: &Resolver<'_>, there: &[&Spelling], at: At<'_>) {
    let quote = |spelling: &Spelling| format!("`{}`", spelling.key.name);
    let all: Vec<String> = SPELLINGS.iter().map(quote).collect();
    let there: Vec<&str> = there.iter().map(|spelling| spelling.key.name).collect();
    resolver.problems.add(at.problem(
        match there.is_empty() {
            true => "this does not say which joint it is".to_owned(),
            false => format!("a joint cannot be {} at once", there.join(" and ")),
        },
        format!(
            "give one of {}; a list has several joints: `[{{ hinge: z }}, {{ hinge: y }}]`",
            all.join(", ")
        ),
    ));
}

/// Reports keys that do not belong to the kind of a joint.
fn check_keys(resolver: &Resolver<'_>, written: &Written, spelling: &Spelling, at: At<'_>) {
    let kind = spelling.key.name;
    for other in SPELLINGS.iter().filter(|other| other.key.name != kind) {
        for key in other.keys.iter().map(|key| key.name) {
            if written.has(key) {
                resolver.problems.add(at.key(key).key_problem(
                    format!("a {kind} has no {key}"),
                    format!("remove the key, or write `{}:`", other.key.name),
                ));
            }
        }
    }
    if spelling.coordinates.len() == 1 {
        return;
    }
    for (key, is_there) in [
        ("zero", written.zero.is_some()),
        ("name", written.name.is_some()),
        ("armature", written.armature.is_some()),
        ("follows", written.follows.is_some()),
    ] {
        if is_there {
            resolver.problems.add(at.key(key).key_problem(
                format!("a {kind} has several freedoms, and `{key}` does not say which"),
                "write them as a list: `[{ hinge: x, name: … }, { hinge: y }]`",
            ));
        }
    }
}

/// The degrees of freedom with their names. A name that is not given is made from the kind, and in a list also from the
/// axis.
fn named(resolver: &Resolver<'_>, listed: Vec<Listed<'_>>, at: At<'_>) -> Joint {
    if listed.len() > MOST {
        resolver.problems.add(at.problem(
            format!(
                "a joint of {} freedoms has more than a body can have",
                listed.len()
            ),
            "six are enough: three sliders and three hinges",
        ));
    }
    let single = listed.len() == 1;
    let mut freedoms: Vec<Freedom> = Vec::new();
    for one in listed {
        let Made { kind, direction } = one.made;
        let coordinate = kind.coordinate().name();
        let name = match (one.name, direction.word) {
            (Some(name), _) => {
                resolver.check_name(name, "a freedom", Style::Either, at);
                name.to_owned()
            }
            (None, Some(word)) if !single => format!("{coordinate}-{word}"),
            (None, _) => coordinate.to_owned(),
        };
        if freedoms.iter().any(|other| other.name == name) {
            resolver.problems.add(at.problem(
                format!("two freedoms of this joint are called {}", quoted(&name)),
                "give each a name of its own: `{ hinge: [0, 1, 1], name: flexion }`",
            ));
        }
        freedoms.push(Freedom {
            name,
            kind,
            axis: direction.axis,
            zero: one.zero,
            position: Number::ZERO,
            rate: Number::ZERO,
            armature: one.armature,
            follows: None,
        });
    }
    Joint::Freedoms(freedoms)
}

/// Coordinates or rates at the start of the degrees of freedom of a joint, as one value or a list.
pub(crate) fn freedoms_at_start(
    resolver: &Resolver<'_>,
    (path, freedoms): (&str, &mut [Freedom]),
    written: &OneOrThree,
    rates: bool,
    at: At<'_>,
) {
    let values: Vec<(&Quantity, At<'_>)> = match written {
        OneOrThree::One(one) => vec![(one, at)],
        OneOrThree::List(list) => {
            let items = list.iter().enumerate();
            items.map(|(i, one)| (one, at.item(i))).collect()
        }
    };
    let following = freedoms.iter().any(|f| !f.is_own());
    let freedoms: Vec<&mut Freedom> = freedoms.iter_mut().filter(|f| f.is_own()).collect();
    if freedoms.len() != values.len() {
        let names: Vec<&str> = freedoms.iter().map(|f| f.name.as_str()).collect();
        resolver.problems.add(at.problem(
            format!(
                "the joint of {} has {} freedoms{}, but here stand {} values",
                quoted(path),
                freedoms.len(),
                if following { " that follow no other" } else { "" },
                values.len()
            ),
            match names.is_empty() {
                true if following => "remove the line: where it starts follows from the other joint".to_owned(),
                true => "remove the line: a weld or a joint without freedoms of its own has no coordinate; on a ball joint, give `angles`".to_owned(),
                false => format!("give one value for each: {}", names.join(", ")),
            },
        ));
        return;
    }
    for (freedom, (value, at)) in freedoms.into_iter().zip(values) {
        let coordinate = freedom.kind.coordinate();
        match rates {
            true => freedom.rate = resolver.number(value, at, coordinate.rate()),
            false => freedom.position = resolver.number(value, at, coordinate.value()),
        }
    }
}

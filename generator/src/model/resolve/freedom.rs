//! The joints of elements: which freedoms they have, along and about which axes, and where these start.

use super::quantity::{ANGLE, Expected, INERTIA, LENGTH, MASS, PURE, RATE, SPEED};
use super::{AXES, NOWHERE, Resolver, name::Style};
use crate::description::joint::{Axis, Freedom as Written, Joint as WrittenJoint};
use crate::description::place::At;
use crate::description::quantity::{OneOrThree, Quantity};
use crate::diagnostic::quoted;
use crate::model::{Freedom, FreedomKind, Joint, Number};
use std::f64::consts::TAU;

/// Most freedoms of one joint: those of a body.
const MOST: usize = 6;

impl Resolver<'_> {
    /// The joint of an element; `is_root` where nothing but the reference joint carries it.
    pub fn joint_of(&self, written: Option<&WrittenJoint>, at: At<'_>) -> Joint {
        let word = match written {
            None => return Joint::Ball,
            Some(WrittenJoint::Word(word)) => word.as_str(),
            Some(WrittenJoint::One(one)) => {
                let mut freedoms = Vec::new();
                self.freedoms(one, at, &mut freedoms);
                return self.named(freedoms, at);
            }
            Some(WrittenJoint::List(list)) => {
                let mut freedoms = Vec::new();
                for (index, one) in list.iter().enumerate() {
                    self.freedoms(one, at.item(index), &mut freedoms);
                }
                return self.named(freedoms, at);
            }
        };
        match word {
            "ball" if self.planar => {
                self.problems.add(at.problem(
                    "in the plane there is no ball joint",
                    "write `joint: hinge`, or leave the key out, which means the same",
                ));
                Joint::Ball
            }
            "hinge" if !self.planar => {
                self.problems.add(at.problem(
                    "in space a hinge needs an axis",
                    "write `joint: { hinge: y }`, with the axis in the frame of the carrier",
                ));
                Joint::Ball
            }
            "weld" => Joint::Freedoms(Vec::new()),
            "translation" => self.named(self.sliders(), at),
            "free" => {
                let mut all = self.sliders();
                let axes: &[usize] = if self.planar { &[1] } else { &[0, 1, 2] };
                let hinges = axes
                    .iter()
                    .map(|&axis| Made::along(axis, FreedomKind::Hinge));
                all.extend(hinges);
                self.named(all, at)
            }
            _ => Joint::Ball,
        }
    }

    /// Sliders along all axes.
    fn sliders(&self) -> Vec<Made<'static>> {
        let axes: &[usize] = if self.planar { &[0, 2] } else { &[0, 1, 2] };
        let sliders = axes
            .iter()
            .map(|&axis| Made::along(axis, FreedomKind::Slider));
        sliders.collect()
    }

    /// The freedoms of one joint as written.
    fn freedoms<'w>(&self, written: &'w Written, at: At<'w>, made: &mut Vec<Made<'w>>) {
        let Written {
            name,
            hinge,
            slider,
            screw,
            universal,
            cylinder,
            planar,
            pitch,
            zero,
            armature,
            follows,
        } = written;
        let kinds = [
            ("hinge", hinge.is_some()),
            ("slider", slider.is_some()),
            ("screw", screw.is_some()),
            ("universal", universal.is_some()),
            ("cylinder", cylinder.is_some()),
            ("planar", planar.is_some()),
        ];
        let there: Vec<&str> = kinds.iter().filter(|k| k.1).map(|k| k.0).collect();
        let [kind] = there[..] else {
            self.problems.add(at.problem(
                match there.is_empty() {
                    true => "this does not say which joint it is".to_owned(),
                    false => format!("a joint cannot be {} at once", there.join(" and ")),
                },
                "give one of `hinge`, `slider`, `screw`, `universal`, `cylinder`, `planar`; a list has several joints: `[{ hinge: z }, { hinge: y }]`",
            ));
            return;
        };
        if pitch.is_some() && kind != "screw" {
            self.problems.add(at.key("pitch").key_problem(
                format!("a {kind} has no pitch"),
                "remove the key, or write `screw:`",
            ));
        }
        let several = matches!(kind, "universal" | "cylinder" | "planar");
        for (key, is_there) in [
            ("zero", zero.is_some()),
            ("name", name.is_some()),
            ("armature", armature.is_some()),
            ("follows", follows.is_some()),
        ] {
            if several && is_there {
                self.problems.add(at.key(key).key_problem(
                    format!("a {kind} has several freedoms, and `{key}` does not say which"),
                    "write them as a list: `[{ hinge: x, name: … }, { hinge: y }]`",
                ));
            }
        }
        let place = at.key(kind);
        let expected = if kind == "slider" { LENGTH } else { ANGLE };
        let zero = match zero {
            Some(zero) => self.number(zero, at.key("zero"), expected),
            None => Number::ZERO,
        };
        let inertia = if kind == "slider" { MASS } else { INERTIA };
        let armature = match armature {
            Some(armature) => self.number(armature, at.key("armature"), inertia),
            None => Number::ZERO,
        };
        let mut one = |kind: FreedomKind, axis: ([Number; 3], Option<&'w str>)| {
            made.push(Made {
                armature: armature.clone(),
                name: name.as_deref(),
                kind,
                axis: axis.0,
                word: axis.1,
                zero: zero.clone(),
            });
        };
        if let Some(axis) = hinge {
            one(FreedomKind::Hinge, self.turning(axis, place));
        }
        if let Some(axis) = slider {
            one(FreedomKind::Slider, self.sliding(axis, place));
        }
        if let Some(axis) = screw {
            if self.planar {
                self.problems.add(at.key("screw").key_problem(
                    "a screw leads out of the plane",
                    "write `hinge: y`, or give the model `dimension: 3`",
                ));
                return;
            }
            let Some(pitch) = pitch else {
                self.problems.add(at.problem(
                    "a screw needs its pitch, the length of one turn",
                    "add `pitch: 5 mm`; negative is left-handed",
                ));
                return;
            };
            let advance = self.number(pitch, at.key("pitch"), LENGTH);
            let advance = Number::quotient(advance, TAU.into());
            one(FreedomKind::Screw(advance), self.turning(axis, place));
        }
        if let Some(axes) = universal {
            if self.planar || axes.len() != 2 {
                self.problems.add(place.problem(
                    match self.planar {
                        true => "in the plane all turns are about y",
                        false => "a universal joint has two axes",
                    },
                    "in space write two axes: `universal: [x, y]`",
                ));
                return;
            }
            for (index, axis) in axes.iter().enumerate() {
                one(FreedomKind::Hinge, self.turning(axis, place.item(index)));
            }
        }
        if let Some(axis) = cylinder {
            if self.planar {
                self.problems.add(at.key("cylinder").key_problem(
                    "a cylinder leads out of the plane",
                    "write `slider: x`, or a list of a slider and a hinge",
                ));
                return;
            }
            let axis = self.turning(axis, place);
            one(FreedomKind::Slider, axis.clone());
            one(FreedomKind::Hinge, axis);
        }
        if let Some(normal) = planar {
            let normal = self.turning(normal, place);
            let Some(along) = across(&normal.0) else {
                self.problems.add(place.problem(
                    "the normal of a planar joint is one of the axes x, y, z",
                    "write `planar: z`, or a list of two sliders and a hinge, whose axes you choose",
                ));
                return;
            };
            for axis in along {
                let word = ["x", "y", "z"][axis];
                one(FreedomKind::Slider, (unit(axis), Some(word)));
            }
            one(FreedomKind::Hinge, normal);
        }
    }

    /// An axis of rotation: in the plane along y.
    fn turning<'w>(&self, axis: &'w Axis, at: At<'_>) -> ([Number; 3], Option<&'w str>) {
        match axis {
            Axis::Vector(_) if self.planar => {
                self.problems
                    .add(at.problem("in the plane all turns are about y", "write `hinge: y`"));
                (unit(1), None)
            }
            Axis::Word(word) if self.planar && !word.ends_with('y') => {
                self.problems.add(at.problem(
                    format!("in the plane nothing turns about {word}"),
                    "write `hinge: y`",
                ));
                (unit(1), None)
            }
            axis => self.axis_of_joint(axis, at),
        }
    }

    /// An axis of translation: in the plane not y.
    fn sliding<'w>(&self, axis: &'w Axis, at: At<'_>) -> ([Number; 3], Option<&'w str>) {
        if let (Axis::Word(word), true) = (axis, self.planar)
            && word.ends_with('y')
        {
            self.problems.add(at.problem(
                "in the plane nothing slides along y",
                "write `slider: x`, `slider: z`, or a direction `[x, z]`",
            ));
        }
        self.axis_of_joint(axis, at)
    }

    fn axis_of_joint<'w>(&self, axis: &'w Axis, at: At<'_>) -> ([Number; 3], Option<&'w str>) {
        match axis {
            Axis::Word(word) => {
                let name = word.trim_start_matches('-');
                let index = AXES.iter().position(|w| *w == name).unwrap_or_default();
                let mut axis = unit(index);
                if name != word {
                    axis[index] = Number::Constant(-1.0);
                }
                (axis, Some(name))
            }
            Axis::Vector(written) => {
                let before = self.problems.count();
                let vector = self.vector(written, at, PURE);
                if self.problems.count() > before {
                    return (unit(0), None);
                }
                let squares = vector.iter().map(|n| n.value(&self.defaults).powi(2));
                if squares.sum::<f64>() <= 0.0 {
                    self.problems.add(at.problem(
                        format!(
                            "the axis has no direction{}",
                            match vector.iter().all(|n| n.constant().is_some()) {
                                true => "",
                                false => " at the default parameters",
                            }
                        ),
                        "give at least one component that is not 0, or write `x`, `y` or `z`",
                    ));
                    return (unit(0), None);
                }
                (self.unit(vector), None)
            }
        }
    }

    /// The freedoms with their names: as given, else by what they do, and in a list by their axes too.
    fn named(&self, made: Vec<Made<'_>>, at: At<'_>) -> Joint {
        if made.len() > MOST {
            self.problems.add(at.problem(
                format!(
                    "a joint of {} freedoms has more than a body can have",
                    made.len()
                ),
                "six are enough: three sliders and three hinges",
            ));
        }
        let single = made.len() == 1;
        let mut freedoms: Vec<Freedom> = Vec::new();
        for one in made {
            let kind = if one.kind.turns() {
                "angle"
            } else {
                "position"
            };
            let name = match (one.name, one.word) {
                (Some(name), _) => {
                    self.check_name(name, "a freedom", Style::Either, at);
                    name.to_owned()
                }
                (None, Some(word)) if !single => format!("{kind}-{word}"),
                (None, _) => kind.to_owned(),
            };
            if freedoms.iter().any(|other| other.name == name) {
                self.problems.add(at.problem(
                    format!("two freedoms of this joint are called {}", quoted(&name)),
                    "give each a name of its own: `{ hinge: [0, 1, 1], name: flexion }`",
                ));
            }
            freedoms.push(Freedom {
                name,
                kind: one.kind,
                axis: one.axis,
                zero: one.zero,
                position: Number::ZERO,
                rate: Number::ZERO,
                armature: one.armature,
                follows: None,
            });
        }
        Joint::Freedoms(freedoms)
    }

    /// Coordinates or rates of the freedoms of a joint at the start, one or a list.
    pub fn freedoms_at_start(
        &self,
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
            self.problems.add(at.problem(
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
            let expected: Expected = match (freedom.kind.turns(), rates) {
                (true, false) => ANGLE,
                (true, true) => RATE,
                (false, false) => LENGTH,
                (false, true) => SPEED,
            };
            let number = self.number(value, at, expected);
            match rates {
                true => freedom.rate = number,
                false => freedom.position = number,
            }
        }
    }
}

/// A freedom before it has a name.
struct Made<'w> {
    name: Option<&'w str>,
    kind: FreedomKind,
    axis: [Number; 3],
    /// The word for its axis.
    word: Option<&'w str>,
    zero: Number,
    armature: Number,
}

impl Made<'static> {
    /// A freedom along or about one of the frame's own axes.
    fn along(axis: usize, kind: FreedomKind) -> Self {
        Made {
            name: None,
            kind,
            axis: unit(axis),
            word: Some(AXES[axis]),
            zero: Number::ZERO,
            armature: Number::ZERO,
        }
    }
}

fn unit(axis: usize) -> [Number; 3] {
    let mut vector = NOWHERE;
    vector[axis] = Number::Constant(1.0);
    vector
}

/// The two axes across one of the frame's own.
fn across(normal: &[Number; 3]) -> Option<[usize; 2]> {
    let axis = (0..3).find(|&axis| *normal == unit(axis))?;
    Some(match axis {
        0 => [1, 2],
        1 => [0, 2],
        _ => [0, 1],
    })
}

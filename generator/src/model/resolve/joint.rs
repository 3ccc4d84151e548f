//! The joint of an element, from its written form: a word, or keys below `joint`. What stands for which freedoms
//! is said by the files of [kinds](crate::joint).

use super::name::Style;
use super::{NOWHERE, Resolver, unit};
use crate::description::joint::{
    Axis, Freedom as Written, Joint as WrittenJoint, JointKey, JointWord,
};
use crate::description::measure::Expected;
use crate::description::place::At;
use crate::description::quantity::{Number as WrittenNumber, OneOrThree, Quantity};
use crate::description::shape::Shape;
use crate::diagnostic::{nearest, quoted};
use crate::model::{Coordinate, FreedomKind, Number};
use crate::model::{Freedom, Joint};

/// The largest number of freedoms of one joint: those of a free body.
const MOST: usize = 6;

/// A key of a joint that stands for freedoms, and how they are read.
pub(crate) struct Spelling {
    /// The key as written.
    pub written: JointKey,
    /// Reads these freedoms; `None` after a reported problem.
    pub read: fn(&Reader<'_>) -> Option<Vec<Made>>,
}

/// A word for a joint that needs no keys, and what it stands for.
pub(crate) struct Word {
    /// The word as written.
    pub written: JointWord,
    /// Makes the joint for which the word stands.
    pub joint: fn(&Resolver<'_>, At<'_>) -> Joint,
}

/// A freedom that has no name yet.
pub(crate) struct Made {
    /// The kind of motion.
    pub kind: FreedomKind,
    /// Its axis.
    pub direction: Direction,
}

impl Made {
    /// A freedom of this kind about or along a direction.
    pub fn new(kind: FreedomKind, direction: Direction) -> Self {
        Made { kind, direction }
    }
}

/// A unit vector in the frame of the carrier, with the name of the axis if it is an axis of the frame.
#[derive(Clone)]
pub(crate) struct Direction {
    /// The components.
    pub axis: [Number; 3],
    /// The name of the axis, `x`, `y` or `z`; `None` for other directions.
    pub word: Option<&'static str>,
}

impl Direction {
    /// An axis of the frame: 0, 1, 2 for x, y, z.
    pub fn along(axis: usize) -> Self {
        Direction {
            word: Some(["x", "y", "z"][axis]),
            ..Direction::unnamed(axis)
        }
    }

    /// The opposite direction along an axis of the frame, with the same word.
    fn opposite(mut self) -> Self {
        for component in &mut self.axis {
            if *component == Number::Constant(1.0) {
                *component = Number::Constant(-1.0);
            }
        }
        self
    }

    fn unnamed(axis: usize) -> Self {
        let mut vector = NOWHERE;
        vector[axis] = Number::Constant(1.0);
        Direction {
            axis: vector,
            word: None,
        }
    }
}

/// One written joint while it is read.
pub(crate) struct Reader<'r> {
    resolver: &'r Resolver<'r>,
    written: &'r Written,
    spelling: &'r Spelling,
    at: At<'r>,
}

impl<'r> Reader<'r> {
    /// A reader for a joint that is written this way.
    pub fn new(
        resolver: &'r Resolver<'r>,
        written: &'r Written,
        spelling: &'r Spelling,
        at: At<'r>,
    ) -> Self {
        Reader {
            resolver,
            written,
            spelling,
            at,
        }
    }

    /// Whether the model is planar.
    pub fn planar(&self) -> bool {
        self.resolver.planar
    }

    /// Reports a problem with the joint.
    pub fn problem(&self, message: &str, help: &str) {
        self.resolver.problems.add(self.at.problem(message, help));
    }

    /// Reports a problem with the value of the key of the joint.
    pub fn problem_with_value(&self, message: &str, help: &str) {
        self.resolver
            .problems
            .add(self.place().problem(message, help));
    }

    /// True if the model is planar, where this joint would lead out of the plane; reports this.
    pub fn leads_out_of_plane(&self, help: &str) -> bool {
        if self.planar() {
            let message = format!(
                "a {} leads out of the plane",
                self.spelling.written.key.name
            );
            self.resolver
                .problems
                .add(self.place().key_problem(message, help));
        }
        self.planar()
    }

    /// The axis in the value of the key, for a rotation: in the plane y.
    pub fn turning(&self) -> Option<Direction> {
        let axis = self.value(self.spelling.written.key.name)?;
        Some(self.turning_about(&axis, self.place()))
    }

    /// The axes in the value of the key, for rotations.
    pub fn several_turning(&self) -> Option<Vec<Direction>> {
        let axes: Vec<Axis> = self.value(self.spelling.written.key.name)?;
        let each = axes.iter().enumerate();
        let turning = |(i, axis): (usize, &Axis)| self.turning_about(axis, self.place().item(i));
        Some(each.map(turning).collect())
    }

    /// The axis in the value of the key, for a translation: in the plane not y.
    pub fn sliding(&self) -> Option<Direction> {
        let axis: Axis = self.value(self.spelling.written.key.name)?;
        if let (Axis::Word(word), true) = (&axis, self.planar())
            && word.ends_with('y')
        {
            self.problem_with_value(
                "in the plane nothing slides along y",
                "write `slider: x`, `slider: z`, or a direction `[x, z]`",
            );
        }
        Some(self.direction(&axis, self.place()))
    }

    /// The number in the value of a key.
    pub fn number(&self, key: &str, expected: Expected) -> Option<Number> {
        let quantity: Quantity = self.value(key)?;
        Some(
            self.resolver
                .number_in(&quantity, self.at.key(key), expected),
        )
    }

    /// The place of the value of the key.
    fn place(&self) -> At<'r> {
        self.at.key(self.spelling.written.key.name)
    }

    /// The value of a key; `None` if the key is missing.
    fn value<T: Shape>(&self, key: &str) -> Option<T> {
        match self.written.value(key)? {
            Ok(value) => Some(value),
            Err(error) => {
                let place = self.at.key(key);
                let help = "see the reference of the language";
                self.resolver.problems.add(place.problem(error, help));
                None
            }
        }
    }

    fn turning_about(&self, axis: &Axis, at: At<'_>) -> Direction {
        let message = match axis {
            Axis::Vector(_) if self.planar() => "in the plane all turns are about y".to_owned(),
            Axis::Word(word) if self.planar() && !word.ends_with('y') => {
                format!("in the plane nothing turns about {word}")
            }
            axis => return self.direction(axis, at),
        };
        self.resolver
            .problems
            .add(at.problem(message, "write `hinge: y`"));
        Direction::unnamed(1)
    }

    fn direction(&self, axis: &Axis, at: At<'_>) -> Direction {
        let resolver = self.resolver;
        let written = match axis {
            Axis::Word(word) => {
                let name = word.trim_start_matches('-');
                let index = ["x", "y", "z"].iter().position(|w| *w == name);
                let direction = Direction::along(index.unwrap_or_default());
                return match name == word {
                    true => direction,
                    false => direction.opposite(),
                };
            }
            Axis::Vector(written) => written,
        };
        let before = resolver.problems.count();
        let vector = resolver.vector(written, at);
        if resolver.problems.count() > before {
            return Direction::unnamed(0);
        }
        if vector.iter().all(|n| n.value(&resolver.defaults) == 0.0) {
            let constant = vector.iter().all(|n| n.constant().is_some());
            let when = match constant {
                true => "",
                false => " at the default parameters",
            };
            resolver.problems.add(at.problem(
                format!("the axis has no direction{when}"),
                "give at least one component that is not 0, or write `x`, `y` or `z`",
            ));
            return Direction::unnamed(0);
        }
        // scales a vector whose squares would overflow or lose their digits
        let largest = vector.iter().map(|n| n.value(&resolver.defaults).abs());
        let largest = largest.fold(0.0, f64::max);
        let vector = match (1e-100..1e100).contains(&largest) {
            true => vector,
            false => vector.map(|n| Number::quotient(n, Number::Constant(largest))),
        };
        Direction {
            axis: unit(resolver, vector),
            word: None,
        }
    }
}

/// A freedom with its keys in the list.
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
        let known = resolver
            .kinds
            .words
            .iter()
            .find(|known| known.written.word == word);
        return known.map_or(Joint::Ball, |known| (known.joint)(resolver, at));
    }
    let each = written.each(at).into_iter();
    let listed = each
        .flat_map(|(one, at)| listed(resolver, one, at))
        .collect();
    named(resolver, listed, at)
}

/// The spellings whose keys a joint has: one if the joint is right.
pub(crate) fn spellings(resolver: &Resolver<'_>, written: &Written) -> Vec<&'static Spelling> {
    let spellings = resolver.kinds.spellings.iter();
    let there = |spelling: &&Spelling| written.has(spelling.written.key.name);
    spellings.filter(there).collect()
}

/// The joint with these freedoms, which have no keys of their own.
pub(crate) fn joint_of_made(resolver: &Resolver<'_>, made: Vec<Made>, at: At<'_>) -> Joint {
    named(resolver, made.into_iter().map(Listed::plain).collect(), at)
}

/// The freedoms for which one written joint stands.
fn listed<'w>(resolver: &Resolver<'_>, written: &'w Written, at: At<'w>) -> Vec<Listed<'w>> {
    let there = spellings(resolver, written);
    let [spelling] = there[..] else {
        not_one_kind(resolver, &there, at);
        return Vec::new();
    };
    check_keys(resolver, written, spelling, at);
    let number = |value: Option<&Quantity>, key, expected: fn(Coordinate) -> Expected| {
        match (value, spelling.written.coordinates) {
            (Some(value), [one]) => resolver.number_in(value, at.key(key), expected(*one)),
            // a joint of several freedoms refuses this key
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
    let quote = |spelling: &Spelling| format!("`{}`", spelling.written.key.name);
    let all: Vec<String> = resolver.kinds.spellings.iter().map(quote).collect();
    let there: Vec<&str> = there
        .iter()
        .map(|spelling| spelling.written.key.name)
        .collect();
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
    let kind = spelling.written.key.name;
    for other in resolver
        .kinds
        .spellings
        .iter()
        .filter(|other| other.written.key.name != kind)
    {
        for key in other.written.keys.iter().map(|key| key.name) {
            if written.has(key) {
                resolver.problems.add(at.key(key).key_problem(
                    format!("a {kind} has no {key}"),
                    format!("remove the key, or write `{}:`", other.written.key.name),
                ));
            }
        }
    }
    if spelling.written.coordinates.len() == 1 {
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

/// The freedoms with their names. A name that is not given is made from the kind, and in a list also from the
/// axis.
fn named(resolver: &Resolver<'_>, listed: Vec<Listed<'_>>, at: At<'_>) -> Joint {
    if listed.len() > MOST {
        resolver.problems.add(at.problem(
            format!(
                "a joint of {} freedoms has more than an element can have",
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

/// Coordinates or rates at the start of the freedoms of a joint, as one value or a list.
pub(crate) fn freedoms_at_start<U>(
    resolver: &Resolver<'_>,
    (path, freedoms): (&str, &mut [Freedom]),
    written: &OneOrThree<WrittenNumber<U>>,
    rates: bool,
    at: At<'_>,
) {
    let values = written.each(at);
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
            true => freedom.rate = resolver.number_in(value, at, coordinate.rate()),
            false => freedom.position = resolver.number_in(value, at, coordinate.value()),
        }
    }
}

/// The freedom of a joint that a name refers to.
pub(crate) fn freedom_named(
    resolver: &Resolver<'_>,
    name: Option<&str>,
    path: &str,
    freedoms: &[Freedom],
    at: At<'_>,
) -> Option<usize> {
    let names = || freedoms.iter().map(|f| f.name.as_str());
    let all = names()
        .map(|n| format!("`{n}`"))
        .collect::<Vec<_>>()
        .join(", ");
    match (name, freedoms) {
        (_, []) => {
            resolver.problems.add(at.problem(
                format!("{} is welded: its joint has no freedom", quoted(path)),
                "remove this, or give the element another `joint:`",
            ));
            None
        }
        (None, [_]) => Some(0),
        (None, _) => {
            resolver.problems.add(at.problem(
                format!(
                    "the joint of {} has several freedoms, and it is not said which is meant",
                    quoted(path)
                ),
                format!("add `freedom:` with one of {all}"),
            ));
            None
        }
        (Some(name), _) => {
            let found = freedoms.iter().position(|f| f.name == name);
            if found.is_none() {
                resolver.problems.add(at.key("freedom").problem(
                    format!(
                        "the joint of {} has no freedom {}",
                        quoted(path),
                        quoted(name)
                    ),
                    match nearest(name, names()) {
                        Some(near) => format!("did you mean `{near}`? There are {all}"),
                        None => format!("there are {all}"),
                    },
                ));
            }
            found
        }
    }
}

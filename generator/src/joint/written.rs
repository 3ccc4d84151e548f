//! The written form of joints: a word, or keys below `joint`. Each key stands for degrees of freedom that have a file
//! in this folder.

use super::{Coordinate, FreedomKind, Joint, SPELLINGS, WORDS};
use crate::description::joint::{Axis, Freedom as Written};
use crate::description::place::At;
use crate::description::quantity::Quantity;
use crate::description::shape::{Key, Shape};
use crate::law::contact::plane::unit;
use crate::model::Number;
use crate::model::resolve::quantity::{Expected, PURE};
use crate::model::resolve::{NOWHERE, Resolver};

/// A key of a joint that stands for degrees of freedom.
pub(crate) struct Spelling {
    /// The key. Its value is one axis, or several.
    pub key: Key,
    /// Further keys that only this spelling has.
    pub keys: &'static [Key],
    /// Further keys whose numbers determine whether the joint is left- or right-handed: in a mirror image they change
    /// sign.
    pub handed: &'static [&'static str],
    /// The coordinates of the degrees of freedom for which the key stands, from the carrier outwards.
    pub coordinates: &'static [Coordinate],
    /// Reads these degrees of freedom; `None` after a reported problem.
    pub read: fn(&Reader<'_>) -> Option<Vec<Made>>,
}

/// A word for a joint that needs no keys.
pub(crate) struct Word {
    /// The word itself.
    pub word: &'static str,
    /// True if the joint has axes, which a mirror image would reverse.
    pub has_axes: bool,
    /// Makes the joint for which the word stands.
    pub joint: fn(&Resolver<'_>, At<'_>) -> Joint,
}

/// An optional key of a joint.
pub(crate) const fn key<T: Shape>(name: &'static str) -> Key {
    Key {
        name,
        optional: true,
        check: T::check,
    }
}

/// True if a joint has axes: for a word with axes, and for everything that is no known word.
pub(crate) fn has_axes(word: Option<&str>) -> bool {
    let known = WORDS.iter().find(|known| word == Some(known.word));
    known.is_none_or(|known| known.has_axes)
}

/// The keys of all spellings: first those that stand for degrees of freedom, then those that belong to them.
pub(crate) const KEYS: [Key; count()] = keys();

const fn count() -> usize {
    let (mut count, mut i) = (SPELLINGS.len(), 0);
    while i < SPELLINGS.len() {
        count += SPELLINGS[i].keys.len();
        i += 1;
    }
    count
}

const fn keys() -> [Key; count()] {
    let mut keys = [SPELLINGS[0].key; count()];
    let mut i = 0;
    let mut next = SPELLINGS.len();
    while i < SPELLINGS.len() {
        keys[i] = SPELLINGS[i].key;
        let mut j = 0;
        while j < SPELLINGS[i].keys.len() {
            keys[next] = SPELLINGS[i].keys[j];
            next += 1;
            j += 1;
        }
        i += 1;
    }
    keys
}

/// A degree of freedom that has no name yet.
pub(crate) struct Made {
    /// The kind of motion.
    pub kind: FreedomKind,
    /// Its axis.
    pub direction: Direction,
}

impl Made {
    /// A degree of freedom of this kind about or along a direction.
    pub fn new(kind: impl Into<FreedomKind>, direction: Direction) -> Self {
        Made {
            kind: kind.into(),
            direction,
        }
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
            let message = format!("a {} leads out of the plane", self.spelling.key.name);
            self.resolver
                .problems
                .add(self.place().key_problem(message, help));
        }
        self.planar()
    }

    /// The axis in the value of the key, for a rotation: in the plane y.
    pub fn turning(&self) -> Option<Direction> {
        let axis = self.value(self.spelling.key.name)?;
        Some(self.turning_about(&axis, self.place()))
    }

    /// The axes in the value of the key, for rotations.
    pub fn several_turning(&self) -> Option<Vec<Direction>> {
        let axes: Vec<Axis> = self.value(self.spelling.key.name)?;
        let each = axes.iter().enumerate();
        let turning = |(i, axis): (usize, &Axis)| self.turning_about(axis, self.place().item(i));
        Some(each.map(turning).collect())
    }

    /// The axis in the value of the key, for a translation: in the plane not y.
    pub fn sliding(&self) -> Option<Direction> {
        let axis: Axis = self.value(self.spelling.key.name)?;
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
        Some(self.resolver.number(&quantity, self.at.key(key), expected))
    }

    /// The place of the value of the key.
    fn place(&self) -> At<'r> {
        self.at.key(self.spelling.key.name)
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
        let vector = resolver.vector(written, at, PURE);
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

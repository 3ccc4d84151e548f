//! The joint of an element as written: a word, one joint, or a list of joints from the carrier outwards. What stands
//! for which kind of joint is said by the files of [kinds](crate::joint).

use super::language::Language;
use super::measure::{self, Armature, NotNegative, Pure, Ratio};
use super::place::At;
use super::quantity::{Number, Quantity};
use super::schema::{Schema, any_of, list_of, words};
use super::shape::{Key, Misfit, Problems, Shape, check_keys, check_word, misfit, record};
use super::tree::NodeKind;
use serde_yaml::Value;
use std::collections::BTreeMap;

/// The words for an axis: one of the frame's own, or its opposite.
pub const AXES: [&str; 6] = ["x", "y", "z", "-x", "-y", "-z"];

/// The coordinate of a freedom: an angle, or a length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coordinate {
    /// \[rad\]
    Angle,
    /// \[m\]
    Length,
}

impl Coordinate {
    /// The default name of a freedom with this kind of coordinate.
    pub fn name(self) -> &'static str {
        match self {
            Coordinate::Angle => "angle",
            Coordinate::Length => "position",
        }
    }

    /// SI units of the coordinate and of its rate.
    pub fn units(self) -> [&'static str; 2] {
        match self {
            Coordinate::Angle => ["rad", "rad/s"],
            Coordinate::Length => ["m", "m/s"],
        }
    }
}

/// A key of a joint that stands for freedoms.
#[derive(Clone, Copy, Debug)]
pub struct JointKey {
    /// The key. Its value is one axis, or several.
    pub key: Key,
    /// Further keys that only this key has.
    pub keys: &'static [Key],
    /// Further keys whose numbers determine whether the joint is left- or right-handed: in a mirror image they change
    /// sign.
    pub handed: &'static [&'static str],
    /// The coordinates of the freedoms for which the key stands, from the carrier outwards.
    pub coordinates: &'static [Coordinate],
}

/// A word for a joint that needs no keys.
#[derive(Clone, Copy, Debug)]
pub struct JointWord {
    /// The word itself.
    pub word: &'static str,
    /// True if the joint has axes, which a mirror image would reverse.
    pub has_axes: bool,
}

/// A joint with freedoms of its own.
#[derive(Clone, Debug)]
pub struct Freedom {
    /// Name of the freedom, unique in its joint.
    pub name: Option<String>,
    /// What is added to the coordinate \[rad\] or \[m\].
    pub zero: Option<Quantity>,
    /// Inertia of a rotor that turns with the coordinate \[kg·m²\] or \[kg\].
    pub armature: Option<Quantity>,
    /// Another freedom of the system, whose coordinate gives this one.
    pub follows: Option<Follows>,
    /// The keys that say which joint it is: those of [kinds](crate::joint) and of lists of them.
    of_kind: BTreeMap<String, Value>,
}

impl Freedom {
    /// Whether a key of a kind is there.
    pub(crate) fn has(&self, key: &str) -> bool {
        self.of_kind.contains_key(key)
    }

    /// The value of a key of a kind; none where it is not there. What passes the check can be read.
    pub(crate) fn value<T: Shape>(&self, key: &str) -> Option<Result<T, Misfit>> {
        self.of_kind.get(key).map(T::read)
    }
}

/// The name of a joint of one or several freedoms in messages.
const TITLE: &str = "a joint";

/// The keys of a joint with the title of its record; those of kinds are in the middle.
pub(super) fn keys(language: &Language) -> (&'static str, Vec<Key>) {
    let kinds = language.joint_keys.iter();
    let keys = [Key::of::<Option<String>>(
        "name",
        "`angle` or `position`, in lists with the axis: `angle-x`",
        "name of the freedom, unique in its joint",
    )]
    .into_iter();
    let keys = keys
        .chain(kinds.clone().map(|kind| kind.key))
        .chain(kinds.flat_map(|kind| kind.keys.iter().copied()))
        .chain([
            Key::of::<Option<Number<measure::Coordinate>>>(
            "zero",
            "0",
            "is added to the coordinate: the position of the element where its coordinate is 0",
        ),
            Key::of::<Option<Number<NotNegative<Armature>>>>(
            "armature",
            "0",
            "inertia that only the rate of this freedom moves: that of a rotor, times the square of its gear ratio",
        ),
            Key::of::<Option<Follows>>(
            "follows",
            "",
            "[the freedom](#a-coupling) whose coordinate gives this one",
        ),
        ]);
    (TITLE, keys.collect())
}

/// Reports what cannot be read as a joint.
fn check_freedom(at: At<'_>, problems: &Problems) {
    let (title, keys) = keys(problems.language);
    check_keys(title, &keys, at, problems);
}

impl Shape for Freedom {
    fn schema(to: &mut Schema) -> Value {
        let (title, keys) = keys(to.language);
        to.keys(title, &keys)
    }

    fn check(at: At<'_>, problems: &Problems) {
        if !matches!(at.node.kind, NodeKind::Map(_)) {
            problems.add(at.problem(
                format!("here stands {}, but a joint of a list has keys", at.node.article()),
                "write `{ hinge: z }` or `{ slider: x }`; `ball`, `weld` and the other words stand alone: `joint: ball`",
            ));
            return;
        }
        check_freedom(at, problems);
    }

    fn read(value: &Value) -> Result<Self, Misfit> {
        let entries = (value.as_mapping()).ok_or_else(|| misfit(value, TITLE))?;
        let of_all = ["name", "zero", "armature", "follows"];
        let texts = entries
            .iter()
            .map(|(key, value)| Ok((String::read(key)?, value)));
        let texts: Vec<(String, &Value)> = texts.collect::<Result<_, Misfit>>()?;
        let of_kind = texts
            .into_iter()
            .filter(|(key, _)| !of_all.contains(&key.as_str()));
        Ok(Freedom {
            name: Option::of_key(value, "name")?,
            zero: Option::of_key(value, "zero")?,
            armature: Option::of_key(value, "armature")?,
            follows: Option::of_key(value, "follows")?,
            of_kind: of_kind.map(|(key, value)| (key, value.clone())).collect(),
        })
    }
}

record! {
    /// How a freedom follows another: its coordinate is ratio times that of the other, plus an offset.
    Follows as "a coupling" {
        /// the element, of the same system, whose joint is followed
        joint: String,
        /// required if the joint has several freedoms: the name of the followed freedom
        freedom: Option<String>,
        /// change of this coordinate per change of the other
        ratio: Option<Number<Ratio>> = "1",
        /// this coordinate where the other is 0
        offset: Option<Number<measure::Coordinate>> = "0",
    }
}

/// An axis in the frame of what carries the element.
#[derive(Clone, Debug)]
pub enum Axis {
    /// One of the frame's own, or its opposite.
    Word(String),
    /// A vector; its length does not matter.
    Vector(Vec<Number<Pure>>),
}

/// What a joint may look like.
#[derive(Clone, Debug)]
pub enum Joint {
    /// One that needs no axis.
    Word(String),
    /// One.
    One(Box<Freedom>),
    /// Several with no mass between, from the carrier outwards.
    List(Vec<Freedom>),
}

impl Joint {
    /// The joints below each other with their places; none of a word.
    pub(crate) fn each<'w>(&'w self, at: At<'w>) -> Vec<(&'w Freedom, At<'w>)> {
        match self {
            Joint::Word(_) => Vec::new(),
            Joint::One(one) => vec![(one, at)],
            Joint::List(list) => {
                let items = list.iter().enumerate();
                items.map(|(i, one)| (one, at.item(i))).collect()
            }
        }
    }
}

impl Shape for Axis {
    fn schema(to: &mut Schema) -> Value {
        any_of([words(&AXES), Vec::<Number<Pure>>::schema(to)])
    }

    fn check(at: At<'_>, problems: &Problems) {
        match &at.node.kind {
            NodeKind::List(_) => Vec::<Number<Pure>>::check(at, problems),
            _ => check_word(at, &AXES, problems),
        }
    }

    fn read(value: &Value) -> Result<Self, Misfit> {
        match value.as_str() {
            Some(word) => Ok(Axis::Word(word.to_owned())),
            None => Vec::read(value).map(Axis::Vector),
        }
    }
}

impl Shape for Joint {
    fn schema(to: &mut Schema) -> Value {
        let words_of = to.language.joint_words.iter().map(|word| word.word);
        let words_of: Vec<&str> = words_of.collect();
        let one = Freedom::schema(to);
        any_of([words(&words_of), one.clone(), list_of(one)])
    }

    fn check(at: At<'_>, problems: &Problems) {
        match &at.node.kind {
            NodeKind::List(_) => Vec::<Freedom>::check(at, problems),
            NodeKind::Map(_) => check_freedom(at, problems),
            NodeKind::Scalar { .. } => {
                let words = problems.language.joint_words.iter();
                let words: Vec<&str> = words.map(|word| word.word).collect();
                check_word(at, &words, problems);
            }
        }
    }

    fn read(value: &Value) -> Result<Self, Misfit> {
        match value.as_str() {
            Some(word) => Ok(Joint::Word(word.to_owned())),
            None if value.is_sequence() => Vec::read(value).map(Joint::List),
            None => Freedom::read(value).map(|one| Joint::One(Box::new(one))),
        }
    }
}

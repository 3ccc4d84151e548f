//! What a number is measured in: the physical quantities that keys expect, as values and as types. A key is declared
//! with the type, from which reading, the reference page and the schema follow.

use super::rule::Rule;
use bryant_table::unit::Dimension;
use std::marker::PhantomData;

/// The physical quantity that a key expects.
#[derive(Clone, Copy, Debug)]
pub struct Expected {
    /// Name with its article ("a mass").
    pub name: &'static str,
    /// Its dimension.
    pub dimension: Dimension,
}

/// Accepts any dimension; its own powers belong to no unit.
pub const ANY: Expected = Expected {
    name: "anything",
    dimension: Dimension::new(i32::MAX, i32::MAX, i32::MAX, 0),
};

impl Expected {
    /// True if a quantity of this dimension is accepted.
    pub fn accepts(&self, dimension: Dimension) -> bool {
        self.dimension == ANY.dimension || self.dimension == dimension
    }

    /// The SI unit, in words.
    pub fn unit(&self) -> String {
        match self.dimension.to_string() {
            unit if unit.is_empty() => "no unit".to_owned(),
            unit => unit,
        }
    }
}

/// What a number is measured in, as the reference page writes it.
pub trait Unit: Clone + std::fmt::Debug + PartialEq + 'static {
    /// The values that the number may have.
    const RULE: Rule = Rule::Finite;
    /// The unit; "" where the number has none, or its meaning says it.
    fn unit() -> String;
}

/// A function of `X`, measured in `Y`: "m → N"; for several pairs, "m → N, rad → N·m".
impl<X: Unit, Y: Unit> Unit for (X, Y) {
    fn unit() -> String {
        let pure = |unit: &str| if unit.is_empty() { "1" } else { unit }.to_owned();
        let [x, y] = [X::unit(), Y::unit()];
        let pairs = x.split(", ").zip(y.split(", "));
        let pairs = pairs.map(|(x, y)| format!("{} → {}", pure(x), pure(y)));
        pairs.collect::<Vec<_>>().join(", ")
    }
}

/// A unit that does not depend on anything else in the text.
pub trait Measured: Unit {
    /// The physical quantity.
    const EXPECTED: Expected;
}

/// The physical quantity of a number in a law that may be of a coordinate that slides, or of one that turns.
pub trait InPlace: Unit {
    /// The physical quantity, of a sliding coordinate or of a turning one.
    fn expected(slides: bool) -> Expected;
}

macro_rules! in_place {
    ($($name:ident: $slides:ident, $turns:ident;)*) => {$(
        impl InPlace for $name {
            fn expected(slides: bool) -> Expected {
                if slides { $slides } else { $turns }
            }
        }
    )*};
}

in_place! {
    Displacement: LENGTH, ANGLE;
    Effort: FORCE, TORQUE;
    EffortPerCoordinate: STIFFNESS, ANGULAR_STIFFNESS;
    EffortPerRate: LINEAR_DAMPING, ANGULAR_DAMPING;
}

/// `S` where a coordinate slides, `T` where it turns. The reference page writes the unit of `T`.
#[derive(Clone, Debug, PartialEq)]
pub struct Either<S, T>(PhantomData<(S, T)>);

impl<S: Measured, T: Measured> Unit for Either<S, T> {
    const RULE: Rule = T::RULE;

    fn unit() -> String {
        T::unit()
    }
}

impl<S: Measured, T: Measured> InPlace for Either<S, T> {
    fn expected(slides: bool) -> Expected {
        match slides {
            true => S::EXPECTED,
            false => T::EXPECTED,
        }
    }
}

macro_rules! ruled {
    ($($(#[$meta:meta])* $name:ident)*) => {$(
        $(#[$meta])*
        #[derive(Clone, Debug, PartialEq)]
        pub struct $name<U>(PhantomData<U>);

        impl<U: Unit> Unit for $name<U> {
            const RULE: Rule = Rule::$name;

            fn unit() -> String {
                U::unit()
            }
        }

        impl<U: Measured> Measured for $name<U> {
            const EXPECTED: Expected = U::EXPECTED;
        }

        impl<U: InPlace> InPlace for $name<U> {
            fn expected(slides: bool) -> Expected {
                U::expected(slides)
            }
        }
    )*};
}

ruled! {
    /// A number of `U` that is 0 or more.
    NotNegative
    /// A number of `U` that is more than 0.
    Positive
}

macro_rules! measured {
    ($($name:ident $constant:ident = $words:literal $unit:literal [$m:literal $kg:literal $s:literal $rad:literal $kelvin:literal];)*) => {
    $(
        #[doc = concat!("\\[", $unit, "\\]")]
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct $name;

        impl Unit for $name {
            fn unit() -> String {
                $unit.to_owned()
            }
        }

        impl Measured for $name {
            const EXPECTED: Expected = $constant;
        }

        impl InPlace for $name {
            fn expected(_: bool) -> Expected {
                $constant
            }
        }

        #[doc = concat!($words, " \\[", $unit, "\\]")]
        pub const $constant: Expected = Expected {
            name: $words,
            dimension: Dimension::new($m, $kg, $s, $rad).kelvin($kelvin),
        };
    )*

        // Public for the tests in `tests/it`, which are compiled apart from this crate.
        #[doc(hidden)]
        pub const ALL: &[(&str, Expected)] = &[$(($unit, $constant)),*];
    };
}

measured! {
    Length LENGTH = "a length" "m" [1 0 0 0 0];
    Time TIME = "a time" "s" [0 0 1 0 0];
    Mass MASS = "a mass" "kg" [0 1 0 0 0];
    Inertia INERTIA = "a moment of inertia" "kg·m²" [2 1 0 0 0];
    Angle ANGLE = "an angle" "rad" [0 0 0 1 0];
    Speed SPEED = "a speed" "m/s" [1 0 -1 0 0];
    Rate RATE = "an angular velocity" "rad/s" [0 0 -1 1 0];
    Acceleration ACCELERATION = "an acceleration" "m/s²" [1 0 -2 0 0];
    Force FORCE = "a force" "N" [1 1 -2 0 0];
    Torque TORQUE = "a torque" "N·m" [2 1 -2 0 0];
    Moment MOMENT = "a moment" "N·m" [2 1 -2 0 0];
    Stiffness STIFFNESS = "a stiffness" "N/m" [0 1 -2 0 0];
    LinearDamping LINEAR_DAMPING = "a damping coefficient" "N·s/m" [0 1 -1 0 0];
    AngularStiffness ANGULAR_STIFFNESS = "a stiffness" "N·m/rad" [2 1 -2 -1 0];
    AngularDamping ANGULAR_DAMPING = "a damping coefficient" "N·m·s/rad" [2 1 -1 -1 0];
    Pure PURE = "a pure number" "" [0 0 0 0 0];
    LengthPerAngle LENGTH_PER_ANGLE = "a length per angle" "m/rad" [1 0 0 -1 0];
    AnglePerLength ANGLE_PER_LENGTH = "an angle per length" "rad/m" [-1 0 0 1 0];
    Coefficient FRICTION = "a coefficient of friction" "" [0 0 0 0 0];
    ForcePerElongation FORCE_PER_ELONGATION = "a force per elongation" "N" [1 1 -2 0 0];
    Area AREA = "an area" "m²" [2 0 0 0 0];
    Pressure PRESSURE = "a pressure" "Pa" [-1 1 -2 0 0];
    MassFlow MASS_FLOW = "a mass per time" "kg/s" [0 1 -1 0 0];
    Temperature TEMPERATURE = "a temperature" "K" [0 0 0 0 1];
    GasConstant GAS_CONSTANT = "a gas constant" "J/(kg·K)" [2 0 -2 0 -1];
}

impl Measured for Any {
    const EXPECTED: Expected = ANY;
}

macro_rules! dependent {
    ($($(#[$meta:meta])* $name:ident $unit:literal;)*) => {$(
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct $name;

        impl Unit for $name {
            fn unit() -> String {
                $unit.to_owned()
            }
        }
    )*};
}

dependent! {
    /// Any unit.
    Any "any";
    /// The unit of the key `value` beside it.
    OfTheValue "of the value";
    /// The unit of the quantity that the entry names.
    OfTheQuantity "of the quantity";
    /// The units that the curve is used with.
    OfItsUse "of its use";
    /// The unit that makes a product fit.
    OfTheFactor "such that the product fits";
    /// Of a coordinate of a joint.
    Coordinate "rad, m";
    /// Of the rate of a coordinate.
    CoordinateRate "rad/s, m/s";
    /// Of the inertia that goes with a coordinate.
    Armature "kg·m², kg";
    /// Of a ratio of coordinates.
    Ratio "1, m/rad, rad/m";
    /// Of a displacement along an axis, or of an angle about it.
    Displacement "m, rad";
    /// Of what acts along such an axis, or about it.
    Effort "N, N·m";
    /// Per unit of a coordinate.
    EffortPerCoordinate "N/m, N·m/rad";
    /// Per unit of the rate of a coordinate.
    EffortPerRate "N·s/m, N·m·s/rad";
    /// Per relative elongation, or per elongation.
    Webbing "N, or N/m";
}

//! Short forms as written: one entry that stands for several. [`expand`](super::expand) writes them out before values
//! are read, so that only the long form is read.

use super::place::At;
use super::quantity::Quantity;
use super::shape::{Misfit, Problems, Record, Shape, check_record, misfit, record, words};
use super::tree::Kind;
use serde_yaml::Value;
use std::ops::Deref;

record! {
    /// How the names and the places of two sides correspond.
    Mirror as "a mirror" {
        /// Word in the names of the side that is written.
        from: Option<String>,
        /// Word in its place in the names of the other side.
        to: Option<String>,
        /// The axis that is reversed.
        axis: Option<LongAxis>,
    }
}

record! {
    /// A file that is read with another name for its system.
    Instance as "an instance" {
        /// The file, relative to this one.
        file: String,
        /// Name of its system here.
        system: String,
    }
}

record! {
    /// A person as a system.
    Person as "a person" {
        /// Who it is.
        human: Human,
        /// Name of the system.
        system: String,
    }
}

record! {
    /// Size and posture of a person.
    Human as "a human" {
        /// A usual size by its name.
        like: Option<HumanName>,
        /// The sex that the data are of.
        sex: Option<HumanSex>,
        /// From sole to vertex \[m\].
        stature: Option<Quantity>,
        /// Of the whole body \[kg\].
        mass: Option<Quantity>,
        /// Of stature and of mass, from 1 to 99.
        percentile: Option<Quantity>,
        /// How the body is placed at the start.
        posture: Option<HumanPosture>,
        /// Other angles than those of the posture.
        angles: Option<HumanAngles>,
        /// Where the elastic torques of spine and neck are 0.
        neutral: Option<HumanNeutral>,
    }
}

words! {
    /// Where the elastic torques of spine and neck are 0.
    HumanNeutral {
        /// In the posture at the start.
        Posture = "posture",
        /// Upright, whatever the posture.
        Upright = "upright",
    }
}

record! {
    /// Angles about y of the joints of a person, both sides alike.
    HumanAngles as "the angles of a human" {
        /// The trunk against the vertical.
        trunk: Option<Quantity>,
        /// The head against the trunk.
        head: Option<Quantity>,
        /// The upper arms against the trunk.
        upper_arms: Option<Quantity>,
        /// The forearms against the upper arms.
        forearms: Option<Quantity>,
        /// The hands against the forearms.
        hands: Option<Quantity>,
        /// The thighs against the trunk.
        thighs: Option<Quantity>,
        /// The shanks against the thighs.
        shanks: Option<Quantity>,
        /// The feet against the shanks.
        feet: Option<Quantity>,
    }
}

words! {
    /// Usual sizes of adults, crash dummies and children.
    HumanName {
        /// A man of 1.753 m and 77.7 kg.
        Male50 = "male-50",
        /// A man of 1.877 m and 101.2 kg.
        Male95 = "male-95",
        /// A woman of 1.501 m and 49 kg.
        Female5 = "female-5",
        /// An adult with the masses of the Hybrid III 50th percentile male.
        Hybrid50 = "hybrid-3-50",
        /// An adult with the masses of the Hybrid III 5th percentile female.
        Hybrid5 = "hybrid-3-5",
        /// A child like the Hybrid III six-year-old.
        Child6 = "child-6",
        /// A child like the Hybrid III three-year-old.
        Child3 = "child-3",
    }
}

words! {
    /// The sex that data are of.
    HumanSex {
        /// Female.
        Female = "f",
        /// Male.
        Male = "m",
    }
}

words! {
    /// How a body is placed.
    HumanPosture {
        /// Upright, arms hanging.
        Standing = "standing",
        /// Thighs forward, shanks down, forearms forward.
        Seated = "seated",
    }
}

record! {
    /// A part of a car by name.
    Part as "a part" {
        /// Which part.
        part: PartName,
        /// Begins the names of its surfaces, curves and contacts.
        name: String,
        /// The vehicle that it is on, or `frame`.
        on: String,
        /// Where it is.
        at: Vec<Quantity>,
        /// What it leans by.
        angle: Option<Quantity>,
        /// Systems of the people who meet it.
        against: Option<Vec<String>>,
        /// Factor on its forces.
        times: Option<Quantity>,
    }
}

words! {
    /// Parts of a car.
    PartName {
        /// The plane of a seat cushion.
        Cushion = "cushion",
        /// A cushion and a back.
        Seat = "seat",
        /// A padded panel before the knees.
        KneeBolster = "knee-bolster",
        /// A steering wheel on a column that gives way.
        SteeringColumn = "steering-column",
    }
}

/// A file to be read first, by its path alone or as an instance; or a person, or a part.
#[derive(Clone, Debug)]
pub struct Include;

impl Shape for Include {
    fn check(at: At<'_>, problems: &Problems) {
        match at.node.kind {
            Kind::Map(_) if at.node.get("human").is_some() => check_record::<Person>(at, problems),
            Kind::Map(_) if at.node.get("part").is_some() => check_record::<Part>(at, problems),
            Kind::Map(_) => check_record::<Instance>(at, problems),
            _ => String::check(at, problems),
        }
    }

    fn read(value: &Value) -> Result<Self, Misfit> {
        Err(misfit(value, "nothing: files are included before"))
    }
}

/// One, or a list for one entry of the long form each. Derefs to the one.
#[derive(Clone, Copy, Debug)]
pub struct Each<T>(pub T);

impl<T> Deref for Each<T> {
    type Target = T;
    fn deref(&self) -> &T {
        &self.0
    }
}

impl<T: Shape> Shape for Each<T> {
    fn check(at: At<'_>, problems: &Problems) {
        let Kind::List(items) = &at.node.kind else {
            return T::check(at, problems);
        };
        if items.is_empty() {
            problems.add(at.problem("the list is empty", "name at least one"));
        }
        Vec::<T>::check(at, problems);
    }

    fn read(value: &Value) -> Result<Self, Misfit> {
        T::read(value).map(Each)
    }
}

/// A surface in place, the name of one, or a list of names. Derefs to the surface.
#[derive(Clone, Debug)]
pub struct ByName<R>(pub R);

impl<R> Deref for ByName<R> {
    type Target = R;
    fn deref(&self) -> &R {
        &self.0
    }
}

impl<R: Record + Shape> Shape for ByName<R> {
    fn check(at: At<'_>, problems: &Problems) {
        match at.node.kind {
            Kind::Map(_) => check_record::<R>(at, problems),
            _ => Each::<String>::check(at, problems),
        }
    }

    fn read(value: &Value) -> Result<Self, Misfit> {
        R::read(value).map(ByName)
    }
}

words! {
    /// A local axis.
    LongAxis {
        /// The local x axis.
        X = "x",
        /// The local y axis.
        Y = "y",
        /// The local z axis.
        Z = "z",
    }
}

//! Short forms as written: one entry that stands for several. [`expand`](super::expand) writes them out before values
//! are read, so that only the long form is read.

use super::measure::{Angle, Length, Mass};
use super::place::At;
use super::quantity::{Number, Quantity};
use super::schema::{Schema, any_of, list_of, typed};
use super::shape::{Misfit, Problems, Record, Shape, check_record, misfit, record, words};
use super::tree::NodeKind;
use serde_yaml::Value;
use std::ops::Deref;

record! {
    /// How the names and the places of two sides correspond.
    Mirror as "a mirror" {
        /// word in the names of the written entries
        from: Option<String> = "`left`",
        /// word in the names of the images
        to: Option<String> = "`right`",
        /// the axis that is reversed: `x`, `y` or `z`
        axis: Option<LongAxis> = "`y`",
    }
}

record! {
    /// A file that is read with another name for its system.
    Instance as "an instance" {
        /// the file, relative to this one
        file: String,
        /// name of this instance of its system
        system: String,
    }
}

record! {
    /// A person as a system.
    Person as "a person" {
        /// [who it is](#a-human)
        human: Human,
        /// name of the system
        system: String,
    }
}

record! {
    /// Size and posture of a person.
    Human as "a human" {
        /// an adult, `male-50` (1.753 m, 77.7 kg), `male-95` (1.877 m, 101.2 kg) or `female-5` (1.501 m, 49 kg); an
        /// adult with the masses of a crash dummy, `hybrid-3-50` (78.2 kg) or `hybrid-3-5` (49 kg); a child, `child-6`
        /// (1.143 m, 23.4 kg) or `child-3` (0.945 m, 15.5 kg)
        like: Option<HumanName>,
        /// `f` or `m`: which data
        sex: Option<HumanSex>,
        /// from sole to vertex, 1.40 to 2.10 m
        stature: Option<Number<Length>>,
        /// of the whole body, 15 to 45 kg/m² times the squared stature
        mass: Option<Number<Mass>>,
        /// of stature and of mass, 1 to 99, of [ANSUR II](humans.md): soldiers
        percentile: Option<Quantity>,
        /// `standing`, or `seated`: thighs forward, shanks down
        posture: Option<HumanPosture> = "`standing`",
        /// [angles](#the-angles-of-a-human) of the trunk and of joints
        angles: Option<HumanAngles> = "those of the posture",
        /// where the elastic torques of spine and neck are 0: in the `posture` with its `angles`, or `upright` whatever
        /// these are; a `start` of the system does not move it
        neutral: Option<HumanNeutral> = "`posture`",
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
        /// pelvis, abdomen and thorax against the vertical
        trunk: Option<Number<Angle>> = "0",
        /// against the trunk
        head: Option<Number<Angle>> = "0",
        /// against the trunk
        upper_arms: Option<Number<Angle>> = "0, seated −30°",
        /// against the upper arms
        forearms: Option<Number<Angle>> = "0, seated −60°",
        /// against the forearms
        hands: Option<Number<Angle>> = "0",
        /// against the trunk
        thighs: Option<Number<Angle>> = "0, seated −90°",
        /// against the thighs
        shanks: Option<Number<Angle>> = "0, seated 90°",
        /// against the shanks
        feet: Option<Number<Angle>> = "0",
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
        /// `cushion`, `seat`, `knee-bolster` or `steering-column`
        part: PartName,
        /// begins the names of its surfaces, curves and contacts
        name: String,
        /// the vehicle that it is on, or `frame`
        on: String,
        /// where it is, in the frame of the vehicle: `[x, z]` in the plane, `[x, y, z]` in space; numbers, no
        /// parameters
        at: Vec<Number<Length>>,
        /// the angle that it leans by; a number, no parameter
        angle: Option<Number<Angle>> = "as in the table",
        /// systems of the people who meet it
        against: Option<Vec<String>>,
        /// factor on its forces: a number or the name of a parameter
        times: Option<Quantity> = "1",
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
    fn schema(to: &mut Schema) -> Value {
        any_of([
            typed("string"),
            Person::schema(to),
            Part::schema(to),
            Instance::schema(to),
        ])
    }

    fn check(at: At<'_>, problems: &Problems) {
        match at.node.kind {
            NodeKind::Map(_) if at.node.get("human").is_some() => {
                check_record::<Person>(at, problems)
            }
            NodeKind::Map(_) if at.node.get("part").is_some() => check_record::<Part>(at, problems),
            NodeKind::Map(_) => check_record::<Instance>(at, problems),
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
    fn schema(to: &mut Schema) -> Value {
        let one = T::schema(to);
        any_of([one.clone(), list_of(one)])
    }

    fn check(at: At<'_>, problems: &Problems) {
        let NodeKind::List(items) = &at.node.kind else {
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
    fn schema(to: &mut Schema) -> Value {
        any_of([R::schema(to), Each::<String>::schema(to)])
    }

    fn check(at: At<'_>, problems: &Problems) {
        match at.node.kind {
            NodeKind::Map(_) => check_record::<R>(at, problems),
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

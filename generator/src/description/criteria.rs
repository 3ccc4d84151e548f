//! Injury criteria as written: by which regulation, for which dummy, and where what is.

use super::measure::{Acceleration, Effort, Force, Length, Rate, Torque};
use super::shape::{In, record, words};

words! {
    /// Whose coefficients filters have.
    FilterStandard {
        /// ISO 6487
        Iso6487 = "iso6487",
        /// SAE J211-1
        SaeJ211 = "sae-j211",
    }
}

/// The places where a dummy measures, as keys with units: each has the name of an output, or, of a head and a chest, of
/// an element.
macro_rules! places {
    ($( $(#[doc = $meaning:literal])* $place:ident: $unit:ty, )*) => {
        record! {
            /// By what a run is judged.
            Criteria as "a set of criteria" {
                /// the regulation; `bryant criteria --list` has those that are known
                standard: String,
                /// the dummy
                dummy: String,
                /// whose coefficients the [filters](compare.md#filters) have: `iso6487`, or `sae-j211`
                filter_standard: Option<FilterStandard> = "`iso6487`",
                /// test object and position, the first two characters of the codes, where outputs of several occupants
                /// have one, `"13"`
                occupant: Option<String> = "that of the outputs' codes",
                $( $(#[doc = $meaning])* $place: Option<In<String, $unit>>, )*
            }
        }

        impl Criteria {
            /// Each place that is said, by its key, with what stands there.
            pub fn places(&self) -> Vec<(&'static str, &str)> {
                let all = [ $( (stringify!($place), self.$place.as_ref().map(|name| name.as_str())), )* ];
                let said = all.into_iter().filter_map(|(key, text)| Some((key, text?)));
                said.collect()
            }
        }
    };
}

places! {
    /// resultant of the acceleration of the head: an output, or the element. An element gets outputs `head-x`,
    /// `head-y` and `head-z`, of accelerometers along its own axes at its centre of gravity
    head: Acceleration,
    /// its component along the x axis of the head; if components are given, they are used instead of the resultant
    head_x: Acceleration,
    /// the same along y
    head_y: Acceleration,
    /// the same along z
    head_z: Acceleration,
    /// angular velocity of the head about its own x axis
    head_wx: Rate,
    /// the same about y
    head_wy: Rate,
    /// the same about z
    head_wz: Rate,
    /// how far the head comes forward in the seat
    head_excursion: Length,
    /// the element of the head: it gets outputs `neck-fx`, `neck-fz` and `neck-my` of what its joint transmits
    neck: Effort,
    /// shear force at the upper neck
    neck_fx: Force,
    /// axial force there; tension is positive
    neck_fz: Force,
    /// moment there; flexion is positive
    neck_my: Torque,
    /// as `head`
    chest: Acceleration,
    /// as `head_x`
    chest_x: Acceleration,
    /// as `head_y`
    chest_y: Acceleration,
    /// as `head_z`
    chest_z: Acceleration,
    /// how far the chest is pressed in
    chest_deflection: Length,
    /// axial force of the left femur
    femur_left: Force,
    /// axial force of the right femur
    femur_right: Force,
    /// how far the left knee slides
    knee_left: Length,
    /// how far the right knee slides
    knee_right: Length,
    /// moment about x of the left tibia
    tibia_left_mx: Torque,
    /// moment about y of the left tibia
    tibia_left_my: Torque,
    /// axial force of the left tibia
    tibia_left_fz: Force,
    /// as of the left one
    tibia_right_mx: Torque,
    /// as of the left one
    tibia_right_my: Torque,
    /// as of the left one
    tibia_right_fz: Force,
    /// acceleration of the vehicle along its direction of travel
    pulse: Acceleration,
}

//! Injury criteria as written: by which regulation, for which dummy, and where what is.

use super::shape::{record, words};

words! {
    /// Whose coefficients filters have.
    FilterStandard {
        /// ISO 6487
        Iso6487 = "iso6487",
        /// SAE J211-1
        SaeJ211 = "sae-j211",
    }
}

/// The places where a dummy measures, as keys: each has the name of an output, or, of a head and a chest, of an element.
macro_rules! places {
    ($( $(#[$meta:meta])* $place:ident, )*) => {
        record! {
            /// By what a run is judged.
            Criteria as "a set of criteria" {
                /// The regulation.
                standard: String,
                /// The dummy.
                dummy: String,
                /// Whose coefficients the filters have.
                filter_standard: Option<FilterStandard>,
                /// Test object and position of the occupant, the first two characters of the codes of its outputs.
                occupant: Option<String>,
                $( $(#[$meta])* $place: Option<String>, )*
            }
        }

        impl Criteria {
            /// Each place that is said, by its key, with what stands there.
            pub fn places(&self) -> Vec<(&'static str, &str)> {
                let all = [ $( (stringify!($place), self.$place.as_deref()), )* ];
                let said = all.into_iter().filter_map(|(key, text)| Some((key, text?)));
                said.collect()
            }
        }
    };
}

places! {
    /// Acceleration of the centre of gravity of the head, its resultant; or the element.
    head,
    /// The same along the axes of the head.
    head_x,
    /// Along y.
    head_y,
    /// Along z.
    head_z,
    /// Angular velocity of the head about its own axes.
    head_wx,
    /// About y.
    head_wy,
    /// About z.
    head_wz,
    /// How far the head comes forward in the seat.
    head_excursion,
    /// The head whose joint is the upper neck: its shear force, axial force and moment.
    neck,
    /// Shear force at the upper neck.
    neck_fx,
    /// Axial force at the upper neck, tension positive.
    neck_fz,
    /// Moment at the upper neck, flexion positive.
    neck_my,
    /// Acceleration of the chest, its resultant; or the element.
    chest,
    /// The same along the axes of the chest.
    chest_x,
    /// Along y.
    chest_y,
    /// Along z.
    chest_z,
    /// Deflection of the chest.
    chest_deflection,
    /// Axial force of the left femur.
    femur_left,
    /// Axial force of the right femur.
    femur_right,
    /// Sliding of the left knee.
    knee_left,
    /// Sliding of the right knee.
    knee_right,
    /// Moment about x of the left tibia.
    tibia_left_mx,
    /// Moment about y of the left tibia.
    tibia_left_my,
    /// Axial force of the left tibia.
    tibia_left_fz,
    /// Moment about x of the right tibia.
    tibia_right_mx,
    /// Moment about y of the right tibia.
    tibia_right_my,
    /// Axial force of the right tibia.
    tibia_right_fz,
    /// Acceleration of the vehicle along its way.
    pulse,
}

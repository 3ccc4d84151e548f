//! Injury criteria: their names, the places of a dummy that they use, their filters and formulas, and the limits of
//! regulations.
//!
//! | file | what |
//! |---|---|
//! | `limits` | limits by regulation and dummy, `limits.json` |
//! | `places` | the places where a dummy measures, and their channel codes |
//! | `choice` | finds the channels or outputs that measure at these places |
//! | `judge` | the criteria of a model |
//!
//! The filter is applied to what a sensor measures, before a resultant is formed.

pub mod choice;
mod judge;
pub mod limits;
mod places;

pub use judge::{Judged, Shown, judge, named};
pub use places::{PLACES, SensorPlace, fits};

use crate::response::What;
use bryant_runtime::response::STANDARD_GRAVITY;
use bryant_runtime::response::channel::Combination;
use bryant_runtime::response::filter::Class;
use limits::Limits;

/// A criterion.
pub struct Criterion {
    /// Its name.
    pub name: &'static str,
    /// The unit in which its limits and values are shown.
    pub unit: &'static str,
    /// SI value of that unit.
    pub scale: f64,
    /// Filter class of its signals by SAE J211-1, if they are filtered; a regulation may have another, see
    /// [`Criterion::class`].
    filter: Option<Class>,
    // Public for the tests in `tests/it`, which are compiled apart from this crate.
    #[doc(hidden)]
    pub measure: Measure,
}

/// How a criterion is computed from signals, which are named by their places.
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub enum Measure {
    /// A response of a resultant acceleration.
    Resultant(&'static str, What),
    /// A response of one signal.
    Of(&'static str, Combination, What),
    /// The neck injury criterion.
    Nij,
    /// The moment about the joint of head and neck that bends the head backwards.
    NeckExtension,
    /// The viscous criterion of the chest's deflection.
    Viscous,
    /// The tibia index; the text is the common beginning of the names of its places.
    Tibia(&'static str),
    /// A criterion of the angular velocity of the head.
    Rotation,
}

const fn criterion(
    name: &'static str,
    (unit, scale): (&'static str, f64),
    filter: Option<Class>,
    measure: Measure,
) -> Criterion {
    Criterion {
        name,
        unit,
        scale,
        filter,
        measure,
    }
}

const G: (&str, f64) = ("g", STANDARD_GRAVITY);
const NEWTON: (&str, f64) = ("N", 1.0);
const PURE: (&str, f64) = ("", 1.0);
const MM: (&str, f64) = ("mm", 1e-3);
const CLIP: What = What::Clip { duration: 3e-3 };

/// Critical angular velocities of BrIC \[rad/s\]: the means of the values by two measures of strain \[Takhounts 2013,
/// as in the program pyisomme\].
const ROTATION: [f64; 3] = [66.25, 56.45, 42.87];

/// All criteria.
pub const CRITERIA: [Criterion; 22] = {
    use Combination::{Itself, Positive};
    use Measure::{NeckExtension, Nij, Of, Resultant, Rotation, Tibia, Viscous};
    use What::{Hic15, Hic36, Magnitude, Olc, Peak};
    const CFC60: Option<Class> = Some(Class::Cfc60);
    const CFC180: Option<Class> = Some(Class::Cfc180);
    const CFC600: Option<Class> = Some(Class::Cfc600);
    const CFC1000: Option<Class> = Some(Class::Cfc1000);
    const TENSION: Measure = Of("neck-fz", Positive(1.0), Peak);
    const COMPRESSION: Measure = Of("neck-fz", Positive(-1.0), Peak);
    const EXCURSION: Measure = Of("head-excursion", Itself, Peak);
    const fn of_size(place: &'static str) -> Measure {
        Of(place, Itself, Magnitude)
    }
    [
        criterion("HIC15", PURE, CFC1000, Resultant("head", Hic15)),
        criterion("HIC36", PURE, CFC1000, Resultant("head", Hic36)),
        criterion("head 3 ms", G, CFC1000, Resultant("head", CLIP)),
        criterion("BrIC", PURE, CFC60, Rotation),
        criterion("head excursion", MM, None, EXCURSION),
        criterion("Nij", PURE, CFC600, Nij),
        criterion("neck tension", NEWTON, CFC1000, TENSION),
        criterion("neck compression", NEWTON, CFC1000, COMPRESSION),
        criterion("neck shear", NEWTON, CFC1000, of_size("neck-fx")),
        criterion("neck extension", ("N*m", 1.0), CFC600, NeckExtension),
        criterion("chest 3 ms", G, CFC180, Resultant("chest", CLIP)),
        criterion("chest deflection", MM, CFC600, of_size("chest-deflection")),
        criterion("VC", ("m/s", 1.0), CFC180, Viscous),
        criterion("femur left", NEWTON, CFC600, of_size("femur-left")),
        criterion("femur right", NEWTON, CFC600, of_size("femur-right")),
        criterion("knee left", MM, CFC180, of_size("knee-left")),
        criterion("knee right", MM, CFC180, of_size("knee-right")),
        criterion("tibia left", PURE, CFC600, Tibia("tibia-left")),
        criterion("tibia right", PURE, CFC600, Tibia("tibia-right")),
        criterion("tibia force left", NEWTON, CFC600, of_size("tibia-left-fz")),
        criterion(
            "tibia force right",
            NEWTON,
            CFC600,
            of_size("tibia-right-fz"),
        ),
        criterion("OLC", G, CFC60, Of("pulse", Itself, Olc)),
    ]
};

/// Why a criterion has no value.
#[derive(Clone, Debug, PartialEq)]
pub enum Missing {
    /// Nothing is measured at this place.
    Place(String),
    /// The measurement at the place cannot be used, or the regulation has no critical values.
    Unusable(String),
}

/// The signals that a criterion is read off.
#[derive(Clone, Debug, PartialEq)]
pub struct Formed {
    /// The places of the signals, in the order of the combination.
    pub places: Vec<String>,
    /// How the signals are combined.
    pub combination: Combination,
    /// The response that is read off.
    pub what: What,
    /// A remark on it.
    pub detail: &'static str,
}

impl Criterion {
    /// A criterion by its name in upper or lower case.
    pub fn named(name: &str) -> Option<&'static Criterion> {
        CRITERIA
            .iter()
            .find(|one| one.name.eq_ignore_ascii_case(name.trim()))
    }

    /// The filter of its signals in a regulation; `None` if they are not filtered.
    pub fn class(&self, limits: &Limits) -> Option<Class> {
        let own = limits.filters.get(self.name);
        let own = own.and_then(|number| {
            Class::ALL
                .into_iter()
                .find(|class| class.number() == *number)
        });
        own.or(self.filter)
    }

    /// True if a signal that was filtered by the class `before` may be judged, although its class is narrower than that
    /// of the criterion. SAE J211-1 and ISO 6487 have different classes for deflections of the chest, and tests use
    /// either.
    pub fn allows(&self, before: Class) -> bool {
        self.name == "chest deflection" && before == Class::Cfc180
    }

    /// The signals of the criterion. `has` is true for available places; if the motion is `planar`, components along y
    /// are not needed.
    ///
    /// # Errors
    /// A place is not available, or the regulation has no critical values.
    pub fn formed(
        &self,
        limits: &Limits,
        has: &dyn Fn(&str) -> bool,
        planar: bool,
    ) -> Result<Formed, Missing> {
        let unusable = |what: &str| Missing::Unusable(format!("the limits have no {what}"));
        let (places, combination, what, detail) = match &self.measure {
            Measure::Resultant(place, what) => {
                let (places, combination) = resultant(place, has, planar)?;
                let detail = match combination {
                    Combination::Resultant => "",
                    _ => "filtered as a resultant",
                };
                (places, combination, *what, detail)
            }
            Measure::Of(place, combination, what) => {
                let what = match limits.falling(self) {
                    Some(limit) => What::Exceedance { limit },
                    None => *what,
                };
                (vec![(*place).to_owned()], *combination, what, "")
            }
            Measure::Nij => {
                let critical = limits
                    .nij
                    .ok_or_else(|| unusable("critical values of Nij"))?;
                let places = ["neck-fx", "neck-fz", "neck-my"];
                let combination = Combination::Nij(critical);
                (
                    places.map(str::to_owned).to_vec(),
                    combination,
                    What::Peak,
                    "",
                )
            }
            Measure::NeckExtension => {
                let places = ["neck-fx", "neck-my"].map(str::to_owned);
                (places.to_vec(), Combination::Extension, What::Peak, "")
            }
            Measure::Viscous => {
                let chest = limits.chest.ok_or_else(|| unusable("depth of the chest"))?;
                let places = vec!["chest-deflection".to_owned()];
                (places, Combination::Viscous(chest), What::Peak, "")
            }
            Measure::Tibia(side) => {
                let [moment, force] = limits
                    .tibia
                    .ok_or_else(|| unusable("critical values of the tibia"))?;
                let places = ["mx", "my", "fz"].map(|what| format!("{side}-{what}"));
                let combination = Combination::Tibia { moment, force };
                (places.to_vec(), combination, What::Peak, "")
            }
            Measure::Rotation => {
                let places = ["head-wx", "head-wy", "head-wz"].map(str::to_owned);
                let combination = Combination::Rotation(ROTATION);
                (places.to_vec(), combination, What::Peak, "")
            }
        };
        match places.iter().find(|place| !has(place)) {
            Some(place) => Err(Missing::Place(place.clone())),
            None => Ok(Formed {
                places,
                combination,
                what,
                detail,
            }),
        }
    }
}

/// The places of a resultant: its components, or the resultant itself if there are no components.
fn resultant(
    place: &str,
    has: &dyn Fn(&str) -> bool,
    planar: bool,
) -> Result<(Vec<String>, Combination), Missing> {
    let component = |axis: &str| format!("{place}-{axis}");
    if !has(&component("x")) {
        return match has(place) {
            true => Ok((vec![place.to_owned()], Combination::Itself)),
            false => Err(Missing::Place(place.to_owned())),
        };
    }
    let axes: &[&str] = match planar && !has(&component("y")) {
        true => &["x", "z"],
        false => &["x", "y", "z"],
    };
    let places = axes.iter().map(|axis| component(axis)).collect();
    Ok((places, Combination::Resultant))
}

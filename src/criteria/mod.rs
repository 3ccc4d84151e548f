//! Injury criteria of a recording beside the limits of a regulation.
//!
//! | file | what |
//! |---|---|
//! | `limits` | limits by regulation and dummy |
//! | `places` | which channel of a recording is which place of a dummy |
//! | `measures` | the criteria that are no responses of the runtime: Nij, the viscous criterion |
//!
//! Each criterion says its filter. The filter is applied to what a sensor measures, before a resultant is formed.

pub mod limits;
mod measures;
mod places;

pub use places::{PLACES, Places};

use bryant_runtime::Response;
use bryant_runtime::response::{STANDARD_GRAVITY, reduce};
use bryant_signal::Signal;
use bryant_signal::filter::{Class, FilterError};
use limits::Limits;

/// A criterion.
pub struct Criterion {
    /// What it is called.
    pub name: &'static str,
    /// What its limits and values are shown in.
    pub unit: &'static str,
    /// SI value of that unit.
    scale: f64,
    /// By which its signals are filtered.
    pub filter: Class,
    measure: Measure,
}

/// What a criterion is of its signals, by the names of their places.
enum Measure {
    /// Of a resultant acceleration.
    Resultant(&'static str, Response),
    /// Of one signal, with its sign.
    Of(&'static str, f64, Response),
    /// Of the neck.
    Nij,
    /// The moment about the joint of head and neck that bends the head back.
    NeckExtension,
    /// Of the chest's deflection.
    Viscous,
}

const fn criterion(
    name: &'static str,
    (unit, scale): (&'static str, f64),
    filter: Class,
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
const CLIP: Response = Response::Clip { duration: 3e-3 };

/// All criteria.
pub const CRITERIA: [Criterion; 13] = {
    use Class::{Cfc180, Cfc600, Cfc1000};
    use Measure::{NeckExtension, Nij, Of, Resultant, Viscous};
    use Response::{Hic, Magnitude, Peak};
    [
        criterion(
            "HIC15",
            PURE,
            Cfc1000,
            Resultant("head", Hic { window: 15e-3 }),
        ),
        criterion(
            "HIC36",
            PURE,
            Cfc1000,
            Resultant("head", Hic { window: 36e-3 }),
        ),
        criterion("head 3 ms", G, Cfc1000, Resultant("head", CLIP)),
        criterion("Nij", PURE, Cfc600, Nij),
        criterion("neck tension", NEWTON, Cfc1000, Of("neck-fz", 1.0, Peak)),
        criterion(
            "neck compression",
            NEWTON,
            Cfc1000,
            Of("neck-fz", -1.0, Peak),
        ),
        criterion("neck shear", NEWTON, Cfc1000, Of("neck-fx", 1.0, Magnitude)),
        criterion("neck extension", ("N*m", 1.0), Cfc600, NeckExtension),
        criterion("chest 3 ms", G, Cfc180, Resultant("chest", CLIP)),
        criterion(
            "chest deflection",
            ("mm", 1e-3),
            Cfc180,
            Of("chest-deflection", 1.0, Magnitude),
        ),
        criterion("VC", ("m/s", 1.0), Cfc180, Viscous),
        criterion(
            "femur left",
            NEWTON,
            Cfc600,
            Of("femur-left", 1.0, Magnitude),
        ),
        criterion(
            "femur right",
            NEWTON,
            Cfc600,
            Of("femur-right", 1.0, Magnitude),
        ),
    ]
};

/// A criterion of a recording.
pub struct Judged {
    /// Which.
    pub criterion: &'static Criterion,
    /// Its limit, in the criterion's unit.
    pub limit: f64,
    /// Its value, in the criterion's unit; or why there is none.
    pub value: Result<f64, Missing>,
    /// More about the value, such as the mode of Nij.
    pub detail: String,
}

/// Why a criterion has no value.
#[derive(Clone, Debug, PartialEq)]
pub enum Missing {
    /// There is no channel of this place.
    Channel(String),
    /// Its channel cannot be used.
    Unusable(String),
}

/// All criteria that a regulation limits, of a recording.
pub fn judge(limits: &Limits, places: &Places<'_>) -> Vec<Judged> {
    let limited = CRITERIA
        .iter()
        .filter_map(|criterion| Some((criterion, *limits.limits.get(criterion.name)?)));
    limited
        .map(|(criterion, limit)| {
            let value = criterion.value(limits, places);
            let (value, detail) = match value {
                Ok((value, detail)) => (Ok(value / criterion.scale), detail),
                Err(missing) => (Err(missing), String::new()),
            };
            Judged {
                criterion,
                limit,
                value,
                detail,
            }
        })
        .collect()
}

impl Criterion {
    /// Its value \[SI\], with more about it.
    fn value(&self, limits: &Limits, places: &Places<'_>) -> Result<(f64, String), Missing> {
        let signal = |place: &str| places.filtered(place, self.filter);
        match &self.measure {
            Measure::Resultant(place, response) => {
                let (signal, detail) = places.resultant(place, self.filter)?;
                Ok((of(*response, &signal)?, detail))
            }
            Measure::Of(place, sign, response) => {
                let mut signal = signal(place)?;
                signal.values.iter_mut().for_each(|value| *value *= sign);
                // a tension that there never is is none, and no negative one
                Ok((of(*response, &signal)?.max(0.0), String::new()))
            }
            Measure::Nij => {
                let Some(critical) = &limits.nij else {
                    return Err(Missing::Unusable(
                        "the limits have no critical values".to_owned(),
                    ));
                };
                let neck =
                    places::together([signal("neck-fx")?, signal("neck-fz")?, signal("neck-my")?])?;
                Ok(measures::nij(&neck, critical))
            }
            Measure::NeckExtension => {
                let [shear, moment] = places::together([signal("neck-fx")?, signal("neck-my")?])?;
                let moments = shear.values.iter().zip(&moment.values);
                let moments = moments.map(|(fx, my)| -measures::moment(*fx, *my));
                Ok((moments.fold(0.0, f64::max), String::new()))
            }
            Measure::Viscous => {
                let Some(chest) = &limits.chest else {
                    return Err(Missing::Unusable(
                        "the limits do not describe the chest".to_owned(),
                    ));
                };
                let deflection = signal("chest-deflection")?;
                Ok((measures::viscous(&deflection, chest)?, String::new()))
            }
        }
    }
}

/// A response of a signal.
fn of(response: Response, signal: &Signal) -> Result<f64, Missing> {
    let mut scratch = vec![0.0; response.scratch(signal.values.len())];
    let value = reduce(response, &signal.values, signal.interval, &mut scratch);
    match value.is_finite() {
        true => Ok(value),
        false => Err(Missing::Unusable(
            "the recording is too short for it".to_owned(),
        )),
    }
}

/// Why a filter is not applied.
fn unusable(error: &FilterError) -> Missing {
    Missing::Unusable(error.to_string())
}

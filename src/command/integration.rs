//! The options of the integrator, which several commands have.

use super::Error;
use crate::accuracy::setting::Scheme;
use crate::quantity;
use bryant_runtime::{Formula, Integrator, Tolerances};
use clap::Args;
use clap::builder::PossibleValuesParser;

/// The integrator and its steps.
#[derive(Args, Debug)]
pub struct Integration {
    /// Integrator [default: dopri5, and rodas5 where the scene is stiff; rk4 where --step is given]
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(Formula::ALL.map(Formula::name)))]
    method: Option<String>,

    /// Fixed steps of at most this length; a time [default of rk4 and semi-implicit-euler: 0.1 ms]
    #[arg(long, value_name = "TIME", value_parser = quantity::time, allow_hyphen_values = true)]
    step: Option<f64>,

    /// Relative error allowed in a step; positions (m) and angles (rad) may err by a tenth of it, whatever their size
    /// [default: 1e-7]
    #[arg(long, value_name = "NUMBER", value_parser = quantity::tolerance, allow_hyphen_values = true, conflicts_with = "step")]
    tolerance: Option<f64>,

    /// What steps do at kinks of force laws, where a contact touches or a curve bends: `located` ends steps there,
    /// `passed` steps over them; locating pays at tolerances below about 1e-8
    #[arg(long, value_name = "HOW", default_value = "passed", value_parser = PossibleValuesParser::new(["located", "passed"]))]
    kinks: String,
}

/// Length of fixed steps if the user gives none \[s\]: the usual step of crash simulations.
const CUSTOMARY_STEP: f64 = 1e-4;

impl Integration {
    /// True if the method needs a Jacobian.
    pub fn is_implicit(&self) -> bool {
        self.method.as_deref() == Some(Formula::Rodas5.name())
    }

    /// True if steps end at kinks of force laws.
    pub fn locates_kinks(&self) -> bool {
        self.kinks == "located"
    }

    /// The integrator and its steps; `None` if the user says nothing about them.
    pub fn method(&self) -> Result<Option<Integrator>, Error> {
        let named = self.method.as_deref().and_then(Formula::named);
        Ok(match (named, self.step, self.tolerance) {
            (None, None, None) => None,
            (formula, Some(step), _) => {
                Some(Integrator::fixed(formula.unwrap_or(Formula::Rk4), step))
            }
            (Some(formula), None, tolerance) if !formula.estimates_error() => {
                if tolerance.is_some() {
                    return Err(Error::Input(format!(
                        "{formula} does not estimate its error and so has no tolerance\n  help: use --step, or --tolerance with one of {}",
                        with_tolerances()
                    )));
                }
                Some(Integrator::fixed(formula, CUSTOMARY_STEP))
            }
            (formula, None, tolerance) => {
                let tolerances = tolerance
                    .map_or_else(Tolerances::default, Tolerances::of)
                    .calm();
                Some(match formula {
                    Some(formula) => Integrator::adaptive(formula, tolerances),
                    None => Integrator::switching(Scheme::DEFAULT.formula, tolerances),
                })
            }
        })
    }
}

/// The names of the integrators that estimate their error.
fn with_tolerances() -> String {
    let estimating = Formula::ALL.into_iter().filter(|f| f.estimates_error());
    estimating.map(Formula::name).collect::<Vec<_>>().join(", ")
}

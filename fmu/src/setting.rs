//! How an FMU is integrated.

use bryant_runtime::{Formula, Integrator, Pace, Settings, Tolerances};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::fmt::Write;

/// How an FMU is integrated: the options of a run that its importer does not give.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Setting {
    /// Name of the integrator.
    pub formula: String,
    /// Length of fixed steps \[s\]; `None` for steps under error control.
    pub step: Option<f64>,
    /// Relative error allowed in a step, where the importer gives none; `None` for that of a run.
    pub tolerance: Option<f64>,
    /// Whether the integrator changes where the scene is stiff.
    pub switches: bool,
    /// Whether steps end at kinks of force laws.
    pub locate: bool,
    /// Values of parameters in place of their defaults \[SI\].
    pub parameters: Vec<(String, f64)>,
    /// Time \[s\] and state at the start; `None` for those of the model.
    pub start: Option<(f64, Vec<f64>)>,
    /// Time at which a run usually ends \[s\].
    pub stop: f64,
    /// Usual time between two communications \[s\].
    pub every: f64,
}

impl Setting {
    /// The setting of runs with these settings.
    pub fn of(
        settings: &Settings,
        parameters: Vec<(String, f64)>,
        start: Option<Vec<f64>>,
    ) -> Self {
        let (step, tolerance, switches) = match settings.method.pace {
            Pace::Fixed(step) => (Some(step), None, false),
            Pace::Adaptive(adaptive) => {
                (None, Some(adaptive.tolerances.relative), adaptive.switches)
            }
        };
        Setting {
            formula: settings.method.formula.name().to_owned(),
            step,
            tolerance: tolerance.filter(|&of| of != Tolerances::default().relative),
            switches,
            locate: settings.locate,
            parameters,
            start: start.map(|state| (settings.start, state)),
            stop: settings.duration,
            every: settings.every,
        }
    }

    /// The integrator, with the tolerance of the importer if it gives one; `None` if its name is not known.
    pub fn method(&self, tolerance: Option<f64>) -> Option<Integrator> {
        let formula = Formula::named(&self.formula)?;
        if let Some(step) = self.step {
            return Some(Integrator::fixed(formula, step));
        }
        let tolerance = tolerance.or(self.tolerance);
        let tolerances = tolerance
            .map_or_else(Tolerances::default, Tolerances::of)
            .calm();
        Some(match self.switches {
            true => Integrator::switching(formula, tolerances),
            false => Integrator::adaptive(formula, tolerances),
        })
    }

    /// The start of a run \[s\].
    pub fn begin(&self) -> f64 {
        self.start.as_ref().map_or(0.0, |(t, _)| *t)
    }

    /// The resource of an FMU.
    pub fn written(&self) -> String {
        serde_json::to_string_pretty(self)
            .unwrap_or_else(|error| unreachable!("plain data: {error}"))
    }
}

/// The token by which an importer sees that description and resources belong together: a digest of the resources, as a
/// GUID is written.
pub fn token(engine: &[u8], setting: &str) -> String {
    let digest = Sha256::new()
        .chain_update(engine)
        .chain_update(setting)
        .finalize();
    let mut token = String::from("{");
    for (index, byte) in digest.iter().take(16).enumerate() {
        if [4, 6, 8, 10].contains(&index) {
            token.push('-');
        }
        let _ = write!(token, "{byte:02x}");
    }
    token + "}"
}

//! An instance: values before a run, inputs and outputs of it.

use crate::owned_run::Running;
use crate::setting::{Setting, token};
use crate::variables::{Of, Variable, variables};
use bryant_engine::Engine;
use bryant_runtime::{Dynamics, Info, Refusal, Settings};
use std::path::Path;

/// The resource with the engine.
pub const ENGINE: &str = "model.bryant";

/// The resource with the [`Setting`].
pub const SETTING: &str = "setting.json";

/// The end of a run whose importer gives none \[s\].
const LONG: f64 = 1e9;

/// Times that differ by this share of themselves are the same: importers add lengths of steps.
const ROUNDING: f64 = 1e-12;

/// A message for the importer.
pub type Message = String;

/// An instance of a model.
pub struct Instance {
    engine: Engine,
    setting: Setting,
    variables: Vec<Variable>,
    /// The parameters of the model, with the inputs \[SI\].
    values: Vec<f64>,
    /// Start of the run, its end, and the tolerance, as the importer gives them.
    begin: f64,
    end: Option<f64>,
    tolerance: Option<f64>,
    running: Option<Running>,
    /// What the present values lead to, if they were asked for since the last change.
    shown: Option<Shown>,
}

/// A state with its outputs.
struct Shown {
    t: f64,
    state: Vec<f64>,
    outputs: Vec<f64>,
}

impl Instance {
    /// The instance of an FMU with these resources, if they are those of its description.
    ///
    /// # Errors
    /// Resources that cannot be read, or are not of the description that has this token.
    pub fn new(resources: &Path, expected: &str) -> Result<Self, Message> {
        let read = |name: &str| {
            let path = resources.join(name);
            std::fs::read(&path).map_err(|error| format!("cannot read {}: {error}", path.display()))
        };
        let (engine, setting) = (read(ENGINE)?, read(SETTING)?);
        let setting = String::from_utf8(setting).map_err(|error| format!("{SETTING}: {error}"))?;
        if token(&engine, &setting) != expected {
            return Err(format!(
                "the resources do not belong to the description with the token {expected}"
            ));
        }
        let setting: Setting =
            serde_json::from_str(&setting).map_err(|error| format!("{SETTING}: {error}"))?;
        let engine = Engine::of_kept(&engine).map_err(|error| error.to_string())?;
        if setting.method(None).is_none() {
            return Err(format!("{SETTING}: no integrator {}", setting.formula));
        }
        let info = engine.info();
        let mut instance = Instance {
            variables: variables(info),
            values: Vec::new(),
            begin: setting.begin(),
            end: None,
            tolerance: None,
            running: None,
            shown: None,
            engine,
            setting,
        };
        instance.reset();
        Ok(instance)
    }

    fn info(&self) -> &Info<'_> {
        self.engine.info()
    }

    /// Ends a run, and sets all values to those of the description.
    pub fn reset(&mut self) {
        self.values = starts(self.info(), &self.setting);
        (self.begin, self.end, self.tolerance) = (self.setting.begin(), None, None);
        (self.running, self.shown) = (None, None);
    }

    /// What the importer says of the run to come: start and end \[s\], tolerance.
    ///
    /// # Errors
    /// Times and tolerances that no run has.
    pub fn set_up(
        &mut self,
        begin: f64,
        end: Option<f64>,
        tolerance: Option<f64>,
    ) -> Result<(), Message> {
        if !begin.is_finite() || end.is_some_and(|end| !(end.is_finite() && end > begin)) {
            return Err(format!(
                "no run goes from {begin} s to {} s",
                end.unwrap_or(begin)
            ));
        }
        if tolerance.is_some_and(|tolerance| !(0.0 < tolerance && tolerance < 1.0)) {
            return Err("the tolerance must be above 0 and below 1".to_owned());
        }
        (self.begin, self.end, self.tolerance) = (begin, end, tolerance);
        self.shown = None;
        Ok(())
    }

    /// Begins the run at the values that were set.
    ///
    /// # Errors
    /// Values that the model refuses.
    pub fn begin(&mut self) -> Result<(), Message> {
        let info = self.info();
        let Some(method) = self.setting.method(self.tolerance) else {
            unreachable!("known since the instance was made")
        };
        let settings = Settings {
            start: self.begin,
            duration: self.end.unwrap_or(LONG),
            // nobody but the importer asks for samples
            every: self.end.unwrap_or(LONG),
            method,
            locate: self.setting.locate,
            max_steps: u64::MAX,
            ..Settings::of(info)
        };
        let start = self.setting.start.as_ref().map(|(_, state)| &state[..]);
        let running = Running::new(&self.engine, &self.values, start, &settings);
        self.running = Some(running?);
        self.shown = None;
        self.advance_to(self.begin)
    }

    /// Advances the run from one time to another \[s\].
    ///
    /// # Errors
    /// A time that is not that of the run; no run; a run that fails.
    pub fn step(&mut self, from: f64, length: f64) -> Result<(), Message> {
        let Some(shown) = self.shown.as_ref().filter(|_| self.running.is_some()) else {
            return Err("there is no run: it was not initialised, or it failed".to_owned());
        };
        let trifle = ROUNDING * from.abs().max(length.abs());
        if from.is_nan() || (from - shown.t).abs() > trifle {
            return Err(format!(
                "the run is at {} s, and the step begins at {from} s",
                shown.t
            ));
        }
        if !(length.is_finite() && length > 0.0) {
            return Err(format!("the step has a length of {length} s"));
        }
        // where a run with equal intervals would sample, if that differs by rounding; and the end, if rounding goes
        // past it
        let sum = from + length;
        let every = self.setting.every;
        let multiple = (sum / every).round() * every;
        let target = match (multiple - sum).abs() <= 8.0 * (sum.abs().next_up() - sum.abs()) {
            true => multiple,
            false => sum,
        };
        let target = match self.end {
            Some(end) if (target - end).abs() <= trifle => end,
            _ => target,
        };
        self.advance_to(target)
    }

    fn advance_to(&mut self, t: f64) -> Result<(), Message> {
        let Some(running) = &mut self.running else {
            return Err("there is no run".to_owned());
        };
        match running.advance_to(t) {
            Ok(sample) => {
                self.shown = Some(Shown {
                    t: sample.t,
                    state: sample.state.to_vec(),
                    outputs: sample.outputs.to_vec(),
                });
                Ok(())
            }
            // the last sample stays: it is the last time that was reached
            Err(failure) => Err(failure.to_string()),
        }
    }

    /// Ends the run; returns why it cannot be trusted.
    pub fn end(&mut self) -> Vec<Message> {
        self.running.take().map_or_else(Vec::new, Running::end)
    }

    /// The time reached \[s\].
    pub fn time(&self) -> f64 {
        self.shown.as_ref().map_or(self.begin, |shown| shown.t)
    }

    /// Reads variables.
    ///
    /// # Errors
    /// A value reference that is none; values that the model refuses.
    pub fn get(&mut self, references: &[u32], values: &mut [f64]) -> Result<(), Message> {
        for (&reference, value) in references.iter().zip(values) {
            *value = match self.of(reference)? {
                None => self.time(),
                Some(Of::Parameter(index) | Of::Input(index)) => self.values[index],
                Some(Of::Output(index)) => self.show()?.outputs[index],
                Some(Of::State(index)) => self.show()?.state[index],
            };
        }
        Ok(())
    }

    /// What a value reference stands for; `None` for the time.
    fn of(&self, reference: u32) -> Result<Option<Of>, Message> {
        let Some(index) = (reference as usize).checked_sub(1) else {
            return Ok(None);
        };
        let variable = self.variables.get(index);
        let variable =
            variable.ok_or_else(|| format!("there is no value reference {reference}"))?;
        Ok(Some(variable.of))
    }

    /// State and outputs at the present values.
    fn show(&mut self) -> Result<&Shown, Message> {
        let engine = &self.engine;
        let info = engine.info();
        let shown = match (self.shown.take(), &self.running) {
            (Some(shown), _) => shown,
            (None, Some(_)) => return Err("the run could not begin".to_owned()),
            (None, None) => {
                let mut model = engine.in_double();
                model.set_parameters(&self.values);
                if let Some(refusal) = Refusal::of(&*model as &dyn Dynamics<f64>) {
                    return Err(words(info, refusal));
                }
                let mut state = vec![0.0; info.state_length()];
                match &self.setting.start {
                    Some((_, start)) => state.copy_from_slice(start),
                    None => model.initial_state(&mut state),
                }
                let mut outputs = vec![0.0; info.outputs.len()];
                model.outputs(self.begin, &state, &mut outputs);
                Shown {
                    t: self.begin,
                    state,
                    outputs,
                }
            }
        };
        Ok(self.shown.insert(shown))
    }

    /// Sets variables.
    ///
    /// # Errors
    /// A value reference that is none; what is no parameter or input; a parameter during a run; a value that the model
    /// refuses. Nothing is set then.
    pub fn set(&mut self, references: &[u32], values: &[f64]) -> Result<(), Message> {
        let info = self.engine.info();
        let mut wanted = self.values.clone();
        for (&reference, &value) in references.iter().zip(values) {
            let name = || self.variables[reference as usize - 1].name.clone();
            let index = match self.of(reference)? {
                Some(Of::Input(index)) => index,
                Some(Of::Parameter(index)) if self.running.is_none() => index,
                Some(Of::Parameter(_)) => {
                    return Err(format!("{} is constant during a run", name()));
                }
                None => return Err("the time cannot be set".to_owned()),
                Some(_) => return Err(format!("{} is no parameter and no input", name())),
            };
            let of = &info.parameters[index];
            if !value.is_finite() {
                return Err(words(info, Refusal::NotFinite(index, value)));
            }
            if !(of.min..=of.max).contains(&value) {
                return Err(words(info, Refusal::OutOfLimits(index, value)));
            }
            wanted[index] = value;
        }
        if let Some(running) = &self.running {
            let inputs: Vec<f64> = info.inputs().map(|index| wanted[index]).collect();
            let refused = |refusal| words(info, refusal);
            running.set_inputs(&inputs).map_err(refused)?;
            if let Some(shown) = &mut self.shown {
                running
                    .driven()
                    .outputs(shown.t, &shown.state, &mut shown.outputs);
            }
        } else {
            self.shown = None;
        }
        self.values = wanted;
        Ok(())
    }
}

/// The values of parameters and inputs at the start \[SI\].
pub fn starts(info: &Info, setting: &Setting) -> Vec<f64> {
    let of = |parameter: &bryant_runtime::ParameterInfo| {
        let mut set = setting.parameters.iter();
        set.find(|(name, _)| name == parameter.name)
            .map_or(parameter.default, |(_, value)| *value)
    };
    info.parameters.iter().map(of).collect()
}

fn words(info: &Info<'_>, refusal: Refusal) -> Message {
    let mut words = String::new();
    let _ = refusal.write(info, &mut words);
    words
}

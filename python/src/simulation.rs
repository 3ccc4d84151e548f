//! A run with error control that is driven from outside: it is advanced from time to time, and its inputs change
//! between.

use crate::arrays::{Array, Filled};
use crate::model::Model;
use crate::wrong;
use bryant_engine::Engine;
use bryant_runtime::program::Finding;
use bryant_runtime::simulate::{Driven, Run, Watch, workspace_length};
use bryant_runtime::{Pace, Settings, Tolerances};
use pyo3::prelude::*;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Mutex, PoisonError};

/// Share of energy that may be missing in the balance of a run.
const SHARE: f64 = 0.02;

/// A time that no run reaches [s].
const LONG: f64 = 1e9;

/// A run, on a thread of its own, which waits for times to advance to.
#[pyclass(frozen)]
pub struct Simulation {
    outputs: usize,
    inputs: usize,
    lines: Mutex<Option<Lines>>,
}

struct Lines {
    ask: Sender<Ask>,
    answer: Receiver<Result<Answer, String>>,
}

/// The inputs from now on, and the time to advance to.
struct Ask {
    inputs: Option<Vec<f64>>,
    time: f64,
}

/// What a run says at a time; at its end, why it cannot be trusted.
#[derive(Default)]
struct Answer {
    time: f64,
    state: Vec<f64>,
    outputs: Vec<f64>,
    steps: u64,
    doubts: Vec<String>,
}

/// Time, state, outputs, steps so far.
type Said<'py> = (f64, Bound<'py, PyAny>, Bound<'py, PyAny>, u64);

#[pymethods]
impl Simulation {
    #[new]
    #[pyo3(signature = (model, state=None, t=0.0, tolerance=1e-7))]
    fn new(
        model: &Bound<'_, Model>,
        state: Option<&Bound<'_, PyAny>>,
        t: f64,
        tolerance: f64,
    ) -> PyResult<Self> {
        let model = model.get();
        let (engine, parameters) = (model.engine().clone(), model.present().clone());
        let info = engine.info();
        let state = state.map(Array::of).transpose()?;
        let state = state.map(|state| state.numbers().to_vec());
        if state
            .as_ref()
            .is_some_and(|state| state.len() != info.state_length())
        {
            return Err(wrong(format!(
                "a state of {} has {} entries",
                info.name,
                info.state_length()
            )));
        }
        let (ask, asked) = channel();
        let (answer, answers) = channel();
        let (outputs, inputs) = (info.outputs.len(), info.inputs().count());
        let run = move || {
            let setting = Setting {
                parameters,
                state,
                time: t,
                tolerance,
            };
            if let Err(message) = run(&engine, setting, &asked, &answer) {
                // nobody may wait any more
                let _ = answer.send(Err(message));
            }
        };
        std::thread::Builder::new().spawn(run).map_err(wrong)?;
        Ok(Simulation {
            outputs,
            inputs,
            lines: Mutex::new(Some(Lines {
                ask,
                answer: answers,
            })),
        })
    }

    /// Sets the inputs, if they are given, and advances to a time.
    #[pyo3(signature = (t, u=None))]
    fn advance<'py>(
        &self,
        py: Python<'py>,
        t: f64,
        u: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Said<'py>> {
        let inputs = match u.map(Array::of).transpose()? {
            None => None,
            Some(u) if u.numbers().len() == self.inputs => Some(u.numbers().to_vec()),
            Some(u) => {
                let (found, inputs) = (u.numbers().len(), self.inputs);
                return Err(wrong(format!(
                    "u must have {inputs} numbers, and has {found}"
                )));
            }
        };
        let answer = py.detach(|| {
            let mut lines = self.lines.lock().unwrap_or_else(PoisonError::into_inner);
            let over = || "the run is over: it has failed before".to_owned();
            let open = lines.as_ref().ok_or_else(over)?;
            open.ask.send(Ask { inputs, time: t }).map_err(|_| over())?;
            let answer = open.answer.recv().map_err(|_| over());
            let answer = answer.and_then(|answer| answer);
            if let Err(message) = &answer
                && !message.starts_with(REFUSED)
            {
                *lines = None;
            }
            answer
        });
        let answer = answer.map_err(|message| wrong(message.trim_start_matches(REFUSED)))?;
        let array = |numbers: &[f64]| -> PyResult<Bound<'py, PyAny>> {
            let mut filled = Filled::new(py, None, &[numbers.len()])?;
            filled.room.numbers_mut()?.copy_from_slice(numbers);
            Ok(filled.array)
        };
        debug_assert_eq!(answer.outputs.len(), self.outputs);
        let (state, outputs) = (array(&answer.state)?, array(&answer.outputs)?);
        Ok((answer.time, state, outputs, answer.steps))
    }

    /// Ends the run, and returns why it cannot be trusted, a sentence each.
    fn finish(&self, py: Python<'_>) -> Vec<String> {
        let mut lines = self.lines.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(Lines { ask, answer }) = lines.take() else {
            return Vec::new();
        };
        drop(ask);
        let answer = Mutex::new(answer);
        let last = || answer.lock().unwrap_or_else(PoisonError::into_inner).recv();
        match py.detach(last) {
            Ok(Ok(last)) => last.doubts,
            _ => Vec::new(),
        }
    }
}

/// Begins a message after which the run goes on.
const REFUSED: &str = "refused: ";

/// How a run begins.
struct Setting {
    parameters: Vec<f64>,
    state: Option<Vec<f64>>,
    time: f64,
    tolerance: f64,
}

/// Runs until nobody asks any more.
fn run(
    engine: &Engine,
    setting: Setting,
    asked: &Receiver<Ask>,
    answer: &Sender<Result<Answer, String>>,
) -> Result<(), String> {
    let mut model = engine.in_double();
    let info = engine.info();
    model.set_parameters(&setting.parameters);
    let mut settings = Settings::of(info);
    settings.start = setting.time;
    // without an end
    (settings.duration, settings.every) = (LONG, LONG);
    if let Pace::Adaptive(adaptive) = &mut settings.method.pace {
        adaptive.tolerances = Tolerances::uniform(setting.tolerance);
    }
    let mut start = vec![0.0; info.state_length()];
    match setting.state {
        Some(state) => start.copy_from_slice(&state),
        None => model.initial_state(&mut start),
    }
    let mut memory = vec![0.0; workspace_length(info, &settings)];
    let mut parameters = vec![0.0; Driven::<f64>::length(info)];
    let model = Driven::new(&mut *model, info, &mut parameters);
    let mut watch = Watch::new(info, SHARE);
    let mut run = Run::driven(&mut memory, &model, &start, &settings, Some(&mut watch))
        .map_err(|failure| failure.to_string())?;
    for ask in asked {
        if let Some(inputs) = &ask.inputs
            && let Err(refusal) = model.set_inputs(inputs)
        {
            let mut words = REFUSED.to_owned();
            let _ = refusal.write(info, &mut words);
            if answer.send(Err(words)).is_err() {
                break;
            }
            continue;
        }
        let sample = run
            .advance_to(ask.time)
            .map_err(|failure| failure.to_string())?;
        let said = Answer {
            time: sample.t,
            state: sample.state.to_vec(),
            outputs: sample.outputs.to_vec(),
            steps: 0,
            ..Answer::default()
        };
        let said = Answer {
            steps: run.report().steps,
            ..said
        };
        if answer.send(Ok(said)).is_err() {
            break;
        }
    }
    let words = |finding: Finding| match finding.remedy.as_str() {
        "" => finding.message,
        remedy => format!("{}: {remedy}", finding.message),
    };
    let doubts = watch.diagnostics().map(Finding::from).map(words).collect();
    let last = Answer {
        doubts,
        ..Answer::default()
    };
    // it may be that nobody asks
    let _ = answer.send(Ok(last));
    Ok(())
}

//! A model at many states, as arrays.

use crate::arrays::{Array, Filled, Shape};
use crate::wrong;
use bryant_engine::Engine;
use bryant_engine::batch::{Batch, Hold, Rollout, Rows, Wanted};
use bryant_generator::{Config, model};
use bryant_runtime::{Info, Section};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::collections::HashMap;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

/// The ending of files with derived equations.
const KEPT: &str = ".bryant";

/// Number of rows from which other threads of Python may run meanwhile. For fewer, waiting for them would take longer
/// than the rows do.
const MANY: usize = 8;

/// The equations of a model as machine code.
#[pyclass(frozen, subclass)]
pub struct Model {
    /// The description; `None` where the engine was kept in a file.
    model: Option<model::Model>,
    pool: Pool,
    /// The functions that were asked for, by name, each derived when it was asked for first.
    functions: Mutex<HashMap<String, Arc<Pool>>>,
    /// The values of all parameters [SI].
    parameters: Mutex<Vec<f64>>,
}

/// An engine, with room for calls.
struct Pool {
    engine: Engine,
    idle: Mutex<Idle>,
}

/// Models that no thread uses now, each with its number of threads. Calls on several threads of Python take one each.
#[derive(Default)]
struct Idle {
    batches: Vec<(usize, Box<Batch>)>,
    /// Counts the changes of parameters: a model that was taken before the last one is not put back.
    changes: u64,
}

/// A model that a call uses.
struct Taken {
    batch: Box<Batch>,
    threads: usize,
    changes: u64,
}

impl Pool {
    fn new(engine: Engine) -> Self {
        Pool {
            engine,
            idle: Mutex::default(),
        }
    }

    fn idle(&self) -> std::sync::MutexGuard<'_, Idle> {
        self.idle.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A batch for so many threads, with these parameters, which were accepted before.
    fn take(&self, threads: usize, parameters: &Mutex<Vec<f64>>) -> Taken {
        let mut idle = self.idle();
        let changes = idle.changes;
        let found = idle.batches.iter().position(|(of, _)| *of == threads);
        let found = found.map(|found| idle.batches.swap_remove(found).1);
        drop(idle);
        let batch = found.unwrap_or_else(|| {
            let mut batch = Box::new(self.engine.batch(threads));
            let values = parameters.lock().unwrap_or_else(PoisonError::into_inner);
            let _ = batch.set_parameters(&values);
            batch
        });
        Taken {
            batch,
            threads,
            changes,
        }
    }

    fn put_back(&self, taken: Taken) {
        let mut idle = self.idle();
        if idle.changes == taken.changes {
            idle.batches.push((taken.threads, taken.batch));
        }
    }

    /// Drops all models, because the parameters have changed.
    fn forget(&self) {
        let mut idle = self.idle();
        idle.changes += 1;
        idle.batches.clear();
    }
}

/// A name, a unit, a default, the limits, and whether it is an input.
type Parameter<'a> = (&'a str, &'a str, f64, f64, f64, bool);

#[pymethods]
impl Model {
    /// The model of a file: YAML, URDF, or one that `keep` made; or a bundled one, by name.
    #[new]
    fn new(py: Python<'_>, path: &str) -> PyResult<Self> {
        py.detach(|| {
            if path.ends_with(KEPT) {
                let content = std::fs::read(path);
                let content = content.map_err(|error| wrong(format!("{path}: {error}")))?;
                let engines = Engine::all_of_kept(&content);
                let engines = engines.map_err(|error| wrong(format!("{path}: {error}")))?;
                return Ok(Self::of(engines, None));
            }
            let model = match bryant::bundled::find(path) {
                Some(bundled) => bryant::bundled::model(bundled).map_err(wrong)?,
                None => bryant_generator::read(Path::new(path)).map_err(wrong)?.0,
            };
            let engine = Engine::of(&model, &Config::new()).map_err(wrong)?;
            Ok(Self::of(vec![engine], Some(model)))
        })
    }

    /// The content of a file with the derived equations, and these functions.
    fn derived(&self, py: Python<'_>, functions: Vec<String>) -> PyResult<Vec<u8>> {
        py.detach(|| {
            let Some(model) = &self.model else {
                return Err(wrong("the equations are from a kept file: copy that"));
            };
            // each function by itself, so that all have the bits that they have here
            let mut content = self.pool.engine.keep();
            for name in &functions {
                content.extend(of_function(model, name)?.keep());
            }
            Ok(content)
        })
    }

    #[getter]
    fn name(&self) -> &str {
        self.pool.engine.info().name
    }

    #[getter]
    fn digest(&self) -> &str {
        self.pool.engine.info().digest
    }

    #[getter]
    fn arithmetic(&self) -> &'static str {
        self.pool.engine.arithmetic()
    }

    /// Names and units of q, v, z and m.
    #[getter]
    fn state(&self) -> [Vec<(&str, &str)>; 4] {
        let info = self.pool.engine.info();
        let mut from = 0;
        [
            info.coordinates,
            info.velocities,
            info.auxiliaries,
            info.memory,
        ]
        .map(|names| {
            let units = (from..).map(|index| info.state_unit(index).unwrap_or(""));
            from += names.len();
            names.iter().copied().zip(units).collect()
        })
    }

    #[getter]
    fn outputs_named(&self) -> Vec<(&str, &str)> {
        let outputs = self.pool.engine.info().outputs.iter();
        outputs.map(|of| (of.name, of.unit)).collect()
    }

    #[getter]
    fn parameters_named(&self) -> Vec<Parameter<'_>> {
        let parameters = self.pool.engine.info().parameters.iter();
        let facts = parameters.map(|of| (of.name, of.unit, of.default, of.min, of.max, of.input));
        facts.collect()
    }

    /// The values of all parameters [SI].
    #[getter]
    fn values(&self) -> Vec<f64> {
        self.present().clone()
    }

    /// Sets all parameters [SI].
    #[setter]
    fn set_values(&self, values: Vec<f64>) -> PyResult<()> {
        let mut taken = self.pool.take(1, &self.parameters);
        taken.batch.set_parameters(&values).map_err(wrong)?;
        *self.present() = values;
        self.pool.forget();
        let functions = self
            .functions
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        functions.values().for_each(|pool| pool.forget());
        Ok(())
    }

    /// q, v, z and m with which a run begins.
    fn begin(&self) -> [Vec<f64>; 4] {
        let mut model = self.pool.engine.in_double();
        model.set_parameters(&self.present());
        let info = self.pool.engine.info();
        let mut y = vec![0.0; info.state_length()];
        model.initial_state(&mut y);
        let mut rest = &y[..];
        [
            info.coordinates,
            info.velocities,
            info.auxiliaries,
            info.memory,
        ]
        .map(|names| {
            let (mine, behind) = rest.split_at(names.len());
            rest = behind;
            mine.to_vec()
        })
    }

    /// Accelerations v̇ at one state (n,) or at many (states, n). u: the inputs of the model, or the parameters that
    /// `vary` names, for each. states: z and m of force laws, where the model has any; as at the start of a run if left
    /// out. out: an array for the results. threads: a number of threads.
    #[pyo3(signature = (q, v, u=None, states=None, t=0.0, vary=None, out=None, threads=1))]
    #[expect(clippy::too_many_arguments, reason = "those of a function of Python")]
    fn accelerations<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        v: &Bound<'py, PyAny>,
        u: Option<&Bound<'py, PyAny>>,
        states: Option<&Bound<'py, PyAny>>,
        t: f64,
        vary: Option<Vec<String>>,
        out: Option<&Bound<'py, PyAny>>,
        threads: usize,
    ) -> PyResult<Bound<'py, PyAny>> {
        let what = "accelerations";
        self.evaluate(py, what, q, Some(v), u, states, t, vary, out, threads, None)
    }

    /// Evaluates `what` at rows of states: see `accelerations`. `what` is a section, or a function that is derived when
    /// it is asked for first; a: accelerations that functions need.
    #[pyo3(signature = (what, q, v, u=None, states=None, t=0.0, vary=None, out=None, threads=1, a=None))]
    #[expect(clippy::too_many_arguments, reason = "those of a function of Python")]
    fn evaluate<'py>(
        &self,
        py: Python<'py>,
        what: &str,
        q: &Bound<'py, PyAny>,
        v: Option<&Bound<'py, PyAny>>,
        u: Option<&Bound<'py, PyAny>>,
        states: Option<&Bound<'py, PyAny>>,
        t: f64,
        vary: Option<Vec<String>>,
        out: Option<&Bound<'py, PyAny>>,
        threads: usize,
        a: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let asked = match wanted(what) {
            Some(wanted) => (None, wanted),
            None => (Some(self.asked(py, what)?), Wanted::Function(0)),
        };
        let (pool, wanted) = (asked.0.as_deref().unwrap_or(&self.pool), asked.1);
        let info = pool.engine.info();
        let given = Given::of(info, q, v, u, states, a)?;
        let vary = vary.map(|names| self.indices(&names)).transpose()?;
        let mut taken = pool.take(threads, &self.parameters);
        let batch = &mut taken.batch;
        if let Some(vary) = &vary {
            batch.vary(vary);
        }
        let freedoms = info.velocities.len();
        let mut shape = match wanted {
            Wanted::MassMatrix => given.leading.and(&[freedoms, freedoms]),
            Wanted::Section(Section::KineticEnergy) => given.leading,
            Wanted::Function(index) => {
                let function = &pool.engine.functions()[index];
                let sides = [function.rows.len(), function.columns.len()];
                // a column, and a single number, have no second dimension
                given.leading.and(match sides {
                    [1, 1] => &sides[..0],
                    [_, 1] => &sides[..1],
                    _ => &sides[..],
                })
            }
            _ => given.leading.and(&[batch.length(wanted)]),
        };
        // one number is that of an array of one
        let alone = shape.is_empty();
        if alone {
            shape = shape.and(&[1]);
        }
        let mut filled = Filled::new(py, out, &shape)?;
        given.apart_from(&filled.room)?;
        let results = filled.room.numbers_mut()?;
        let mut work = || batch.evaluate(wanted, &given.rows(t), results);
        let done = match given.count >= MANY {
            true => py.detach(work),
            false => work(),
        };
        if vary.is_none() {
            pool.put_back(taken);
        }
        done.map_err(wrong)?;
        match alone {
            true => filled.array.get_item(0),
            false => Ok(filled.array),
        }
    }

    /// The names of the rows and columns of a function.
    fn names_of(&self, py: Python<'_>, what: &str) -> PyResult<(Vec<String>, Vec<String>)> {
        let asked = self.asked(py, what)?;
        let function = &asked.engine.functions()[0];
        Ok((function.rows.clone(), function.columns.clone()))
    }

    /// Takes `steps` steps from rows of states. Returns the states after each step, or its outputs.
    #[pyo3(signature = (q, v, dt, steps, u=None, states=None, t=0.0, parts=1, linear=false, outputs=false, vary=None, out=None, threads=1))]
    #[expect(clippy::too_many_arguments, reason = "those of a function of Python")]
    fn march<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        v: &Bound<'py, PyAny>,
        dt: f64,
        steps: usize,
        u: Option<&Bound<'py, PyAny>>,
        states: Option<&Bound<'py, PyAny>>,
        t: f64,
        parts: usize,
        linear: bool,
        outputs: bool,
        vary: Option<Vec<String>>,
        out: Option<&Bound<'py, PyAny>>,
        threads: usize,
    ) -> PyResult<Bound<'py, PyAny>> {
        if !(dt.is_finite() && dt > 0.0) || parts == 0 {
            return Err(PyValueError::new_err(
                "dt must be positive and finite, and parts at least 1",
            ));
        }
        let info = self.pool.engine.info();
        let given = Given::of(info, q, Some(v), u, states, None)?;
        let rollout = Rollout {
            step: dt,
            steps,
            parts,
            hold: if linear { Hold::Linear } else { Hold::Constant },
        };
        let length = match outputs {
            true => info.outputs.len(),
            false => info.state_length(),
        };
        let shape = given.leading.and(&[steps, length]);
        let mut filled = Filled::new(py, out, &shape)?;
        given.apart_from(&filled.room)?;
        let results = filled.room.numbers_mut()?;
        let (to_states, to_outputs) = match outputs {
            true => (&mut [][..], results),
            false => (results, &mut [][..]),
        };
        let vary = vary.map(|names| self.indices(&names)).transpose()?;
        let mut taken = self.pool.take(threads, &self.parameters);
        let batch = &mut taken.batch;
        if let Some(vary) = &vary {
            batch.vary(vary);
        }
        let done = py.detach(|| batch.rollout(&rollout, &given.rows(t), to_states, to_outputs));
        if vary.is_none() {
            self.pool.put_back(taken);
        }
        done.map_err(wrong)?;
        Ok(filled.array)
    }
}

impl Model {
    pub fn engine(&self) -> &Engine {
        &self.pool.engine
    }

    pub fn present(&self) -> std::sync::MutexGuard<'_, Vec<f64>> {
        self.parameters
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
    }

    /// Indices of parameters.
    fn indices(&self, names: &[String]) -> PyResult<Vec<usize>> {
        let parameters = self.pool.engine.info().parameters;
        let place = |name: &String| {
            let found = parameters.iter().position(|of| of.name == name);
            found.ok_or_else(|| {
                let all: Vec<&str> = parameters.iter().map(|of| of.name).collect();
                PyValueError::new_err(format!(
                    "there is no parameter {name}; there are {}",
                    all.join(", ")
                ))
            })
        };
        names.iter().map(place).collect()
    }

    /// A model at the default values of its parameters, by its engine, and those of functions.
    fn of(engines: Vec<Engine>, model: Option<model::Model>) -> Self {
        let mut engines = engines.into_iter();
        let Some(engine) = engines.next() else {
            unreachable!("a file has an engine or is refused")
        };
        let mut functions = HashMap::new();
        for engine in engines {
            for function in engine.functions() {
                let pool = Arc::new(Pool::new(engine.clone()));
                functions.insert(function.name.clone(), pool);
            }
        }
        let parameters = engine.info().parameters.iter().map(|of| of.default);
        Model {
            parameters: Mutex::new(parameters.collect()),
            functions: Mutex::new(functions),
            pool: Pool::new(engine),
            model,
        }
    }

    /// The engine of a function, which is derived when it is asked for first.
    fn asked(&self, py: Python<'_>, what: &str) -> PyResult<Arc<Pool>> {
        let functions = || {
            self.functions
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
        };
        if let Some(found) = functions().get(what) {
            return Ok(found.clone());
        }
        let Some(model) = &self.model else {
            return Err(wrong(format!(
                "{what} was not kept with these equations: keep it with the model, or load the description"
            )));
        };
        let engine = py.detach(|| of_function(model, what))?;
        let derived = Arc::new(Pool::new(engine));
        functions().insert(what.to_owned(), derived.clone());
        Ok(derived)
    }
}

/// The engine of one function.
fn of_function(model: &model::Model, name: &str) -> PyResult<Engine> {
    let mut config = Config::new();
    config.matrices(false).functions([name]);
    config.requests(model, &model.name).map_err(wrong)?;
    Engine::of(model, &config).map_err(wrong)
}

/// The arrays of a call.
struct Given {
    q: Array,
    v: Option<Array>,
    u: Option<Array>,
    states: Option<Array>,
    a: Option<Array>,
    /// v where it was not given.
    zeros: Vec<f64>,
    /// The dimensions before the last one: none for one state, one for several.
    leading: Shape,
    count: usize,
}

impl Given {
    fn of(
        info: &Info,
        q: &Bound<'_, PyAny>,
        v: Option<&Bound<'_, PyAny>>,
        u: Option<&Bound<'_, PyAny>>,
        states: Option<&Bound<'_, PyAny>>,
        a: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let (q, v) = (Array::of(q)?, v.map(Array::of).transpose()?);
        let leading = match q.shape() {
            [length] if *length == info.coordinates.len() => Shape::default(),
            [count, length] if *length == info.coordinates.len() => Shape::default().and(&[*count]),
            other => {
                let n = info.coordinates.len();
                return Err(PyValueError::new_err(format!(
                    "q must have the shape ({n},) or (states, {n}), and has {other:?}: the coordinates are {}",
                    info.coordinates.join(", ")
                )));
            }
        };
        let count = leading.first().copied().unwrap_or(1);
        if let Some(v) = &v {
            let expected = &leading.and(&[info.velocities.len()])[..];
            if v.shape() != expected {
                return Err(PyValueError::new_err(format!(
                    "v must have the shape {expected:?}, as q has, and has {:?}: the velocities are {}",
                    v.shape(),
                    info.velocities.join(", ")
                )));
            }
        }
        Ok(Given {
            zeros: match v {
                Some(_) => Vec::new(),
                None => vec![0.0; count * info.velocities.len()],
            },
            q,
            v,
            u: u.map(Array::of).transpose()?,
            states: states.map(Array::of).transpose()?,
            a: a.map(Array::of).transpose()?,
            leading,
            count,
        })
    }

    /// Fails if results would be written to numbers that are still read.
    fn apart_from(&self, results: &Array) -> PyResult<()> {
        let (v, u) = (self.v.as_ref(), self.u.as_ref());
        let given = [
            ("q", Some(&self.q)),
            ("v", v),
            ("u", u),
            ("states", self.states.as_ref()),
            ("a", self.a.as_ref()),
        ];
        let shared =
            |(_, array): &(&str, Option<&Array>)| array.is_some_and(|one| one.overlaps(results));
        match given.into_iter().find(shared) {
            None => Ok(()),
            Some((name, _)) => Err(PyValueError::new_err(format!(
                "the array for results shares memory with {name}: give another one, or a copy of {name}"
            ))),
        }
    }

    fn rows(&self, time: f64) -> Rows<'_> {
        Rows {
            time,
            coordinates: self.q.numbers(),
            velocities: self.v.as_ref().map_or(&self.zeros, Array::numbers),
            states: self.states.as_ref().map_or(&[], Array::numbers),
            accelerations: self.a.as_ref().map_or(&[], Array::numbers),
            inputs: self.u.as_ref().map_or(&[], Array::numbers),
        }
    }
}

/// What every model has, by name; `None` for a function.
fn wanted(what: &str) -> Option<Wanted> {
    Some(match what {
        "accelerations" => Wanted::Accelerations,
        "rates" => Wanted::Rates,
        "mass_matrix" => Wanted::MassMatrix,
        "velocity_forces" => Wanted::VelocityForces,
        "applied_forces" => Wanted::AppliedForces,
        _ => {
            let mut sections = Section::ALL.iter();
            return sections
                .find(|section| section.name() == what)
                .map(|section| Wanted::Section(*section));
        }
    })
}

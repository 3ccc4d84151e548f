//! Many states of one model at once: rates, sections, matrices, and rollouts in steps of one length.
//!
//! Rows become lanes of the widest registers that the processor has, and are shared among threads. A row has the same
//! bits whatever its neighbours are, however many there are, and on however many threads.

mod lanes;

use crate::model::{Engine, Evaluated, Varying};
use bryant_generator::program::{Function, Method};
use bryant_runtime::real::lanes::with_width;
use bryant_runtime::{Adjustable, Dynamics, Info, Refusal, Section, Width};
use lanes::{Lanes, Make};
use std::ops::Range;

/// States of one model, as slices of equally long rows, one after the other.
#[derive(Clone, Copy, Debug, Default)]
pub struct Rows<'a> {
    /// t \[s\], for all rows.
    pub time: f64,
    /// q: as many as [`Info::coordinates`] for each row.
    pub coordinates: &'a [f64],
    /// v: as many as [`Info::velocities`] for each row.
    pub velocities: &'a [f64],
    /// z and m: as many as [`Info::auxiliaries`] and [`Info::memory`] for each row. If empty, each row has those with
    /// which a run starts.
    pub states: &'a [f64],
    /// a: accelerations that functions need, as many as [`Info::velocities`] for each row. If empty, they are 0.
    pub accelerations: &'a [f64],
    /// The varying parameters \[SI\], as many as [`Batch::vary`] names for each row. If empty, each row has the values
    /// of [`Batch::set_parameters`].
    pub inputs: &'a [f64],
}

/// What to compute at each row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wanted {
    /// ẏ: the rates of q, v, z and m.
    Rates,
    /// v̇.
    Accelerations,
    /// A section.
    Section(Section),
    /// A [function](Engine::functions) that was asked for when the engine was made, by its index.
    Function(usize),
    /// S, all of its entries, by rows. The engine must have been made with matrices.
    MassMatrix,
    /// r_s. The engine must have been made with matrices.
    VelocityForces,
    /// r_k. The engine must have been made with matrices.
    AppliedForces,
}

/// How inputs go from one step to the next.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Hold {
    /// The inputs of step k are held until step k + 1. Each row has inputs for every step.
    #[default]
    Constant,
    /// The inputs go linearly from those at the beginning of step k to those at its end. Each row has inputs for every
    /// step, and then those at the end of the last one.
    Linear,
}

/// A rollout: steps of one length from each row, by the classical Runge–Kutta method, as
/// [`march`](bryant_runtime::integrate::march()) takes them. Steps pass over kinks and events; for steps with error
/// control that end at events, use a [`Run`](bryant_runtime::simulate::Run).
#[derive(Clone, Copy, Debug)]
pub struct Rollout {
    /// Length of a step \[s\].
    pub step: f64,
    /// Number of steps. Inputs may change at each, and each is recorded.
    pub steps: usize,
    /// Number of equal parts in which a step is computed, at least 1.
    pub parts: usize,
    /// How inputs go from step to step.
    pub hold: Hold,
}

/// Why rows were not computed. Nothing is written then.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Misfit {
    /// A slice has another length than the rows need.
    Length {
        /// The slice.
        what: &'static str,
        /// The length that it has.
        found: usize,
        /// The length that it must have.
        needed: usize,
    },
    /// The parameters of a row are refused.
    Refused {
        /// The row; for a rollout the row of inputs.
        row: usize,
        /// Why.
        refusal: Refusal,
        /// Why, in words.
        message: String,
    },
    /// The engine was made without what is wanted.
    Missing {
        /// What it lacks.
        what: &'static str,
    },
}

impl std::fmt::Display for Misfit {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Misfit::Length {
                what,
                found,
                needed,
            } => write!(f, "{what} must have {needed} numbers, and has {found}"),
            Misfit::Refused { row, message, .. } => write!(f, "row {row}: {message}"),
            Misfit::Missing { what } => write!(f, "the engine was made without {what}"),
        }
    }
}

impl std::error::Error for Misfit {}

/// Number of rows whose inputs are compared with their limits at once, so that registers are full.
const REPEATED: usize = 8;

/// A model at many states. It is made once; calls allocate nothing, except that a call on several
/// threads starts them, and that a refusal is put into words.
pub struct Batch {
    /// The parameters that each row has.
    varying: Varying,
    /// The least value that each of them may have, and the greatest, for [`REPEATED`] rows; finite, so that other
    /// values are beyond them.
    limits: [Vec<f64>; 2],
    /// All parameters \[SI\].
    parameters: Vec<f64>,
    /// Whether the engine has S, r_s and r_k.
    matrices: bool,
    /// The number of results of each function.
    functions: Vec<usize>,
    /// Whether values of the varying parameters may break a condition of the model.
    conditional: bool,
    /// The model over one number, which checks conditions.
    checks: Evaluated<f64>,
    workers: Vec<Worker>,
}

/// The model for one thread: for one row, and for a register full.
struct Worker {
    one: Box<dyn Lanes>,
    many: Box<dyn Lanes>,
}

impl Worker {
    fn of(&mut self, rows: usize) -> &mut dyn Lanes {
        match rows {
            1 => &mut *self.one,
            _ => &mut *self.many,
        }
    }

    fn both(&mut self) -> [&mut dyn Lanes; 2] {
        [&mut *self.one, &mut *self.many]
    }
}

impl std::fmt::Debug for Batch {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Batch")
            .field("model", &self.info().name)
            .field("threads", &self.workers.len())
            .finish_non_exhaustive()
    }
}

impl Engine {
    /// The model at many states, on `threads` threads (at least one). The inputs of the model are the parameters that
    /// vary from row to row, until [`Batch::vary`] names others.
    pub fn batch(&self, threads: usize) -> Batch {
        let info = self.info();
        let made = |width| -> Box<dyn Lanes> {
            with_width(width, Make(self)).unwrap_or_else(|| unreachable!("the width is there"))
        };
        let worker = |_| Worker {
            // a row alone has the bits of a lane
            one: made(Width::One),
            many: made(Width::widest()),
        };
        let mut batch = Batch {
            varying: Varying::default(),
            limits: Default::default(),
            parameters: info.parameters.iter().map(|of| of.default).collect(),
            matrices: !self.lists().list(Method::MassMatrix).results.is_empty(),
            functions: lengths(self.functions()),
            conditional: false,
            checks: self.over(),
            workers: (0..threads.max(1)).map(worker).collect(),
        };
        batch.vary(&info.inputs().collect::<Vec<_>>());
        batch
    }
}

impl Batch {
    /// Names, units and sizes.
    pub fn info(&self) -> &Info<'_> {
        self.checks.info()
    }

    /// The parameters that vary from row to row, as indices into [`Info::parameters`].
    pub fn varying(&self) -> &[usize] {
        self.varying.indices()
    }

    /// Names the parameters that vary from row to row, as indices into [`Info::parameters`]: inputs, or any others.
    ///
    /// # Panics
    /// If the model has no parameter with one of these indices.
    pub fn vary(&mut self, parameters: &[usize]) {
        assert!(
            parameters
                .iter()
                .all(|of| *of < self.info().parameters.len()),
            "parameters of {}",
            self.info().name
        );
        self.varying = self.checks.varying(parameters);
        let limits = parameters.iter().map(|index| {
            let of = &self.info().parameters[*index];
            match of.input {
                true => (of.min.max(f64::MIN), of.max.min(f64::MAX)),
                false => (f64::MIN, f64::MAX),
            }
        });
        let (low, high): (Vec<f64>, Vec<f64>) = limits.unzip();
        self.limits = [low, high].map(|limits| limits.repeat(REPEATED));
        self.conditional = self.checks.depends(Method::Conditions, parameters);
        // the values of a row that was refused stay in it until then
        self.checks.set_parameters(&self.parameters);
        for worker in &mut self.workers {
            for lanes in worker.both() {
                lanes.vary(parameters);
            }
        }
        self.forward_parameters();
    }

    /// Sets all parameters \[SI\], in the order of [`Info::parameters`], for all rows.
    ///
    /// # Errors
    /// Another number of values than there are parameters, or values that are refused; nothing is set then.
    pub fn set_parameters(&mut self, values: &[f64]) -> Result<(), Misfit> {
        fits("parameters", values.len(), self.parameters.len())?;
        for (index, &value) in values.iter().enumerate() {
            let refused = |refusal| self.refused(0, refusal);
            self.allowed(index, value).map_err(refused)?;
        }
        self.checks.set_parameters(values);
        if let Some(condition) = self.checks.violated() {
            self.checks.set_parameters(&self.parameters);
            return Err(self.refused(0, Refusal::Condition(condition)));
        }
        self.parameters.copy_from_slice(values);
        self.forward_parameters();
        Ok(())
    }

    fn forward_parameters(&mut self) {
        for worker in &mut self.workers {
            for lanes in worker.both() {
                lanes.set_parameters(&self.parameters);
            }
        }
    }

    /// The number of results for each row.
    ///
    /// # Panics
    /// If there is no function of this index.
    pub fn length(&self, wanted: Wanted) -> usize {
        let freedoms = self.info().velocities.len();
        match wanted {
            Wanted::Rates => self.info().state_length(),
            Wanted::MassMatrix => freedoms * freedoms,
            Wanted::Section(section) => self.info().length(section),
            Wanted::Function(index) => self.functions[index],
            _ => freedoms,
        }
    }

    /// Computes something at each row, and writes it to `results`, row by row.
    ///
    /// # Errors
    /// If the slices do not fit, or if parameters of a row are refused.
    ///
    /// # Panics
    /// If there is no function of this index.
    pub fn evaluate(
        &mut self,
        wanted: Wanted,
        rows: &Rows<'_>,
        results: &mut [f64],
    ) -> Result<(), Misfit> {
        let of_matrices = matches!(
            wanted,
            Wanted::MassMatrix | Wanted::VelocityForces | Wanted::AppliedForces
        );
        if of_matrices && !self.matrices {
            return Err(Misfit::Missing { what: "matrices" });
        }
        let (count, length) = (self.count(rows)?, self.length(wanted));
        fits("results", results.len(), count * length)?;
        if !rows.inputs.is_empty() {
            fits("inputs", rows.inputs.len(), count * self.varying().len())?;
            self.check(rows.inputs)?;
        }
        let work = |lanes: &mut dyn Lanes, range: Range<usize>, [results, _]: [&mut [f64]; 2]| {
            lanes.evaluate(wanted, rows, range, results);
        };
        self.share(count, [(results, length), (&mut [], 0)], &work);
        Ok(())
    }

    /// Takes steps from each row. The states after each step go to `states` (q, v, z and m), the outputs after each
    /// step to `outputs`: for each row its steps, one after the other. Either may be empty, and is not recorded then.
    /// The inputs are those of [`Rollout::hold`], for each row its steps one after the other.
    ///
    /// # Errors
    /// If the slices do not fit, or if inputs are refused.
    pub fn rollout(
        &mut self,
        rollout: &Rollout,
        rows: &Rows<'_>,
        states: &mut [f64],
        outputs: &mut [f64],
    ) -> Result<(), Misfit> {
        let count = self.count(rows)?;
        let ticks = match rollout.hold {
            Hold::Constant => rollout.steps,
            Hold::Linear => rollout.steps + 1,
        };
        if !rows.inputs.is_empty() {
            let needed = count * ticks * self.varying().len();
            fits("inputs", rows.inputs.len(), needed)?;
            self.check(rows.inputs)?;
        }
        let lengths = [self.info().state_length(), self.info().outputs.len()];
        let [of_states, of_outputs] = lengths.map(|length| length * rollout.steps);
        for (what, found, length) in [
            ("states", states.len(), of_states),
            ("outputs", outputs.len(), of_outputs),
        ] {
            if found > 0 {
                fits(what, found, count * length)?;
            }
        }
        let of_states = if states.is_empty() { 0 } else { of_states };
        let of_outputs = if outputs.is_empty() { 0 } else { of_outputs };
        let work = |lanes: &mut dyn Lanes, range: Range<usize>, to: [&mut [f64]; 2]| {
            lanes.rollout(rollout, rows, range, to);
        };
        self.share(count, [(states, of_states), (outputs, of_outputs)], &work);
        Ok(())
    }

    /// The number of rows.
    fn count(&self, rows: &Rows<'_>) -> Result<usize, Misfit> {
        let info = self.info();
        let count = match info.velocities.len() {
            0 => 0,
            length => rows.velocities.len() / length,
        };
        fits(
            "velocities",
            rows.velocities.len(),
            count * info.velocities.len(),
        )?;
        fits(
            "coordinates",
            rows.coordinates.len(),
            count * info.coordinates.len(),
        )?;
        if !rows.accelerations.is_empty() {
            let needed = rows.velocities.len();
            fits("accelerations", rows.accelerations.len(), needed)?;
        }
        if !rows.states.is_empty() {
            let length = info.auxiliaries.len() + info.memory.len();
            fits("states", rows.states.len(), count * length)?;
        }
        Ok(count)
    }

    /// Refuses values that are not finite, outside of the limits of an input, or that break a condition.
    fn check(&mut self, inputs: &[f64]) -> Result<(), Misfit> {
        let [low, high] = &self.limits;
        let rows = inputs.len() / self.varying.indices().len().max(1);
        let within = self.workers[0].of(rows).within(inputs, [low, high]);
        if within && !self.conditional {
            return Ok(());
        }
        for (row, values) in inputs.chunks_exact(self.varying().len().max(1)).enumerate() {
            if !within {
                let refused = |refusal| self.refused(row, refusal);
                for (&index, &value) in self.varying().iter().zip(values) {
                    self.allowed(index, value).map_err(refused)?;
                }
            }
            if self.conditional {
                self.checks.set_some(&self.varying, values);
                if let Some(condition) = self.checks.violated() {
                    return Err(self.refused(row, Refusal::Condition(condition)));
                }
            }
        }
        Ok(())
    }

    fn refused(&self, row: usize, refusal: Refusal) -> Misfit {
        let mut message = String::new();
        // a string takes all text
        let _ = refusal.write(self.info(), &mut message);
        Misfit::Refused {
            row,
            refusal,
            message,
        }
    }

    fn allowed(&self, index: usize, value: f64) -> Result<(), Refusal> {
        let of = &self.info().parameters[index];
        match value {
            value if !value.is_finite() => Err(Refusal::NotFinite(index, value)),
            value if of.input && !(of.min..=of.max).contains(&value) => {
                Err(Refusal::OutOfLimits(index, value))
            }
            _ => Ok(()),
        }
    }

    /// Shares rows among the threads. Each result has a length for each row.
    fn share(&mut self, count: usize, results: [(&mut [f64], usize); 2], work: &Work<'_>) {
        let group = Width::widest().lanes();
        let groups = count.div_ceil(group).div_ceil(self.workers.len()).max(1);
        let each = groups * group;
        if count <= each {
            if count > 0 {
                let [(first, _), (second, _)] = results;
                work(self.workers[0].of(count), 0..count, [first, second]);
            }
            return;
        }
        std::thread::scope(|scope| {
            let mut rest = results;
            let mut from = 0;
            for worker in &mut self.workers {
                let to = (from + each).min(count);
                let mine = rest.each_mut().map(|(results, length)| {
                    let (mine, behind) =
                        std::mem::take(results).split_at_mut((to - from) * *length);
                    *results = behind;
                    mine
                });
                let range = from..to;
                from = to;
                if range.is_empty() {
                    continue;
                }
                // the last part is this thread's own
                match to == count {
                    true => work(worker.of(range.len()), range, mine),
                    false => {
                        scope.spawn(move || work(worker.of(range.len()), range, mine));
                    }
                }
            }
        });
    }
}

/// The number of results of each function.
fn lengths(functions: &[Function]) -> Vec<usize> {
    functions.iter().map(|of| of.list.results.len()).collect()
}

/// What a thread does with its rows.
type Work<'a> = dyn Fn(&mut dyn Lanes, Range<usize>, [&mut [f64]; 2]) + Sync + 'a;

fn fits(what: &'static str, found: usize, needed: usize) -> Result<(), Misfit> {
    match found == needed {
        true => Ok(()),
        false => Err(Misfit::Length {
            what,
            found,
            needed,
        }),
    }
}

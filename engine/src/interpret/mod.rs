//! The interpreter: runs lists over any scalar.
//!
//! When a method is used for the first time, its list becomes code for all scalars:
//!
//! | step | where |
//! |---|---|
//! | operations are joined into chains, if only the next one uses the result; changes of sign become part of fused operations | `chain` |
//! | chains are ordered such that runs of one shape are long | `order` |
//! | values get places in a frame; a place is reused after the last use of its value | `encode` |
//! | one loop executes each run | `run` |
//!
//! All methods share one frame of values: constants, parameters, values derived from them, time, state, and room for the
//! results of operations. The operations, their order and their rounding are those of the list.
//!
//! Places have sixteen bits, so that the code fits into the first-level cache of a processor. A plain loop over
//! operations (`plain`) is used for models that need more places, and for scalars with costly operations: duals and
//! double-doubles. For plain numbers it takes several times as long as runs.

mod chain;
mod encode;
mod frame;
mod order;
mod plain;
mod run;

use crate::execute::{Execute, Given};
use crate::model::Shared;
use crate::sets::Sets;
use bryant_generator::program::{Input, List, Lists, Methods};
use bryant_runtime::Real;
use bryant_runtime::real::Base;
use encode::Code;
use frame::Frame;
use run::Runs;
use std::cell::RefCell;
use std::collections::HashMap;
use std::sync::Arc;

/// The methods of a model in the form that the interpreter runs, the same for all scalars.
#[derive(Debug)]
pub struct Programs {
    constants: Vec<f64>,
    /// The place of each constant, by its bits.
    place_of: HashMap<u64, u32>,
    layout: Layout,
    /// The runs of each set of methods; `None` if it needs too many places.
    runs: Sets<Option<Code>>,
    /// The plain code of each set of methods.
    plain: Sets<plain::Code>,
}

/// The first place of each part of the frame. The constants come first, then these parts in their order.
#[derive(Clone, Copy, Debug)]
struct Layout {
    parameters: u32,
    derived: u32,
    time: u32,
    state: u32,
    /// Results of operations.
    rest: u32,
}

impl Layout {
    /// The place of an input in the frame.
    fn place(&self, input: Input) -> u32 {
        match input {
            Input::Time => self.time,
            Input::State(i) => self.state + i,
            Input::Acceleration(_) | Input::EventFunction(_) => {
                unreachable!("a list of the engine computes them")
            }
            Input::Parameter(i) => self.parameters + i,
            Input::Derived(i) => self.derived + i,
        }
    }
}

impl Programs {
    pub fn new(lists: &Lists) -> Self {
        let facts = &lists.facts;
        let mut constants = Vec::new();
        let mut place_of: HashMap<u64, u32> = HashMap::new();
        let all = lists.routines.iter();
        for constant in all.flat_map(|routine| &routine.list.constants) {
            place_of.entry(constant.to_bits()).or_insert_with(|| {
                constants.push(*constant);
                constants.len() as u32 - 1
            });
        }
        let parameters = constants.len() as u32;
        let derived = parameters + facts.parameters.len() as u32;
        let time = derived + lists.derived as u32;
        let state = time + 1;
        let rest = state + facts.kinds.len() as u32;
        Programs {
            constants,
            place_of,
            layout: Layout {
                parameters,
                derived,
                time,
                state,
                rest,
            },
            runs: Default::default(),
            plain: Default::default(),
        }
    }

    fn runs(&self, methods: Methods, list: &List) -> Option<&Code> {
        let encode = || encode::encode(list, &self.layout, &self.place_of);
        self.runs.get(methods, encode)?.as_ref()
    }

    fn plain(&self, methods: Methods, list: &List) -> Option<&plain::Code> {
        let encode = || plain::encode(list, &self.layout, &self.place_of);
        self.plain.get(methods, encode)
    }
}

/// Evaluates lists over one scalar by interpretation.
#[derive(Debug)]
pub struct Interpreter<T> {
    shared: Arc<Shared>,
    values: RefCell<Values<T>>,
}

#[derive(Debug)]
struct Values<T> {
    frame: Vec<T>,
    arguments: Vec<T>,
}

impl<T: Real> Interpreter<T> {
    /// True if loops for runs of chains are compiled over this scalar. This takes long, and pays only if an operation
    /// is about as fast as finding out which operation is next. Scalars without a form may be that fast.
    const RUNS: bool = match T::FORM {
        Some(form) => form.order == 0 && !matches!(form.base, Base::DoubleDouble),
        None => true,
    };

    pub(crate) fn new(shared: Arc<Shared>) -> Self {
        let programs = shared.programs();
        let mut frame = vec![T::from_f64(0.0); programs.layout.rest as usize];
        for (place, constant) in frame.iter_mut().zip(&programs.constants) {
            *place = T::from_f64(*constant);
        }
        let values = RefCell::new(Values {
            frame,
            arguments: Vec::new(),
        });
        Interpreter { values, shared }
    }
}

impl<T: Real> Execute<T> for Interpreter<T> {
    fn set_constants(&mut self, parameters: &[T], derived: &[T]) {
        let layout = self.shared.programs().layout;
        let frame = &mut self.values.get_mut().frame;
        frame[layout.parameters as usize..][..parameters.len()].copy_from_slice(parameters);
        frame[layout.derived as usize..][..derived.len()].copy_from_slice(derived);
    }

    fn run(&self, methods: Methods, given: Given<'_, T>, results: &mut [T]) -> bool {
        let programs = self.shared.programs();
        let Some(list) = self.shared.list(methods) else {
            return false;
        };
        let library = &self.shared.library;
        let mut values = self.values.borrow_mut();
        values.give(&programs.layout, given);
        // a branch on a constant: without `RUNS`, no loop for runs is compiled
        if Self::RUNS
            && let Some(code) = programs.runs(methods, list)
        {
            values.make_room(code.end(), code.most_arguments());
            let Values { frame, arguments } = &mut *values;
            T::dispatch(Runs {
                code,
                library,
                frame: Frame::new(frame, arguments, code),
            });
            for (result, &place) in results.iter_mut().zip(&code.results) {
                *result = frame[usize::from(place)];
            }
            return true;
        }
        let Some(code) = programs.plain(methods, list) else {
            return false;
        };
        values.make_room(code.end, code.most_arguments());
        let Values { frame, arguments } = &mut *values;
        T::dispatch(plain::Steps {
            code,
            library,
            frame,
            arguments,
        });
        for (result, &place) in results.iter_mut().zip(&code.results) {
            *result = frame[place as usize];
        }
        true
    }
}

impl<T: Real> Values<T> {
    /// Writes the inputs to their places.
    fn give(&mut self, layout: &Layout, given: Given<'_, T>) {
        let frame = &mut self.frame;
        frame[layout.time as usize] = given.time;
        frame[layout.state as usize..][..given.state.len()].copy_from_slice(given.state);
    }

    /// Makes room for a method, so that nothing is allocated when the method runs again.
    fn make_room(&mut self, places: usize, arguments: usize) {
        if self.frame.len() < places {
            self.frame.resize(places, T::from_f64(0.0));
        }
        if self.arguments.len() < arguments {
            self.arguments.resize(arguments, T::from_f64(0.0));
        }
    }
}

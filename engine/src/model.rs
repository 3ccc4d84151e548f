//! A model that is known only at run time, as the runtime's [`Dynamics`].

use crate::call::Library;
use crate::evaluate::{Codes, Evaluator};
use crate::execute::{Execute, Given};
use crate::info;
use crate::interpret::{Interpreter, Programs};
use crate::jacobian::{Jacobian, jacobian};
use crate::user::UserFunctions;
use bryant_generator::expression::Function;
use bryant_generator::program::{Combination, List, Lists, Method, Operation, Start};
use bryant_runtime::dynamics::{arrive, exchange};
use bryant_runtime::real::Base;
use bryant_runtime::{Adjustable, Arrival, Dynamics, Family, Info, Real, Schedule, Task};
use std::any::{Any, TypeId};
use std::cell::RefCell;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// A model for any scalar. It is made once from the lists of the model and shared by all threads.
#[derive(Clone, Debug)]
pub struct Engine {
    pub(crate) shared: Arc<Shared>,
}

/// The parts of a model that all scalars share.
#[derive(Debug)]
pub(crate) struct Shared {
    pub info: &'static Info,
    pub lists: Lists,
    pub library: Arc<Library>,
    /// Made when a method is interpreted for the first time.
    programs: OnceLock<Programs>,
    /// Combinations of methods, each as one list, made when the combination is used for the first time.
    combined: [OnceLock<List>; Combination::ALL.len()],
    /// The machine code over each scalar: [`Codes`].
    codes: Mutex<HashMap<TypeId, Arc<dyn Any + Send + Sync>>>,
}

impl Shared {
    /// The methods in the form that the interpreter runs.
    pub fn programs(&self) -> &Programs {
        self.programs.get_or_init(|| Programs::new(&self.lists))
    }

    /// A combination of methods as one list.
    pub fn combined(&self, combination: Combination) -> &List {
        let list = || self.lists.combined(combination);
        self.combined[combination as usize].get_or_init(list)
    }

    /// The machine code over a scalar, which all models over it share.
    pub fn codes<T: Real>(&self) -> Arc<Codes<T>> {
        let mut codes = self.codes.lock().unwrap_or_else(PoisonError::into_inner);
        let made = codes
            .entry(TypeId::of::<T>())
            .or_insert_with(|| Arc::new(Codes::<T>::default()));
        let made = Arc::clone(made).downcast();
        made.unwrap_or_else(|_| unreachable!("the scalar is the key"))
    }
}

/// Why an engine could not be made.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Error {
    /// The model calls a function of the user, and none was given; such functions need a compiler.
    UserFunction {
        /// Its name in the description.
        name: String,
    },
}

impl std::fmt::Display for Error {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Error::UserFunction { name } => {
                write!(f, "the function {name} is Rust text: it needs a compiler")
            }
        }
    }
}

impl std::error::Error for Error {}

impl Engine {
    /// The engine of a model that calls no function of the user.
    ///
    /// # Errors
    /// If the model calls a function of the user.
    pub fn new(lists: Lists) -> Result<Self, Error> {
        Self::with_functions(lists, None)
    }

    /// The engine of a model that may call these functions of its user.
    ///
    /// # Errors
    /// If the model calls a function of the user that is not among these.
    pub fn with_functions(
        lists: Lists,
        users: Option<Arc<dyn UserFunctions>>,
    ) -> Result<Self, Error> {
        for routine in &lists.routines {
            for operation in &routine.list.operations {
                if let Operation::Call {
                    function: Function::User(call),
                    ..
                } = operation
                {
                    let force = usize::from(call.force);
                    if !users.as_ref().is_some_and(|users| users.knows(force)) {
                        let name = lists.users.get(force).cloned().flatten();
                        let name = name.unwrap_or_default();
                        return Err(Error::UserFunction { name });
                    }
                }
            }
        }
        Ok(Engine {
            shared: Arc::new(Shared {
                info: info::info(&lists.facts),
                library: Arc::new(Library::new(&lists.curves, users)),
                programs: OnceLock::new(),
                combined: [const { OnceLock::new() }; Combination::ALL.len()],
                codes: Mutex::default(),
                lists,
            }),
        })
    }

    /// Names, units and sizes.
    pub fn info(&self) -> &'static Info {
        self.shared.info
    }

    /// How methods are evaluated over doubles, as text for people: "machine code" or "interpreter".
    pub fn arithmetic(&self) -> &'static str {
        match self.code_bytes(Method::Derivative) {
            Some(_) => "machine code",
            None => "interpreter",
        }
    }

    /// Length in bytes of the machine code of a method over doubles; `None` if the method is interpreted.
    pub fn code_bytes(&self, method: Method) -> Option<usize> {
        Evaluator::<f64>::new(self.shared.clone()).bytes(method)
    }

    /// The lists that the engine was made from.
    pub fn lists(&self) -> &Lists {
        &self.shared.lists
    }

    /// The model over a scalar, with the default values of all parameters. It uses machine code where possible, else
    /// the interpreter.
    pub fn over<T: Real>(&self) -> Evaluated<T> {
        Machine::new(self.shared.clone(), Evaluator::new(self.shared.clone()))
    }

    /// The model over a scalar, with the default values of all parameters. It uses the interpreter only.
    pub fn interpreted<T: Real>(&self) -> Interpreted<T> {
        Machine::new(self.shared.clone(), Interpreter::new(self.shared.clone()))
    }
}

impl Family for Engine {
    fn info(&self) -> &'static Info {
        self.shared.info
    }

    /// The model has a Jacobian, except over double-doubles: these are for reference solutions, which use explicit
    /// methods.
    fn over<T: Real>(&self) -> Box<dyn Adjustable<T> + '_> {
        // a branch on a constant, so that dual numbers over double-doubles are not compiled
        match const { is_double_double::<T>() } {
            true => Box::new(WithoutJacobian(Engine::over::<T>(self))),
            false => Box::new(Engine::over::<T>(self)),
        }
    }

    fn for_batch<T: Real>(&self) -> Box<dyn Adjustable<T> + '_> {
        Box::new(WithoutJacobian(Engine::over::<T>(self)))
    }

    fn schedule<T: Real>(&self) -> Box<dyn Schedule<T> + '_> {
        let model: Box<dyn Adjustable<T> + '_> = Family::for_batch(self);
        Box::new(model)
    }
}

const fn is_double_double<T: Real>() -> bool {
    match T::FORM {
        Some(form) => form.order == 0 && matches!(form.base, Base::DoubleDouble),
        None => false,
    }
}

/// A model over one scalar, by machine code where that is possible.
pub type Evaluated<T> = Machine<T, Evaluator<T>>;

/// A model over one scalar, by the interpreter.
pub type Interpreted<T> = Machine<T, Interpreter<T>>;

/// A model over one scalar; `E` evaluates its methods.
#[derive(Debug)]
pub struct Machine<T, E> {
    shared: Arc<Shared>,
    execute: E,
    parameters: Vec<T>,
    /// The values that depend only on parameters.
    derived: Vec<T>,
    /// Room for the rates; methods that need accelerations read them here.
    rates: RefCell<Vec<T>>,
    /// Room for the event functions, for methods that need them.
    event_functions: RefCell<Vec<T>>,
    /// Results that are processed before they are returned.
    results: RefCell<Vec<T>>,
    /// Room for the results of a combination of methods.
    combined: RefCell<Vec<T>>,
    /// The indices of the wanted outputs; `None` if all are wanted.
    wanted: Option<Box<[usize]>>,
    /// The Jacobian, made when it is used for the first time.
    jacobian: RefCell<Option<Box<dyn Jacobian<T>>>>,
}

/// A model over one scalar without a Jacobian, so that its equations are not compiled over dual numbers. A batch never
/// uses this type.
struct WithoutJacobian<M>(M);

impl<T: Real, E: Execute<T>> Machine<T, E> {
    fn new(shared: Arc<Shared>, execute: E) -> Self {
        let zeros = |methods: &[Method]| {
            let lengths = methods.iter().map(|&m| shared.lists.list(m).results.len());
            RefCell::new(vec![T::from_f64(0.0); lengths.max().unwrap_or(0)])
        };
        let defaults = shared.info.parameters.iter();
        let mut machine = Machine {
            parameters: defaults.map(|p| T::from_f64(p.default)).collect(),
            derived: vec![T::from_f64(0.0); shared.lists.derived],
            rates: zeros(&[Method::Derivative]),
            event_functions: zeros(&[Method::EventFunctions]),
            results: zeros(&[
                Method::Renewed,
                Method::Pivots,
                Method::Conditions,
                Method::KinkRates,
            ]),
            combined: {
                let length = |method: &Method| shared.lists.list(*method).results.len();
                let arrival = Combination::WatchedArrival.methods();
                let arrival: usize = arrival.iter().map(length).sum();
                let longest = arrival.max(length(&Method::Outputs));
                RefCell::new(vec![T::from_f64(0.0); longest])
            },
            wanted: None,
            jacobian: RefCell::new(None),
            shared,
            execute,
        };
        machine.derive();
        machine
    }

    /// Computes the values that depend only on parameters.
    fn derive(&mut self) {
        derive(&mut self.execute, &self.parameters, &mut self.derived);
        if let Some(jacobian) = self.jacobian.get_mut() {
            jacobian.forget_parameters();
        }
    }

    /// Runs a method at a state. If it needs results of another method, that method runs first.
    fn at(&self, method: Method, t: T, y: &[T], results: &mut [T]) {
        let routine = self.shared.lists.routine(method);
        if routine.list.results.is_empty() {
            return;
        }
        let given = Given {
            time: t,
            state: y,
            before: &[],
        };
        match routine.start {
            Start::State => self.execute.run(method, given, results),
            Start::Accelerations => {
                let combination = match method {
                    Method::EventFunctions => Some(Combination::EventFunctions),
                    Method::Outputs => Some(Combination::Outputs),
                    _ => None,
                };
                if combination.is_some_and(|all| self.execute.run_combined(all, given, results)) {
                    return;
                }
                let mut rates = self.rates.borrow_mut();
                self.execute.run(Method::Derivative, given, &mut rates);
                let info = self.shared.info;
                let (q, v) = (info.coordinates.len(), info.velocities.len());
                let before = &rates[q..q + v];
                self.execute.run(method, Given { before, ..given }, results);
            }
            Start::EventFunctions => {
                let mut event_functions = self.event_functions.borrow_mut();
                self.at(Method::EventFunctions, t, y, &mut event_functions);
                let before = &event_functions;
                self.execute.run(method, Given { before, ..given }, results);
            }
        }
    }

    /// Runs a combination of methods and passes the results of each to `hand_on`; returns false if this is not
    /// possible.
    fn at_once(
        &self,
        combination: Combination,
        (t, y): (T, &[T]),
        mut hand_on: impl FnMut(Method, &[T]),
    ) -> bool {
        let mut results = self.combined.borrow_mut();
        let given = Given {
            time: t,
            state: y,
            before: &[],
        };
        let done = self.execute.run_combined(combination, given, &mut results);
        if done {
            let mut rest = &results[..];
            for &method in combination.methods() {
                let (mine, behind) = rest.split_at(self.shared.lists.list(method).results.len());
                hand_on(method, mine);
                rest = behind;
            }
        }
        done
    }

    /// Computes [`Dynamics::exchange`] by a combination of methods; returns false if this is not possible.
    fn exchange_at_once(
        &self,
        at: (T, &[T]),
        powers: &mut [T],
        external_wrench: &mut [T; 6],
    ) -> bool {
        self.at_once(Combination::Exchange, at, |method, results| match method {
            Method::Powers => powers.copy_from_slice(results),
            _ => external_wrench[..results.len()].copy_from_slice(results),
        })
    }

    /// Computes [`Dynamics::arrive`] by a combination of methods; returns false if this is not possible.
    fn arrive_at_once(&self, at: (T, &[T]), arrival: &mut Arrival<'_, T>) -> bool {
        let combination = match (&arrival.account, arrival.curves.is_empty()) {
            (Some(_), _) => Combination::WatchedArrival,
            (None, false) => Combination::ArrivalWithCurves,
            (None, true) => Combination::Arrival,
        };
        let Arrival {
            event_functions,
            onsets,
            renewed,
            curves,
            account,
        } = arrival;
        let memory = !self.shared.info.memory.is_empty();
        let nothing =
            event_functions.is_empty() && onsets.is_empty() && curves.is_empty() && !memory;
        if nothing && account.is_none() {
            return true;
        }
        self.at_once(combination, at, |method, results| {
            match (method, &mut *account) {
                (Method::EventFunctions, _) => event_functions.copy_from_slice(results),
                (Method::Onsets, _) => onsets.copy_from_slice(results),
                (Method::Renewed, _) if self.shared.info.memory.is_empty() => {}
                (Method::Renewed, _) => {
                    renewed.copy_from_slice(at.1);
                    for (&place, &value) in self.shared.lists.renewed.iter().zip(results) {
                        renewed[place as usize] = value;
                    }
                }
                (Method::Curves, _) => curves.copy_from_slice(results),
                (Method::KineticEnergy, Some(account)) => *account.kinetic_energy = results[0],
                (Method::Powers, Some(account)) => account.powers.copy_from_slice(results),
                (Method::Momentum, Some(account)) => {
                    account.momentum[..results.len()].copy_from_slice(results)
                }
                (_, Some(account)) => {
                    account.external_wrench[..results.len()].copy_from_slice(results)
                }
                (_, None) => {}
            }
        })
    }

    /// Writes only the wanted outputs, to their places, and returns true; returns false if all are wanted or there is
    /// no machine code.
    fn wanted_outputs(&self, t: T, y: &[T], outputs: &mut [T]) -> bool {
        let Some(wanted) = &self.wanted else {
            return false;
        };
        let mut results = self.combined.borrow_mut();
        let results = &mut results[..wanted.len()];
        let given = Given {
            time: t,
            state: y,
            before: &[],
        };
        let done = self.execute.run_outputs(wanted, given, results);
        if done {
            for (place, result) in wanted.iter().zip(results) {
                outputs[*place] = *result;
            }
        }
        done
    }

    /// Runs a method that needs only parameters.
    fn of_parameters(&self, method: Method, results: &mut [T]) {
        if !self.shared.lists.list(method).results.is_empty() {
            self.execute.run(method, Given::nothing(), results);
        }
    }

    /// The six results of a method; zeros if the method has none because no system is free.
    fn six(&self, method: Method, t: T, y: &[T]) -> [T; 6] {
        let mut results = [T::from_f64(0.0); 6];
        self.at(method, t, y, &mut results);
        results
    }
}

/// Computes the values that depend only on parameters, and sets both in `execute`.
pub(crate) fn derive<T: Real>(execute: &mut impl Execute<T>, parameters: &[T], derived: &mut [T]) {
    execute.set_constants(parameters, &[]);
    execute.run(Method::Derived, Given::nothing(), derived);
    execute.set_constants(parameters, derived);
}

/// Implements [`Dynamics`] for a type that holds a model over one scalar; the Jacobian is an argument.
macro_rules! dynamics {
    ($holder:ty, $jacobian:item) => {
impl<T: Real, E: Execute<T>> Dynamics<T> for $holder {
    fn info(&self) -> &'static Info {
        self.machine().shared.info
    }

    fn parameter(&self, index: usize) -> Option<T> {
        self.machine().parameters.get(index).copied()
    }

    fn initial_state(&self, y: &mut [T]) {
        self.machine().of_parameters(Method::InitialState, y);
    }

    fn derivative(&self, t: T, y: &[T], rate: &mut [T]) {
        let (varying, memory) = rate.split_at_mut(self.machine().shared.info.varying_length());
        self.machine().at(Method::Derivative, t, y, varying);
        memory.fill(T::from_f64(0.0));
    }

    fn coordinate_rates(&self, y: &[T], rate: &mut [T]) {
        let coordinates = &mut rate[..self.machine().shared.info.coordinates.len()];
        self.machine().at(Method::CoordinateRates, T::from_f64(0.0), y, coordinates);
    }

    $jacobian

    fn outputs(&self, t: T, y: &[T], outputs: &mut [T]) {
        if !self.machine().wanted_outputs(t, y, outputs) {
            self.machine().at(Method::Outputs, t, y, outputs);
        }
    }

    fn normalize(&self, y: &mut [T]) {
        for range in &self.machine().shared.lists.quaternions {
            T::dispatch(Normalize(&mut y[range.clone()]));
        }
    }

    fn renew(&self, t: T, y: &mut [T]) {
        let mut results = self.machine().results.borrow_mut();
        let places = &self.machine().shared.lists.renewed;
        self.machine().at(Method::Renewed, t, y, &mut results[..places.len()]);
        for (&place, &value) in places.iter().zip(results.iter()) {
            y[place as usize] = value;
        }
    }

    fn renew_by(&self, t: T, y: &mut [T], event_functions: &[T]) {
        let machine = self.machine();
        let routine = machine.shared.lists.routine(Method::Renewed);
        if routine.start != Start::EventFunctions {
            return self.renew(t, y);
        }
        let mut results = machine.results.borrow_mut();
        let places = &machine.shared.lists.renewed;
        let given = Given {
            time: t,
            state: y,
            before: event_functions,
        };
        machine.execute.run(Method::Renewed, given, &mut results[..places.len()]);
        for (&place, &value) in places.iter().zip(results.iter()) {
            y[place as usize] = value;
        }
    }

    fn event_functions(&self, t: T, y: &[T], event_functions: &mut [T]) {
        self.machine().at(Method::EventFunctions, t, y, event_functions);
    }

    fn kinks(&self, t: T, y: &[T], kinks: &mut [T]) {
        self.machine().at(Method::Kinks, t, y, kinks);
    }

    fn onsets(&self, t: T, y: &[T], onsets: &mut [T]) {
        self.machine().at(Method::Onsets, t, y, onsets);
    }

    fn curves(&self, t: T, y: &[T], arguments: &mut [T]) {
        self.machine().at(Method::Curves, t, y, arguments);
    }

    fn smallest_pivot(&self, t: T, y: &[T]) -> Option<(usize, T)> {
        let mut results = self.machine().results.borrow_mut();
        let pivots = &mut results[..self.machine().shared.info.pivots.len()];
        self.machine().at(Method::Pivots, t, y, pivots);
        let pivots = pivots.iter().copied().enumerate();
        pivots.min_by(|a, b| a.1.to_f64().total_cmp(&b.1.to_f64()))
    }

    fn violated(&self) -> Option<usize> {
        let mut results = self.machine().results.borrow_mut();
        let rules = &self.machine().shared.lists.rules;
        let values = &mut results[..rules.len()];
        self.machine().of_parameters(Method::Conditions, values);
        let mut conditions = values.iter().zip(rules);
        conditions.position(|(value, rule)| !rule.keeps(value.to_f64()))
    }

    fn kinetic_energy(&self, t: T, y: &[T]) -> T {
        let mut energy = [T::from_f64(0.0)];
        self.machine().at(Method::KineticEnergy, t, y, &mut energy);
        energy[0]
    }

    fn powers(&self, t: T, y: &[T], powers: &mut [T]) {
        self.machine().at(Method::Powers, t, y, powers);
    }

    fn momentum(&self, t: T, y: &[T]) -> [T; 6] {
        self.machine().six(Method::Momentum, t, y)
    }

    fn external_wrench(&self, t: T, y: &[T]) -> [T; 6] {
        self.machine().six(Method::ExternalWrench, t, y)
    }

    fn exchange(&self, t: T, y: &[T], powers: &mut [T], external_wrench: &mut [T; 6]) {
        if !self.machine().exchange_at_once((t, y), powers, external_wrench) {
            exchange(self, t, y, powers, external_wrench);
        }
    }

    fn arrive(&self, t: T, y: &[T], arrival: &mut Arrival<'_, T>) {
        if !self.machine().arrive_at_once((t, y), arrival) {
            arrive(self, t, y, arrival);
        }
    }

    fn kink_after(&self, t: f64) -> T {
        let mut results = self.machine().results.borrow_mut();
        let stretched = &self.machine().shared.lists.stretched;
        let rates = &mut results[..stretched.len()];
        self.machine().of_parameters(Method::KinkRates, rates);
        T::dispatch(KinkAfter {
            library: &self.machine().shared.library,
            stretched,
            rates,
            t,
        })
    }
}
    };
}

dynamics!(
    Machine<T, E>,
    fn jacobian(&self, t: T, y: &[T], by_state: &mut [T], by_time: &mut [T]) -> bool {
        let mut made = self.jacobian.borrow_mut();
        let made = made.get_or_insert_with(|| jacobian(&self.shared));
        made.evaluate(&self.parameters, (t, y), by_state, by_time);
        true
    }
);

dynamics!(
    WithoutJacobian<Machine<T, E>>,
    fn jacobian(&self, _: T, _: &[T], _: &mut [T], _: &mut [T]) -> bool {
        false
    }
);

impl<T, E> Machine<T, E> {
    fn machine(&self) -> &Self {
        self
    }
}

impl<M> WithoutJacobian<M> {
    fn machine(&self) -> &M {
        &self.0
    }
}

impl<T: Real, E: Execute<T>> Adjustable<T> for WithoutJacobian<Machine<T, E>> {
    fn set_parameters(&mut self, values: &[T]) {
        self.0.set_parameters(values);
    }

    fn want_outputs(&mut self, wanted: &[usize]) {
        self.0.want_outputs(wanted);
    }
}

impl<T: Real, E: Execute<T>> Adjustable<T> for Machine<T, E> {
    fn set_parameters(&mut self, values: &[T]) {
        for (parameter, value) in self.parameters.iter_mut().zip(values) {
            *parameter = *value;
        }
        self.derive();
    }

    fn want_outputs(&mut self, wanted: &[usize]) {
        // each valid index once
        let all = 0..self.shared.info.outputs.len();
        let wanted: Box<[usize]> = all.filter(|index| wanted.contains(index)).collect();
        self.wanted = (wanted.len() < self.shared.info.outputs.len()).then_some(wanted);
        self.execute.forget_outputs();
    }
}

/// Scales quaternions to length 1, as a task.
struct Normalize<'a, T>(&'a mut [T]);

impl<T: Real> Task for Normalize<'_, T> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        for quaternion in self.0.as_chunks_mut::<4>().0 {
            let [w, x, y, z] = *quaternion;
            let squared = w * w + x * x + y * y + z * z;
            let scale = T::from_f64(1.0) / squared.sqrt();
            *quaternion = [w * scale, x * scale, y * scale, z * scale];
        }
    }
}

/// The first kink after a time, of the curves whose abscissae depend on parameters, as a task.
struct KinkAfter<'a, T> {
    library: &'a Library,
    stretched: &'a [u32],
    rates: &'a [T],
    t: f64,
}

impl<T: Real> Task for KinkAfter<'_, T> {
    type Output = T;
    #[inline(always)]
    fn run(self) -> T {
        let mut first = T::from_f64(f64::INFINITY);
        for (&curve, &rate) in self.stretched.iter().zip(self.rates) {
            first = first.min(self.library.curve(curve).kink_after(rate, self.t));
        }
        first
    }
}

//! A model that is known only at run time, as the runtime's [`Dynamics`].

use crate::call::Library;
use crate::evaluate::{Codes, Evaluator};
use crate::execute::{Execute, Given};
use crate::info::OwnedInfo;
use crate::interpret::{Interpreter, Programs};
use crate::jacobian::{Jacobian, jacobian};
use crate::sets::Sets;
use crate::user::UserFunctions;
use bryant_generator::expression::Function;
use bryant_generator::program::{self, Input, List, Lists, Method, Methods, Operation, Start};
use bryant_runtime::dynamics::one_by_one;
use bryant_runtime::real::Base;
use bryant_runtime::{Adjustable, Dynamics, Family, Info, Real, Schedule, Section, Task};
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
    info: OwnedInfo,
    pub lists: Lists,
    pub library: Arc<Library>,
    /// Made when a method is interpreted for the first time.
    programs: OnceLock<Programs>,
    /// The lists of the functions that were asked for, with accelerations as entries behind those of the state.
    pub functions: Vec<List>,
    /// The lists of sets of methods, and of methods that start from others.
    combined: Sets<List>,
    /// The machine code over each scalar: [`Codes`].
    codes: Mutex<HashMap<TypeId, Arc<dyn Any + Send + Sync>>>,
}

impl Shared {
    /// Names, units and sizes.
    pub fn info(&self) -> &Info<'_> {
        self.info.get()
    }

    /// The methods in the form that the interpreter runs.
    pub fn programs(&self) -> &Programs {
        self.programs.get_or_init(|| Programs::new(&self.lists))
    }

    /// Methods as one list that needs only time, state and parameters; `None` if there are too many sets of several.
    #[inline]
    pub fn list(&self, methods: Methods) -> Option<&List> {
        let alone = methods.one().map(|method| self.lists.routine(method));
        match alone {
            Some(routine) if routine.start == Start::State => Some(&routine.list),
            _ => self.combined.get(methods, || self.lists.combined(methods)),
        }
    }

    /// The number of results of a method.
    fn length(&self, method: Method) -> usize {
        self.lists.list(method).results.len()
    }

    /// The machine code over a scalar, which all models over it share.
    pub fn codes<T: Real>(&self) -> Arc<Codes<T>> {
        let mut codes = self.codes.lock().unwrap_or_else(PoisonError::into_inner);
        let made = codes
            .entry(TypeId::of::<T>())
            .or_insert_with(|| Arc::new(Codes::<T>::new(self.functions.len())));
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
        let state = lists.facts.kinds.len() as u32;
        Ok(Engine {
            shared: Arc::new(Shared {
                info: OwnedInfo::new(&lists.facts),
                library: Arc::new(Library::new(&lists.curves, users)),
                programs: OnceLock::new(),
                functions: lists
                    .functions
                    .iter()
                    .map(|of| behind_state(of, state))
                    .collect(),
                combined: Sets::default(),
                codes: Mutex::default(),
                lists,
            }),
        })
    }

    /// Names, units and sizes.
    pub fn info(&self) -> &Info<'_> {
        self.shared.info()
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

    /// The functions that were asked for when the lists were made.
    pub fn functions(&self) -> &[program::Function] {
        &self.shared.lists.functions
    }

    /// The index among the [functions](Self::functions) of the one with this name, as `jacobian(arm/hand)`.
    pub fn function(&self, name: &str) -> Option<usize> {
        self.functions().iter().position(|of| of.name == name)
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

/// The list of a function, with accelerations as entries behind those of a state of this length.
fn behind_state(function: &program::Function, state: u32) -> List {
    let mut list = function.list.clone();
    for input in &mut list.inputs {
        if let Input::Acceleration(index) = *input {
            *input = Input::State(state + index);
        }
    }
    list
}

impl Family for Engine {
    fn info(&self) -> &Info<'_> {
        self.shared.info()
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
    /// Room for results that are not returned as they are.
    results: RefCell<Vec<T>>,
    /// Room for a state and accelerations behind it; empty if no function needs accelerations.
    given: RefCell<Vec<T>>,
    /// The indices of the wanted outputs; `None` if all are wanted.
    wanted: Option<Box<[usize]>>,
    /// The Jacobian, made when it is used for the first time.
    jacobian: RefCell<Option<Box<dyn Jacobian<T>>>>,
}

/// Some parameters of one model, by [`Machine::varying`], which [`Machine::set_some`] sets. They are looked up once,
/// since they may be set at each step.
#[derive(Clone, Debug, Default)]
pub struct Varying {
    indices: Box<[usize]>,
    /// Whether values that depend only on parameters depend on these.
    derive: bool,
}

impl Varying {
    /// Their indices in [`Info::parameters`].
    pub fn indices(&self) -> &[usize] {
        &self.indices
    }
}

/// A model over one scalar without a Jacobian, so that its equations are not compiled over dual numbers. A batch never
/// uses this type.
pub(crate) struct WithoutJacobian<M>(pub(crate) M);

impl<T: Real, E: Execute<T>> Machine<T, E> {
    fn new(shared: Arc<Shared>, execute: E) -> Self {
        let room: usize = Method::ALL.map(|method| shared.length(method)).iter().sum();
        let defaults = shared.info().parameters.iter();
        let facts = &shared.lists.facts;
        let needed = shared.lists.functions.iter().any(|of| of.accelerations);
        let given = match needed {
            true => facts.kinds.len() + facts.velocities.len(),
            false => 0,
        };
        let mut machine = Machine {
            given: RefCell::new(vec![T::from_f64(0.0); given]),
            parameters: defaults.map(|p| T::from_f64(p.default)).collect(),
            derived: vec![T::from_f64(0.0); shared.lists.derived],
            results: RefCell::new(vec![T::from_f64(0.0); room]),
            wanted: None,
            jacobian: RefCell::new(None),
            shared,
            execute,
        };
        machine.derive();
        machine
    }

    /// The results of a method at a time and a state, such as the entries of S; none if the lists have no such method.
    pub fn results(&self, method: Method, time: T, state: &[T]) -> Vec<T> {
        let mut results = vec![T::from_f64(0.0); self.shared.length(method)];
        self.evaluate(method, time, state, &mut results);
        results
    }

    /// Writes the results of a method at a time and a state, such as the entries of S. `results` is at least as long;
    /// nothing is written if the lists have no such method.
    pub fn evaluate(&self, method: Method, time: T, state: &[T], results: &mut [T]) {
        self.at(method, time, state, results);
    }

    /// Sets some parameters of this model \[SI\], a value for each.
    pub fn set_some(&mut self, parameters: &Varying, values: &[T]) {
        for (index, value) in parameters.indices.iter().zip(values) {
            self.parameters[*index] = *value;
        }
        if parameters.derive {
            self.derive();
        } else {
            self.execute.set_constants(&self.parameters, &self.derived);
            if let Some(jacobian) = self.jacobian.get_mut() {
                jacobian.forget_parameters();
            }
        }
    }

    /// Parameters that are set together, by their indices in [`Info::parameters`], in the order of their values.
    pub fn varying(&self, indices: &[usize]) -> Varying {
        Varying {
            derive: self.depends(Method::Derived, indices),
            indices: indices.into(),
        }
    }

    /// Whether a method needs one of these parameters, itself or by a value that depends on parameters alone.
    pub fn depends(&self, method: Method, parameters: &[usize]) -> bool {
        let lists = &self.shared.lists;
        let needs = |method: Method, derived: bool| {
            let mut inputs = lists.list(method).inputs.iter();
            inputs.any(|input| match input {
                Input::Parameter(index) => parameters.contains(&(*index as usize)),
                Input::Derived(_) => derived,
                _ => false,
            })
        };
        needs(
            method,
            method != Method::Derived && needs(Method::Derived, false),
        )
    }

    /// The number of results of a function.
    pub(crate) fn function_length(&self, index: usize) -> usize {
        self.shared.lists.functions[index].list.results.len()
    }

    /// The values of a [function](Engine::functions) at a time, a state and accelerations: a matrix by rows. The
    /// accelerations are as many as there are velocities; they are not read if the function does not need them.
    ///
    /// # Panics
    /// If there is no function of this index, or if a slice is too short.
    pub fn function(
        &self,
        index: usize,
        time: T,
        state: &[T],
        accelerations: &[T],
        results: &mut [T],
    ) {
        let function = &self.shared.lists.functions[index];
        let results = &mut results[..function.list.results.len()];
        let facts = &self.shared.lists.facts;
        let state = &state[..facts.kinds.len()];
        if !function.accelerations {
            return self
                .execute
                .run_function(index, Given { time, state }, results);
        }
        let mut given = self.given.borrow_mut();
        let (before, behind) = given.split_at_mut(state.len());
        before.copy_from_slice(state);
        behind.copy_from_slice(&accelerations[..facts.velocities.len()]);
        let state = &given[..];
        self.execute
            .run_function(index, Given { time, state }, results);
    }

    /// Computes the values that depend only on parameters.
    fn derive(&mut self) {
        derive(&mut self.execute, &self.parameters, &mut self.derived);
        if let Some(jacobian) = self.jacobian.get_mut() {
            jacobian.forget_parameters();
        }
    }

    /// Runs a method at a state.
    fn at(&self, method: Method, time: T, state: &[T], results: &mut [T]) {
        if self.shared.length(method) > 0 {
            self.execute
                .run(method.into(), Given { time, state }, results);
        }
    }

    /// Runs the methods of sections at once, and passes the results on. Returns false, and writes nothing, if the
    /// sections are not in order or if there are too many sets of them.
    fn at_once(&self, time: T, state: &[T], wanted: &mut [(Section, &mut [T])]) -> bool {
        let mut methods = Methods::default();
        for (section, _) in wanted.iter().filter(|(_, results)| !results.is_empty()) {
            let next = method_of(*section);
            if Methods::from(next) <= methods {
                return false;
            }
            methods = methods.with(next);
        }
        if methods == Methods::default() {
            return true;
        }
        let mut found = self.results.borrow_mut();
        let done = self.execute.run(methods, Given { time, state }, &mut found);
        if done {
            let mut rest = &found[..];
            for (section, results) in wanted.iter_mut().filter(|(_, results)| !results.is_empty()) {
                let (mine, behind) = rest.split_at(self.shared.length(method_of(*section)));
                self.pass_on(*section, state, mine, results);
                rest = behind;
            }
        }
        done
    }

    /// Writes the results of a section from those of its method.
    fn pass_on(&self, section: Section, state: &[T], found: &[T], results: &mut [T]) {
        match section {
            Section::Renewed => {
                results.copy_from_slice(state);
                for (&place, &value) in self.shared.lists.renewed.iter().zip(found) {
                    results[place as usize] = value;
                }
            }
            _ => results.copy_from_slice(found),
        }
    }

    /// Writes only the wanted outputs, to their places, and returns true; returns false if all are wanted or there is
    /// no machine code.
    fn wanted_outputs(&self, t: T, y: &[T], outputs: &mut [T]) -> bool {
        let Some(wanted) = &self.wanted else {
            return false;
        };
        let mut results = self.results.borrow_mut();
        let results = &mut results[..wanted.len()];
        let given = Given { time: t, state: y };
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
        self.at(method, T::from_f64(0.0), &[], results);
    }
}

/// The method of a section: that of the same name. A section without a method, or one in another order than the
/// methods, does not compile.
const fn method_of(section: Section) -> Method {
    const METHODS: [Method; Section::ALL.len()] = {
        let mut methods = [Method::Derived; Section::ALL.len()];
        let (mut at, mut before) = (0, Method::Derived);
        while at < methods.len() {
            let method = Method::named(Section::ALL[at].name()).expect("a method for each section");
            assert!(
                before as usize <= method as usize,
                "sections in the order of methods"
            );
            (methods[at], before) = (method, method);
            at += 1;
        }
        methods
    };
    METHODS[section as usize]
}

/// Computes the values that depend only on parameters, and sets both in `execute`.
pub(crate) fn derive<T: Real>(execute: &mut impl Execute<T>, parameters: &[T], derived: &mut [T]) {
    execute.set_constants(parameters, &[]);
    execute.run(Method::Derived.into(), Given::nothing(), derived);
    execute.set_constants(parameters, derived);
}

/// Implements [`Dynamics`] for a type that holds a model over one scalar; the Jacobian is an argument.
macro_rules! dynamics {
    ($holder:ty, $jacobian:item) => {
impl<T: Real, E: Execute<T>> Dynamics<T> for $holder {
    fn info(&self) -> &Info<'_> {
        self.machine().shared.info()
    }

    fn parameter(&self, index: usize) -> Option<T> {
        self.machine().parameters.get(index).copied()
    }

    fn initial_state(&self, y: &mut [T]) {
        self.machine().of_parameters(Method::InitialState, y);
    }

    fn derivative(&self, t: T, y: &[T], rate: &mut [T]) {
        let (varying, memory) = rate.split_at_mut(self.machine().shared.info().varying_length());
        self.machine().at(Method::Derivative, t, y, varying);
        memory.fill(T::from_f64(0.0));
    }

    fn coordinate_rates(&self, y: &[T], rate: &mut [T]) {
        let coordinates = &mut rate[..self.machine().shared.info().coordinates.len()];
        self.machine().at(Method::CoordinateRates, T::from_f64(0.0), y, coordinates);
    }

    $jacobian

    fn normalize(&self, y: &mut [T]) {
        for range in &self.machine().shared.lists.quaternions {
            T::dispatch(Normalize(&mut y[range.clone()]));
        }
    }

    fn smallest_pivot(&self, t: T, y: &[T]) -> Option<(usize, T)> {
        let mut results = self.machine().results.borrow_mut();
        let pivots = &mut results[..self.machine().shared.info().pivots.len()];
        self.machine().at(Method::Pivots, t, y, pivots);
        let pivots = pivots.iter().copied().enumerate();
        // the sign of a NaN depends on the processor, so it decides nothing
        pivots.reduce(|least, next| match next.1.to_f64() < least.1.to_f64() {
            true => next,
            false => least,
        })
    }

    fn violated(&self) -> Option<usize> {
        let mut results = self.machine().results.borrow_mut();
        let rules = &self.machine().shared.lists.rules;
        let values = &mut results[..rules.len()];
        self.machine().of_parameters(Method::Conditions, values);
        let mut conditions = values.iter().zip(rules);
        conditions.position(|(value, rule)| !rule.keeps(value.to_f64()))
    }

    fn section(&self, section: Section, t: T, y: &[T], results: &mut [T]) {
        let machine = self.machine();
        match section {
            Section::Outputs if machine.wanted_outputs(t, y, results) => {}
            Section::Renewed => {
                let mut found = machine.results.borrow_mut();
                let found = &mut found[..machine.shared.lists.renewed.len()];
                machine.at(Method::Renewed, t, y, found);
                machine.pass_on(section, y, found, results);
            }
            _ => machine.at(method_of(section), t, y, results),
        }
    }

    fn sections(&self, t: T, y: &[T], wanted: &mut [(Section, &mut [T])]) {
        if !self.machine().at_once(t, y, wanted) {
            one_by_one(self, t, y, wanted);
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
        let all = 0..self.shared.info().outputs.len();
        let wanted: Box<[usize]> = all.filter(|index| wanted.contains(index)).collect();
        self.wanted = (wanted.len() < self.shared.info().outputs.len()).then_some(wanted);
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

//! Evaluates methods by machine code where possible, else by the interpreter.

use crate::call::Library;
use crate::execute::{Execute, Given};
use crate::interpret::Interpreter;
use crate::model::Shared;
use crate::native::{Call, Compiled, compile};
use crate::sets::Sets;
use bryant_generator::expression::Function;
use bryant_generator::program::{List, Method, Methods};
use bryant_runtime::Real;
use std::cell::{OnceCell, RefCell};
use std::ptr::from_ref;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// The machine code of a model over one scalar: of each list, once compiled; `None` where compilation was tried and
/// there is no code.
///
/// A list is compiled when it runs for the first time. Its code depends on the scalar and the processor alone, so all
/// runs of an engine share it.
#[derive(Debug)]
pub struct Codes<T> {
    sets: Sets<Option<Code<T>>>,
    /// Code of the functions that were asked for.
    functions: Box<[OnceLock<Option<Code<T>>>]>,
    /// Code of some of the outputs.
    outputs: Mutex<Last<T>>,
}

/// The code of one list.
type Code<T> = Compiled<T, LibraryFunction>;

/// The code of some of the outputs.
type Chosen<T> = Arc<Option<Code<T>>>;

/// The outputs that were wanted last, and their code.
type Last<T> = Option<(Box<[usize]>, Chosen<T>)>;

impl<T> Codes<T> {
    /// No code yet, of a model with this number of functions.
    pub fn new(functions: usize) -> Self {
        Codes {
            sets: Sets::default(),
            functions: (0..functions).map(|_| OnceLock::new()).collect(),
            outputs: Mutex::new(None),
        }
    }
}

impl<T: Real> Codes<T> {
    fn of(&self, shared: &Shared, methods: Methods) -> Option<&Option<Code<T>>> {
        let list = shared.list(methods)?;
        self.sets.get(methods, || code(shared, list))
    }

    fn function(&self, shared: &Shared, index: usize) -> &Option<Code<T>> {
        self.functions[index].get_or_init(|| code(shared, &shared.functions[index]))
    }

    fn outputs(&self, shared: &Shared, wanted: &[usize]) -> Chosen<T> {
        let mut last = self.outputs.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((outputs, code)) = &*last
            && **outputs == *wanted
        {
            return code.clone();
        }
        let chosen = shared.list(Method::Outputs.into()).and_then(|all| {
            let results = wanted.iter().map(|index| all.results[*index]).collect();
            let list = List {
                results,
                ..all.clone()
            };
            code(shared, &list)
        });
        let code = Arc::new(chosen);
        *last = Some((wanted.into(), code.clone()));
        code
    }
}

fn code<T: Real>(shared: &Shared, list: &List) -> Option<Code<T>> {
    compile(list, &shared.lists.curves, |function| LibraryFunction {
        library: shared.library.clone(),
        function,
    })
}

/// Evaluates lists over one scalar. Numbers and registers of numbers use machine code where the processor and the
/// system allow it; everything else uses the interpreter. Both give the same bits.
#[derive(Debug)]
pub struct Evaluator<T: Real> {
    shared: Arc<Shared>,
    parameters: Vec<T>,
    derived: Vec<T>,
    codes: Arc<Codes<T>>,
    /// The code of the wanted outputs, if only some are wanted.
    outputs: OnceCell<Chosen<T>>,
    /// Room for the values of code.
    frame: RefCell<Vec<T>>,
    /// The interpreter for methods without code.
    interpreter: OnceCell<Interpreter<T>>,
}

impl<T: Real> Evaluator<T> {
    pub(crate) fn new(shared: Arc<Shared>) -> Self {
        Evaluator {
            codes: shared.codes(),
            shared,
            parameters: Vec::new(),
            derived: Vec::new(),
            outputs: OnceCell::new(),
            frame: RefCell::default(),
            interpreter: OnceCell::new(),
        }
    }

    /// Length of the machine code of a method in bytes, with its constants; `None` where it is interpreted.
    pub fn bytes(&self, method: Method) -> Option<usize> {
        let code = self.codes.of(&self.shared, method.into());
        code?.as_ref().map(Code::bytes)
    }

    /// The address of the machine code of a method.
    pub(crate) fn address(&self, method: Method) -> Option<usize> {
        let code = self.codes.of(&self.shared, method.into())?;
        code.as_ref().map(|code| from_ref(code) as usize)
    }

    /// The address of the machine code of some outputs. It is that of the code that is kept for all runs.
    pub(crate) fn address_of_outputs(&self, wanted: &[usize]) -> Option<usize> {
        let code = self.codes.outputs(&self.shared, wanted);
        (*code).as_ref().map(|code| from_ref(code) as usize)
    }

    fn run_code(&self, code: &Code<T>, given: Given<'_, T>, results: &mut [T]) {
        let constants = (&self.parameters[..], &self.derived[..]);
        code.run(given, constants, &self.frame, results);
    }

    fn interpreter(&self) -> &Interpreter<T> {
        self.interpreter.get_or_init(|| {
            let mut interpreter = Interpreter::new(self.shared.clone());
            interpreter.set_constants(&self.parameters, &self.derived);
            interpreter
        })
    }
}

impl<T: Real> Execute<T> for Evaluator<T> {
    fn set_constants(&mut self, parameters: &[T], derived: &[T]) {
        for (kept, values) in [
            (&mut self.parameters, parameters),
            (&mut self.derived, derived),
        ] {
            kept.clear();
            kept.extend_from_slice(values);
        }
        if let Some(interpreter) = self.interpreter.get_mut() {
            interpreter.set_constants(parameters, derived);
        }
    }

    #[inline]
    fn run(&self, methods: Methods, given: Given<'_, T>, results: &mut [T]) -> bool {
        match self.codes.of(&self.shared, methods) {
            Some(Some(code)) => self.run_code(code, given, results),
            Some(None) => return self.interpreter().run(methods, given, results),
            None => return false,
        }
        true
    }

    #[inline]
    fn run_function(&self, index: usize, given: Given<'_, T>, results: &mut [T]) {
        match self.codes.function(&self.shared, index) {
            Some(code) => self.run_code(code, given, results),
            None => self.interpreter().run_function(index, given, results),
        }
    }

    fn run_outputs(&self, wanted: &[usize], given: Given<'_, T>, results: &mut [T]) -> bool {
        let chosen = || self.codes.outputs(&self.shared, wanted);
        let code = self.outputs.get_or_init(chosen);
        if let Some(code) = &**code {
            self.run_code(code, given, results);
        }
        code.is_some()
    }

    fn forget_outputs(&mut self) {
        self.outputs = OnceCell::new();
    }
}

/// A function of the runtime or of the user, in the form that machine code calls.
#[derive(Debug)]
#[allow(dead_code, reason = "machine code alone calls it")]
struct LibraryFunction {
    library: Arc<Library>,
    function: Function,
}

impl<T: Real> Call<T> for LibraryFunction {
    fn call(&self, arguments: &[T], results: &mut [T]) {
        self.library.call(self.function, arguments, results);
    }
}

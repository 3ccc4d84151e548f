//! Evaluates methods by machine code where possible, else by the interpreter.

use crate::execute::{Execute, Given};
use crate::interpret::Interpreter;
use crate::model::Shared;
use crate::native::{Call, Compiled, compile};
use bryant_generator::expression::Function;
use bryant_generator::program::{Combination, List, Method};
use bryant_runtime::Real;
use std::cell::OnceCell;
use std::sync::Arc;

/// Evaluates lists over one scalar. Numbers, and registers of several numbers, use machine code if the processor and
/// the system allow it; other scalars use the interpreter. Both give the same bits.
///
/// A method is compiled when it runs for the first time.
#[derive(Debug)]
pub struct Evaluator<T: Real> {
    shared: Arc<Shared>,
    parameters: Vec<T>,
    derived: Vec<T>,
    /// The machine code of each method, set when the method first runs; `None` if the method has to be interpreted.
    compiled: [OnceCell<Option<Code<T>>>; Method::ALL.len()],
    /// The machine code of each combination of methods, in the same form.
    combined: [OnceCell<Option<Code<T>>>; Combination::ALL.len()],
    /// The machine code of the wanted outputs, in the same form, if only some outputs are wanted.
    outputs: OnceCell<Option<Code<T>>>,
    /// The interpreter for methods without machine code.
    interpreter: OnceCell<Interpreter<T>>,
}

/// The machine code of one list.
type Code<T> = Compiled<T, LibraryFunction>;

impl<T: Real> Evaluator<T> {
    pub(crate) fn new(shared: Arc<Shared>) -> Self {
        Evaluator {
            shared,
            parameters: Vec::new(),
            derived: Vec::new(),
            compiled: [const { OnceCell::new() }; Method::ALL.len()],
            combined: [const { OnceCell::new() }; Combination::ALL.len()],
            outputs: OnceCell::new(),
            interpreter: OnceCell::new(),
        }
    }

    /// True if the method runs as machine code.
    pub fn is_compiled(&self, method: Method) -> bool {
        self.compiled(method).is_some()
    }

    /// Length of the machine code of a method in bytes, with its constants; `None` if the method is interpreted.
    pub fn bytes(&self, method: Method) -> Option<usize> {
        self.compiled(method).map(Code::bytes)
    }

    fn compiled(&self, method: Method) -> Option<&Code<T>> {
        let list = || self.shared.lists.list(method);
        let compiled = self.compiled[method as usize].get_or_init(|| self.code(list()));
        compiled.as_ref()
    }

    fn combined(&self, combination: Combination) -> Option<&Code<T>> {
        let list = || self.shared.combined(combination);
        let combined = self.combined[combination as usize].get_or_init(|| self.code(list()));
        combined.as_ref()
    }

    fn code(&self, list: &List) -> Option<Code<T>> {
        compile(list, &self.shared.lists.curves, |function| {
            LibraryFunction {
                shared: self.shared.clone(),
                function,
            }
        })
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
    fn run(&self, method: Method, given: Given<'_, T>, results: &mut [T]) {
        match self.compiled(method) {
            Some(code) => code.run(given, &self.parameters, &self.derived, results),
            None => self.interpreter().run(method, given, results),
        }
    }

    fn run_combined(
        &self,
        combination: Combination,
        given: Given<'_, T>,
        results: &mut [T],
    ) -> bool {
        let code = self.combined(combination);
        if let Some(code) = code {
            code.run(given, &self.parameters, &self.derived, results);
        }
        code.is_some()
    }

    fn run_outputs(&self, wanted: &[usize], given: Given<'_, T>, results: &mut [T]) -> bool {
        let code = self.outputs.get_or_init(|| {
            let all = self.shared.combined(Combination::Outputs);
            let results = wanted.iter().map(|index| all.results[*index]).collect();
            self.code(&List {
                results,
                ..all.clone()
            })
        });
        if let Some(code) = code {
            code.run(given, &self.parameters, &self.derived, results);
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
    shared: Arc<Shared>,
    function: Function,
}

impl<T: Real> Call<T> for LibraryFunction {
    fn call(&self, arguments: &[T], results: &mut [T]) {
        self.shared.library.call(self.function, arguments, results);
    }
}

//! The interpreter: runs lists over any scalar.
//!
//! When a method is used for the first time, its list becomes code for all scalars. Operations are ordered such that
//! those of one kind follow each other, and one loop executes each such run: to find out which operation is next takes
//! longer than most operations. Values get places in a frame, and a place is reused after the last use of its value.
//!
//! All methods share one frame: constants, parameters, values derived from them, time, state, and room for the results
//! of operations. The operations and their rounding are those of the list.

use crate::call::{self, Library};
use crate::execute::{Execute, Given};
use crate::model::Shared;
use crate::sets::Sets;
use bryant_generator::expression::Function;
use bryant_generator::program::{Input, List, Lists, Methods, Operation, Value};
use bryant_runtime::{Real, Task};
use std::cell::RefCell;
use std::collections::HashMap;
use std::sync::{Arc, OnceLock};

/// The methods of a model in the form that the interpreter runs, the same for all scalars.
#[derive(Debug)]
pub struct Programs {
    constants: Vec<f64>,
    /// The place of each constant, by its bits.
    place_of: HashMap<u64, FrameIndex>,
    layout: Layout,
    /// The code of each set of methods.
    codes: Sets<Code>,
    /// The code of each function.
    functions: Box<[OnceLock<Code>]>,
}

/// A place in the frame.
type FrameIndex = u32;

/// The first place of each part of the frame. The constants come first, then these parts in their order.
#[derive(Clone, Copy, Debug)]
struct Layout {
    parameters: FrameIndex,
    derived: FrameIndex,
    time: FrameIndex,
    state: FrameIndex,
    /// Results of operations.
    rest: FrameIndex,
}

/// A list in the form that the interpreter runs.
#[derive(Debug, Default)]
struct Code {
    runs: Vec<Run>,
    steps: Vec<Step>,
    /// The calls; a step has the index of its call.
    calls: Vec<Call>,
    /// The places of the arguments of calls.
    arguments: Vec<FrameIndex>,
    /// Number of arguments of the longest call.
    most_arguments: usize,
    /// The places of the results of the list.
    results: Vec<FrameIndex>,
    /// One more than the largest place.
    end: usize,
}

/// Successive operations of one kind.
#[derive(Clone, Copy, Debug)]
struct Run {
    kind: OperationKind,
    count: usize,
}

/// An operation on places: that of its first result, and those of its operands. In a call, `a` is the index of the
/// call.
#[derive(Clone, Copy, Debug)]
struct Step {
    to: FrameIndex,
    a: FrameIndex,
    b: FrameIndex,
    c: FrameIndex,
}

/// A call: the range of its arguments; and the first place of its results, with their number.
#[derive(Clone, Copy, Debug)]
struct Call {
    function: Function,
    arguments: (usize, usize),
    results: (usize, usize),
}

/// The kind of an operation.
#[derive(Clone, Copy, Debug, PartialEq)]
enum OperationKind {
    Mul,
    MulAdd,
    Add,
    Sub,
    Neg,
    Div,
    Sqrt,
    SinCos,
    Atan2,
    Max,
    Min,
    Call,
}

/// Number of kinds.
const KINDS: usize = OperationKind::Call as usize + 1;

impl OperationKind {
    fn of(operation: Operation) -> OperationKind {
        match operation {
            Operation::Neg(_) => OperationKind::Neg,
            Operation::Add(..) => OperationKind::Add,
            Operation::Sub(..) => OperationKind::Sub,
            Operation::Mul(..) => OperationKind::Mul,
            Operation::Div(..) => OperationKind::Div,
            Operation::MulAdd(..) => OperationKind::MulAdd,
            Operation::Sqrt(_) => OperationKind::Sqrt,
            Operation::SinCos(_) => OperationKind::SinCos,
            Operation::Atan2(..) => OperationKind::Atan2,
            Operation::Max(..) => OperationKind::Max,
            Operation::Min(..) => OperationKind::Min,
            Operation::Call { .. } => OperationKind::Call,
        }
    }
}

impl Layout {
    /// The place of an input in the frame.
    fn place(&self, input: Input) -> FrameIndex {
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
        let mut place_of: HashMap<u64, FrameIndex> = HashMap::new();
        let functions = lists.functions.iter().map(|function| &function.list);
        let all = lists.routines.iter().map(|routine| &routine.list);
        for constant in all.chain(functions).flat_map(|list| &list.constants) {
            place_of.entry(constant.to_bits()).or_insert_with(|| {
                constants.push(*constant);
                constants.len() as FrameIndex - 1
            });
        }
        let parameters = constants.len() as FrameIndex;
        let derived = parameters + facts.parameters.len() as FrameIndex;
        let time = derived + lists.derived as FrameIndex;
        let state = time + 1;
        // accelerations, for functions that need them, are behind the state
        let accelerations = match lists.functions.iter().any(|of| of.accelerations) {
            true => facts.velocities.len() as FrameIndex,
            false => 0,
        };
        let rest = state + facts.kinds.len() as FrameIndex + accelerations;
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
            codes: Sets::default(),
            functions: lists.functions.iter().map(|_| OnceLock::new()).collect(),
        }
    }

    fn code(&self, methods: Methods, list: &List) -> Option<&Code> {
        let encode = || encode(list, &self.layout, &self.place_of);
        self.codes.get(methods, encode)
    }
}

/// Encodes a list. `constants` gives the place of each constant, by its bits.
fn encode(list: &List, layout: &Layout, constants: &HashMap<u64, FrameIndex>) -> Code {
    let ordered = in_runs(list);
    let mut place: Vec<FrameIndex> = Vec::with_capacity(list.values());
    place.extend(list.constants.iter().map(|c| constants[&c.to_bits()]));
    place.extend(list.inputs.iter().map(|input| layout.place(*input)));
    let leaves = place.len();
    place.resize(list.values(), 0);
    // for each value, the last operation that uses it, or the operation that defines it if none uses it
    let mut last_use = vec![usize::MAX; list.values()];
    for (number, &(first, operation)) in ordered.iter().enumerate() {
        last_use[first..first + operation.defines()].fill(number);
        for value in list.operands(operation) {
            if value.0 as usize >= leaves {
                last_use[value.0 as usize] = number;
            }
        }
    }
    for value in &list.results {
        last_use[value.0 as usize] = usize::MAX;
    }
    let (mut code, mut free, mut next) = (Code::default(), Vec::new(), layout.rest);
    for (number, &(first, operation)) in ordered.iter().enumerate() {
        let kind = OperationKind::of(operation);
        let mut operands = list.operands(operation);
        let argument = code.arguments.len();
        let [a, b, c] = match kind {
            OperationKind::Call => {
                code.arguments
                    .extend(operands.map(|value| place[value.0 as usize]));
                [code.calls.len() as FrameIndex, 0, 0]
            }
            _ => {
                std::array::from_fn(|_| operands.next().map_or(0, |value| place[value.0 as usize]))
            }
        };
        let count = operation.defines();
        // a value is freed once, even if the operation uses it twice
        let mut free_after = |value: usize, place: &[FrameIndex]| {
            if last_use[value] == number {
                last_use[value] = usize::MAX;
                free.push(place[value]);
            }
        };
        for value in list.operands(operation) {
            free_after(value.0 as usize, &place);
        }
        // The results of a call have neighbouring places. All arguments are copied before the results are written.
        let reused = (count == 1).then(|| free.pop()).flatten();
        let to = reused.unwrap_or_else(|| {
            next += count as FrameIndex;
            next - count as FrameIndex
        });
        for value in first..first + count {
            place[value] = to + (value - first) as FrameIndex;
            if last_use[value] == number {
                free.push(place[value]);
            }
        }
        if let Operation::Call { function, .. } = operation {
            code.most_arguments = code.most_arguments.max(function.arity());
            code.calls.push(Call {
                function,
                arguments: (argument, code.arguments.len()),
                results: (to as usize, count),
            });
        }
        match code.runs.last_mut() {
            Some(run) if run.kind == kind => run.count += 1,
            _ => code.runs.push(Run { kind, count: 1 }),
        }
        code.steps.push(Step { to, a, b, c });
    }
    code.results = (list.results.iter())
        .map(|value| place[value.0 as usize])
        .collect();
    code.end = next as usize;
    code
}

/// The operations of a list, each with the first value that it defines, in an order of long runs.
///
/// Kinds take turns, and an operation waits for its operands and then for the turn of its kind. In one turn operations
/// keep their order, so there an operation may follow its operand.
fn in_runs(list: &List) -> Vec<(usize, Operation)> {
    let mut turns = vec![0; list.values()];
    let mut next = list.constants.len() + list.inputs.len();
    let mut ordered = Vec::with_capacity(list.operations.len());
    for &operation in &list.operations {
        let operands = list.operands(operation);
        let ready = operands.map(|Value(value)| turns[value as usize]).max();
        let (ready, kind) = (ready.unwrap_or(0), OperationKind::of(operation) as usize);
        let turn = ready + (KINDS + kind - ready % KINDS) % KINDS;
        ordered.push((turn, (next, operation)));
        let first = next;
        next += operation.defines();
        turns[first..next].fill(turn);
    }
    ordered.sort_by_key(|(turn, _)| *turn);
    ordered.into_iter().map(|(_, step)| step).collect()
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
    /// Room for the arguments of a call.
    arguments: Vec<T>,
}

impl<T: Real> Interpreter<T> {
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
        Interpreter { shared, values }
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
        let list = self.shared.list(methods);
        let Some(code) = list.and_then(|list| programs.code(methods, list)) else {
            return false;
        };
        self.run_code(code, given, results);
        true
    }

    fn run_function(&self, index: usize, given: Given<'_, T>, results: &mut [T]) {
        let programs = self.shared.programs();
        let encode = || {
            encode(
                &self.shared.functions[index],
                &programs.layout,
                &programs.place_of,
            )
        };
        self.run_code(
            programs.functions[index].get_or_init(encode),
            given,
            results,
        );
    }
}

/// The results of a list by itself, as tests need it. `inputs` are the parameters, the values derived from them, the
/// time and the state.
pub fn alone(list: &List, inputs: [&[f64]; 4]) -> Vec<f64> {
    let mut starts = [list.constants.len() as FrameIndex; 5];
    for (i, input) in inputs.iter().enumerate() {
        starts[i + 1] = starts[i] + input.len() as FrameIndex;
    }
    let [parameters, derived, time, state, rest] = starts;
    let layout = Layout {
        parameters,
        derived,
        time,
        state,
        rest,
    };
    let places = (0..).zip(&list.constants);
    let constants = places.map(|(place, c)| (c.to_bits(), place)).collect();
    let code = encode(list, &layout, &constants);
    let mut frame = [&list.constants[..], &inputs.concat()].concat();
    frame.resize(code.end, f64::NAN);
    f64::dispatch(Runs {
        code: &code,
        library: &Library::new(&[], None),
        frame: &mut frame,
        arguments: &mut vec![f64::NAN; code.most_arguments],
    });
    let results = code.results.iter();
    results.map(|&place| frame[place as usize]).collect()
}

/// The number of runs of one kind of operation in a list, in its own order and in that in which they are executed.
pub fn count_runs(list: &List) -> [usize; 2] {
    let runs = |operations: &mut dyn Iterator<Item = Operation>| {
        let kinds: Vec<OperationKind> = operations.map(OperationKind::of).collect();
        kinds.chunk_by(|a, b| a == b).count()
    };
    [
        runs(&mut list.operations.iter().copied()),
        runs(&mut in_runs(list).into_iter().map(|(_, operation)| operation)),
    ]
}

impl<T: Real> Interpreter<T> {
    fn run_code(&self, code: &Code, given: Given<'_, T>, results: &mut [T]) {
        let Values { frame, arguments } = &mut *self.values.borrow_mut();
        let layout = self.shared.programs().layout;
        frame[layout.time as usize] = given.time;
        frame[layout.state as usize..][..given.state.len()].copy_from_slice(given.state);
        // nothing is allocated when the method runs again
        let grow = |room: &mut Vec<T>, length| {
            if room.len() < length {
                room.resize(length, T::from_f64(0.0));
            }
        };
        grow(frame, code.end);
        grow(arguments, code.most_arguments);
        T::dispatch(Runs {
            code,
            library: &self.shared.library,
            frame,
            arguments,
        });
        for (result, &place) in results.iter_mut().zip(&code.results) {
            *result = frame[place as usize];
        }
    }
}

/// The runs of a list as a task, compiled for the instructions of the scalar.
struct Runs<'a, T> {
    code: &'a Code,
    library: &'a Library,
    frame: &'a mut [T],
    /// Room for the arguments of a call.
    arguments: &'a mut [T],
}

impl<T: Real> Task for Runs<'_, T> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        let Runs {
            code,
            library,
            frame,
            arguments,
        } = self;
        let mut rest = &code.steps[..];
        for run in &code.runs {
            let (steps, after) = rest.split_at(run.count);
            rest = after;
            // executes all steps of the run; a closure would not have the instructions of the scalar
            macro_rules! each {
                ($($operand:ident)*: $result:expr) => {
                    for step in steps {
                        $(let $operand = frame[step.$operand as usize];)*
                        frame[step.to as usize] = $result;
                    }
                };
            }
            match run.kind {
                OperationKind::Neg => each!(a: -a),
                OperationKind::Add => each!(a b: a + b),
                OperationKind::Sub => each!(a b: a - b),
                OperationKind::Mul => each!(a b: a * b),
                OperationKind::Div => each!(a b: a / b),
                OperationKind::MulAdd => each!(a b c: a.mul_add(b, c)),
                OperationKind::Sqrt => each!(a: a.sqrt()),
                OperationKind::SinCos => {
                    for step in steps {
                        let (sin, cos) = call::sin_cos(frame[step.a as usize]);
                        frame[step.to as usize] = sin;
                        frame[step.to as usize + 1] = cos;
                    }
                }
                OperationKind::Atan2 => each!(a b: call::atan2(a, b)),
                OperationKind::Max => each!(a b: a.max(b)),
                OperationKind::Min => each!(a b: a.min(b)),
                OperationKind::Call => {
                    for step in steps {
                        let call = &code.calls[step.a as usize];
                        let places = &code.arguments[call.arguments.0..call.arguments.1];
                        for (argument, &place) in arguments.iter_mut().zip(places) {
                            *argument = frame[place as usize];
                        }
                        let (to, count) = call.results;
                        let given = &arguments[..places.len()];
                        library.call(call.function, given, &mut frame[to..to + count]);
                    }
                }
            }
        }
    }
}

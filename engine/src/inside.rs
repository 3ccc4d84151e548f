//! What the tests in `tests/it`, which are compiled apart from this crate, see of its inside.

pub use crate::call::Library;
pub use crate::native::{Call, Compiled, compile, target, there};

use crate::evaluate::Evaluator;
use crate::interpret;
use crate::model::{Engine, WithoutJacobian};
use bryant_generator::program::{List, Method};
use bryant_runtime::{Adjustable, Family, Real};

/// A model by the interpreter and by machine code, without a Jacobian, as batches have it: with one, its equations would be
/// compiled over dual numbers of the scalar.
pub fn for_batch<T: Real>(engine: &Engine) -> [Box<dyn Adjustable<T> + '_>; 2] {
    let interpreted = Box::new(WithoutJacobian(engine.interpreted::<T>()));
    [interpreted, Family::for_batch(engine)]
}

/// The results of a list by the interpreter. `inputs` are the parameters, the values derived from them, the time and the state.
pub fn interpreted(list: &List, inputs: [&[f64]; 4]) -> Vec<f64> {
    interpret::alone(list, inputs)
}

/// The number of runs of one kind of operation in a list, in its own order and in that of the interpreter.
pub fn runs(list: &List) -> [usize; 2] {
    interpret::count_runs(list)
}

/// The addresses of the machine code of an engine over one scalar: of the derivative, of the event functions with what
/// precedes them, and of the outputs that are wanted. `None` where there is no code.
pub fn addresses<T: Real>(engine: &Engine, wanted: &[usize]) -> [Option<usize>; 3] {
    let evaluator = Evaluator::<T>::new(engine.shared.clone());
    let of = |method: Method| evaluator.address(method);
    let (derivative, events) = (of(Method::Derivative), of(Method::EventFunctions));
    [derivative, events, evaluator.address_of_outputs(wanted)]
}

//! What the tests in `tests/it`, which are compiled apart from this crate, see of its inside.

pub use crate::call::Library;
pub use crate::interpret::{alone, count_runs};
pub use crate::native::{Call, Compiled, compile, has_machine_code, target};

use crate::evaluate::Evaluator;
use crate::model::{Engine, WithoutJacobian};
use bryant_generator::program::Method;
use bryant_runtime::{Adjustable, Family, Real};

/// A model by the interpreter and by machine code, without a Jacobian, as batches have it: with one, its equations
/// would be compiled over dual numbers of the scalar.
pub fn for_batch<T: Real>(engine: &Engine) -> [Box<dyn Adjustable<T> + '_>; 2] {
    let interpreted = Box::new(WithoutJacobian(engine.interpreted::<T>()));
    [interpreted, Family::for_batch(engine)]
}

/// The addresses of the machine code of an engine over one scalar: of the derivative, of the event functions with what
/// precedes them, and of the outputs that are wanted. `None` where there is no code. While the second result is kept,
/// no other code can have the addresses of the first two.
pub fn addresses<T: Real>(
    engine: &Engine,
    wanted: &[usize],
) -> ([Option<usize>; 3], impl Sized + use<T>) {
    let evaluator = Evaluator::<T>::new(engine.shared.clone());
    let of = |method: Method| evaluator.address(method);
    let (derivative, events) = (of(Method::Derivative), of(Method::EventFunctions));
    let outputs = evaluator.address_of_outputs(wanted);
    ([derivative, events, outputs], evaluator)
}

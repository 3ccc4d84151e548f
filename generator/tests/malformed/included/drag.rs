//! A user function.

fn helper() {}

pub fn drag<T: Real>(input: &Input<T>) -> Output<T> {
    let mut output = Output::zero();
    output.points.head.force = input.points.hed.velocity;
    output.states.path.rate = input.parameters.area;
    output
}

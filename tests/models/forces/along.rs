/// A force along x.
pub fn along<T: Real>(input: &Input<T>) -> Output<T> {
    let mut output = Output::zero();
    output.points.at.force[0] = input.parameters.force;
    output
}

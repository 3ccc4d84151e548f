fn drag<T: Real>(input: &Input<T>) -> Output<T> {
    let mut output = Output::zero();
    output.points.head.force = input.points.head.velocity;
    output
}

fn lift<T: Real>(input: &Input<T>) -> Output<T> {
    drag(input)
}

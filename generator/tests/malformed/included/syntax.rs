fn drag<T: Real>(input: &Input<T>) -> Output<T> {
    let x = 1.0 +;
    Output::zero()
}

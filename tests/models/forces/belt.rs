/// A belt force that returns all results in one literal.
pub fn belt<T: Real>(input: &Input<T>) -> Output<T> {
    let zero = T::from_f64(0.0);
    let input::Parameters { stiffness, damping, length } = input.parameters;
    let chest = input.lines.chest;
    let elongation = chest.length / length - T::from_f64(1.0);
    let force = (T::from_f64(10.0) * stiffness * elongation + damping * chest.rate).max(zero);
    let tension = T::select(zero.lt(elongation), force, zero);
    Output {
        lines: output::Lines { chest: output::Line { tension } },
    }
}

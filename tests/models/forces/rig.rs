//! The forces of `twin-joints.yaml`, along freedoms.

/// A spring and a damper along the rails, a damper about one axis of a list, a screw driven by time, a spring on a
/// follower.
pub fn rig<T: Real>(input: &Input<T>) -> Output<T> {
    let num = T::from_f64;
    let (freedoms, p) = (&input.freedoms, input.parameters);
    let mut output = Output::zero();
    let slide = freedoms.slide;
    output.freedoms.slide.effort = -p.stiffness * slide.coordinate - num(5.0) * slide.rate;
    output.freedoms.pitch.effort = -num(0.5) * freedoms.pitch.rate;
    let nut = freedoms.nut;
    output.freedoms.nut.effort = num(2.0) * (input.time - nut.coordinate) - num(0.01) * nut.rate;
    output.freedoms.gear.effort = -num(3.0) * freedoms.gear.coordinate;
    output
}

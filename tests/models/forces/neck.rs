//! Torques about the three relative rotations.

// importing an already imported name again is allowed
use bryant_runtime::Real;

/// Elastic about x and y, viscous about all.
fn neck<T: Real>(input: &Input<T>) -> Output<T> {
    let num = T::from_f64;
    let p = &input.parameters;
    let input::Joint { angle: [x, y, _], rate } = input.joints.joint;
    let mut output = Output::zero();
    output.joints.joint.torque = [
        -(p.x * x) - num(0.4) * rate[0],
        -(p.y * y) - num(0.6) * rate[1],
        num(-0.5) * rate[2],
    ];
    output
}

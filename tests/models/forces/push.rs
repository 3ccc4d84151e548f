//! A force at one point of a body, converted to a force at another point and a moment.

/// F = (30, −20, 10) N at the tip; inputs that are given in several forms are compared.
pub fn push<T: Real>(input: &Input<T>) -> Output<T> {
    let num = T::from_f64;
    let (origin, tip, head) = (&input.points.origin, &input.points.tip, &input.bodies.head);
    let force = [30.0, -20.0, 10.0].map(num);
    let local = [0.05, -0.02, 0.1].map(num);
    let arm = head.rotation.map(|row| dot(row, local));

    // this is 0 if the position, velocity, rotation and angular velocity have the meaning of their names
    let turning = cross(head.angular_velocity, arm);
    let mut apart = num(0.0);
    for i in 0..3 {
        apart += (tip.position[i] - origin.position[i] - arm[i]).abs();
        apart += (tip.velocity[i] - origin.velocity[i] - turning[i]).abs();
    }

    let mut output = Output::zero();
    output.points.origin.force = force;
    let moment = cross(arm, force);
    output.bodies.head.moment = [
        moment[0] + num(1.0) + num(1e3) * apart,
        moment[1] + num(2.0),
        moment[2] + num(3.0),
    ];
    output.points.tip.force = [num(0.0); 3];
    output
}

fn dot<T: Real>(a: [T; 3], b: [T; 3]) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross<T: Real>(a: [T; 3], b: [T; 3]) -> [T; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

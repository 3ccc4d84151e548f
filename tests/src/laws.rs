//! Force laws in a user's crate: the model names them by their path.

use crate::models::user_plane::plane::{Input, Output, input};
use bryant_runtime::Real;

/// The forces of `models/twin-plane.yaml`. Inputs that are given in several forms are compared: a difference would turn
/// the head.
pub fn plane<T: Real>(input: &Input<T>) -> Output<T> {
    let num = T::from_f64;
    let (points, bodies, lines) = (&input.points, &input.bodies, &input.lines);
    let mut output = Output::zero();

    output.points.torso_cg.force = [num(0.0), num(-30.0) * input.parameters.gravity];
    output.points.head_cg.force = [num(0.0), num(-4.5) * input.parameters.gravity];
    output.points.head.force = [num(30.0), num(-20.0)];
    // this force acts on the absolute frame, so it has no effect
    output.points.anchor.force = [num(1e6), num(1e6)];

    // the root's joint is between it and the absolute frame
    let body = &bodies.body;
    output.bodies.body.moment = -(num(90.0) * body.angle) - num(3.0) * body.angular_velocity;
    // from the centre of gravity to the other point of the head: (0.03, 0) rotated, and its velocity ω × r
    let (sin, cos) = bodies.skull.angle.sin_cos();
    let arm = [num(0.03) * cos, num(-0.03) * sin];
    let [x, z] = between(points.head_cg.position, points.head.position);
    let [vx, vz] = between(points.head_cg.velocity, points.head.velocity);
    let omega = bodies.skull.angular_velocity;
    let apart = [
        x - arm[0],
        z - arm[1],
        vx - omega * arm[1],
        vz + omega * arm[0],
    ];
    let apart = apart.into_iter().fold(num(0.0), |sum, d| sum + d.abs());
    output.bodies.skull.moment = num(4.0) + num(1e3) * apart;

    let elongation = lines.chest.length / num(0.55) - num(1.0);
    output.lines.chest.tension = taut(
        elongation,
        input.curves.webbing(elongation) + num(100.0) * lines.chest.rate,
    );
    let elongation = lines.chin.length / num(0.15) - num(1.0);
    output.lines.chin.tension = taut(elongation, num(500.0) * elongation);

    let input::Joint { angle, rate } = input.joints.neck;
    output.joints.neck.torque =
        -input.curves.elastic(angle - input.parameters.neutral) - num(0.6) * rate;
    output
}

fn between<T: Real>(from: [T; 2], to: [T; 2]) -> [T; 2] {
    [to[0] - from[0], to[1] - from[1]]
}

/// A tension if the line is taut, else 0.
fn taut<T: Real>(elongation: T, tension: T) -> T {
    let zero = T::from_f64(0.0);
    T::select(zero.lt(elongation), tension.max(zero), zero)
}

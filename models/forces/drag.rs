//! Aerodynamic drag on a body that is small against the distances in which the wind changes.

/// F = −½ ρ c_d A |w| w, with w = v − wind the velocity of the point relative to the air.
///
/// G. K. Batchelor, An Introduction to Fluid Dynamics, 1967, section 4.12. It holds where the flow has separated
/// (Reynolds numbers of 10³ to 10⁵ for a sphere); c_d and A do not change with the direction of the flow.
pub fn drag<T: Real>(input: &Input<T>) -> Output<T> {
    let input::Parameters { density, area, cd, wind } = input.parameters;
    let [x, z] = input.points.body.velocity;
    let x = x - wind;
    let speed = (x * x + z * z).sqrt();
    let factor = T::from_f64(-0.5) * density * cd * area * speed;

    let mut output = Output::zero();
    output.points.body.force = [factor * x, factor * z];
    output
}

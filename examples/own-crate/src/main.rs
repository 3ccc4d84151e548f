//! A double pendulum twice: its accelerations in a loop, and a run of it.

mod double_pendulum {
    bryant_runtime::include_model!("double-pendulum");
}

use bryant_runtime::nalgebra::SVector;
use bryant_runtime::{Failure, Settings, simulate};
use double_pendulum::{INFO, Mechanism, Parameters, coordinates, outputs};
use std::hint::black_box;
use std::time::Instant;

fn main() -> Result<(), Failure<'static>> {
    let pendulum = Mechanism::new(Parameters { brake: 0.01 });

    // what a controller or a sampler does
    let (mut q, v) = pendulum.initial_conditions();
    let evaluations = 1_000_000;
    let start = Instant::now();
    for i in 0..evaluations {
        q[coordinates::LOWER_PHI] = 1e-6 * f64::from(i);
        black_box(pendulum.accelerations(0.0, black_box(&q), &v));
    }
    let each = start.elapsed() / evaluations;
    println!("accelerations: {each:?} each");

    // S v̇ = r_s + r_k as matrices: mass matrix S, bias forces r_s (`velocity_forces`), applied forces r_k
    let accelerations = SVector::from(pendulum.accelerations(0.0, &q, &v));
    let forces = pendulum.velocity_forces(&q, &v) + pendulum.applied_forces(0.0, &q, &v);
    let mass = pendulum.mass_matrix(&q);
    let rest = mass * accelerations - forces;
    println!("S v̇ − r_s − r_k, N m: {:.0e} {:.0e}", rest[0], rest[1]);
    // S is positive definite, so v̇ = S⁻¹ (r_s + r_k) by its Cholesky decomposition, too
    if let Some(root) = mass.cholesky() {
        let difference = root.solve(&forces) - accelerations;
        println!(
            "v̇ by Cholesky's decomposition, rad/s²: {:.0e} away",
            difference.amax()
        );
    }

    println!("{:>6} {:>8} {:>8} {:>8}", "t", "tip x", "tip z", "energy");
    let report = simulate(&pendulum, &Settings::of(&INFO), &mut |sample| {
        let [x, z, energy] =
            [outputs::TIP_X, outputs::TIP_Z, outputs::ENERGY].map(|at| sample.outputs[at]);
        println!("{:6.2} {x:8.4} {z:8.4} {energy:8.4}", sample.t);
    })?;
    println!("{} steps, {} evaluations", report.steps, report.evaluations);
    Ok(())
}

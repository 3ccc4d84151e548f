use bryant_generator::dynamics::elimination::tip::Pinned;
use bryant_generator::expression::evaluate::{Inputs, NoFunctions, evaluate};
use bryant_generator::expression::{Graph, Symbol};
use nalgebra::{Matrix3, Vector3};

/// Q and −J⁻¹ b̃, assembled from the vectors p, for a body of 3 kg whose mass is a number or the value of a parameter.
fn put_together(
    parameter: bool,
    moments: [f64; 3],
    g: [f64; 3],
) -> (usize, Matrix3<f64>, Matrix3<f64>) {
    let graph = Graph::new();
    let mass = match parameter {
        true => graph.symbol(Symbol::Parameter(0)),
        false => graph.constant(3.0),
    };
    let answers = Pinned::of(mass, moments, g).answers();
    let inputs = Inputs {
        time: 0.0,
        coordinates: &[],
        velocities: &[],
        parameters: &[3.0],
        auxiliaries: &[],
        memory: &[],
        accelerations: &[],
    };
    let (mut resistance, mut turning) = (Matrix3::zeros(), Matrix3::zeros());
    for answer in &answers {
        let entries = [answer.across, answer.turn].into_iter().flat_map(|v| v.0);
        let mut roots = vec![answer.resistance.id()];
        roots.extend(entries.map(|entry| entry.id()));
        let found = evaluate(&graph, &roots, &inputs, &NoFunctions);
        let across = Vector3::from_column_slice(&found[1..4]);
        resistance += found[0] * across * across.transpose();
        turning += Vector3::from_column_slice(&found[4..7]) * across.transpose();
    }
    (answers.len(), resistance, turning)
}

#[test]
fn answers_are_those_of_the_inverse_inertia() {
    let bodies = [
        ([0.0178, 0.0234, 0.0201], [0.019, 0.001, 0.042]),
        ([0.0011, 0.0056, 0.0059], [0.061, -0.004, -0.045]),
        // a spherical body, a rod, and centres of gravity on a principal axis and in a plane of two of them
        ([0.02, 0.02, 0.02], [0.03, -0.02, 0.05]),
        ([0.02, 0.02, 1e-6], [0.0, 0.0, -0.2]),
        ([0.3, 0.2, 0.4], [0.1, 0.0, 0.0]),
        ([0.3, 0.2, 0.4], [0.0, -0.3, 0.2]),
    ];
    for (moments, g) in bodies {
        let b: Vector3<f64> = 3.0 * Vector3::from(g);
        let tilde = b.cross_matrix();
        let inertia = Matrix3::from_diagonal(&Vector3::from(moments));
        let about_joint = inertia - tilde * tilde / 3.0;
        let inverse = about_joint.try_inverse().unwrap();
        let condition = about_joint.norm() * inverse.norm();
        for parameter in [false, true] {
            let (count, resistance, turning) = put_together(parameter, moments, g);
            assert_eq!(count, 2);
            // some tens of roundings, each multiplied by the condition number of J
            let near = |found: Matrix3<f64>, expected: Matrix3<f64>| {
                let bound = 50.0 * f64::EPSILON * condition * expected.norm();
                let difference = (found - expected).norm();
                assert!(difference <= bound, "{moments:?} {g:?}: {difference:e}");
            };
            near(resistance, -tilde * inverse * tilde);
            near(turning, -inverse * tilde);
        }
    }
}

#[test]
fn a_body_held_at_its_centre_answers_nothing() {
    for parameter in [false, true] {
        let (count, ..) = put_together(parameter, [0.3, 0.2, 0.4], [0.0; 3]);
        assert_eq!(count, 0);
    }
}

//! How many operations one evaluation of the accelerations takes: what `bryant check` prints, a fused multiply-add being two.
//!
//! Counts are the same on every machine. The bounds are goals, not measurements: the snapshots have the figures.

use bryant_generator::emit;
use bryant_generator::equations::Route;
use bryant_generator::expression::evaluate::{Inputs, evaluate};
use bryant_generator::formalism::{Options, derive_with};
use bryant_generator::model::{Coordinates, Dimension, Model, Number, Parameter, Reference, read};
use bryant_tests::reference::load;
use bryant_tests::trees::{Random, Shape, choices, random_charts, random_state, random_tree};
use std::path::Path;

/// Operations of `accelerations` as emitted.
fn operations(model: &Model) -> usize {
    let options = Options {
        matrices: false,
        ..Options::default()
    };
    let equations = derive_with(model, options);
    let emitted = emit::Options {
        matrices: false,
        ..emit::Options::default()
    };
    let costs = emit::costs(model, &equations, &emitted);
    let found = costs.iter().find(|(method, _)| *method == "accelerations");
    found.map_or(0, |(_, table)| table.total.total())
}

fn model(file: &str) -> Model {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    read(&path)
        .unwrap_or_else(|problems| panic!("{problems}"))
        .0
}

#[track_caller]
fn at_most(name: &str, model: &Model, goal: usize) {
    let operations = operations(model);
    println!("{name}: {operations}, goal {goal}");
    assert!(operations > 0, "{name}: nothing is computed");
    assert!(operations <= goal, "{name}: {operations} > {goal}");
}

#[test]
fn a_human_like_tree_takes_less_than_5000() {
    at_most("dummy15", &model("../models/dummy15.yaml"), 5_000);
}

#[test]
fn a_chain_of_100_takes_less_than_34000() {
    at_most("chain100", &model("models/large/chain100.yaml"), 34_000);
}

/// Nothing vanishes here: lengths, centres of gravity and principal axes in all directions.
#[test]
fn a_chain_of_100_of_any_shape_takes_less_than_36000() {
    let (space, coordinates) = (Dimension::Space, Coordinates::Quaternion);
    let shape = Shape::Chain;
    let mut random = Random::new(5);
    let model = random_tree(&mut random, space, coordinates, Reference::Free, shape, 100);
    at_most("random chain", &model, 36_000);
}

/// Robotran prints 763 for S and r_s alone of nine planar joints.
#[test]
fn nine_elements_in_the_plane_take_less_than_600() {
    let tree = load("planar9", Coordinates::Quaternion);
    at_most("planar9", &tree.model, 600);
}

#[test]
fn a_human_like_tree_of_adjustable_masses_takes_less_than_5400() {
    let model = with_adjustable_masses(model("../models/dummy15.yaml"));
    at_most("dummy15 of parameters", &model, 5_400);
}

/// Every mass a parameter with the value that it has.
fn with_adjustable_masses(mut model: Model) -> Model {
    for system in &mut model.systems {
        for element in &mut system.elements {
            let Number::Constant(default) = element.mass else {
                panic!("{}: a mass that is a number", element.name)
            };
            element.mass = Number::Parameter(model.parameters.len());
            model.parameters.push(Parameter {
                name: format!("mass_of_{}", element.name.replace('-', "_")),
                default,
                min: None,
                max: None,
                unit: "kg".into(),
            });
        }
    }
    model
}

/// A body of numbers is eliminated in its own axes, one of parameters in the absolute ones: two derivations of the same
/// motion. Both solve S v̇ = r, so they differ by c·κ(S)·ε; κ(S) is below 1e6 for these trees (masses 0.5 to 5 kg, lengths up to
/// 0.4 m, moments from 1e-4 kg m² on), and c = 10 as where elimination is compared with Cholesky.
#[test]
fn numbers_and_parameters_give_the_same_accelerations() {
    let mut random = Random::new(6);
    let shapes = [Shape::Chain, Shape::Star, Shape::Random];
    for coordinates in [Coordinates::Quaternion, Coordinates::Bryant] {
        for reference in [Reference::Free, Reference::Fixed] {
            for (shape, count) in shapes.into_iter().zip([6, 4, 9]) {
                let space = Dimension::Space;
                let tree = random_tree(
                    &mut random,
                    space,
                    coordinates,
                    reference.clone(),
                    shape,
                    count,
                );
                let adjustable = with_adjustable_masses(tree.clone());
                let masses: Vec<f64> = adjustable.parameters.iter().map(|p| p.default).collect();
                let options = Options {
                    matrices: false,
                    route: Some(Route::Elimination),
                };
                let of_numbers = derive_with(&tree, options);
                let of_parameters = derive_with(&adjustable, options);
                for _ in 0..20 {
                    let (q, v) = random_state(&mut random, &tree);
                    let m = random_charts(&mut random, &tree);
                    let [ours, expected] = [(&of_numbers, &[][..]), (&of_parameters, &masses)].map(
                        |(equations, parameters)| {
                            let inputs = Inputs {
                                time: 0.0,
                                coordinates: &q,
                                velocities: &v,
                                parameters,
                                auxiliaries: &[],
                                memory: &m,
                            };
                            evaluate(
                                &equations.graph,
                                &equations.accelerations,
                                &inputs,
                                &choices,
                            )
                        },
                    );
                    let norm = |x: &mut dyn Iterator<Item = f64>| x.map(|x| x * x).sum::<f64>();
                    let size = norm(&mut expected.iter().copied()).sqrt();
                    let pairs = ours.iter().zip(&expected);
                    let difference = norm(&mut pairs.map(|(a, b)| a - b)).sqrt() / size;
                    let bound = 10.0 * 1e6 * f64::EPSILON;
                    assert!(
                        difference <= bound,
                        "{coordinates:?} {reference:?} {shape:?}: {difference:e} > {bound:e}"
                    );
                }
            }
        }
    }
}

//! The number of operations in one evaluation of the accelerations, as `bryant check` prints it; a fused multiply-add
//! counts as two.
//!
//! Counts are the same on every machine. The bounds are goals, not measurements: the snapshots have the actual counts.

use bryant_generator::dynamics::{Options, derive_with};
use bryant_generator::equations::Route;
use bryant_generator::expression::count::Count;
use bryant_generator::expression::evaluate::{Inputs, evaluate};
use bryant_generator::expression::passes::factor::factor;
use bryant_generator::model::{Coordinates, Dimension, Model, Number, Parameter, Reference};
use bryant_generator::program;
use bryant_generator::read;
use bryant_generator::read_str;
use bryant_tests::reference::load;
use bryant_tests::trees::{Random, Shape, choices, random_charts, random_state, random_tree};
use std::path::Path;

/// Number of operations in the emitted `accelerations`.
fn operations(model: &Model) -> usize {
    let options = Options {
        matrices: false,
        ..Options::default()
    };
    let equations = derive_with(model, options);
    let emitted = program::Options {
        matrices: false,
        ..program::Options::default()
    };
    let costs = program::costs(model, &equations, &emitted);
    let found = costs.iter().find(|(method, _)| *method == "accelerations");
    found.map_or(0, |(_, table)| table.total.total())
}

/// Number of operations for S (its upper triangle) and r_s together.
fn operations_of_matrices(model: &Model) -> usize {
    let equations = derive_with(model, Options::default());
    let rows = equations.mass_matrix.iter().enumerate();
    let mut roots: Vec<_> = rows.flat_map(|(i, row)| row[i..].to_vec()).collect();
    roots.extend(&equations.velocity_forces);
    let factored = factor(&equations.graph, &roots);
    Count::of(&factored.graph, &factored.roots).total()
}

/// A mechanism in space that stands on the ground and falls, with these elements.
fn falling(reference: &str, elements: &str) -> Model {
    let text = format!(
        "model: falling\ndimension: 3\nsystems:\n  - name: s\n    reference: {reference}\n    elements:\n{elements}\
         forces:\n  - {{ field: gravity, acceleration: [0, 0, -9.81] }}\nrun: {{ duration: 1 s, every: 0.1 s }}\n"
    );
    let none = |_: &Path| Err(std::io::ErrorKind::NotFound.into());
    match read_str("falling.yaml", &text, &none) {
        Ok((model, _)) => model,
        Err(problems) => panic!("{problems}\n{text}"),
    }
}

/// An arm with the geometry and the masses of a UR5.
const ARM_OF_6: &str = "
      - { name: shoulder, joint: { hinge: z }, mass: 3.7, cg: [0, 0, 0], inertia: [0.010267495893, 0.010267495893, 0.00666] }
      - { name: upper-arm, on: shoulder, at: [0, 0.13585, 0], joint: { hinge: y }, mass: 8.393, cg: [0.28, 0, 0], inertia: [0.0151074, 0.22689067591, 0.22689067591] }
      - { name: forearm, on: upper-arm, at: [0.425, -0.1197, 0], joint: { hinge: y }, mass: 2.275, cg: [0.25, 0, 0], inertia: [0.004095, 0.049443313556, 0.049443313556] }
      - { name: wrist-1, on: forearm, at: [0.39225, 0, 0], joint: { hinge: y }, mass: 1.219, cg: [0, 0, 0], inertia: [0.111172755531, 0.111172755531, 0.21942] }
      - { name: wrist-2, on: wrist-1, at: [0, 0.093, 0], joint: { hinge: [0, 0, -1] }, mass: 1.219, cg: [0, 0, 0], inertia: [0.111172755531, 0.111172755531, 0.21942] }
      - { name: hand, on: wrist-2, at: [0, 0, -0.09465], joint: { hinge: y }, mass: 0.1879, cg: [0, 0, 0], inertia: [0.0171364731454, 0.0171364731454, 0.033822] }
";

/// An arm with seven hinges, each perpendicular to the one before and intersecting it, like a KUKA LBR iiwa; the bodies
/// have any shape.
fn arm_of_7() -> String {
    let mut random = Random::new(8);
    let mut text = String::new();
    for (k, (axis, at)) in ["z", "y", "z", "y", "z", "y", "z"]
        .into_iter()
        .zip([0.0, 0.2, 0.22, 0.18, 0.22, 0.18, 0.08])
        .enumerate()
    {
        let on = match k {
            0 => String::new(),
            _ => format!("on: e{}, at: [0, 0, {at}], ", k - 1),
        };
        let mut number = |low: f64, high: f64| random.uniform(low, high);
        let cg = [(); 3].map(|()| number(-0.1, 0.1));
        let inertia = [(); 3].map(|()| number(0.02, 0.03));
        let axes = [(); 3].map(|()| number(-1.0, 1.0));
        text += &format!(
            "      - {{ name: e{k}, {on}joint: {{ hinge: {axis} }}, mass: 3, cg: {cg:?}, inertia: {inertia:?}, axes: {axes:?} }}\n"
        );
    }
    text
}

/// The counts of a prototype of the formulation, plus 5 %: for S and the bias forces, and for the accelerations.
#[test]
fn arms_take_few_operations() {
    for (name, elements, matrices, accelerations) in [
        ("arm of 6", ARM_OF_6.to_owned(), 254, 333),
        ("arm of 7", arm_of_7(), 721, 928),
    ] {
        let model = falling("fixed", elements.trim_start_matches('\n'));
        at_most(name, &model, accelerations * 105 / 100);
        let found = operations_of_matrices(&model);
        println!("{name}: S and r_s {found}, goal {matrices}");
        assert!(found > 0, "{name}: nothing is computed");
        assert!(found <= matrices * 105 / 100, "{name}: S and r_s {found}");
    }
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

/// Nothing vanishes here: lengths, centres of gravity and principal axes have all directions.
#[test]
fn a_chain_of_100_of_any_shape_takes_less_than_36000() {
    let (space, coordinates) = (Dimension::Space, Coordinates::Quaternion);
    let shape = Shape::Chain;
    let mut random = Random::new(5);
    let model = random_tree(&mut random, space, coordinates, Reference::Free, shape, 100);
    at_most("random chain", &model, 36_000);
}

/// Robotran prints 763 operations for only S and r_s of nine planar joints.
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

/// The model with every mass as a parameter with its present value.
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
                input: false,
            });
        }
    }
    model
}

/// A body with constant masses is eliminated in its own axes, one with parameters in absolute axes: two derivations of
/// the same motion. Both solve S v̇ = r, so they differ by c·κ(S)·ε; κ(S) is below 1e6 for these trees (masses 0.5 to 5
/// kg, lengths up to 0.4 m, moments from 1e-4 kg m² on), and c = 10 as in the comparison of elimination with Cholesky.
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
                                accelerations: &[],
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

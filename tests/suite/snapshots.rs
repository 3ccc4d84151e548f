//! Texts that a person reviews: equations small enough to be checked by hand, and what the bundled models cost.

use bryant::notation::Notation;
use bryant_generator::Config;
use bryant_generator::equations::Equations;
use bryant_generator::expression::NodeId;
use bryant_generator::expression::count::{Count, Table};
use bryant_generator::expression::print::{Names, text};
use bryant_generator::formalism::derive;
use bryant_generator::model::{
    Force, ForceKind, JointTorque, Model, Number, Reference, read, read_str,
};
use std::fmt::Write;
use std::path::Path;

/// S by its upper triangle, r_s and r_k.
fn equations(yaml: &str) -> String {
    let none = |_: &Path| Err(std::io::ErrorKind::NotFound.into());
    let (model, _) =
        read_str("model.yaml", yaml, &none).unwrap_or_else(|problems| panic!("{problems}"));
    let equations = derive(&model);
    let notation = Notation::new(&model, &equations);
    let names: Vec<String> = equations
        .velocities
        .iter()
        .map(|v| v.name.rsplit('/').next().unwrap_or(&v.name).to_owned())
        .collect();
    let mut roots = Vec::new();
    for (i, row) in equations.system_matrix.iter().enumerate() {
        for (j, entry) in row.iter().enumerate().skip(i) {
            if !equations.graph.expr(*entry).is_zero() {
                roots.push((format!("S[{}, {}]", names[i], names[j]), *entry));
            }
        }
    }
    for (vector, entries) in [
        ("r_s", &equations.velocity_forces),
        ("r_k", &equations.applied_forces),
    ] {
        for (name, entry) in names.iter().zip(entries) {
            roots.push((format!("{vector}[{name}]"), *entry));
        }
    }
    let symbol = |symbol| notation.text(symbol);
    let function = |function| notation.function(function);
    let names = Names {
        symbol: &symbol,
        function: &function,
    };
    text(&equations.graph, &roots, &names)
}

#[test]
fn a_planar_double_pendulum_has_the_equations_of_the_textbook() {
    insta::assert_snapshot!(
        "double_pendulum",
        equations(
            "
model: double-pendulum
dimension: 2
parameters: { m1: 1, m2: 1, l1: 1, l2: 1, g: 9.81 }
systems:
  - name: arm
    reference: fixed
    elements:
      - { name: upper, mass: m1, cg: [0, -l1], inertia: 0 }
      - { name: lower, on: upper, at: [0, -l1], mass: m2, cg: [0, -l2], inertia: 0 }
forces:
  - { field: gravity, acceleration: [0, -g] }
"
        )
    );
}

#[test]
fn two_elements_in_space_have_equations_that_fit_a_page() {
    insta::assert_snapshot!(
        "spatial_chain",
        equations(
            "
model: spatial-chain
dimension: 3
coordinates: bryant
parameters: { m1: 1, m2: 1, l1: 1, l2: 1, a1: 0.1, c1: 0.05, a2: 0.1, c2: 0.05, g: 9.81 }
systems:
  - name: chain
    reference: fixed
    elements:
      - { name: upper, mass: m1, cg: [0, 0, -l1], inertia: [a1, a1, c1] }
      - { name: lower, on: upper, at: [0, 0, -l1], mass: m2, cg: [0, 0, -l2], inertia: [a2, a2, c2] }
forces:
  - { field: gravity, acceleration: [0, 0, -g] }
"
        )
    );
}

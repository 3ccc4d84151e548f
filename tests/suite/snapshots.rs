//! Texts for review by a person: equations small enough to be checked by hand, and the costs of the bundled models.

use bryant::notation::Notation;
use bryant_generator::Config;
use bryant_generator::dynamics::{derive, derive_in_first_chart};
use bryant_generator::expression::NodeId;
use bryant_generator::expression::count::{Count, Table};
use bryant_generator::expression::print::{Names, text};
use bryant_generator::law::ForceKind;
use bryant_generator::law::types::{BeltLength, JointTorque};
use bryant_generator::model::{FieldComponent, Force, Model, Number, Reference};
use bryant_generator::read;
use bryant_generator::read_str;
use std::path::Path;

/// S by its upper triangle, r_s and r_k.
fn equations(yaml: &str) -> String {
    let none = |_: &Path| Err(std::io::ErrorKind::NotFound.into());
    let (model, _) =
        read_str("model.yaml", yaml, &none).unwrap_or_else(|problems| panic!("{problems}"));
    let equations = derive_in_first_chart(&model);
    let notation = Notation::new(&model, &equations);
    let names: Vec<String> = equations
        .velocities
        .iter()
        .map(|v| v.name.rsplit('/').next().unwrap_or(&v.name).to_owned())
        .collect();
    let mut roots = Vec::new();
    for (i, row) in equations.mass_matrix.iter().enumerate() {
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

/// With s = sin(φ_upper − φ_lower) and c = cos(φ_upper − φ_lower), the text has the equations of the textbooks for
/// point masses m1, m2 on massless rods l1, l2 with absolute angles (Wells, *Lagrangian dynamics*;
/// Goldstein, *Classical mechanics*, ch. 1):
///
/// (m1 + m2) l1² φ̈_upper + m2 l1 l2 c φ̈_lower = −m2 l1 l2 s φ̇_lower² − (m1 + m2) gravity l1 sin φ_upper
/// m2 l1 l2 c φ̈_upper + m2 l2² φ̈_lower = m2 l1 l2 s φ̇_upper² − m2 gravity l2 sin φ_lower
#[test]
fn a_planar_double_pendulum_has_the_equations_of_the_textbook() {
    let text = equations(
        "
model: double-pendulum
dimension: 2
parameters: { m1: 1, m2: 1, l1: 1, l2: 1, gravity: 9.81 }
systems:
  - name: arm
    reference: fixed
    elements:
      - { name: upper, mass: m1, cg: [0, -l1], inertia: 0 }
      - { name: lower, on: upper, at: [0, -l1], mass: m2, cg: [0, -l2], inertia: 0 }
forces:
  - { field: gravity, acceleration: [0, -gravity] }
",
    );
    insta::assert_snapshot!("double_pendulum", text);
}

/// Two rods, one hanging from the other. Their moments of inertia are chosen such that those of the augmented bodies
/// are the same about all axes: 4 and 2 kg m². Then, with b = 2 m kg and 1 m kg along −z of the element, and u = −z of
/// the upper one times 1 m,
///
/// S_kk = J \[\[1, 0, sin φ₂\], \[0, 1, 0\], \[sin φ₂, 0, 1\]\], as of a spherical top in these angles (Wittenburg,
/// ch. 2), S_jk = D_j(u)ᵀ D_k(w), the columns of D(v) being e₁ × v, e₂ × v, e₃ × v with e₁ = x, e₂ = Rx y, e₃ = Rx Ry
/// z,
///
/// r_s has no term ω × Jω, but only J times the rates of the axes by φ̇, and the moments of the centripetal
/// accelerations. r_k is (e_j × w)·gravity, which is 0 for e₃: this axis is the rod.
#[test]
fn two_rods_in_space_have_equations_that_fit_a_page() {
    let text = equations(
        "
model: spatial-chain
dimension: 3
coordinates: bryant
systems:
  - name: chain
    reference: fixed
    elements:
      - { name: upper, mass: 1, cg: [0, 0, -1], inertia: [2, 2, 4] }
      - { name: lower, on: upper, at: [0, 0, -1], mass: 1, cg: [0, 0, -1], inertia: [1, 1, 2] }
forces:
  - { field: gravity, acceleration: [0, 0, -10] }
",
    );
    insta::assert_snapshot!("spatial_chain", text);
}

#[test]
fn bundled_models_cost_what_they_did() {
    for bundled in bryant_generated::MODELS {
        let name = bundled.entry.info.name;
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../models/{name}.yaml"));
        let model = read(&path)
            .unwrap_or_else(|problems| panic!("{problems}"))
            .0;
        let source = Config::new().source(&model);
        let longest = functions(&source).map(|(_, lets)| lets).max();
        // rustc crashes on functions with a few thousand statements
        assert!(longest <= Some(1000), "{name}: {longest:?}");
        let name = format!("statistics_{}", name.replace('-', "_"));
        let statistics = statistics(&model, &source);
        insta::assert_snapshot!(name, statistics);
    }
}

/// Sizes, effects and operations of a model, and the length of its text.
fn statistics(model: &Model, source: &str) -> String {
    let equations = derive(model);
    let mut text = String::new();
    let mut line = |line: String| {
        text.push_str(line.trim_end());
        text.push('\n');
    };
    let (q, v) = (equations.coordinates.len(), equations.velocities.len());
    let (outputs, parameters) = (equations.outputs.len(), model.parameters.len());
    line(format!(
        "{q} coordinates, {v} velocities, {outputs} outputs, {parameters} parameters"
    ));
    let entries = equations.mass_matrix.concat();
    let is_zero = |entry: &&NodeId| equations.graph.expr(**entry).is_zero();
    let zeros = entries.iter().filter(is_zero).count();
    line(format!(
        "S: {} of {} entries are not zero",
        entries.len() - zeros,
        entries.len()
    ));
    line(format!("accelerations by {:?}", equations.route));

    line("\neffects".into());
    for system in &model.systems {
        let reference = match system.reference {
            Reference::Free => "free",
            Reference::Fixed => "fixed: its equations are out",
            Reference::Prescribed(_) => "prescribed: its equations are out",
            Reference::Riding { .. } => "on a vehicle: its equations are out",
        };
        line(format!("  reference joint of {}: {reference}", system.name));
    }
    for force in &model.forces {
        let options = options(force).into_iter();
        let (with, without): (Vec<_>, Vec<_>) = options.partition(|(_, is_in)| *is_in);
        let list = |options: Vec<(&str, bool)>| {
            let names: Vec<&str> = options.iter().map(|(name, _)| *name).collect();
            match names.is_empty() {
                true => "nothing".to_owned(),
                false => names.join(", "),
            }
        };
        let (with, without) = (list(with), list(without));
        line(format!("  {}: {with}; out: {without}", title(force)));
    }

    line("\noperations of the equations as derived".into());
    let derivative = [&equations.coordinate_rates[..], &equations.accelerations].concat();
    for (name, roots) in [
        ("mass_matrix", &entries),
        ("velocity_forces", &equations.velocity_forces),
        ("applied_forces", &equations.applied_forces),
        ("accelerations", &equations.accelerations),
        ("derivative", &derivative),
        ("outputs", &equations.outputs),
    ] {
        line(format!("  {name}: {}", Count::of(&equations.graph, roots)));
    }

    line("\noperations as emitted".into());
    let of_method = source
        .lines()
        .skip_while(|line| !line.starts_with("// Operations (a fused"))
        .skip(1)
        .take_while(|line| *line != "//");
    of_method.for_each(|row| line(row.trim_start_matches("//").to_owned()));

    line("\naccelerations as derived, by block".into());
    let table = Table::of(&equations.graph, &equations.accelerations);
    table
        .to_string()
        .lines()
        .for_each(|row| line(format!("  {row}")));

    let (longest, lets) = functions(source)
        .max_by_key(|(_, lets)| *lets)
        .unwrap_or_default();
    line(format!(
        "\nsource: {} lines, {} functions, the longest {longest} with {lets} lets",
        source.lines().count(),
        functions(source).count(),
    ));
    text
}

/// Functions of an emitted text: name and number of lets. Methods are in an impl; their statements are indented by
/// eight spaces.
fn functions(source: &str) -> impl Iterator<Item = (&str, usize)> {
    let starts = |line: &&str| {
        let line = line.trim_start();
        line.starts_with("fn ") || line.starts_with("pub fn ")
    };
    let lines: Vec<&str> = source.lines().collect();
    let mut found = Vec::new();
    for (k, line) in lines.iter().enumerate().filter(|(_, line)| starts(line)) {
        let name = line.split("fn ").nth(1).unwrap_or_default();
        let name = name.split(['(', '<']).next().unwrap_or_default();
        let body = lines[k + 1..].iter().take_while(|line| !starts(line));
        let lets = body
            .filter(|line| line.trim_start().starts_with("let "))
            .count();
        found.push((name, lets));
    }
    found.into_iter()
}

fn title(force: &Force) -> String {
    format!("{} {}", force.law.key(), force.name)
}

/// The optional terms of a force, and whether it has them.
fn options(force: &Force) -> Vec<(&'static str, bool)> {
    let acts = |components: &[FieldComponent; 3], axis: usize| match &components[axis] {
        FieldComponent::Constant(value) => !value.is_zero(),
        FieldComponent::Curve(_) => true,
    };
    let damps = |damping: &Option<Number>| damping.as_ref().is_some_and(|d| !d.is_zero());
    match ForceKind::of(force) {
        ForceKind::Joint(joint) => {
            let any = |has: &dyn Fn(&JointTorque) -> bool| joint.about.iter().any(has);
            vec![
                ("elastic", any(&|law| law.elastic.is_some())),
                ("neutral angle", any(&|law| law.neutral.is_some())),
                ("damping", any(&|law| damps(&law.damping))),
                ("friction", any(&|law| law.friction.is_some())),
            ]
        }
        ForceKind::Freedom(freedom) => vec![
            ("elastic", freedom.law.elastic.is_some()),
            ("neutral angle", freedom.law.neutral.is_some()),
            ("damping", damps(&freedom.law.damping)),
            ("friction", freedom.law.friction.is_some()),
        ],
        ForceKind::Field(field) => ["x", "y", "z"]
            .into_iter()
            .zip((0..3).map(|axis| acts(&field.acceleration, axis)))
            .collect(),
        ForceKind::Contact(contact) => vec![
            ("elastic", contact.elastic.is_some()),
            ("damping", damps(&contact.damping)),
            ("friction", contact.friction.is_some()),
        ],
        ForceKind::Belt(belt) => vec![
            (
                "slack or length",
                !matches!(belt.length, BeltLength::Pretension(_)),
            ),
            (
                "pretension",
                matches!(belt.length, BeltLength::Pretension(_)),
            ),
            ("damping", damps(&belt.damping)),
        ],
        ForceKind::Airbag(airbag) => vec![
            ("inflow", airbag.inflow.is_some()),
            ("vent", airbag.vent.is_some()),
        ],
        ForceKind::Spring(spring) => vec![
            ("elastic", spring.elastic.is_some()),
            ("given length", spring.length.is_some()),
            ("damping", damps(&spring.damping)),
        ],
        ForceKind::Bushing(bushing) => {
            let laws = || bushing.along.iter().chain(&bushing.about);
            vec![
                ("elastic", laws().any(|law| law.elastic.is_some())),
                ("damping", laws().any(|law| damps(&law.damping))),
            ]
        }
        ForceKind::Load(load) => vec![
            ("force", (0..3).any(|axis| acts(&load.force, axis))),
            ("moment", (0..3).any(|axis| acts(&load.moment, axis))),
        ],
        ForceKind::User(user) => vec![
            ("points", !user.points.is_empty()),
            ("bodies", !user.bodies.is_empty()),
            ("lines", !user.lines.is_empty()),
            ("joints", !user.joints.is_empty()),
            ("states", !user.states.is_empty()),
        ],
    }
}

//! Compares the equations of random models with other derivations: Lagrange's equations, virtual power, Cholesky's
//! factors, and the other coordinates.

use super::panics::Tried;
use super::sample;
use super::tree;
use crate::bench::{Bench, Engine, Trouble};
use crate::case::{Case, Group};
use crate::random::Random;
use crate::rounding::Rounded;
use bryant_generator::dynamics::lagrange::lagrange;
use bryant_generator::dynamics::{Options, derive_with};
use bryant_generator::equations::{Equations, LawState, Route};
use bryant_generator::expression::differentiate::differentiate_along;
use bryant_generator::expression::evaluate::Inputs;
use bryant_generator::expression::{Graph, NodeId, Symbol, sum};
use bryant_generator::method::Method;
use bryant_generator::model::{Dimension, Model, Reference};

/// Random models.
pub const RANDOM_MODELS: Case = Case {
    group: Group::Garbage,
    name: "random models",
    law: "S and r_s equal those of Lagrange's equations, which are derived by independent code. vᵀ r_k is the power of the forces, and the \
          powers together are the rate of the kinetic energy. Accelerations equal those by Cholesky's factors of S, and those in \
          quaternions.",
    run: random_models,
};

/// Number of states of each model.
const STATES: usize = 3;
/// Factor between the scatter of eight samples and the largest allowed difference, as in the tests of compiled
/// equations.
const C: f64 = 20.0;
/// Number of roundings in a constant that the generator sums up: the mass of as many elements as a tree has.
const FOLDED: f64 = 8.0;

fn random_models(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let count = if bench.full() { 4000 } else { 400 };
    let mut random = Random::new(7);
    let mut tried = Tried::default();
    let mut refused = Vec::new();
    for _ in 0..count {
        let text = tree::model(&mut random);
        let seed = random.bits();
        tried.input(&|| text.clone(), || match sample::read(&text) {
            Ok(model) => compare(bench.engine(), &text, &model, &mut Random::new(seed)),
            Err(problems) => {
                refused.push(problems.problems[0].line());
                Ok(())
            }
        });
    }
    tried.note(
        bench,
        count,
        "the same by every derivation",
        "20 times the scatter of eight evaluations with every operation rounded at random, which is κ·ε of each value; for the \
         solution with S, plus the componentwise bound of Higham (Accuracy and Stability, 10.1)",
    );
    // the language refuses some models, such as one with a belt whose ends coincide; these are not compared
    bench.at_most(
        format!(
            "refused{}",
            refused
                .first()
                .map_or(String::new(), |first| format!(" ({first})"))
        ),
        refused.len() as f64,
        0.2 * count as f64,
        "",
        "enough scenes must remain to prove something",
    );
    Ok(())
}

/// Values with their scatter.
struct Values {
    value: Vec<f64>,
    scatter: Vec<f64>,
}

/// A state of a model.
#[derive(Clone)]
struct State {
    t: f64,
    q: Vec<f64>,
    v: Vec<f64>,
    z: Vec<f64>,
    m: Vec<f64>,
}

fn values(
    engine: &dyn Engine,
    model: &Model,
    graph: &Graph,
    roots: &[NodeId],
    state: &State,
) -> Values {
    let parameters: Vec<f64> = model.parameters.iter().map(|p| p.default).collect();
    let inputs = Inputs {
        time: state.t,
        coordinates: &state.q,
        velocities: &state.v,
        parameters: &parameters,
        auxiliaries: &state.z,
        memory: &state.m,
        accelerations: &[],
    };
    let (value, scatter) =
        Rounded::new(graph, roots).evaluate(&inputs, &engine.functions(model), f64::EPSILON);
    Values { value, scatter }
}

/// Checks that two results are equal within their scatter.
fn same(what: &str, names: &dyn Fn(usize) -> String, a: &Values, b: &Values) -> Result<(), String> {
    for i in 0..a.value.len() {
        let (x, y) = (a.value[i], b.value[i]);
        // the scatter does not include rounding of sums of constants, such as the masses of a tree
        let folded = FOLDED * f64::EPSILON * (x.abs() + y.abs());
        let bound = C * (a.scatter[i] + b.scatter[i]) + folded;
        // false, too, for values that are not finite
        let agree = (x - y).abs() <= bound;
        if !agree {
            return Err(format!(
                "{what} of {}: {x:e} and {y:e}, allowed {bound:e}",
                names(i)
            ));
        }
    }
    Ok(())
}

fn compare(
    engine: &dyn Engine,
    text: &str,
    model: &Model,
    random: &mut Random,
) -> Result<(), String> {
    let options = Options {
        matrices: true,
        route: Some(Route::Elimination),
    };
    let equations = derive_with(model, options);
    let mut bare = model.clone();
    bare.forces.clear();
    bare.switches.clear();
    bare.outputs.clear();
    let inertial = derive_with(&bare, options);
    let oracle = lagrange(model).map_err(|error| format!("{error:?}"))?;
    let turned = match model.dimension {
        Dimension::Plane => None,
        Dimension::Space => {
            let model = sample::read(&text.replace("bryant", "quaternion"))
                .map_err(|problems| problems.to_string())?;
            let equations = derive_with(&model, options);
            Some((model, equations))
        }
    };
    for _ in 0..STATES {
        let state = state(engine, model, &equations, random);
        as_lagrange(
            engine,
            model,
            &inertial,
            &oracle,
            &of_laws(&equations, &inertial, &state),
        )?;
        powers(engine, model, &equations, &state)?;
        solved(engine, model, &equations, &state)?;
        if let Some((other, others)) = &turned {
            in_quaternions(engine, model, &equations, other, others, &state)?;
        }
    }
    Ok(())
}

/// Compares S, and r without forces, with those of Lagrange's equations; r includes the inertia forces of prescribed
/// accelerations.
fn as_lagrange(
    engine: &dyn Engine,
    model: &Model,
    inertial: &Equations,
    oracle: &bryant_generator::dynamics::lagrange::Lagrange,
    state: &State,
) -> Result<(), String> {
    let graph = &inertial.graph;
    let mut ours = inertial.mass_matrix.concat();
    let rows = inertial
        .velocity_forces
        .iter()
        .zip(&inertial.applied_forces);
    ours.extend(rows.map(|(s, k)| (graph.expr(*s) + graph.expr(*k)).id()));
    let theirs = [oracle.mass_matrix.concat(), oracle.velocity_forces.clone()].concat();
    let ours = values(engine, model, graph, &ours, state);
    let theirs = values(engine, model, &oracle.graph, &theirs, state);
    let n = state.v.len();
    let name = |i: usize| match i < n * n {
        true => format!(
            "({}, {})",
            inertial.velocities[i / n].name,
            inertial.velocities[i % n].name
        ),
        false => inertial.velocities[i - n * n].name.clone(),
    };
    same("S, r_s", &name, &ours, &theirs)
}

/// Compares dT/dt with the powers; and vᵀ r_k with the power of the forces, if no motion is prescribed.
fn powers(
    engine: &dyn Engine,
    model: &Model,
    equations: &Equations,
    state: &State,
) -> Result<(), String> {
    let graph = &equations.graph;
    let power = sum(
        graph,
        equations
            .section(Method::Powers)
            .iter()
            .map(|p| graph.expr(p.value)),
    );
    let derived = differentiate_along(
        graph,
        &[equations.section(Method::KineticEnergy)[0].value],
        |symbol| {
            graph.expr(match symbol {
                Symbol::Time => graph.constant(1.0).id(),
                Symbol::Coordinate(i) => equations.coordinate_rates[i as usize],
                Symbol::Velocity(i) => equations.accelerations[i as usize],
                _ => graph.constant(0.0).id(),
            })
        },
    );
    let rate = derived.map_err(|error| format!("{error:?}"))?[0];
    let rows = equations.applied_forces.iter().enumerate();
    let virtual_power = sum(
        graph,
        rows.map(|(i, force)| graph.symbol(Symbol::Velocity(i as u32)) * graph.expr(*force)),
    );
    let roots = [power.id(), rate, virtual_power.id()];
    let Values { value, scatter } = values(engine, model, graph, &roots, state);
    let at = |i: usize| Values {
        value: vec![value[i]],
        scatter: vec![scatter[i]],
    };
    same(
        "dT/dt and the power",
        &|_| "the model".into(),
        &at(1),
        &at(0),
    )?;
    let given = |reference: &Reference| {
        matches!(
            reference,
            Reference::Prescribed(_) | Reference::Riding { .. }
        )
    };
    match model.systems.iter().any(|system| given(&system.reference)) {
        true => Ok(()),
        false => same(
            "vᵀ r_k and the power",
            &|_| "the model".into(),
            &at(2),
            &at(0),
        ),
    }
}

/// Compares v̇ by elimination with v̇ by Cholesky's factors of S.
fn solved(
    engine: &dyn Engine,
    model: &Model,
    equations: &Equations,
    state: &State,
) -> Result<(), String> {
    let graph = &equations.graph;
    let n = state.v.len();
    let mut roots = equations.mass_matrix.concat();
    let rows = equations
        .velocity_forces
        .iter()
        .zip(&equations.applied_forces);
    roots.extend(rows.map(|(s, k)| (graph.expr(*s) + graph.expr(*k)).id()));
    roots.extend(&equations.accelerations);
    let Values { value, scatter } = values(engine, model, graph, &roots, state);
    let (s, rest) = value.split_at(n * n);
    let (r, a) = rest.split_at(n);
    let factor = cholesky(s, n).ok_or("S is not positive definite")?;
    let expected = solve(&factor, n, r);
    let inverse: Vec<Vec<f64>> = (0..n)
        .map(|j| {
            let unit: Vec<f64> = (0..n).map(|i| f64::from(u8::from(i == j))).collect();
            solve(&factor, n, &unit)
        })
        .collect();
    // error bounds: |δr| + |δS| |x| for errors of S and r, and (3 n + 1) ε |L| |Lᵀ| |x| for the solution
    let given: Vec<f64> = (0..n)
        .map(|i| {
            let row = (0..n).map(|k| {
                let product: f64 = (0..n)
                    .map(|l| (factor[i * n + l] * factor[k * n + l]).abs())
                    .sum();
                (C * scatter[i * n + k] + (3 * n + 1) as f64 * f64::EPSILON * product)
                    * expected[k].abs()
            });
            C * scatter[n * n + i] + row.sum::<f64>()
        })
        .collect();
    for i in 0..n {
        let carried: f64 = (0..n).map(|j| inverse[j][i].abs() * given[j]).sum();
        let bound = C * scatter[n * n + n + i] + carried;
        let agree = (a[i] - expected[i]).abs() <= bound;
        if !agree {
            return Err(format!(
                "the acceleration of {} is {:e} by elimination, {:e} by Cholesky, allowed {bound:e}",
                equations.velocities[i].name, a[i], expected[i]
            ));
        }
    }
    Ok(())
}

/// L of S = L Lᵀ, by rows; `None` if S is not positive definite.
fn cholesky(s: &[f64], n: usize) -> Option<Vec<f64>> {
    let mut l = vec![0.0; n * n];
    for i in 0..n {
        for j in 0..=i {
            let rest = s[i * n + j] - (0..j).map(|k| l[i * n + k] * l[j * n + k]).sum::<f64>();
            l[i * n + j] = match i == j {
                true if rest > 0.0 => rest.sqrt(),
                true => return None,
                false => rest / l[j * n + j],
            };
        }
    }
    Some(l)
}

fn solve(l: &[f64], n: usize, r: &[f64]) -> Vec<f64> {
    let mut x = r.to_vec();
    for i in 0..n {
        let known: f64 = (0..i).map(|k| l[i * n + k] * x[k]).sum();
        x[i] = (x[i] - known) / l[i * n + i];
    }
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|k| l[k * n + i] * x[k]).sum();
        x[i] = (x[i] - known) / l[i * n + i];
    }
    x
}

/// Converts accelerations of Bryant angles to those of ω, and compares them with the accelerations of the model in
/// quaternions.
///
/// ω = W φ̇, ω̇ = W φ̈ + Ẇ φ̇; the columns of W are x, Rx(φ₁) y and Rx(φ₁) Ry(φ₂) z.
fn in_quaternions(
    engine: &dyn Engine,
    model: &Model,
    equations: &Equations,
    other: &Model,
    others: &Equations,
    state: &State,
) -> Result<(), String> {
    let ours = values(
        engine,
        model,
        &equations.graph,
        &equations.accelerations,
        state,
    );
    let mut there = State {
        q: Vec::new(),
        v: Vec::new(),
        ..of_laws(equations, others, state)
    };
    let (mut expected, mut i) = (
        Values {
            value: Vec::new(),
            scatter: Vec::new(),
        },
        0,
    );
    while i < state.q.len() {
        if equations.coordinates[i].element.is_none() {
            there.q.push(state.q[i]);
            there.v.push(state.v[i]);
            expected.value.push(ours.value[i]);
            expected.scatter.push(ours.scatter[i]);
            i += 1;
            continue;
        }
        let angles = [0, 1, 2].map(|k| state.q[i + k]);
        let rates = [0, 1, 2].map(|k| state.v[i + k]);
        let second = [0, 1, 2].map(|k| ours.value[i + k]);
        let scatter = [0, 1, 2].map(|k| ours.scatter[i + k]);
        there.q.extend(quaternion(angles));
        let [(s1, c1), (s2, c2), _] = angles.map(f64::sin_cos);
        let w = [[1.0, 0.0, s2], [0.0, c1, -s1 * c2], [0.0, s1, c1 * c2]];
        let [d1, d2, _] = rates;
        let dw = [
            [0.0, 0.0, c2 * d2],
            [0.0, -s1 * d1, -c1 * c2 * d1 + s1 * s2 * d2],
            [0.0, c1 * d1, -s1 * c2 * d1 - c1 * s2 * d2],
        ];
        let dot = |row: &[f64; 3], x: &[f64; 3]| -> f64 { (0..3).map(|k| row[k] * x[k]).sum() };
        let size =
            |row: &[f64; 3], x: &[f64; 3]| -> f64 { (0..3).map(|k| (row[k] * x[k]).abs()).sum() };
        for row in 0..3 {
            there.v.push(dot(&w[row], &rates));
            expected
                .value
                .push(dot(&w[row], &second) + dot(&dw[row], &rates));
            let rounding = f64::EPSILON * (size(&w[row], &second) + 4.0 * size(&dw[row], &rates));
            expected.scatter.push(size(&w[row], &scatter) + rounding);
        }
        i += 3;
    }
    let theirs = values(engine, other, &others.graph, &others.accelerations, &there);
    same(
        "the acceleration",
        &|i| others.velocities[i].name.clone(),
        &theirs,
        &expected,
    )
}

/// The quaternion of A = Rx(φ₁) Ry(φ₂) Rz(φ₃).
fn quaternion(angles: [f64; 3]) -> [f64; 4] {
    let [x, y, z] = [0, 1, 2].map(|axis| {
        let (sin, cos) = (0.5 * angles[axis]).sin_cos();
        let mut turn = [cos, 0.0, 0.0, 0.0];
        turn[axis + 1] = sin;
        turn
    });
    let product = |a: [f64; 4], b: [f64; 4]| {
        [
            a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
            a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
            a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
            a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
        ]
    };
    product(product(x, y), z)
}

/// A state of the model `others`: the states of force laws and charts are taken from a model of the same scene by their
/// names. `others` may have fewer of them.
fn of_laws(equations: &Equations, others: &Equations, state: &State) -> State {
    let kept = |names: &[LawState], values: &[f64], wanted: &[LawState]| {
        let of = |wanted: &LawState| names.iter().position(|known| known.name == wanted.name);
        (wanted.iter())
            .map(|wanted| of(wanted).map_or(f64::NAN, |i| values[i]))
            .collect()
    };
    State {
        z: kept(&equations.auxiliaries, &state.z, &others.auxiliaries),
        m: kept(&equations.memory, &state.m, &others.memory),
        ..state.clone()
    }
}

/// A random state, with second angles away from their singularity. States of force laws and memory have their initial
/// values; but in half of the states, pending events have happened at t = 0.
fn state(engine: &dyn Engine, model: &Model, equations: &Equations, random: &mut Random) -> State {
    let q = (equations.coordinates.iter())
        .map(|variable| match variable.unit {
            "m" => random.uniform(-0.5, 0.5),
            _ if variable.name.ends_with("phi2") => random.uniform(-1.1, 1.1),
            _ => random.uniform(-1.5, 1.5),
        })
        .collect();
    let v = equations
        .velocities
        .iter()
        .map(|_| random.uniform(-3.0, 3.0))
        .collect();
    let nothing = State {
        t: 0.0,
        q: Vec::new(),
        v: Vec::new(),
        z: Vec::new(),
        m: Vec::new(),
    };
    let mut initial = |states: &[LawState]| -> Vec<f64> {
        let roots: Vec<NodeId> = states.iter().map(|state| state.initial).collect();
        let happened = random.one_in(2);
        let value = values(engine, model, &equations.graph, &roots, &nothing).value;
        value
            .into_iter()
            .map(|x| if happened && x.abs() > 1e20 { 0.0 } else { x })
            .collect()
    };
    let (z, m) = (initial(&equations.auxiliaries), initial(&equations.memory));
    State {
        t: random.uniform(0.0, 1.0),
        q,
        v,
        z,
        m,
    }
}

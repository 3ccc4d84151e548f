//! Derivatives of the dynamics, in the frames of links and by differentiation of S and r_s.

use crate::link::{Numbers, TreeKind, read, tree};
use bryant_generator::dynamics::augmented_body::AugmentedTree;
use bryant_generator::dynamics::charts;
use bryant_generator::dynamics::derivatives::graph::InGraph;
use bryant_generator::dynamics::derivatives::{
    DerivativeInputs, Found, Square, acceleration_derivatives, inverse_dynamics_derivatives,
    linearisation,
};
use bryant_generator::dynamics::derive;
use bryant_generator::dynamics::link::derivatives::ways;
use bryant_generator::dynamics::spatial::Spatial;
use bryant_generator::expression::count::Count;
use bryant_generator::expression::differentiate::differentiate_along;
use bryant_generator::expression::evaluate::{Inputs, Scalar, evaluate};
use bryant_generator::expression::passes::factor;
use bryant_generator::expression::{Expr, Function, Graph, Node, NodeId, Symbol};
use bryant_generator::law;
use bryant_generator::model::Model;
use bryant_generator::motion::{Layout, Motion, State};
use std::ops::{Add, Div, Mul, Neg, Sub};
use std::path::{Path, PathBuf};

/// Calls a function with all that derivatives are made from.
fn with_scene(model: &Model, of: &mut dyn for<'g> FnMut(&DerivativeInputs<'g, '_>, &Layout)) {
    let graph = Graph::new();
    let layout = Layout::of(model);
    let started = layout.start(&graph, model);
    let start = Motion::at_start(&graph, model, &layout, &started);
    let state = State::symbols(&graph, &layout);
    let motion = Motion::of(&graph, model, &layout, &state);
    let trees: Vec<AugmentedTree<'_>> = (0..model.systems.len())
        .map(|s| AugmentedTree::of(&graph, model, s, &motion))
        .collect();
    let charts = charts::memory(model, &layout, &started, &state);
    let applied = law::applied_forces(&graph, model, &motion, &start, charts);
    let systems: Vec<Spatial<'_, '_>> = (trees.iter().enumerate())
        .map(|(system, tree)| Spatial {
            graph: &graph,
            model,
            layout: &layout,
            system,
            motion: &motion,
            tree,
        })
        .collect();
    let scene = DerivativeInputs {
        graph: &graph,
        model,
        layout: &layout,
        state: &state,
        motion: &motion,
        start: &start,
        systems: &systems,
        applied: &applied,
    };
    of(&scene, &layout);
}

/// Symbols for v̇, numbered after the parameters of the model.
fn rates<'g>(scene: &DerivativeInputs<'g, '_>) -> Vec<Expr<'g>> {
    let (graph, model) = (scene.graph, scene.model);
    let first = model.parameters.len();
    let symbol = |i: usize| graph.symbol(Symbol::Parameter((first + i) as u32));
    (0..scene.state.v.len()).map(symbol).collect()
}

/// The number of operations as they are emitted.
fn operations<'g>(graph: &Graph, values: impl Iterator<Item = Expr<'g>>) -> usize {
    let ids: Vec<NodeId> = values.map(|value| value.id()).collect();
    let fewer = factor::factor(graph, &ids);
    Count::of(&fewer.graph, &fewer.roots).total()
}

/// Robots, with the most operations of ∂τ/∂q and ∂τ/∂v together, and of v̇ with its derivatives and S⁻¹.
const ROBOTS: [(&str, &str, [usize; 2]); 3] = [
    (
        "panda",
        include_str!("../../../tests/reference/panda.yaml"),
        [2300, 4100],
    ),
    (
        "ur5",
        include_str!("../../../tests/reference/ur5.yaml"),
        [850, 1700],
    ),
    (
        "anymal",
        include_str!("../../../tests/reference/anymal.yaml"),
        [6200, 17000],
    ),
];

#[test]
fn derivatives_of_robots_take_few_operations() {
    for (name, text, most) in ROBOTS {
        with_scene(&read(text), &mut |scene, _| {
            let graph = scene.graph;
            let forces = inverse_dynamics_derivatives(scene, &rates(scene)).expect("derivatives");
            let both = [&forces.by_position, &forces.by_velocity];
            let none = vec![graph.constant(0.0); scene.state.v.len()];
            let of_rates = acceleration_derivatives(scene, &none).expect("derivatives");
            let counts = [
                operations(graph, both.into_iter().flatten().flatten().copied()),
                operations(graph, of_rates.values()),
            ];
            println!("{name}: {counts:?}");
            assert!(
                counts[0] <= most[0] && counts[1] <= most[1],
                "{name}: {counts:?}"
            );
        });
    }
}

/// The values of expressions at a state.
fn values(
    graph: &Graph,
    ids: &[NodeId],
    (q, v, parameters): (&[f64], &[f64], &[f64]),
    charts: usize,
) -> Vec<f64> {
    let inputs = Inputs {
        time: 0.013,
        coordinates: q,
        velocities: v,
        parameters,
        auxiliaries: &[],
        memory: &vec![0.0; charts],
        accelerations: &[],
    };
    let call = |function: Function, a: &[f64]| match *a {
        // any curves of time with their slopes
        [x] => 100.0 * x,
        [a, b, then, _] if a < b => then,
        [_, _, _, otherwise] => otherwise,
        _ => panic!("{function:?}"),
    };
    evaluate(graph, ids, &inputs, &call)
}

/// A state at random: q and v.
fn state(layout: &Layout, numbers: &mut Numbers) -> (Vec<f64>, Vec<f64>) {
    let coordinates = layout.coordinates.iter();
    let mut q: Vec<f64> = coordinates.map(|_| 1.2 * numbers.next()).collect();
    for range in layout.quaternions() {
        let length = q[range.clone()].iter().map(|x| x * x).sum::<f64>().sqrt();
        q[range].iter_mut().for_each(|x| *x /= length);
    }
    let velocities = layout.velocities.iter();
    (q, velocities.map(|_| 2.0 * numbers.next()).collect())
}

fn ids(found: &Found<'_>) -> [Vec<NodeId>; 4] {
    let of = |square: &[Vec<Expr<'_>>]| square.iter().flatten().map(|e| e.id()).collect();
    [
        found.forces.iter().map(|e| e.id()).collect(),
        of(&found.matrix),
        of(&found.by_position),
        of(&found.by_velocity),
    ]
}

/// The largest difference between two lists, relative to the largest value.
fn apart(found: &[f64], expected: &[f64]) -> f64 {
    let largest = expected.iter().fold(1e-3f64, |m, x| m.max(x.abs()));
    let difference = found.iter().zip(expected).map(|(a, b)| (a - b).abs());
    difference.fold(0.0, f64::max) / largest
}

#[test]
fn link_frames_say_what_differentiation_says() {
    let mut numbers = Numbers(11);
    let (mut cases, mut all) = (0, 0);
    while cases < 40 {
        all += 1;
        let kind = [TreeKind::Any, TreeKind::Coupled][numbers.below(2)];
        let text = tree(&mut numbers, "quaternion", kind);
        let model = read(&text);
        with_scene(&model, &mut |scene, layout| {
            let spatial = &scene.systems[0];
            let ways = ways(spatial, scene.applied);
            if ways.is_empty() {
                return;
            }
            cases += 1;
            let a = rates(scene);
            let direct = InGraph::of(scene, spatial).expect("derivatives").at(&a);
            let (q, v) = state(layout, &mut numbers);
            let mut parameters = vec![1.3];
            parameters.extend(a.iter().map(|_| 3.0 * numbers.next()));
            let at = (&q[..], &v[..], &parameters[..]);
            for way in ways {
                let found = way.at(&a);
                let names = ["τ", "S", "∂τ/∂q", "∂τ/∂v"];
                for (name, (found, direct)) in
                    names.iter().zip(ids(&found).iter().zip(ids(&direct)))
                {
                    let found = values(spatial.graph, found, at, layout.charts());
                    let direct = values(spatial.graph, &direct, at, layout.charts());
                    let apart = apart(&found, &direct);
                    assert!(
                        apart < 1e-11,
                        "{name}: {apart:.1e}\n{found:?}\n{direct:?}\n{text}"
                    );
                }
            }
        });
    }
    println!("{cases} of {all} trees have axes alone");
}

/// The product of two square matrices, by rows.
fn product(a: &[f64], b: &[f64]) -> Vec<f64> {
    let size = a.len().isqrt();
    let entry = |i: usize, j: usize| (0..size).map(|k| a[i * size + k] * b[k * size + j]).sum();
    let places = (0..size).flat_map(|i| (0..size).map(move |j| (i, j)));
    places.map(|(i, j)| entry(i, j)).collect()
}

#[test]
fn accelerations_solve_the_equations_of_their_derivatives() {
    let mut numbers = Numbers(5);
    for case in 0..24 {
        let kind = [TreeKind::Any, TreeKind::Coupled][case % 2];
        let coordinates = ["quaternion", "quaternion", "bryant"][case % 3];
        let text = tree(&mut numbers, coordinates, kind);
        let model = read(&text);
        with_scene(&model, &mut |scene, layout| {
            let graph = scene.graph;
            let size = layout.velocities.len();
            let symbols: Vec<Expr<'_>> = (1..=2 * size)
                .map(|i| graph.symbol(Symbol::Parameter(i as u32)))
                .collect();
            let [a, r] = [&symbols[..size], &symbols[size..]];
            let found = acceleration_derivatives(scene, r).expect("derivatives");
            let direct = InGraph::of(scene, &scene.systems[0])
                .expect("derivatives")
                .at(a);
            let (q, v) = state(layout, &mut numbers);
            let mut parameters = vec![0.0; 1 + 2 * size];
            parameters.fill_with(|| 3.0 * numbers.next());
            parameters[0] = 1.3;
            let of = |values_of: &[Expr<'_>], parameters: &[f64]| {
                let ids: Vec<NodeId> = values_of.iter().map(|e| e.id()).collect();
                values(graph, &ids, (&q, &v, parameters), layout.charts())
            };
            let rates = of(&found.accelerations, &parameters);
            let flat = |square: &Square<'_>, parameters: &[f64]| of(&square.concat(), parameters);
            let squares = [&found.by_position, &found.by_velocity, &found.inverse];
            let squares = squares.map(|square| flat(square, &parameters));
            parameters[1..=size].copy_from_slice(&rates);
            let matrix = flat(&direct.matrix, &parameters);
            let same = |found: &[f64], expected: &[f64]| {
                let apart = apart(found, expected);
                assert!(apart < 1e-9, "{apart:.1e}\n{found:?}\n{expected:?}\n{text}");
            };
            same(&of(&direct.forces, &parameters), &parameters[1 + size..]);
            let mut unit = vec![0.0; size * size];
            unit.iter_mut().step_by(size + 1).for_each(|one| *one = 1.0);
            same(&product(&matrix, &squares[2]), &unit);
            for (square, of_forces) in squares
                .iter()
                .zip([&direct.by_position, &direct.by_velocity])
            {
                let forces = flat(of_forces, &parameters).into_iter().map(|x| -x);
                same(&product(&matrix, square), &forces.collect::<Vec<_>>());
            }
        });
    }
}

/// The derivatives by Pinocchio: a line for each robot and quantity, state after state.
const BY_PINOCCHIO: &str = include_str!("../../../tests/reference/robot-derivatives.txt");

#[test]
fn derivatives_of_robots_are_those_of_pinocchio() {
    for (name, text, _) in ROBOTS {
        let lines = BY_PINOCCHIO
            .lines()
            .map(|line| line.split(' ').collect::<Vec<_>>());
        let rows: Vec<Vec<f64>> = lines
            .filter(|words| words[0] == name)
            .map(|words| {
                words[2..]
                    .iter()
                    .map(|w| w.parse().expect("a number"))
                    .collect()
            })
            .collect();
        assert_eq!(rows.len(), 20 * 12);
        let model = read(text);
        with_scene(&model, &mut |scene, layout| {
            let graph = scene.graph;
            let size = layout.velocities.len();
            let symbols: Vec<Expr<'_>> = (0..2 * size)
                .map(|i| graph.symbol(Symbol::Parameter(i as u32)))
                .collect();
            let [a, r] = [&symbols[..size], &symbols[size..]];
            let forces = inverse_dynamics_derivatives(scene, a).expect("derivatives");
            let rates = acceleration_derivatives(scene, r).expect("derivatives");
            let vectors = [&forces.forces, &rates.accelerations];
            let squares = [
                &forces.by_position,
                &forces.by_velocity,
                &rates.by_position,
                &rates.by_velocity,
                &rates.inverse,
            ];
            let ids: Vec<NodeId> = (vectors.into_iter().flatten())
                .chain(squares.into_iter().flatten().flatten())
                .map(|e| e.id())
                .collect();
            for row in rows.chunks(12) {
                let [
                    q,
                    v,
                    a,
                    r,
                    w,
                    tau,
                    tau_q,
                    tau_v,
                    of_v,
                    of_q,
                    of_rates,
                    inverse,
                ] = row
                else {
                    panic!("twelve quantities")
                };
                let found = values(graph, &ids, (q, v, &[&a[..], r].concat()), 0);
                let (vectors, squares) = found.split_at(2 * size);
                let mut said = vec![vectors[..size].to_vec(), vectors[size..].to_vec()];
                for square in squares.chunks(size * size) {
                    let rows = square.chunks(size);
                    said.push(
                        rows.map(|row| row.iter().zip(w).map(|(d, w)| d * w).sum())
                            .collect(),
                    );
                }
                let expected = [tau, of_v, tau_q, tau_v, of_q, of_rates, inverse];
                for (k, (found, expected)) in said.iter().zip(expected).enumerate() {
                    let apart = apart(found, expected);
                    assert!(
                        apart < 1e-12,
                        "{name} {k}: {apart:.1e}\n{found:?}\n{expected:?}"
                    );
                }
            }
        });
    }
}

#[test]
fn the_part_of_the_velocities_is_half_symmetric_with_the_rate_of_s() {
    let mut numbers = Numbers(8);
    for _ in 0..12 {
        let text = tree(&mut numbers, "bryant", TreeKind::Any);
        let model = read(&text);
        with_scene(&model, &mut |scene, layout| {
            let spatial = &scene.systems[0];
            let graph = spatial.graph;
            let zero = graph.constant(0.0);
            let a = rates(scene);
            let found = inverse_dynamics_derivatives(scene, &a).expect("derivatives");
            let roots: Vec<NodeId> = found.matrix.iter().flatten().map(|e| e.id()).collect();
            let along = |symbol| match symbol {
                Symbol::Coordinate(i) => graph.symbol(Symbol::Velocity(i)),
                _ => zero,
            };
            let rate = differentiate_along(graph, &roots, along).expect("derivatives");
            let size = layout.velocities.len();
            let half = graph.constant(0.5);
            let sum = |i: usize, j: usize| found.by_velocity[i][j] + found.by_velocity[j][i];
            let places = (0..size).flat_map(|i| (0..size).map(move |j| (i, j)));
            let twice: Vec<NodeId> = places.map(|(i, j)| (half * sum(i, j)).id()).collect();
            let (q, v) = state(layout, &mut numbers);
            // a carrier that turns adds forces that are linear in v, and skew
            let at = (&q[..], &v[..], &[1.3; 40][..]);
            let rate = values(graph, &rate, at, layout.charts());
            let apart = apart(&values(graph, &twice, at, layout.charts()), &rate);
            assert!(apart < 1e-11, "{apart:.1e}\n{text}");
        });
    }
}

/// A value and its slope.
#[derive(Clone, Copy, Debug)]
struct Dual(f64, f64);

impl Add for Dual {
    type Output = Dual;
    fn add(self, b: Dual) -> Dual {
        Dual(self.0 + b.0, self.1 + b.1)
    }
}
impl Sub for Dual {
    type Output = Dual;
    fn sub(self, b: Dual) -> Dual {
        Dual(self.0 - b.0, self.1 - b.1)
    }
}
impl Mul for Dual {
    type Output = Dual;
    fn mul(self, b: Dual) -> Dual {
        Dual(self.0 * b.0, self.1 * b.0 + self.0 * b.1)
    }
}
impl Div for Dual {
    type Output = Dual;
    fn div(self, b: Dual) -> Dual {
        let quotient = self.0 / b.0;
        Dual(quotient, (self.1 - quotient * b.1) / b.0)
    }
}
impl Neg for Dual {
    type Output = Dual;
    fn neg(self) -> Dual {
        Dual(-self.0, -self.1)
    }
}
impl Scalar for Dual {
    fn from_f64(value: f64) -> Self {
        Dual(value, 0.0)
    }
    fn sqrt(self) -> Self {
        let root = self.0.sqrt();
        Dual(root, 0.5 * self.1 / root)
    }
    fn sin(self) -> Self {
        Dual(libm::sin(self.0), libm::cos(self.0) * self.1)
    }
    fn cos(self) -> Self {
        Dual(libm::cos(self.0), -libm::sin(self.0) * self.1)
    }
    fn atan2(self, x: Self) -> Self {
        let square = x.0 * x.0 + self.0 * self.0;
        let turn = (x.0 * self.1 - self.0 * x.1) / square;
        Dual(libm::atan2(self.0, x.0), turn)
    }
    fn max(self, other: Self) -> Self {
        if self.0 < other.0 { other } else { self }
    }
    fn min(self, other: Self) -> Self {
        if other.0 < self.0 { other } else { self }
    }
}

/// Functions over duals: curves are straight lines, so that all their functions agree.
fn over_duals(function: Function, a: &[Dual]) -> Dual {
    let slope = Dual(100.0, 0.0);
    match (function, a) {
        (Function::Curve(_), &[x]) => slope * x,
        (Function::CurveSlope(_), _) => slope,
        (Function::CurveSecondDerivative(_) | Function::CurveStop(_), _) => Dual(0.0, 0.0),
        (Function::CurveIntegral(_), &[x]) => Dual(0.5, 0.0) * slope * x * x,
        (Function::CurveDoubleIntegral(_), &[x]) => Dual(1.0 / 6.0, 0.0) * slope * x * x * x,
        (Function::CurveInverse(_), &[x]) => x / slope,
        (Function::Power, &[x, y]) => {
            let power = libm::pow(x.0, y.0);
            let by_base = y.0 * libm::pow(x.0, y.0 - 1.0);
            Dual(power, by_base * x.1 + libm::log(x.0) * power * y.1)
        }
        (Function::Choose, &[a, b, then, otherwise]) => match a.0 < b.0 {
            true => then,
            false => otherwise,
        },
        _ => panic!("{function:?}"),
    }
}

/// A state with parameters, and the index of a direction: of v, then of velocities, z and parameters.
struct At<'a> {
    q: &'a [f64],
    v: &'a [f64],
    z: &'a [f64],
    memory: &'a [f64],
    parameters: &'a [f64],
}

impl At<'_> {
    /// The values and their slopes along the motion of velocity `k`, or with respect to input `k` of the others.
    fn slopes(
        &self,
        layout: &Layout,
        graph: &Graph,
        roots: &[NodeId],
        k: Option<usize>,
    ) -> Vec<Dual> {
        let plain = |values: &[f64]| values.iter().map(|x| Dual(*x, 0.0)).collect::<Vec<_>>();
        let mut q = plain(self.q);
        let mut v = plain(self.v);
        let mut z = plain(self.z);
        let mut parameters = plain(self.parameters);
        let size = v.len();
        match k {
            None => {}
            Some(k) if k < size => {
                let (mut coordinate, mut left) = (0, k);
                let turns = layout.quaternions();
                loop {
                    let turn = turns.iter().find(|range| range.start == coordinate);
                    let own = if turn.is_some() { 3 } else { 1 };
                    if left < own {
                        match turn {
                            None => q[coordinate].1 = 1.0,
                            Some(range) => {
                                // half (0, e) times (w, x, y, z)
                                let [w, rest @ ..] = [0, 1, 2, 3].map(|i| self.q[range.start + i]);
                                let mut e = [0.0; 3];
                                e[left] = 0.5;
                                let [x, y, z] = rest;
                                q[range.start].1 = -(e[0] * x + e[1] * y + e[2] * z);
                                q[range.start + 1].1 = e[0] * w + e[1] * z - e[2] * y;
                                q[range.start + 2].1 = e[1] * w + e[2] * x - e[0] * z;
                                q[range.start + 3].1 = e[2] * w + e[0] * y - e[1] * x;
                            }
                        }
                        break;
                    }
                    left -= own;
                    coordinate += turn.map_or(1, |range| range.len());
                }
            }
            Some(k) if k < 2 * size => v[k - size].1 = 1.0,
            Some(k) if k < 2 * size + z.len() => z[k - 2 * size].1 = 1.0,
            Some(k) => parameters[k - 2 * size - self.z.len()].1 = 1.0,
        }
        let inputs = Inputs {
            time: Dual(0.013, 0.0),
            coordinates: &q,
            velocities: &v,
            parameters: &parameters,
            auxiliaries: &z,
            memory: &plain(self.memory),
            accelerations: &[],
        };
        evaluate(graph, roots, &inputs, &over_duals)
    }
}

/// True if equations need the nearest points of ellipsoids. Tests of the program compare these with its dual numbers;
/// here they are only differentiated.
fn calls_a_search(graph: &Graph) -> bool {
    let is_search = |node: &Node| {
        matches!(
            node,
            Node::Call(Function::Approach(_) | Function::Support(_), _)
        )
    };
    graph.nodes().iter().any(is_search)
}

/// Compares the linearisation of a model with dual numbers over its equations; returns why it cannot be linearised.
fn check_linearisation(model: &Model, numbers: &mut Numbers, text: &str) -> Option<String> {
    let equations = derive(model);
    let mut refused = None;
    with_scene(model, &mut |scene, layout| {
        let graph = scene.graph;
        let all: Vec<usize> = (0..model.parameters.len()).collect();
        let found = match linearisation(scene, &all) {
            Ok(found) => found,
            Err(problem) => {
                refused = Some(problem.to_string());
                return;
            }
        };
        if calls_a_search(&equations.graph) {
            return;
        }
        let (q, v) = state(layout, numbers);
        let mut few = |count: usize| (0..count).map(|_| 0.1 * numbers.next()).collect::<Vec<_>>();
        let (z, memory) = (
            few(equations.auxiliaries.len()),
            few(equations.memory.len()),
        );
        let parameters: Vec<f64> = model.parameters.iter().map(|p| p.default).collect();
        let at = At {
            q: &q,
            v: &v,
            z: &z,
            memory: &memory,
            parameters: &parameters,
        };
        let ids = |values: &[Expr<'_>]| values.iter().map(|e| e.id()).collect::<Vec<_>>();
        let evaluated = |values: &[Expr<'_>]| {
            let values = at.slopes(layout, graph, &ids(values), None);
            values.into_iter().map(|value| value.0).collect::<Vec<_>>()
        };
        let size = v.len();
        let mut roots = equations.accelerations.clone();
        roots.extend(equations.auxiliaries.iter().map(|state| state.next));
        roots.extend(&equations.outputs);
        let own = at.slopes(layout, &equations.graph, &roots, None);
        let own: Vec<f64> = own.into_iter().map(|value| value.0).collect();
        let said = [&found.rates[size..], &found.outputs].concat();
        let check = |found: &[f64], expected: &[f64], what: &str| {
            let parts = [0..size, size..size + z.len(), size + z.len()..roots.len()];
            for part in parts {
                let (found, expected) = (&found[part.clone()], &expected[part]);
                let apart = apart(found, expected);
                assert!(
                    apart < 1e-8,
                    "{what}: {apart:.1e}\n{found:?}\n{expected:?}\n{text}"
                );
            }
        };
        check(&evaluated(&said), &own, "values");
        let count = 2 * size + z.len();
        for k in 0..count + all.len() {
            let expected = at.slopes(layout, &equations.graph, &roots, Some(k));
            let expected: Vec<f64> = expected.into_iter().map(|value| value.1).collect();
            let (rows, outputs, k) = match k.checked_sub(count) {
                None => (&found.a, &found.c, k),
                Some(k) => (&found.b, &found.d, k),
            };
            let column = rows[size..].iter().chain(outputs).map(|row| row[k]);
            let column = evaluated(&column.collect::<Vec<_>>());
            check(&column, &expected, &format!("column {k}"));
        }
    });
    refused
}

#[test]
fn linearisations_are_the_slopes_of_the_equations() {
    let mut numbers = Numbers(21);
    for case in 0..18 {
        let kind = [TreeKind::Any, TreeKind::Coupled][case % 2];
        let coordinates = ["quaternion", "bryant"][case % 3 / 2];
        let text = tree(&mut numbers, coordinates, kind);
        let outputs = "outputs: [{ name: p, of: s/e1, what: acceleration, component: x }]\nrun:";
        let rope = "forces:\n  - { spring: rope, from: { on: s/e1, at: [0.1, 0.2, 0.3] }, to: { on: frame, at: [-3, 2, 1] }, stiffness: 70 N/m, damping: 5 N*s/m, length: 0.4 m }\n";
        let text = text.replace("forces:\n", rope);
        let text = text.replace("run:", outputs);
        let refused = check_linearisation(&read(&text), &mut numbers, &text);
        assert_eq!(refused, None, "{text}");
    }
}

/// The models of the repository but the largest, each with its path.
fn all_models() -> Vec<(String, Model)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut paths = Vec::new();
    for folder in ["models", "tests/models"] {
        models(&root.join(folder), &mut paths);
    }
    paths.sort();
    let read = |path: &PathBuf| {
        // parts of models are no models
        let (model, _) = bryant_generator::read(path).ok()?;
        let small = Layout::of(&model).velocities.len() <= 60;
        small.then(|| (path.display().to_string(), model))
    };
    let found: Vec<(String, Model)> = paths.iter().filter_map(read).collect();
    assert!(found.len() > 60, "{}", found.len());
    found
}

#[test]
fn all_models_are_linearised_or_refused_for_a_reason() {
    // functions of which symbols know no derivative
    let reasons = [
        "a function of the user's",
        "a stop",
        "a second derivative of a curve",
    ];
    let mut numbers = Numbers(3);
    let mut linearised = 0;
    for (path, model) in all_models() {
        match check_linearisation(&model, &mut numbers, &path) {
            None => linearised += 1,
            Some(why) => assert!(reasons.iter().any(|r| why.starts_with(r)), "{path}: {why}"),
        }
    }
    assert!(linearised >= 65, "{linearised}");
}

/// Two systems with a spring between them, a third without velocities, and fields that only some elements feel.
const TWO: &str = "model: two
dimension: 3
parameters: { push: 3 N, weight: 0.8 kg }
systems:
  - name: arm
    reference: fixed
    elements:
      - { name: upper, joint: { hinge: x }, mass: weight, cg: [0, 0.1, -0.3], inertia: [0.03, 0.025, 0.02] }
      - { name: lower, on: upper, at: [0, 0, -0.6], joint: { universal: [x, y] }, mass: 0.5, cg: [0.1, 0, -0.2], inertia: [0.01, 0.02, 0.02] }
  - name: body
    reference: free
    elements:
      - { name: hull, mass: 2, cg: [0.05, 0, 0.1], inertia: [0.2, 0.3, 0.25] }
      - { name: flap, on: hull, at: [0.2, 0, 0], joint: { hinge: [0, 1, 1] }, mass: weight, cg: [0.1, 0.1, 0], inertia: [0.01, 0.01, 0.01] }
  - name: rock
    reference: fixed
    elements: [{ name: stone, joint: weld, mass: 1, cg: [0, 0, 0], inertia: [1, 1, 1] }]
forces:
  - { field: gravity, acceleration: [0, 0, -9.81] }
  - { field: wind, on: [arm/lower, body/flap], acceleration: [3, 1, 0] }
";

#[test]
fn systems_pull_each_other_and_some_elements_feel_other_fields() {
    let forces = "  - { spring: band, from: { on: arm/lower, at: [0, 0, -0.4] }, to: { on: body/hull, at: [0, 0.1, 0] }, stiffness: 40 N/m, damping: 2 N*s/m, length: 0.3 m }
  - { load: thrust, on: body/hull, at: [0, 0, 0.2], force: [push, 0, 0] }
outputs:
  - { name: a, of: body/flap, what: acceleration, component: z }
  - { name: f, of: spring band, what: force }
run: { duration: 1 s, every: 0.1 s }
";
    let mut numbers = Numbers(4);
    let text = format!("{TWO}{forces}");
    for _ in 0..3 {
        assert_eq!(check_linearisation(&read(&text), &mut numbers, &text), None);
    }
}

#[test]
fn without_other_forces_the_accelerations_are_those_of_the_equations() {
    let text = format!("{TWO}run: {{ duration: 1 s, every: 0.1 s }}\n");
    let model = read(&text);
    let equations = derive(&model);
    let mut numbers = Numbers(6);
    with_scene(&model, &mut |scene, layout| {
        let graph = scene.graph;
        let size = layout.velocities.len();
        let none = vec![graph.constant(0.0); size];
        let found = acceleration_derivatives(scene, &none).expect("derivatives");
        let a = rates(scene);
        let forces = inverse_dynamics_derivatives(scene, &a).expect("derivatives");
        let (q, v) = state(layout, &mut numbers);
        let mut parameters: Vec<f64> = model.parameters.iter().map(|p| p.default).collect();
        let at = At {
            q: &q,
            v: &v,
            z: &[],
            memory: &[],
            parameters: &parameters,
        };
        let slopes = |k| at.slopes(layout, &equations.graph, &equations.accelerations, k);
        let own = |values: Vec<Expr<'_>>| {
            let ids: Vec<NodeId> = values.iter().map(|e| e.id()).collect();
            let values = at.slopes(layout, graph, &ids, None);
            values
                .into_iter()
                .map(|value| value.0)
                .collect::<Vec<f64>>()
        };
        let rates: Vec<f64> = slopes(None).into_iter().map(|value| value.0).collect();
        assert!(apart(&own(found.accelerations.clone()), &rates) < 1e-12);
        for k in 0..2 * size {
            let expected: Vec<f64> = slopes(Some(k)).into_iter().map(|value| value.1).collect();
            let (of, k) = match k < size {
                true => (&found.by_position, k),
                false => (&found.by_velocity, k - size),
            };
            let apart = apart(&own(of.iter().map(|row| row[k]).collect()), &expected);
            assert!(apart < 1e-11, "{k}: {apart:.1e}");
        }
        // at these accelerations nothing else is needed
        parameters.extend(&rates);
        let ids: Vec<NodeId> = forces.forces.iter().map(|e| e.id()).collect();
        let left = values(graph, &ids, (&q, &v, &parameters), 0);
        assert!(left.iter().all(|force| force.abs() < 1e-11), "{left:?}");
    });
}

/// The models of a folder, and of those in it.
fn models(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            models(&path, found);
        } else if path.extension().is_some_and(|e| e == "yaml") {
            found.push(path);
        }
    }
}

#[test]
fn the_bodies_of_all_models_have_the_derivatives_of_dual_numbers() {
    let mut numbers = Numbers(9);
    for (path, mut model) in all_models() {
        model.forces.clear();
        model.outputs.clear();
        model.switches.clear();
        let equations = derive(&model);
        with_scene(&model, &mut |scene, layout| {
            let size = layout.velocities.len();
            let a = rates(scene);
            let found = inverse_dynamics_derivatives(scene, &a).expect("derivatives");
            let (q, v) = state(layout, &mut numbers);
            let given: Vec<f64> = a.iter().map(|_| 3.0 * numbers.next()).collect();
            let mut parameters: Vec<f64> = model.parameters.iter().map(|p| p.default).collect();
            parameters.extend(&given);
            let memory = vec![0.0; equations.memory.len()];
            let at = At {
                q: &q,
                v: &v,
                z: &[],
                memory: &memory,
                parameters: &parameters,
            };
            let mut roots = equations.mass_matrix.concat();
            roots.extend(&equations.velocity_forces);
            roots.extend(&equations.applied_forces);
            let forces = |k: Option<usize>| -> Vec<f64> {
                let all = at.slopes(layout, &equations.graph, &roots, k);
                let part = |value: &Dual| if k.is_some() { value.1 } else { value.0 };
                let row = |i: usize| {
                    let terms = all[i * size..][..size].iter().zip(&given);
                    let needed: f64 = terms.map(|(s, a)| part(s) * a).sum();
                    let others = &all[size * size..];
                    needed - part(&others[i]) - part(&others[size + i])
                };
                (0..size).map(row).collect()
            };
            let own = |values: Vec<Expr<'_>>| {
                let ids: Vec<NodeId> = values.iter().map(|e| e.id()).collect();
                let values = at.slopes(layout, scene.graph, &ids, None);
                values
                    .into_iter()
                    .map(|value| value.0)
                    .collect::<Vec<f64>>()
            };
            let column = |of: &Square<'_>, k: usize| own(of.iter().map(|row| row[k]).collect());
            assert!(apart(&own(found.forces.clone()), &forces(None)) < 1e-9);
            for k in 0..size {
                for (of, k, place) in [
                    (&found.by_position, k, k),
                    (&found.by_velocity, k, size + k),
                ] {
                    let apart = apart(&column(of, k), &forces(Some(place)));
                    assert!(apart < 1e-9, "{path}, {place}: {apart:.1e}");
                }
            }
        });
    }
}

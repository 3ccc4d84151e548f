//! Derivatives of the dynamics, in the frames of links and by differentiation of S and r_s.

use crate::link::{Kind, Numbers, read, tree};
use bryant_generator::dynamics::augmented::AugmentedTree;
use bryant_generator::dynamics::charts;
use bryant_generator::dynamics::derivatives::graph::InGraph;
use bryant_generator::dynamics::derivatives::{Found, Scene, Square, acceleration_derivatives};
use bryant_generator::dynamics::link::derivatives::ways;
use bryant_generator::dynamics::spatial::Spatial;
use bryant_generator::expression::count::Count;
use bryant_generator::expression::evaluate::{Inputs, evaluate};
use bryant_generator::expression::passes::factor;
use bryant_generator::expression::{Expr, Function, Graph, NodeId, Symbol};
use bryant_generator::law;
use bryant_generator::model::Model;
use bryant_generator::motion::{Layout, Motion, State};

/// Calls a function with all that derivatives are made from, and symbols for v̇.
fn with_scene(model: &Model, of: &mut dyn FnMut(&Scene<'_, '_>, &Layout)) {
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
    let scene = Scene {
        state: &state,
        systems: &systems,
        applied: &applied,
    };
    of(&scene, &layout);
}

/// Symbols for v̇, numbered after the parameters of the model.
fn rates<'g>(scene: &Scene<'g, '_>) -> Vec<Expr<'g>> {
    let (graph, model) = (scene.systems[0].graph, scene.systems[0].model);
    let first = model.parameters.len();
    let symbol = |i: usize| graph.symbol(Symbol::Parameter((first + i) as u32));
    (0..scene.state.v.len()).map(symbol).collect()
}

fn operations<'g>(graph: &Graph, values: impl Iterator<Item = Expr<'g>>) -> [usize; 2] {
    let ids: Vec<NodeId> = values.map(|value| value.id()).collect();
    let before = Count::of(graph, &ids).total();
    let after = factor::factor(graph, &ids);
    [before, Count::of(&after.graph, &after.roots).total()]
}

#[test]
#[ignore = "prints the counts of the robots in the folder ROBOTS"]
fn counts() {
    let folder = std::env::var("ROBOTS").expect("a folder");
    let only = std::env::var("ROBOT").unwrap_or_default();
    for name in ["panda", "ur5", "anymal", "hyq", "talos"] {
        if !name.contains(&only) {
            continue;
        }
        let text = std::fs::read_to_string(format!("{folder}/{name}.yaml")).expect("a model");
        let model = read(&text);
        with_scene(&model, &mut |scene, _| {
            let graph = scene.systems[0].graph;
            let a = rates(scene);
            for way in ways(&scene.systems[0], scene.applied) {
                let found = way.at(&a);
                let q = found.by_position.iter().flatten().copied();
                let v = found.by_velocity.iter().flatten().copied();
                let s = found.matrix.iter().flatten().copied();
                println!(
                    "{name}: dq {:?} dv {:?} both {:?}, with τ and S {:?}",
                    operations(graph, q.clone()),
                    operations(graph, v.clone()),
                    operations(graph, q.clone().chain(v.clone())),
                    operations(
                        graph,
                        q.chain(v).chain(s).chain(found.forces.iter().copied())
                    ),
                );
            }
            let none = vec![graph.constant(0.0); a.len()];
            let found = acceleration_derivatives(scene, &none).expect("derivatives");
            println!(
                "{name}: accelerations {:?} of it v̇ {:?}",
                operations(graph, found.values()),
                operations(graph, found.accelerations.iter().copied())
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
        let kind = [Kind::Any, Kind::Coupled][numbers.below(2)];
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
        let kind = [Kind::Any, Kind::Coupled][case % 2];
        let coordinates = ["quaternion", "quaternion", "bryant"][case % 3];
        let text = tree(&mut numbers, coordinates, kind);
        let model = read(&text);
        with_scene(&model, &mut |scene, layout| {
            let graph = scene.systems[0].graph;
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

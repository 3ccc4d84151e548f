//! Accelerations in the frames of links against those in absolute axes, whichever of them would be taken.

use super::frames::{Choice, Framed, ReferenceTurn, natural_axes};
use super::tree::Tree;
use super::{elimination, rates, search};
use crate::expression::evaluate::{Inputs, evaluate};
use crate::expression::{Function, Graph, NodeId};
use crate::formalism::augmented::AugmentedTree;
use crate::formalism::kinematics::{Motion, State};
use crate::formalism::layout::Layout;
use crate::formalism::spatial::{self, Spatial};
use crate::formalism::{chart, force};
use crate::model::{Model, read_str};
use std::path::Path;

fn read(text: &str) -> Model {
    let none = |_: &Path| Err(std::io::ErrorKind::NotFound.into());
    match read_str("model.yaml", text, &none) {
        Ok((model, _)) => model,
        Err(problems) => panic!("{problems}\n{text}"),
    }
}

/// Numbers without any relation to each other, from −1 to 1.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn below(&mut self, count: usize) -> usize {
        ((self.next() * 0.5 + 0.5) * count as f64) as usize
    }

    fn vector(&mut self) -> String {
        // with zeros, as real mechanisms have
        let entries = [(); 3].map(|()| match self.below(3) {
            0 => "0".to_owned(),
            _ => format!("{:.3}", self.next()),
        });
        format!("[{}]", entries.join(", "))
    }
}

const JOINTS: [&str; 15] = [
    "{ hinge: x }",
    "{ hinge: y }",
    "{ hinge: z }",
    "{ hinge: [0, 0, -1] }",
    "{ hinge: [1, -2, 0.5], zero: 30 deg }",
    "{ slider: z }",
    "{ slider: [0.3, 1, -1], zero: 0.2 }",
    "{ screw: [1, 1, 0.2], pitch: -0.3, zero: 0.4 }",
    "{ universal: [x, y] }",
    "{ cylinder: z }",
    "{ planar: y }",
    "translation",
    "[{ slider: x, name: a }, { hinge: z, name: b }, { hinge: y, name: c }]",
    "ball",
    "weld",
];

/// A hinge along x, y or z but for a small angle, as right angles of few digits leave it.
fn almost_along_an_axis(numbers: &mut Numbers) -> String {
    let mut axis = [(); 3].map(|()| numbers.next() * 10f64.powi(-2 - numbers.below(15) as i32));
    axis[numbers.below(3)] = [1.0, -1.0][numbers.below(2)];
    format!("{{ hinge: {axis:?} }}")
}

/// A tree at random: hinges more often than others, forces on some elements. All joints are `almost` along an axis, or of all kinds.
fn tree(numbers: &mut Numbers, coordinates: &str, almost: bool) -> String {
    let count = 2 + numbers.below(6);
    let reference = ["free", "fixed", "{ on: car, at: [0.5, 0, 1] }"][numbers.below(3)];
    let mut text = format!(
        "model: tree\ndimension: 3\ncoordinates: {coordinates}\nparameters: {{ weight: 1.3 kg }}\nvehicles: [{{ name: car, angles: [0.3, -0.2, 0.5], acceleration: [2, 1, 0] }}]\nsystems:\n  - name: s\n    reference: {reference}\n    elements:\n"
    );
    for k in 0..count {
        let joint = match numbers.below(2) {
            _ if k == 0 && reference == "free" => "ball",
            _ if almost => &almost_along_an_axis(numbers),
            0 => JOINTS[numbers.below(5)],
            _ => JOINTS[numbers.below(JOINTS.len())],
        };
        let on = match k {
            0 => String::new(),
            _ => format!("on: e{}, at: {}, ", numbers.below(k), numbers.vector()),
        };
        let mass = if numbers.below(4) == 0 {
            "weight"
        } else {
            "1.7"
        };
        text += &format!(
            "      - {{ name: e{k}, {on}joint: {joint}, mass: {mass}, cg: {}, inertia: [0.3, 0.25, 0.2], axes: {} }}\n",
            numbers.vector(),
            numbers.vector(),
        );
    }
    text += "forces:\n  - { field: gravity, acceleration: [1, 2, -9.81] }\n";
    if numbers.below(2) == 0 {
        text += &format!(
            "  - {{ spring: pull, from: {{ on: s/e{}, at: {} }}, to: {{ on: frame, at: [3, 2, 1] }}, stiffness: 100 N/m, length: 0.5 m }}\n",
            numbers.below(count),
            numbers.vector(),
        );
    }
    text + "run: { duration: 1 s, every: 0.1 s }\n"
}

fn at_random(numbers: &mut Numbers, links: usize, tree: &Tree<'_>) -> Choice {
    let mut choice = Choice::plain(links);
    let natural = natural_axes(tree);
    for (k, link) in choice.links.iter_mut().enumerate() {
        // the frame of a ball is that of its element
        if !tree.links[k].joint.is_ball() {
            link.turn = 2.0 * numbers.next();
            link.place = numbers.next();
        }
        link.aligned = numbers.below(2) == 0 && super::frames::can_align(tree, &natural, k);
        link.by_inertia = numbers.below(2) == 0;
        link.scales_bias = numbers.below(2) == 0;
        link.scales_rate = numbers.below(2) == 0;
        link.order = [[2, 0, 1], [0, 1, 2], [1, 0, 2]][numbers.below(3)];
        link.reference = [
            ReferenceTurn::Zero,
            ReferenceTurn::Rest,
            ReferenceTurn::Product,
            ReferenceTurn::NegativeProduct,
        ][numbers.below(4)];
    }
    choice.unit = 0.3 + numbers.below(3) as f64;
    choice.base = [(); 3].map(|()| numbers.next());
    choice
}

/// How far the accelerations of a model are apart, relative to the largest, by the choice that is found and by one at random.
fn apart(text: &str, numbers: &mut Numbers) -> [f64; 2] {
    let model = read(text);
    let graph = Graph::new();
    let layout = Layout::of(&model);
    let started = layout.start(&graph, &model);
    let start = Motion::at_start(&graph, &model, &layout, &started);
    let state = State::symbols(&graph, &layout);
    let motion = Motion::of(&graph, &model, &layout, &state);
    let augmented = AugmentedTree::of(&graph, &model, 0, &motion);
    let charts = chart::memory(&model, &layout, &started, &state);
    let loads = force::loads(&graph, &model, &motion, &start, charts);
    let spatial = Spatial {
        graph: &graph,
        model: &model,
        layout: &layout,
        system: 0,
        motion: &motion,
        tree: &augmented,
    };
    let tree = Tree::of(&spatial, &loads).expect("link frames can say it");
    let random = at_random(numbers, tree.links.len(), &tree);
    let expected = spatial::accelerations(&spatial, &loads);
    let name = |_: &super::tree::Link<'_>| String::new();
    let found = [search::choice(&tree), random].map(|choice| {
        let framed = Framed::of(&tree, &natural_axes(&tree), &choice);
        let solved = elimination::accelerations(&tree, &framed, &choice, &name);
        rates(&spatial, &loads, &tree, &solved)
    });
    let rows = |rates: &[(usize, crate::expression::Expr<'_>)]| {
        let mut rows: Vec<(usize, NodeId)> = rates.iter().map(|(i, e)| (*i, e.id())).collect();
        rows.sort_unstable();
        let (rows, ids): (Vec<usize>, Vec<NodeId>) = rows.into_iter().unzip();
        assert_eq!(
            rows,
            (0..layout.velocities.len()).collect::<Vec<_>>(),
            "every row once\n{text}"
        );
        ids
    };
    let mut q: Vec<f64> = layout
        .coordinates
        .iter()
        .map(|_| 1.2 * numbers.next())
        .collect();
    for range in layout.quaternions() {
        let length = q[range.clone()].iter().map(|x| x * x).sum::<f64>().sqrt();
        q[range].iter_mut().for_each(|x| *x /= length);
    }
    let v: Vec<f64> = layout
        .velocities
        .iter()
        .map(|_| 2.0 * numbers.next())
        .collect();
    let values = |ids: &[NodeId]| {
        let inputs = Inputs {
            time: 0.0,
            coordinates: &q,
            velocities: &v,
            parameters: &[1.3],
            auxiliaries: &[],
            memory: &vec![0.0; layout.charts()],
        };
        evaluate(
            &graph,
            ids,
            &inputs,
            &|function: Function, a: &[f64]| match *a {
                // a stiffness, as good as any
                [x] => 100.0 * x,
                [a, b, then, _] if a < b => then,
                [_, _, _, otherwise] => otherwise,
                _ => panic!("{function:?}"),
            },
        )
    };
    let expected = values(&rows(&expected));
    let largest = expected.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    found.map(|found| {
        let found = values(&rows(&found));
        let difference = found.iter().zip(&expected).map(|(a, b)| (a - b).abs());
        difference.fold(0.0, f64::max) / largest
    })
}

#[test]
fn trees_at_random_have_the_accelerations_of_absolute_axes() {
    let mut numbers = Numbers(7);
    let mut worst: f64 = 0.0;
    for i in 0..300 {
        let text = tree(&mut numbers, ["quaternion", "bryant"][i % 2], false);
        for difference in apart(&text, &mut numbers) {
            // both ways are backward stable, and no tree here is worse conditioned than 1e4 or so
            assert!(difference < 1e-11, "{difference:e}\n{text}");
            worst = worst.max(difference);
        }
    }
    assert!(worst > 0.0, "two ways never agree to the last bit");
}

#[test]
fn axes_that_are_almost_parallel_cost_no_digits() {
    let mut numbers = Numbers(11);
    let mut worst: f64 = 0.0;
    for _ in 0..200 {
        let text = tree(&mut numbers, "quaternion", true);
        for difference in apart(&text, &mut numbers) {
            assert!(difference < 1e-11, "{difference:e}\n{text}");
            worst = worst.max(difference);
        }
    }
    assert!(worst > 0.0, "two ways never agree to the last bit");
}

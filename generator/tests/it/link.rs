//! S, r_s, r_k and the accelerations in the frames of links, compared with those in absolute axes, whichever of them
//! the generator would choose.

use crate::share::share;
use bryant_generator::dynamics::augmented_body::AugmentedTree;
use bryant_generator::dynamics::charts;
use bryant_generator::dynamics::link::frames::{
    Choice, Framed, ReferenceTurn, can_align, natural_axes,
};
use bryant_generator::dynamics::link::search::{self, Aim};
use bryant_generator::dynamics::link::tree::{Link, Tree};
use bryant_generator::dynamics::link::{self, elimination, shared_velocities};
use bryant_generator::dynamics::spatial::{self, Spatial};
use bryant_generator::expression::evaluate::{Inputs, evaluate};
use bryant_generator::expression::{Expr, Function, Graph, NodeId};
use bryant_generator::force::AppliedForces;
use bryant_generator::law;
use bryant_generator::model::Model;
use bryant_generator::motion::{Layout, Motion, State};
use bryant_generator::read_str;
use std::path::Path;

pub fn read(text: &str) -> Model {
    let none = |_: &Path| Err(std::io::ErrorKind::NotFound.into());
    match read_str("model.yaml", text, &none) {
        Ok((model, _)) => model,
        Err(problems) => panic!("{problems}\n{text}"),
    }
}

/// Pseudo-random numbers from −1 to 1.
pub struct Numbers(pub u64);

impl Numbers {
    pub fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub fn below(&mut self, count: usize) -> usize {
        ((self.next() * 0.5 + 0.5) * count as f64) as usize
    }

    fn vector(&mut self) -> String {
        // with zeros, as in real mechanisms
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

const JOINTS_OF_THE_PLANE: [&str; 11] = [
    "hinge",
    "hinge",
    "{ hinge: y }",
    "{ hinge: -y, zero: 0.3 }",
    "{ hinge: y, zero: -20 deg }",
    "{ slider: x }",
    "{ slider: [0.3, -1], zero: 0.2 }",
    "translation",
    "[{ slider: z, name: a }, { hinge: y, name: b }]",
    "[{ hinge: y, name: a }, { slider: x, name: b }]",
    "weld",
];

/// A hinge along x, y or z but for a small angle, as right angles of few digits leave it.
fn almost_along_an_axis(numbers: &mut Numbers) -> String {
    let mut axis = [(); 3].map(|()| numbers.next() * 10f64.powi(-2 - numbers.below(15) as i32));
    axis[numbers.below(3)] = [1.0, -1.0][numbers.below(2)];
    format!("{{ hinge: {axis:?} }}")
}

/// The kind of random trees.
#[derive(Clone, Copy, PartialEq)]
pub enum TreeKind {
    /// All joints, with hinges more often than others.
    Any,
    /// Hinges along axes, except for a small angle.
    Almost,
    /// All joints, with rotors and with freedoms that follow others.
    Coupled,
    /// Of the joints of the plane, the same, angles absolute and relative.
    Plane,
}

/// The joint of element k, with a rotor, or with a leader among the elements before it.
fn coupled(
    numbers: &mut Numbers,
    joint: &str,
    leaders: &mut Vec<(usize, bool)>,
    k: usize,
) -> String {
    let hinge = joint.starts_with("{ hinge") || joint.starts_with("{ screw");
    let Some(open) = joint.strip_suffix(" }") else {
        return joint.to_owned();
    };
    if !hinge && !joint.starts_with("{ slider") {
        return joint.to_owned();
    }
    let mut text = open.to_owned();
    if numbers.below(3) == 0 {
        text += ", armature: 0.4";
    }
    let alike: Vec<usize> = (leaders.iter().filter(|(_, turns)| *turns == hinge))
        .map(|(leader, _)| *leader)
        .collect();
    leaders.push((k, hinge));
    if !alike.is_empty() && numbers.below(2) == 0 {
        let leader = alike[numbers.below(alike.len())];
        let ratio = ["-1", "0.7", "1.6"][numbers.below(3)];
        text += &format!(", follows: {{ joint: e{leader}, ratio: {ratio}, offset: 0.2 }}");
    }
    text + " }"
}

/// A random tree with forces on some elements.
pub fn tree(numbers: &mut Numbers, coordinates: &str, kind: TreeKind) -> String {
    let count = 2 + numbers.below(6);
    let reference = ["free", "fixed", "{ on: car, at: [0.5, 0, 1] }"][numbers.below(3)];
    let angles = ["0.3, -0.2, 0.5", "turn, { curve: turn, times: -0.7 }, 0.5"][numbers.below(2)];
    let mut text = format!(
        "model: tree\ndimension: 3\ncoordinates: {coordinates}\nparameters: {{ weight: 1.3 kg }}\ncurves: {{ turn: {{ points: [[0, 0], [1, 1]], interpolate: cubic }} }}\nvehicles: [{{ name: car, angles: [{angles}], acceleration: [2, 1, 0] }}]\nsystems:\n  - name: s\n    reference: {reference}\n    elements:\n"
    );
    let mut leaders = Vec::new();
    for k in 0..count {
        let mut joint = match numbers.below(2) {
            _ if k == 0 && reference == "free" => "ball".to_owned(),
            _ if kind == TreeKind::Almost => almost_along_an_axis(numbers),
            0 => JOINTS[numbers.below(5)].to_owned(),
            _ => JOINTS[numbers.below(JOINTS.len())].to_owned(),
        };
        if kind == TreeKind::Coupled {
            joint = coupled(numbers, &joint, &mut leaders, k);
        }
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

/// The same in the plane. The orientation of one element at least is not absolute: other systems are no concern of link
/// frames.
fn tree_in_the_plane(numbers: &mut Numbers) -> String {
    let count = 2 + numbers.below(6);
    let reference = ["free", "fixed", "{ on: car, at: [0.5, 1] }"][numbers.below(3)];
    let angle = ["0.3", "turn"][numbers.below(2)];
    let mut text = format!(
        "model: tree\ndimension: 2\nparameters: {{ weight: 1.3 kg }}\ncurves: {{ turn: {{ points: [[0, 0], [1, 1]], interpolate: cubic }} }}\nvehicles: [{{ name: car, angles: {angle}, acceleration: [2, 1] }}]\nsystems:\n  - name: s\n    reference: {reference}\n    elements:\n"
    );
    let vector = |numbers: &mut Numbers| format!("[{:.3}, {:.3}]", numbers.next(), numbers.next());
    let mut leaders = Vec::new();
    for k in 0..count {
        let joint = match numbers.below(2) {
            _ if k == 0 && reference == "free" => "hinge",
            _ if k == 1 => "{ hinge: y }",
            0 => JOINTS_OF_THE_PLANE[numbers.below(5)],
            _ => JOINTS_OF_THE_PLANE[numbers.below(JOINTS_OF_THE_PLANE.len())],
        };
        let joint = coupled(numbers, joint, &mut leaders, k);
        let on = match k {
            0 => String::new(),
            _ => format!("on: e{}, at: {}, ", numbers.below(k), vector(numbers)),
        };
        let mass = ["weight", "1.7", "1.7", "1.7"][numbers.below(4)];
        let cg = vector(numbers);
        text += &format!(
            "      - {{ name: e{k}, {on}joint: {joint}, mass: {mass}, cg: {cg}, inertia: 0.3 }}\n"
        );
    }
    text += "forces:\n  - { field: gravity, acceleration: [1, -9.81] }\n  - { joint: s/e1, damping: 0.7, stiffness: 5 }\n";
    if numbers.below(2) == 0 {
        text += &format!(
            "  - {{ spring: pull, from: {{ on: s/e{}, at: {} }}, to: {{ on: frame, at: [3, 1] }}, stiffness: 100 N/m, length: 0.5 m }}\n",
            numbers.below(count),
            vector(numbers),
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
        link.aligned = numbers.below(2) == 0 && can_align(tree, &natural, k);
        link.by_inertia = numbers.below(2) == 0;
        let children = tree.links.iter().enumerate();
        let children = children.filter(|(_, l)| l.parent == Some(k));
        let child = children.map(|(c, _)| c).next_back();
        link.keep = child.map(|child| (child, numbers.below(3)));
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
    if !tree.links[0].joint.is_ball() {
        choice.base = [0.0; 3];
    }
    choice
}

/// How frames are chosen.
#[derive(Clone, Copy, PartialEq)]
enum Way {
    /// All at random.
    Random,
    /// From those that a search tries.
    Drawn,
    /// By a search.
    Found,
}

/// The results of link frames and of absolute axes for a model.
struct Said {
    /// The name of the result, for the reader.
    what: &'static str,
    /// The result in link frames, and in absolute axes.
    ways: [Vec<NodeId>; 2],
}

/// The largest difference between link frames and absolute axes, relative to the largest value: for random choices, for
/// frames that a search tries, and, if `all` is true, for those that a search finds.
fn apart(text: &str, numbers: &mut Numbers, kind: TreeKind, all: bool) -> Vec<(&'static str, f64)> {
    let model = read(text);
    let graph = Graph::new();
    let layout = Layout::of(&model);
    let started = layout.start(&graph, &model);
    let start = Motion::at_start(&graph, &model, &layout, &started);
    let state = State::symbols(&graph, &layout);
    let motion = Motion::of(&graph, &model, &layout, &state);
    let augmented = AugmentedTree::of(&graph, &model, 0, &motion);
    let charts = charts::memory(&model, &layout, &started, &state);
    let applied = law::applied_forces(&graph, &model, &motion, &start, charts);
    let spatial = Spatial {
        graph: &graph,
        model: &model,
        layout: &layout,
        system: 0,
        motion: &motion,
        tree: &augmented,
    };
    let said = said(&spatial, &applied, numbers, (text, kind, all));

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
            time: 0.013,
            coordinates: &q,
            velocities: &v,
            parameters: &[1.3],
            auxiliaries: &[],
            memory: &vec![0.0; layout.charts()],
            accelerations: &[],
        };
        evaluate(
            &graph,
            ids,
            &inputs,
            &|function: Function, a: &[f64]| match *a {
                // any stiffness, and any curves of time with their slopes
                [x] => 100.0 * x,
                [a, b, then, _] if a < b => then,
                [_, _, _, otherwise] => otherwise,
                _ => panic!("{function:?}"),
            },
        )
    };
    let distance = |said: Said| {
        let [found, expected] = said.ways.map(|ids| values(&ids));
        let largest = expected.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        let difference = found.iter().zip(&expected).map(|(a, b)| (a - b).abs());
        // forces that are 0 except for rounding are compared with their terms, numbers of order 1 and more
        (
            said.what,
            difference.fold(0.0, f64::max) / largest.max(1e-3),
        )
    };
    said.into_iter().map(distance).collect()
}

/// All results, both ways.
// Long: each result in turn, which is derived in the frames of links and then compared.
fn said<'g>(
    spatial: &Spatial<'g, '_>,
    applied: &AppliedForces<'g>,
    numbers: &mut Numbers,
    (text, kind, all): (&str, TreeKind, bool),
) -> Vec<Said> {
    let graph = spatial.graph;
    let size = spatial.layout.velocities.len();
    let none = vec![graph.constant(0.0); size];
    let ids = |values: &[Expr<'g>]| values.iter().map(|e| e.id()).collect::<Vec<_>>();
    let sums = |terms: &[(usize, Expr<'g>)]| {
        let mut sums = none.clone();
        for (row, force) in terms {
            sums[*row] = sums[*row] + *force;
        }
        ids(&sums)
    };
    let full = |matrix: &[Vec<Option<Expr<'g>>>]| {
        let entries = matrix.iter().flatten();
        ids(&entries
            .map(|e| e.unwrap_or(graph.constant(0.0)))
            .collect::<Vec<_>>())
    };
    let mut matrix = vec![vec![None; size]; size];
    spatial::mass_matrix(spatial, &mut matrix);
    let (mut r_s, mut r_k, mut rates) = (none.clone(), none.clone(), none.clone());
    spatial::velocity_forces(spatial, &mut r_s);
    spatial::applied_forces(spatial, applied, &mut r_k);
    match spatial.is_coupled() {
        true => spatial::coupled_accelerations(spatial, applied, &mut rates),
        false => {
            for (row, rate) in spatial::accelerations(spatial, applied) {
                rates[row] = rate;
            }
        }
    }
    let tree = Tree::of(spatial, Some(applied)).expect("link frames can say it");
    let random = at_random(numbers, tree.links.len(), &tree);
    // frames from a search, everything else at random
    let mut drawn = random.clone();
    let found = search::drawn(&tree, Aim::Elimination, &mut |count| numbers.below(count));
    for (link, found) in drawn.links.iter_mut().zip(found.links) {
        (link.turn, link.place) = (found.turn, found.place);
    }
    let mut said = Vec::new();
    let mut say = |what, found, expected| {
        let ways = [found, expected];
        said.push(Said { what, ways });
    };
    for way in [Way::Random, Way::Drawn, Way::Found] {
        // a search takes its time; of axes that are almost parallel it is what is tested
        if way == Way::Found && !all && kind != TreeKind::Almost {
            continue;
        }
        let choice = |tree: &Tree<'g>, aim| match way {
            Way::Random => random.clone(),
            Way::Drawn => drawn.clone(),
            Way::Found => search::choice(tree, aim),
        };
        if shared_velocities::elimination_links(&tree).is_some() {
            let choice = choice(&tree, Aim::Elimination);
            let framed = Framed::of(&tree, &natural_axes(&tree), &choice);
            let name = |_: &Link<'_>| String::new();
            let solved = elimination::accelerations(&tree, &framed, &choice, &name);
            let found = link::rates(spatial, applied, &tree, &solved);
            let mut rows: Vec<usize> = found.iter().map(|(row, _)| *row).collect();
            rows.sort_unstable();
            assert!(rows.into_iter().eq(0..size), "every row once\n{text}");
            say("accelerations", sums(&found), ids(&rates));
        }
        if way == Way::Found && !all {
            continue;
        }
        // only the elimination shifts the origin of a base
        let unshifted = |tree: &Tree<'g>, aim| Choice {
            base: [0.0; 3],
            ..choice(tree, aim)
        };
        let chosen = |tree: &Tree<'g>| unshifted(tree, Aim::Matrices);
        let found = link::matrices(spatial, applied, chosen).expect("link frames can say it");
        let mut entries = vec![vec![None; size]; size];
        link::add_entries(&mut entries, &found.matrix);
        for (i, row) in entries.iter().enumerate() {
            for (j, entry) in row.iter().enumerate() {
                let node = |e: Option<Expr<'g>>| e.map(|e| e.id());
                assert_eq!(node(*entry), node(entries[j][i]), "S is symmetric\n{text}");
            }
        }
        say("S", full(&entries), full(&matrix));
        say("r_s", sums(&found.velocity_forces), ids(&r_s));
        say("r_k", sums(&found.applied_forces), ids(&r_k));
        let chosen = |tree: &Tree<'g>| unshifted(tree, Aim::Factorization);
        let mut factorized = none.clone();
        let possible = link::accelerations_by_factors(spatial, applied, chosen, &mut factorized);
        assert!(possible, "link frames can say it\n{text}");
        say("accelerations by S", ids(&factorized), ids(&rates));
    }
    said
}

/// Compares random trees. Both ways are backward stable, and no tree here has a condition number above 1e4 or so.
fn compare(seed: u64, count: usize, kind: TreeKind, coordinates: &[&str]) {
    let mut worst: f64 = 0.0;
    for i in share(6, 0..count) {
        let mut numbers = Numbers(
            seed.wrapping_add(i as u64)
                .wrapping_mul(0x9e37_79b9_7f4a_7c15),
        );
        let text = match kind {
            TreeKind::Plane => tree_in_the_plane(&mut numbers),
            _ => tree(&mut numbers, coordinates[i % coordinates.len()], kind),
        };
        for (what, difference) in apart(&text, &mut numbers, kind, i % 6 == 0) {
            assert!(difference < 1e-11, "{what}: {difference:e}\n{text}");
            worst = worst.max(difference);
        }
    }
    assert!(worst > 0.0, "two ways never agree to the last bit");
}

#[test]
fn trees_at_random_have_the_equations_of_absolute_axes() {
    compare(7, 300, TreeKind::Any, &["quaternion", "bryant"]);
}

#[test]
fn rotors_and_followers_have_the_equations_of_absolute_axes() {
    compare(23, 150, TreeKind::Coupled, &["quaternion", "bryant"]);
}

#[test]
fn trees_in_the_plane_have_the_equations_of_absolute_axes() {
    compare(5, 200, TreeKind::Plane, &["quaternion"]);
}

#[test]
fn axes_that_are_almost_parallel_cost_no_digits() {
    compare(11, 200, TreeKind::Almost, &["quaternion"]);
}

/// For a chain of unlike bodies, the links that the search for frames brings into frames, trial by trial, and those
/// whose equations it derives.
fn work(links: usize, axes: &[&str]) -> [usize; 2] {
    let element = |k: usize| {
        let on = match k {
            0 => String::new(),
            k => format!("on: e{}, at: [0, 0, 0.2], ", k - 1),
        };
        let axis = axes[k % axes.len()];
        // on either side of the axis, in no order
        let side = [0.013, -0.021, -0.009, 0.017, -0.011][k % 5] * (1.0 + 0.01 * k as f64);
        let mass = 1.0 + 0.07 * (k % 11) as f64;
        format!(
            "      - {{ name: e{k}, {on}joint: {{ hinge: {axis} }}, mass: {mass}, cg: [{side}, 0.01, 0.1], inertia: [0.02, 0.03, 0.025] }}\n"
        )
    };
    let elements: String = (0..links).map(element).collect();
    let model = read(&format!(
        "model: chain\ndimension: 3\nsystems:\n  - name: s\n    reference: fixed\n    elements:\n{elements}run: {{ duration: 1 s, every: 10 ms }}\n"
    ));
    let graph = Graph::new();
    let layout = Layout::of(&model);
    let state = State::symbols(&graph, &layout);
    let motion = Motion::of(&graph, &model, &layout, &state);
    let augmented = AugmentedTree::of(&graph, &model, 0, &motion);
    let spatial = Spatial {
        graph: &graph,
        model: &model,
        layout: &layout,
        system: 0,
        motion: &motion,
        tree: &augmented,
    };
    let tree = Tree::of(&spatial, None).expect("link frames can say it");
    search::work(&tree, Aim::Elimination)
}

#[test]
fn a_search_takes_as_long_for_each_link_of_a_long_chain_as_of_a_short_one() {
    // parallel axes, along which a part of the chain reaches furthest, and others
    for axes in [&["y"][..], &["y", "x", "z"]] {
        let [short, long] = [50, 100].map(|links| work(links, axes));
        // the ends of a chain have smaller parts: of 16 links at each end at most, which is a third of 50 and a sixth
        // of 100
        assert!(
            long[0] < 2 * short[0] * 5 / 4,
            "{axes:?}: {short:?} {long:?}"
        );
        // most parts in the middle have shapes of parts before, whichever side of its axis each body is on; else twice
        // as many would be derived
        assert!(long[1] < short[1] * 3 / 2, "{axes:?}: {short:?} {long:?}");
    }
}

//! The order conditions of rooted trees (Butcher 1963): Σ b_i Φ_i(τ) = 1/γ(τ) for every tree τ of at most p nodes.
//!
//! For a tree, Φ is the product, over the children of its root, of Σ_j a_ij Φ_j(child). For a Rosenbrock method a_ij is
//! β_ij = α_ij + γ_ij where the root has a single child, and α_ij where it has several (Hairer & Wanner, *Solving ODEs
//! II*, IV.7).

use super::Formula;
use super::acceleration::limits;
use super::rosenbrock::original;
use super::tableau::Tableau;
use super::tableau::dormand_prince::{Dop853, Dopri5};
use super::tableau::kutta::{Heun, Merson, Rk4};
use super::tableau::tsitouras::Tsit5;

/// A rooted tree: the subtrees at its root, in descending order.
#[derive(Clone, Debug, PartialEq, PartialOrd)]
struct Tree(Vec<Tree>);

impl Tree {
    fn nodes(&self) -> usize {
        1 + self.0.iter().map(Tree::nodes).sum::<usize>()
    }

    /// γ: the product of the numbers of nodes of all subtrees.
    fn density(&self) -> f64 {
        self.nodes() as f64 * self.0.iter().map(Tree::density).product::<f64>()
    }

    /// Φ of each stage.
    fn weights(&self, single: &Matrix, several: &Matrix) -> Vec<f64> {
        let stages = single.len();
        let matrix = if self.0.len() == 1 { single } else { several };
        let mut product = vec![1.0; stages];
        for child in &self.0 {
            let of_child = child.weights(single, several);
            for (product, row) in product.iter_mut().zip(matrix) {
                *product *= row.iter().zip(&of_child).map(|(a, w)| a * w).sum::<f64>();
            }
        }
        product
    }
}

type Matrix = Vec<Vec<f64>>;

/// All trees of exactly `nodes` nodes.
fn trees(nodes: usize) -> Vec<Tree> {
    forests(nodes - 1, nodes - 1, None)
        .into_iter()
        .map(Tree)
        .collect()
}

/// All forests of `nodes` nodes, in descending order. Their trees have at most `largest` nodes and are not beyond
/// `bound`.
fn forests(nodes: usize, largest: usize, bound: Option<&Tree>) -> Vec<Vec<Tree>> {
    if nodes == 0 {
        return vec![vec![]];
    }
    let mut found = Vec::new();
    for size in (1..=largest.min(nodes)).rev() {
        for tree in trees(size) {
            let beyond = bound.is_some_and(|bound| {
                (size, &tree.0) > (bound.nodes(), &bound.0) && size == bound.nodes()
            });
            if beyond {
                continue;
            }
            for mut rest in forests(nodes - size, size, Some(&tree)) {
                rest.insert(0, tree.clone());
                found.push(rest);
            }
        }
    }
    found
}

/// Σ b Φ − θ^nodes/γ of every tree of `nodes` nodes, relative to the sum of the terms' magnitudes plus one.
fn residuals(nodes: usize, b: &[f64], single: &Matrix, several: &Matrix, theta: f64) -> Vec<f64> {
    let of = |tree: &Tree| {
        let weights = tree.weights(single, several);
        let sum: f64 = b.iter().zip(&weights).map(|(b, w)| b * w).sum();
        let size: f64 = b.iter().zip(&weights).map(|(b, w)| (b * w).abs()).sum();
        (sum - theta.powi(nodes as i32) / tree.density()) / (1.0 + size)
    };
    trees(nodes).iter().map(of).collect()
}

/// The coefficients have 16 digits; some dozen of them, up to some dozen in size, are multiplied and summed.
const ROUNDING: f64 = 1000.0 * f64::EPSILON;

fn assert_order(order: usize, b: &[f64], single: &Matrix, several: &Matrix, theta: f64) {
    for nodes in 1..=order {
        for residual in residuals(nodes, b, single, several, theta) {
            assert!(
                residual.abs() < ROUNDING,
                "{nodes} nodes at {theta}: {residual:e}"
            );
        }
    }
}

fn misses(nodes: usize, b: &[f64], single: &Matrix, several: &Matrix) -> f64 {
    let residuals = residuals(nodes, b, single, several, 1.0);
    residuals.iter().fold(0.0, |worst, r| worst.max(r.abs()))
}

/// What a tableau says, without its type, so that checks are compiled once for all.
struct ErasedTableau {
    stages: usize,
    all: usize,
    c: &'static [f64],
    a: &'static [&'static [f64]],
    b: &'static [f64],
    e: [&'static [f64]; 2],
    last_is_first: bool,
    estimate: u32,
    interpolant: usize,
    weights: fn(f64) -> Vec<f64>,
    counts: fn(usize) -> bool,
}

impl ErasedTableau {
    fn of<B: Tableau>() -> Self {
        ErasedTableau {
            stages: B::STAGES,
            all: B::ALL,
            c: B::C,
            a: B::A,
            b: B::B,
            e: B::E,
            last_is_first: B::LAST_IS_FIRST,
            estimate: B::ESTIMATE,
            interpolant: B::INTERPOLANT as usize,
            weights: |theta| B::weights(theta).as_ref().to_vec(),
            counts: B::counts,
        }
    }
}

/// The coefficients of all stages as a square matrix.
fn matrix(m: &ErasedTableau) -> Matrix {
    let mut rows = vec![vec![0.0; m.all]; m.all];
    for (row, a) in rows.iter_mut().zip(m.a) {
        row[..a.len()].copy_from_slice(a);
    }
    rows
}

fn padded(m: &ErasedTableau, weights: &[f64]) -> Vec<f64> {
    let mut all = vec![0.0; m.all];
    all[..weights.len()].copy_from_slice(weights);
    all
}

/// Checks the nodes and the orders of the result, the embedded result and the interpolant, and that these orders are
/// not higher.
fn check(m: &ErasedTableau, order: usize) {
    let a = matrix(m);
    for (i, c) in m.c.iter().enumerate() {
        let sum: f64 = a[i].iter().sum();
        assert!((sum - c).abs() < ROUNDING, "node {i}: {sum} and {c}");
    }
    let b = padded(m, m.b);
    assert_order(order, &b, &a, &a, 1.0);
    assert!(misses(order + 1, &b, &a, &a) > 1e-7);

    for estimate in m.e.iter().filter(|weights| !weights.is_empty()) {
        let other: Vec<f64> = b
            .iter()
            .zip(padded(m, estimate))
            .map(|(b, e)| b - e)
            .collect();
        // a pair of two methods of the same order sees no error
        let embedded = (1..=order).find(|nodes| misses(*nodes, &other, &a, &a) > 1e-7);
        assert!(embedded.is_some());
    }
    let [first, second] = m.e;
    let order_of = |weights: &[f64]| {
        let zero_to = |nodes| {
            let weights = padded(m, weights);
            let sums = residuals(nodes, &weights, &a, &a, 0.0);
            sums.iter().all(|sum| sum.abs() < ROUNDING)
        };
        (1..).find(|nodes| !zero_to(*nodes)).unwrap_or(0) as u32
    };
    match (first.is_empty(), second.is_empty()) {
        (true, _) => assert_eq!(m.estimate, 0),
        (false, true) => assert_eq!(m.estimate, order_of(first)),
        // e²/ē
        (false, false) => assert_eq!(m.estimate, 2 * order_of(first) - order_of(second)),
    }

    for step in 0..=20 {
        let theta = f64::from(step) / 20.0;
        let weights = (m.weights)(theta);
        assert_order(m.interpolant, &weights, &a, &a, theta);
        for (stage, weight) in weights.iter().enumerate() {
            assert!((m.counts)(stage) || *weight == 0.0, "stage {stage} counts");
        }
    }
    for (weight, expected) in [(0.0, vec![0.0; m.all]), (1.0, b)] {
        for (weight, expected) in (m.weights)(weight).iter().zip(expected) {
            assert!((weight - expected).abs() < ROUNDING);
        }
    }
}

#[test]
fn trees_are_as_many_as_they_are() {
    // Sloane's A000081
    let counts: Vec<usize> = (1..=9).map(|nodes| trees(nodes).len()).collect();
    assert_eq!(counts, [1, 1, 2, 4, 9, 20, 48, 115, 286]);
    // Σ n!/(γ σ) over trees of n nodes is (n−1)!; of three nodes: γ = 3 and 6
    let densities: Vec<f64> = trees(3).iter().map(Tree::density).collect();
    assert_eq!(densities, [6.0, 3.0]);
}

#[test]
fn historical_methods_have_their_orders() {
    check(&ErasedTableau::of::<Heun>(), 2);
    check(&ErasedTableau::of::<Rk4>(), 4);
    check(&ErasedTableau::of::<Merson>(), 4);
}

#[test]
fn pairs_of_order_5_have_their_orders() {
    check(&ErasedTableau::of::<Dopri5>(), 5);
    check(&ErasedTableau::of::<Tsit5>(), 5);
}

#[test]
fn the_method_of_order_8_has_its_orders() {
    check(&ErasedTableau::of::<Dop853>(), 8);
}

#[test]
fn the_rosenbrock_method_has_its_orders() {
    let rows = |m: original::Matrix| -> Matrix { m.iter().map(|row| row.to_vec()).collect() };
    let (alpha, gamma) = (rows(original::alpha()), rows(original::gamma()));
    let beta: Matrix = alpha
        .iter()
        .zip(&gamma)
        .map(|(a, g)| a.iter().zip(g).map(|(a, g)| a + g).collect())
        .collect();
    let (nodes, in_time) = original::nodes();
    for i in 0..nodes.len() {
        assert!((alpha[i].iter().sum::<f64>() - nodes[i]).abs() < ROUNDING);
        assert!((gamma[i].iter().sum::<f64>() - in_time[i]).abs() < ROUNDING);
    }
    let b = original::b(1.0);
    assert_order(5, &b, &beta, &alpha, 1.0);
    assert!(misses(6, &b, &beta, &alpha) > 1e-7);
    // stiffly accurate: the result is the last stage, the embedded result the stage before
    for j in 0..b.len() {
        assert!((beta[b.len() - 1][j] - b[j]).abs() < ROUNDING);
    }
    assert_order(4, &beta[b.len() - 2], &beta, &alpha, 1.0);
    for step in 0..=20 {
        let theta = f64::from(step) / 20.0;
        assert_order(4, &original::b(theta), &beta, &alpha, theta);
    }
}

/// The farthest point of |R(z)| = 1 in the left half plane, R(z) = 1 + z bᵀ (1 − z A)⁻¹ 1 = 1 + Σ z^(k+1) bᵀ A^k 1.
fn farthest(m: &ErasedTableau) -> f64 {
    let (a, mut stages) = (matrix(m), vec![1.0; m.all]);
    let b = padded(m, m.b);
    let mut polynomial = vec![1.0];
    for _ in 0..m.stages {
        polynomial.push(b.iter().zip(&stages).map(|(b, x)| b * x).sum());
        let times = |row: &Vec<f64>| row.iter().zip(&stages).map(|(a, x)| a * x).sum();
        stages = a.iter().map(times).collect();
    }
    let amplified = |r: f64, angle: f64| {
        let (x, y) = (r * angle.cos(), r * angle.sin());
        let horner = |(re, im): (f64, f64), c: &f64| (re * x - im * y + c, re * y + im * x);
        let (re, im) = polynomial.iter().rev().fold((0.0, 0.0), horner);
        re.hypot(im)
    };
    let directions =
        (0..=3600).map(|i| std::f64::consts::FRAC_PI_2 * (1.0 + f64::from(i) / 3600.0));
    // at least |R'| on and within a circle, so that |R| is above 1 on the way from a point where it is above 1, as far
    // as its excess over this slope
    let slope = |r: f64| {
        let terms = polynomial.iter().enumerate().skip(1);
        terms.fold(0.0, |sum, (k, c): (usize, &f64)| {
            sum + k as f64 * c.abs() * r.powi(k as i32 - 1)
        })
    };
    let reach = |angle: f64| {
        // beyond 20 each of these polynomials is far above 1
        let mut r = 20.0;
        while r > 0.0 && amplified(r, angle) > 1.0 {
            r -= ((amplified(r, angle) - 1.0) / slope(r)).max(5e-4);
        }
        r
    };
    directions.map(reach).fold(0.0, f64::max)
}

#[test]
fn limits_of_stability_are_those_of_the_polynomials() {
    let close = |found: f64, formula: Formula| {
        let stated = formula.stability_limit().expect("an explicit method");
        // found to 0.0005, stated with three decimals, rounded up
        assert!(
            (0.0..2.5e-3).contains(&(stated - found)),
            "{formula}: {found}"
        );
    };
    close(farthest(&ErasedTableau::of::<Heun>()), Formula::Heun);
    close(farthest(&ErasedTableau::of::<Rk4>()), Formula::Rk4);
    close(farthest(&ErasedTableau::of::<Merson>()), Formula::Merson);
    close(farthest(&ErasedTableau::of::<Dopri5>()), Formula::Dopri5);
    close(farthest(&ErasedTableau::of::<Tsit5>()), Formula::Tsit5);
    close(farthest(&ErasedTableau::of::<Dop853>()), Formula::Dop853);
}

/// (|R(iy)|, |P(iy)|) of an undamped oscillation: what a step makes of it, and how far the last state before the end
/// for the time of the end is from the end.
fn swings(m: &ErasedTableau, y: f64) -> [f64; 2] {
    let times = |(re, im): (f64, f64)| (-y * im, y * re);
    let mut rates: Vec<(f64, f64)> = Vec::new();
    let state = |rates: &[(f64, f64)], weights: &[f64]| {
        let sum = rates.iter().zip(weights);
        sum.fold((1.0, 0.0), |(re, im), (k, w)| (re + w * k.0, im + w * k.1))
    };
    let before = m.stages - usize::from(m.last_is_first);
    let near = (1..before).rev().find(|&i| m.c[i] == 1.0);
    let near = near.expect("a stage at the end");
    let mut other = (0.0, 0.0);
    for i in 0..m.stages {
        let stage = state(&rates, m.a[i]);
        if i == near {
            other = stage;
        }
        rates.push(times(stage));
    }
    let end = state(&rates, m.b);
    [end.0.hypot(end.1), (end.0 - other.0).hypot(end.1 - other.1)]
}

#[test]
fn oscillations_grow_from_the_limits_stated() {
    fn compare(m: &ErasedTableau, formula: Formula) {
        let [limit, polynomial] = limits(formula).expect("a method with two stages at the end");
        let mut places = (1..100_000).map(|i| 1e-4 * f64::from(i));
        let found = places.find(|y| swings(m, *y)[0] > 1.0 + 1e-5);
        let found = found.expect("an explicit method").min(std::f64::consts::PI);
        // found on a grid of 0.0001, stated with three digits
        let close = |stated: f64, found: f64| (stated / found - 1.0).abs() < 5e-3;
        assert!(close(limit, found), "{formula}: {limit}, found {found}");
        let [_, apart] = swings(m, limit);
        assert!(
            close(polynomial, apart),
            "{formula}: {polynomial}, found {apart}"
        );
    }
    compare(&ErasedTableau::of::<Heun>(), Formula::Heun);
    compare(&ErasedTableau::of::<Merson>(), Formula::Merson);
    compare(&ErasedTableau::of::<Dopri5>(), Formula::Dopri5);
    compare(&ErasedTableau::of::<Tsit5>(), Formula::Tsit5);
    compare(&ErasedTableau::of::<Dop853>(), Formula::Dop853);
    for formula in Formula::ALL {
        let adaptive = formula.estimates_error() && formula != Formula::Rodas5;
        assert_eq!(limits(formula).is_some(), adaptive, "{formula}");
    }
}

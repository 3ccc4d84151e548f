//! Modes of a linear system ẋ = A x: eigenvalues, and the motions that belong to them.
//!
//! Eigenvalues come from the real Schur form of A after balancing (Parlett and Reinsch 1969), eigenvectors by inverse
//! iteration with a shift beside the eigenvalue, which also sharpens it by Rayleigh's quotient. It is done on the
//! Hessenberg form, H = Qᵀ A Q, whose elimination takes n² operations.

mod coincidence;

use nalgebra::linalg::balancing::balance_parlett_reinsch;
use nalgebra::{Complex, DMatrix, DVector};

/// A complex number.
pub type Number = Complex<f64>;

/// A mode: x = Re(shape · e^(λ t)).
#[derive(Clone, Debug)]
pub struct Mode {
    /// λ \[1/s\]; of a pair of conjugates the one with the positive imaginary part.
    pub rate: Number,
    /// The shape, an entry for each of x in its unit, scaled so that the largest is 1.
    pub shape: Vec<Number>,
    /// How well A x = λ x holds: the norm of the difference, by that of A and x, after balancing. λ counts as 0 if it
    /// is [`hidden`].
    pub residual: f64,
}

impl Mode {
    /// Whether nothing moves in it but rounding, only states of force laws. `count` is the number of velocities.
    pub fn moves_nothing(&self, count: usize) -> bool {
        let largest =
            |part: &[Number]| part.iter().fold(0.0, |most: f64, one| most.max(one.norm()));
        let (moves, laws) = self.shape.split_at(2 * count);
        largest(moves) <= STANDS * largest(laws)
    }
}

/// Why there are no modes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoModes {
    /// An entry of A is not finite.
    NotFinite,
    /// The iteration for the Schur form did not converge.
    NotConverged,
}

/// Largest number of iterations for a Schur form.
const ITERATIONS: usize = 100_000;

/// The share of the largest |λ| below which rounding hides an eigenvalue: two that coincide at 0, as those of a free
/// motion, are found about √ε = 1.5e-8 from it, times a factor that grows with the size of A: 64 is a margin.
const HIDDEN: f64 = 64.0 * 1.5e-8;

/// The share of |λ| below which an imaginary part is rounding: two real eigenvalues that coincide are found about √ε
/// apart.
const COINCIDE: f64 = 1e-7;

/// The |λ| \[1/s\] below which nothing moves: a factor of e in thirty years.
const STILL: f64 = 1e-9;

/// Nothing moves in a mode of states of force laws if what moves is below this share of them \[SI\]: half of the
/// digits.
const STANDS: f64 = 1e-8;

/// The modes of A, by rows, slowest first. `mass` is S, by rows, of the velocities whose coordinates are the first
/// entries of x; without entries the shapes of rates that coincide are as they were found.
///
/// # Errors
/// See [`NoModes`].
pub fn modes(a: &[f64], size: usize, mass: &[f64]) -> Result<Vec<Mode>, NoModes> {
    if !a.iter().all(|entry| entry.is_finite()) {
        return Err(NoModes::NotFinite);
    }
    let mut balanced = DMatrix::from_row_slice(size, size, a);
    let scales = balance_parlett_reinsch(&mut balanced);
    let schur = balanced.clone().try_schur(f64::EPSILON, ITERATIONS);
    let eigenvalues = schur.ok_or(NoModes::NotConverged)?.complex_eigenvalues();
    let norm = balanced.norm();
    let (q, h) = balanced.clone().hessenberg().unpack();
    let complex = h.map(|entry| Number::new(entry, 0.0));
    let back = (q, scales);
    let mut modes: Vec<Mode> = eigenvalues
        .iter()
        .map(|&rate| match rate.im.abs() <= COINCIDE * rate.norm() {
            // one real rate, twice, as rounding splits it
            true => Number::new(rate.re, 0.0),
            false => rate,
        })
        // of a pair, one
        .filter(|rate| rate.im >= 0.0)
        .enumerate()
        .map(|(index, rate)| mode(&complex, rate, norm, &back, index))
        .collect();
    modes.sort_by(|a, b| a.rate.norm().total_cmp(&b.rate.norm()));
    let residual = |shape: &[Number], rate: Number| {
        let x = DVector::from_fn(size, |i, _| shape[i] / back.1[i]);
        let image = |i: usize| -> Number { (0..size).map(|j| x[j] * balanced[(i, j)]).sum() };
        let image = DVector::from_fn(size, |i, _| image(i));
        (image - &x * rate).norm() / (norm.max(f64::MIN_POSITIVE) * x.norm())
    };
    // where inverse iteration finds the same free motion again and again, singular vectors are all of them
    let null = || -> Vec<Vec<Number>> {
        let svd = balanced
            .clone()
            .try_svd(false, true, f64::EPSILON, ITERATIONS);
        let Some((rows, values)) = svd.and_then(|svd| svd.v_t.zip(Some(svd.singular_values)))
        else {
            return Vec::new();
        };
        // that of an oscillator whose rate is hidden
        let tiny = HIDDEN * HIDDEN * norm;
        let small = (0..size).filter(|&k| values[k] <= tiny);
        let shape = |k| {
            let entry = |i| Number::new(rows[(k, i)] * back.1[i], 0.0);
            (0..size).map(entry).collect()
        };
        small.map(shape).collect()
    };
    if !mass.is_empty() {
        coincidence::choose(&mut modes, mass, &residual, &null);
    }
    Ok(modes)
}

/// Scales a shape so that its largest entry is 1.
fn scale(shape: &mut [Number]) {
    let largest = shape.iter().copied().fold(Number::ZERO, |most, entry| {
        match entry.norm() > most.norm() {
            true => entry,
            false => most,
        }
    });
    if largest != Number::ZERO {
        shape.iter_mut().for_each(|entry| *entry /= largest);
    }
}

/// The mode beside an eigenvalue of the Hessenberg matrix `a`. Q and the scales lead back from its coordinates.
fn mode(
    a: &DMatrix<Number>,
    found: Number,
    norm: f64,
    (q, scales): &(DMatrix<f64>, DVector<f64>),
    index: usize,
) -> Mode {
    let size = a.nrows();
    // another beginning for each, so that equal eigenvalues get different shapes
    let begin = |i: usize| ((i + 1) * (2 * index + 3) * 7919 % 101) as f64;
    let begin = DVector::from_fn(size, |i, _| Number::new(1.0 + begin(i), begin(i + size)));
    // beside the eigenvalue, where the matrix is not singular; further away if it is still
    let near = [1.0, 1e2, 1e4].map(|times| times * f64::EPSILON * norm.max(f64::MIN_POSITIVE));
    let shapes = near.iter().map(|distance| {
        let beside = found + Number::new(*distance, 0.0);
        inverse_iteration(&Factors::of(a, beside), &begin)
    });
    let x = shapes.flatten().next().unwrap_or(begin);
    let image = a * &x;
    let quotient = x.dotc(&image);
    // where two coincide, the quotient is no better
    let better = |rate: Number| (&image - &x * rate).norm();
    let mut rate = match better(quotient) < better(found) {
        true => quotient,
        false => found,
    };
    if rate.im.abs() <= 1e-12 * rate.norm() {
        rate.im = 0.0;
    }
    let residual = better(rate) / norm.max(f64::MIN_POSITIVE);
    let turned = |i: usize| -> Number { (0..size).map(|j| x[j] * q[(i, j)]).sum() };
    let mut shape: Vec<Number> = (0..size).map(|i| turned(i) * scales[i]).collect();
    scale(&mut shape);
    Mode {
        rate,
        shape,
        residual,
    }
}

/// The vector of length 1 that a matrix shrinks most; `None` where the matrix is singular.
fn inverse_iteration(a: &Factors, begin: &DVector<Number>) -> Option<DVector<Number>> {
    let mut x = begin.unscale(begin.norm());
    for _ in 0..3 {
        let next = a.solve(x)?;
        let length = next.norm();
        if !(length.is_finite() && length > 0.0) {
            return None;
        }
        x = next.unscale(length);
    }
    Some(x)
}

/// L U of a Hessenberg matrix less a multiple of 1, each row exchanged with the next if that has the larger pivot.
struct Factors {
    /// U, by rows.
    rows: Vec<Vec<Number>>,
    /// For each row but the last, whether it was exchanged, and the multiple of it that was subtracted from the next.
    steps: Vec<(bool, Number)>,
}

impl Factors {
    fn of(a: &DMatrix<Number>, less: Number) -> Self {
        let size = a.nrows();
        let row = |i: usize| {
            let mut row: Vec<Number> = a.row(i).iter().copied().collect();
            row[i] -= less;
            row
        };
        let mut rows: Vec<Vec<Number>> = (0..size).map(row).collect();
        let mut steps = Vec::new();
        for k in 1..size {
            let swap = rows[k][k - 1].norm() > rows[k - 1][k - 1].norm();
            if swap {
                rows.swap(k - 1, k);
            }
            let (above, below) = rows.split_at_mut(k);
            let (pivot, row) = (&above[k - 1], &mut below[0]);
            let times = match pivot[k - 1] == Number::ZERO {
                true => Number::ZERO,
                false => row[k - 1] / pivot[k - 1],
            };
            for (entry, pivot) in row.iter_mut().zip(pivot).skip(k) {
                *entry -= times * pivot;
            }
            steps.push((swap, times));
        }
        Factors { rows, steps }
    }

    /// `None` where the matrix is singular.
    fn solve(&self, mut x: DVector<Number>) -> Option<DVector<Number>> {
        for (k, (swap, times)) in self.steps.iter().enumerate() {
            if *swap {
                x.swap_rows(k, k + 1);
            }
            let above = x[k];
            x[k + 1] -= times * above;
        }
        for (k, row) in self.rows.iter().enumerate().rev() {
            let known: Number = (k + 1..x.len()).map(|j| row[j] * x[j]).sum();
            if row[k] == Number::ZERO {
                return None;
            }
            x[k] = (x[k] - known) / row[k];
        }
        Some(x)
    }
}

/// The |λ| \[1/s\] below which the eigenvalues of these modes cannot be told from 0.
pub fn hidden(modes: &[Mode]) -> f64 {
    let rates = modes.iter().map(|mode| mode.rate.norm());
    (HIDDEN * rates.fold(0.0, f64::max)).max(STILL)
}

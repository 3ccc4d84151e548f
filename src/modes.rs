//! Modes of a linear system ẋ = A x: eigenvalues, and the motions that belong to them.
//!
//! Eigenvalues come from the real Schur form of A after balancing (Parlett and Reinsch 1969), eigenvectors by inverse iteration with a
//! shift beside the eigenvalue, which also sharpens it by Rayleigh's quotient. It is done on the Hessenberg form, H = Qᵀ A Q, whose
//! elimination takes n² operations.
//!
//! Where rates coincide, the shapes are any basis of a subspace. The basis that is chosen is orthogonal in the mass matrix, and its first shape
//! is the one in which a single velocity has the largest share of the kinetic energy, and so on in what remains: it depends on the subspace alone.

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
    /// How well A x = λ x holds: the norm of the difference, by that of A and x, after balancing. λ counts as 0 if it is [`hidden`].
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

/// The share of the largest |λ| below which rounding hides an eigenvalue: two that coincide at 0, as those of a free motion, are found
/// about √ε = 1.5e-8 from it, times a factor that grows with the size of A: 64 is a margin.
const HIDDEN: f64 = 64.0 * 1.5e-8;

/// The share of |λ| below which an imaginary part is rounding: two real eigenvalues that coincide are found about √ε apart.
const COINCIDE: f64 = 1e-7;

/// The |λ| \[1/s\] below which nothing moves: a factor of e in thirty years.
const STILL: f64 = 1e-9;

/// Vectors are dependent in the mass matrix if less than this share of one is left beside the others: shapes have about half of the digits where
/// rates coincide.
const DEPENDENT: f64 = 1e-4;

/// Nothing moves in a mode of states of force laws if what moves is below this share of them \[SI\]: half of the digits.
const STANDS: f64 = 1e-8;

/// A basis of a subspace is taken if its residual is below this, or no worse than before: then rates did coincide.
const COINCIDED: f64 = 1e-10;

/// The modes of A, by rows, slowest first. `mass` is S, by rows, of the velocities whose coordinates are the first entries of x; without
/// entries the shapes of rates that coincide are as they were found.
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
        let svd = balanced.clone().svd(false, true);
        let rows = svd.v_t.expect("it was asked for");
        // that of an oscillator whose rate is hidden
        let tiny = HIDDEN * HIDDEN * norm;
        let small = (0..size).filter(|&k| svd.singular_values[k] <= tiny);
        let shape = |k| {
            let entry = |i| Number::new(rows[(k, i)] * back.1[i], 0.0);
            (0..size).map(entry).collect()
        };
        small.map(shape).collect()
    };
    if !mass.is_empty() {
        choose(&mut modes, mass, &residual, &null);
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

/// Where rates coincide, takes another basis for the shapes. `residual` is that of a shape at a rate, `null` are the shapes with A x = 0.
fn choose(
    modes: &mut [Mode],
    mass: &[f64],
    residual: &dyn Fn(&[Number], Number) -> f64,
    null: &dyn Fn() -> Vec<Vec<Number>>,
) {
    let count = mass.len().isqrt();
    let metric = Metric {
        first: 0,
        mass,
        count,
    };
    let laws = modes[0].shape.len() - 2 * count;
    let ones: Vec<f64> = (0..laws * laws)
        .map(|k| f64::from(u8::from(k % (laws + 1) == 0)))
        .collect();
    // of states of force laws, each counts as much as any other
    let of_laws = Metric {
        first: 2 * count,
        mass: &ones,
        count: laws,
    };
    let free = hidden(modes);
    let is_free = |rate: Number| rate.norm() <= free;
    let mut rest: Vec<usize> = (0..modes.len()).collect();
    while let Some(&first) = rest.first() {
        let first = modes[first].rate;
        let group: Vec<usize>;
        (group, rest) = rest.iter().partition(|&&index| {
            let rate = modes[index].rate;
            let near = (rate - first).norm() <= COINCIDE * first.norm();
            near || is_free(rate) && is_free(first)
        });
        let basis = match group.len() {
            1 => continue,
            _ if is_free(first) => metric.basis(null()),
            _ => {
                let stands = group.iter().all(|&index| modes[index].moves_nothing(count));
                let metric = if stands { &of_laws } else { &metric };
                metric.basis(
                    group
                        .iter()
                        .map(|&index| modes[index].shape.clone())
                        .collect(),
                )
            }
        };
        // a free motion that nothing slows down is found twice: at rest, and beginning to move
        if basis.is_empty() || basis.len() < group.len() && !is_free(first) {
            continue;
        }
        let chosen = group.iter().enumerate().map(|(number, &index)| {
            let Mode { rate, .. } = modes[index];
            let shape = basis[number % basis.len()].clone();
            let at = if is_free(rate) { Number::ZERO } else { rate };
            let residual = residual(&shape, at);
            Mode {
                rate,
                shape,
                residual,
            }
        });
        let chosen: Vec<Mode> = chosen.collect();
        let holds =
            |(new, &old): (&Mode, &usize)| new.residual <= modes[old].residual.max(COINCIDED);
        if chosen.iter().zip(&group).all(holds) {
            group
                .iter()
                .zip(chosen)
                .for_each(|(index, mode)| modes[*index] = mode);
        }
    }
}

/// A matrix as an inner product of entries of shapes: the mass matrix, of the first.
struct Metric<'a> {
    first: usize,
    mass: &'a [f64],
    count: usize,
}

impl Metric<'_> {
    /// M x.
    fn momentum(&self, x: &[Number]) -> Vec<Number> {
        let row = |i: usize| {
            (0..self.count)
                .map(|j| x[self.first + j] * self.mass[self.count * i + j])
                .sum()
        };
        (0..self.count).map(row).collect()
    }

    fn product(&self, a: &[Number], b: &[Number]) -> Number {
        let momentum = self.momentum(b);
        let a = &a[self.first..];
        a.iter().zip(&momentum).map(|(a, m)| a.conj() * m).sum()
    }

    /// The basis of the subspace of these shapes, largest entries 1; it has fewer where shapes depend on others.
    fn basis(&self, shapes: Vec<Vec<Number>>) -> Vec<Vec<Number>> {
        let unit = |mut shape: Vec<Number>| {
            let length = self.product(&shape, &shape).re.sqrt();
            shape.iter_mut().for_each(|entry| *entry /= length);
            (length > 0.0).then_some(shape)
        };
        let mut space = self.orthonormal(shapes.into_iter().filter_map(unit).collect());
        let mut chosen = Vec::new();
        while !space.is_empty() {
            // the projection V Vᴴ M e of the velocity that has the largest share of the energy of its own projection
            let momenta: Vec<_> = space.iter().map(|one| self.momentum(one)).collect();
            let share = |j: usize| {
                let all: f64 = momenta.iter().map(|one| one[j].norm_sqr()).sum();
                all / self.mass[self.count * j + j]
            };
            // the first of several that are equal but for rounding
            let best =
                (1..self.count).fold(0, |best, j| match share(j) > (1.0 + 1e-6) * share(best) {
                    true => j,
                    false => best,
                });
            let mut one = vec![Number::ZERO; space[0].len()];
            for (vector, momentum) in space.iter().zip(&momenta) {
                subtract(&mut one, -momentum[best].conj(), vector);
            }
            let Some(mut one) = unit(one) else { break };
            for vector in &mut space {
                let part = self.product(&one, vector);
                subtract(vector, part, &one);
            }
            space = self.orthonormal(space);
            scale(&mut one);
            chosen.push(one);
        }
        chosen
    }

    /// An orthonormal basis of vectors of length 1 or less, by Gram and Schmidt, the one of which most is left first.
    fn orthonormal(&self, mut left: Vec<Vec<Number>>) -> Vec<Vec<Number>> {
        let mut found = Vec::new();
        loop {
            let lengths = left
                .iter()
                .map(|x| self.product(x, x).re.sqrt())
                .enumerate();
            let longest = lengths.max_by(|a, b| a.1.total_cmp(&b.1));
            let Some((index, length)) = longest.filter(|(_, length)| *length > DEPENDENT) else {
                return found;
            };
            let mut one = left.swap_remove(index);
            one.iter_mut().for_each(|entry| *entry /= length);
            for other in &mut left {
                let part = self.product(&one, other);
                subtract(other, part, &one);
            }
            found.push(one);
        }
    }
}

fn subtract(from: &mut [Number], times: Number, what: &[Number]) {
    from.iter_mut().zip(what).for_each(|(x, y)| *x -= times * y);
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

#[cfg(test)]
mod tests {
    use super::*;

    /// [0 1; −ω² −2ζω]
    #[test]
    fn an_oscillator_has_its_frequency_and_damping() {
        let (omega, zeta) = (30.0, 0.05);
        let found = modes(&[0.0, 1.0, -omega * omega, -2.0 * zeta * omega], 2, &[]).unwrap();
        assert_eq!(found.len(), 1);
        let rate = found[0].rate;
        assert!((rate.norm() - omega).abs() < 1e-12 * omega, "{rate}");
        assert!((-rate.re / rate.norm() - zeta).abs() < 1e-13, "{rate}");
        // v = λ q
        let [q, v] = found[0].shape[..] else { panic!() };
        assert!((v - rate * q).norm() < 1e-12, "{q} {v}");
    }

    #[test]
    fn a_free_motion_is_hidden_and_an_unstable_one_grows() {
        let free = modes(&[0.0, 1.0, 0.0, 0.0], 2, &[]).unwrap();
        assert!(free.iter().all(|mode| mode.rate.norm() <= 1e-7), "{free:?}");
        let falls = modes(&[0.0, 1.0, 9.0, 0.0], 2, &[]).unwrap();
        let rates: Vec<f64> = falls.iter().map(|mode| mode.rate.re).collect();
        assert!(
            (rates[0].abs() - 3.0).abs() < 1e-14 && (rates[0] + rates[1]).abs() < 1e-14,
            "{rates:?}"
        );
        assert_eq!(modes(&[f64::NAN], 1, &[]).unwrap_err(), NoModes::NotFinite);
    }

    /// Two equal oscillators beside each other, in coordinates that mix them: each is a shape, and orthogonal in the mass matrix.
    #[test]
    fn shapes_of_rates_that_coincide_are_orthogonal_in_the_mass_matrix() {
        // S = [2 1; 1 2], K = 9 S
        let a = [
            [0.0, 0.0, 1.0, 0.0],
            [0.0, 0.0, 0.0, 1.0],
            [-9.0, 0.0, 0.0, 0.0],
            [0.0, -9.0, 0.0, 0.0],
        ];
        let mass = [2.0, 1.0, 1.0, 2.0];
        let found = modes(a.as_flattened(), 4, &mass).unwrap();
        assert_eq!(found.len(), 2);
        let [p, q] = [0, 1].map(|k| &found[k].shape);
        let product: Number = (0..4).map(|k| p[k / 2].conj() * mass[k] * q[k % 2]).sum();
        assert!(product.norm() < 1e-13, "{p:?} {q:?}");
        // the first velocity alone, and what is orthogonal to it: [1, −2]
        assert!(p[1].norm() < 1e-13 * p[0].norm(), "{p:?}");
        assert!((q[1] + 2.0 * q[0]).norm() < 1e-13 * q[0].norm(), "{q:?}");
        assert!(found.iter().all(|mode| mode.residual < 1e-14), "{found:?}");
    }

    /// A body that nothing holds beside two that are held: all of its motions are found, and nothing else.
    #[test]
    fn free_motions_are_all_found() {
        // three velocities, of which the second is slowed down by damping
        let mut a = [[0.0; 6]; 6];
        (0..3).for_each(|k| a[k][3 + k] = 1.0);
        a[4][4] = -5.0;
        let mass = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        let found = modes(a.as_flattened(), 6, &mass).unwrap();
        let free: Vec<&Mode> = found.iter().filter(|m| m.rate.norm() < 1e-6).collect();
        assert_eq!(free.len(), 5);
        for k in 0..3 {
            let alone = |mode: &&&Mode| {
                (0..6).all(|i| (mode.shape[i].norm() - f64::from(u8::from(i == k))).abs() < 1e-12)
            };
            assert!(free.iter().any(|mode| alone(&mode)), "{k}: {free:?}");
        }
    }

    /// Two inverted pendulums: each rate twice, with two shapes.
    #[test]
    fn what_coincides_is_there_twice() {
        let a = [
            [0.0, 0.0, 1.0, 0.0],
            [0.0, 0.0, 0.0, 1.0],
            [16.0, 0.0, 0.0, 0.0],
            [0.0, 16.0, 0.0, 0.0],
        ];
        let found = modes(a.as_flattened(), 4, &[]).unwrap();
        let mut rates: Vec<f64> = found.iter().map(|mode| mode.rate.re).collect();
        rates.sort_by(f64::total_cmp);
        for (rate, expected) in rates.iter().zip([-4.0, -4.0, 4.0, 4.0]) {
            assert!((rate - expected).abs() < 1e-12, "{rates:?}");
        }
        assert!(found.iter().all(|mode| mode.residual < 1e-14), "{found:?}");
    }

    /// Badly scaled: lengths in nanometres beside angles.
    #[test]
    fn scales_do_not_matter() {
        let a = [0.0, 1e9, -4e-9, 0.0];
        let found = modes(&a, 2, &[]).unwrap();
        assert!(
            (found[0].rate - Number::new(0.0, 2.0)).norm() < 1e-14,
            "{found:?}"
        );
        assert!(found[0].residual < 1e-15);
    }
}

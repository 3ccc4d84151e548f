//! Shapes where rates coincide: they are any basis of a subspace.
//!
//! The basis that is chosen is orthogonal in the mass matrix. Its first shape is the one in which a single velocity has
//! the largest share of the kinetic energy; the second is chosen in the same way from what is orthogonal to the first,
//! and so on. It depends on the subspace alone.

use super::{COINCIDE, Mode, Number, hidden, scale};

/// Vectors are dependent in the mass matrix if less than this share of one is left beside the others: shapes have about
/// half of the digits where rates coincide.
const DEPENDENT: f64 = 1e-4;

/// A basis of a subspace is taken if its residual is below this, or no worse than before: then rates did coincide.
const COINCIDED: f64 = 1e-10;

/// Where rates coincide, takes another basis for the shapes. `residual` is that of a shape at a rate, `null` are the
/// shapes with A x = 0.
pub fn choose(
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
    while let Some(&one) = rest.first() {
        let first = modes[one].rate;
        let group: Vec<usize>;
        (group, rest) = rest.iter().partition(|&&index| {
            let rate = modes[index].rate;
            let near = (rate - first).norm() <= COINCIDE * first.norm();
            index == one || near || is_free(rate) && is_free(first)
        });
        let basis = match group.len() {
            1 => continue,
            _ if is_free(first) => metric.basis(null()),
            _ => {
                let stands = group.iter().all(|&index| modes[index].moves_nothing(count));
                let metric = if stands { &of_laws } else { &metric };
                let shapes = group.iter().map(|&index| modes[index].shape.clone());
                metric.basis(shapes.collect())
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

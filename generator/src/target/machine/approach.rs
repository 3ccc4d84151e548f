//! Two ellipsoids or ellipses that are mostly far from each other: the steps for this case, and a branch to the runtime
//! for all others.
//!
//! Only code for one lane uses these steps. They follow the runtime (`touch` in
//! `runtime/src/force/approach/{plane,space}.rs`, which explain them) operation by operation, up to the test whether
//! the line of centres separates the two. If it does not, a branch calls the runtime: see `rare_branches`.

use super::numbers::Signed;
use super::steps::{Callee, Lowering};
use super::terms::Term;
use crate::expression::{ApproachCall, Function};

impl Lowering<'_> {
    /// The results of the call; `None` if the runtime must be called in any case.
    pub fn approach(&mut self, call: ApproachCall, a: &[Term]) -> Option<Vec<Term>> {
        // with several lanes, the pair is near in one of them most of the time; in space, results with their slopes
        // need too many registers at once
        if !call.early || !self.one_lane || self.slopes && !call.planar {
            return None;
        }
        let (both, between) = a.split_at(a.len() - call.components());
        let squared = self.dot(between, between);
        let mut reaches = both.chunks_exact(both.len() / 2);
        let mut reach = || {
            let stretched = self.stretched(reaches.next()?, between);
            let product = self.dot(between, &stretched);
            Some(self.root(product))
        };
        let (first, second) = (reach()?, reach()?);
        let reach = self.sum(first, second);
        let depth = self.sum(reach, squared.negated());
        let (one, half) = (self.number(1.0), self.number(0.5));
        let distance = self.root(squared);
        let scale = self.quotient(one, distance);
        let mut apart: Vec<Term> = between.iter().map(|d| self.product(scale, *d)).collect();
        apart.push(self.product(scale, depth));
        apart.extend(between.iter().map(|d| self.product(half, *d)));

        let callee = Callee::Function(Function::Approach(call).first_part());
        let numbers = |terms: &[Term]| -> Vec<Signed> {
            let parts = |term: &Term| std::iter::once(term.value).chain(term.slope);
            terms.iter().flat_map(parts).collect()
        };
        let (given, results) = (numbers(a), numbers(&apart));
        let found = self.unless_rare(callee, 1, (depth.value, 0.0), &given, &results);
        let mut found = found.into_iter();
        let term = |_| {
            let value = found.next()?;
            let slope = if self.slopes { found.next() } else { None };
            Some(Term { value, slope })
        };
        apart.iter().map(term).collect()
    }

    /// a · b
    fn dot(&mut self, a: &[Term], b: &[Term]) -> Term {
        let last = a.len() - 1;
        let mut sum = self.product(a[last], b[last]);
        for i in (0..last).rev() {
            sum = self.mul_add(a[i], b[i], sum);
        }
        sum
    }

    /// Q d, for a symmetric Q given as xx, zz, xz or as xx, yy, zz, yz, xz, xy.
    fn stretched(&mut self, q: &[Term], d: &[Term]) -> Vec<Term> {
        let rows: &[[usize; 3]] = match d.len() {
            2 => &[[0, 2, 0], [2, 1, 0]],
            _ => &[[0, 5, 4], [5, 1, 3], [4, 3, 2]],
        };
        let row = |row: &[usize; 3]| {
            let entries: Vec<Term> = row[..d.len()].iter().map(|entry| q[*entry]).collect();
            self.dot(&entries, d)
        };
        rows.iter().map(row).collect()
    }
}

//! The candidates of the search: units of length, origins of a base, rotations and origins of frames.

use super::{Aim, Search, UNITS};
use crate::dynamics::link::frames::{Choice, Framed};
use crate::dynamics::link::tree::Tree;
use crate::expression::vector::Vec3;
use crate::expression::{Expr, Graph};

impl Search<'_, '_> {
    /// Tries units of length: the components of positions that occur most often.
    pub fn units(&mut self) {
        let graph = Graph::new();
        let tree = self.opened(&graph);
        let plain = Choice {
            unit: 1.0,
            ..self.best.clone()
        };
        let framed = Framed::in_trial(&tree, &self.natural, &plain);
        let components = framed.links.iter().flat_map(|link| link.place.0);
        let mut lengths: Vec<f64> = components
            .filter_map(|e| e.as_constant())
            .map(f64::abs)
            .filter(|length| *length > 1e-6)
            .collect();
        lengths.sort_by(f64::total_cmp);
        let mut units: Vec<(usize, f64)> = Vec::new();
        for length in lengths {
            match units.last_mut() {
                Some((count, unit)) if (length - *unit).abs() < 1e-12 => *count += 1,
                _ => units.push((1, length)),
            }
        }
        units.sort_by(|(a, x), (b, y)| b.cmp(a).then(y.total_cmp(x)));
        units.truncate(UNITS);
        let with = |(_, unit)| Choice {
            unit,
            ..self.best.clone()
        };
        self.attempt(None, units.into_iter().map(with).collect());
    }

    /// Tries origins of a free base: in the joints of the links that it carries, or level with them.
    pub fn bases(&mut self) {
        // a system whose elements are all welded down has no links
        let first = self.tree.links.first();
        let in_space = first.is_some_and(|link| link.joint.is_ball());
        if !self.tree.free || !in_space || self.aim != Aim::Elimination {
            return;
        }
        let mut places = vec![[0.0; 3]];
        for link in self.tree.links.iter().filter(|l| l.parent == Some(0)) {
            let place = link.place.0.map(|e| e.as_constant().unwrap_or(0.0));
            for mask in 1..8 {
                let masked = [0, 1, 2].map(|i| if mask >> i & 1 == 1 { place[i] } else { 0.0 });
                if !places.contains(&masked) {
                    places.push(masked);
                }
            }
        }
        let with = |base| Choice {
            base,
            ..self.best.clone()
        };
        self.attempt(Some(0), places.into_iter().map(with).collect());
    }

    /// Rotations and origins of a link's frame for which constants vanish.
    pub fn frames(&self, k: usize) -> Vec<(f64, f64)> {
        let mut choice = self.best.clone();
        choice.unit = 1.0;
        choice.links[k].aligned = false;
        (choice.links[k].turn, choice.links[k].place) = (0.0, 0.0);
        let constant = |e: Expr<'_>| e.as_constant().unwrap_or(0.0);
        let mut places = vec![0.0];
        {
            self.graph.clear();
            let part = self.around(&self.graph, k, &choice);
            let (framed, at, children) = part.framed(k);
            let link = &framed.links[at];
            // the joint's position along the axis, seen from the link
            let along = (0..3).map(|i| link.against[i][2] * constant(link.place.0[i]));
            places.push(-along.sum::<f64>());
            places.extend(
                children
                    .iter()
                    .map(|&c| constant(framed.links[c].place.0[2])),
            );
            let (h, s) = (link.body.first.0.map(constant), &link.body.second);
            for (i, h) in h.into_iter().take(2).enumerate() {
                let level = constant(s.entry(i, 2)) / h;
                // an h that is almost 0 would move the origin far away, and the inertia would lose digits
                if level.abs() <= self.reach {
                    places.push(level);
                }
            }
        }
        let mut frames = Vec::new();
        let mut known: Vec<f64> = Vec::new();
        for place in places {
            if known.iter().any(|p: &f64| (p - place).abs() < 1e-13) {
                continue;
            }
            known.push(place);
            choice.links[k].place = place;
            self.graph.clear();
            let part = self.around(&self.graph, k, &choice);
            let (framed, at, children) = part.framed(k);
            let link = &framed.links[at];
            let mut turns = vec![0.0];
            let mut towards = |x: f64, y: f64| {
                if libm::hypot(x, y) > 1e-9 {
                    let quarter = std::f64::consts::FRAC_PI_2;
                    let angle = libm::atan2(y, x);
                    let turn = angle - (angle / quarter).round() * quarter;
                    if turns.iter().all(|t: &f64| (t - turn).abs() > 1e-14) {
                        turns.push(turn);
                    }
                }
            };
            let h = link.body.first.0.map(constant);
            let sigma = |i, j| constant(link.body.second.entry(i, j));
            towards(h[0], h[1]);
            towards(sigma(0, 2), sigma(1, 2));
            let principal = 0.5 * libm::atan2(2.0 * sigma(0, 1), sigma(0, 0) - sigma(1, 1));
            towards(libm::cos(principal), libm::sin(principal));
            // the rotation of the joint relative to its carrier
            towards(link.against[2][1], link.against[2][0]);
            for &c in &children {
                let child = &framed.links[c];
                towards(constant(child.place.0[0]), constant(child.place.0[1]));
                towards(child.against[0][2], child.against[1][2]);
            }
            frames.extend(turns.into_iter().map(|turn| (turn, place)));
        }
        frames
    }
}

/// The largest distance of the origin of a link from its joint \[m\]: four times the largest distance in the tree,
/// between joints or between a centre of mass and its joint. About an origin s such distances away, an inertia is s²
/// times as large and loses that factor in accuracy; 16 is little.
pub fn reach(tree: &Tree<'_>) -> f64 {
    let constant = |e: Expr<'_>| e.as_constant().unwrap_or(0.0);
    let norm = |v: Vec3<'_>| v.0.map(constant).iter().map(|c| c * c).sum::<f64>().sqrt();
    let masses = || tree.links.iter().map(|link| constant(link.body.mass).abs());
    let heaviest = masses().fold(0.0, f64::max);
    let links = tree.links.iter().zip(masses());
    let distances = links.map(|(link, mass)| match mass > 1e-3 * heaviest {
        true => norm(link.place).max(norm(link.body.first) / mass),
        false => norm(link.place),
    });
    4.0 * distances.fold(0.0, f64::max)
}

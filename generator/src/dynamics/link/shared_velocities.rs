//! Velocities that several links share, because freedoms follow others. Each is eliminated at the first link
//! that carries all links that this velocity moves.
//!
//! On the way there, the column of the velocity is passed along: for v̇_r = 1 the bodies outboard need U_r, and D_r
//! v̇_r = u_r − U_r · (Δa, Δα) − Σ D_rq v̇_q.
//!
//! | | |
//! |---|---|
//! | at a link whose joint has the rate σ v_r along its column H | U_r += σ I H,  D_r += 2 σ Hᵀ U_r + σ² Hᵀ I H,  D_rq += σ Hᵀ U_q,  u_r += σ u |
//! | where another velocity (U, D, u) is eliminated, with E_r = Hᵀ U_r or D_r of the two | U_r −= U E_r/D,  D_rq −= E_r E_q/D,  u_r −= E_r u/D |

use super::tree::Tree;
use crate::dynamics::spatial::Wrench;
use crate::expression::Expr;

/// Shared velocities on the way to the links where they are eliminated.
#[derive(Clone, Default)]
pub struct Shared<'g> {
    velocities: Vec<Velocity<'g>>,
    /// D_rq for r < q.
    between: Vec<(usize, usize, Expr<'g>)>,
}

/// One shared velocity.
#[derive(Clone)]
pub struct Velocity<'g> {
    /// r
    pub row: usize,
    /// U_r
    pub needed: Wrench<'g>,
    /// D_r
    pub whole: Expr<'g>,
    /// u_r
    pub left: Expr<'g>,
}

/// For each shared velocity, its row and the link where it is eliminated. `None` if no link carries all links of a
/// velocity, or if a ball is between them.
pub fn elimination_links(tree: &Tree<'_>) -> Option<Vec<(usize, usize)>> {
    let mut found: Vec<(usize, usize)> = Vec::new();
    for (k, link) in tree.links.iter().enumerate() {
        if !link.joint.is_coupled() || found.iter().any(|(row, _)| *row == link.row) {
            continue;
        }
        let same = (k..tree.links.len()).filter(|&l| {
            let other = &tree.links[l];
            other.joint.is_coupled() && other.row == link.row
        });
        let mut members: Vec<usize> = same.collect();
        // replaces the last member by its parent, which carries it, until one member is left
        while members.len() > 1 {
            let last = members.pop()?;
            let carrier = &tree.links[last];
            if carrier.joint.is_ball() {
                return None;
            }
            members.push(carrier.parent?);
            members.sort_unstable();
            members.dedup();
        }
        found.push((link.row, members[0]));
    }
    Some(found)
}

impl<'g> Shared<'g> {
    /// Adds the velocities of another branch.
    pub fn join(&mut self, other: Shared<'g>) {
        for velocity in other.velocities {
            match self.velocities.iter_mut().find(|v| v.row == velocity.row) {
                Some(own) => {
                    own.needed = own.needed.plus(velocity.needed);
                    own.whole = own.whole + velocity.whole;
                    own.left = own.left + velocity.left;
                }
                None => self.velocities.push(velocity),
            }
        }
        for (r, q, value) in other.between {
            self.add_between(r, q, value);
        }
    }

    fn add_between(&mut self, r: usize, q: usize, value: Expr<'g>) {
        let (r, q) = (r.min(q), r.max(q));
        match self.between.iter_mut().find(|(a, b, _)| (*a, *b) == (r, q)) {
            Some((.., sum)) => *sum = *sum + value,
            None => self.between.push((r, q, value)),
        }
    }

    /// The same velocities with all wrenches mapped by `of`, which moves them to another link.
    pub fn passed(mut self, of: impl Fn(Wrench<'g>) -> Wrench<'g>) -> Self {
        for velocity in &mut self.velocities {
            velocity.needed = of(velocity.needed);
        }
        self
    }

    /// Hᵀ U_r by row; `power` gives the power of a wrench per velocity of the joint.
    pub fn powers(&self, power: impl Fn(&Wrench<'g>) -> Expr<'g>) -> Vec<(usize, Expr<'g>)> {
        let each = self.velocities.iter();
        each.map(|v| (v.row, power(&v.needed))).collect()
    }

    /// Adds a link whose joint has a share of a velocity. `own` has U, D and u of the joint alone, and `powers` are the
    /// powers Hᵀ U_q of the velocities that are already present.
    pub fn add(&mut self, share: Expr<'g>, own: Velocity<'g>, powers: &[(usize, Expr<'g>)]) {
        let row = own.row;
        let added = Velocity {
            row,
            needed: Wrench {
                force: share * own.needed.force,
                moment: share * own.needed.moment,
            },
            whole: share.squared() * own.whole,
            left: share * own.left,
        };
        for &(other, power) in powers {
            if other != row {
                self.add_between(row, other, share * power);
            }
        }
        match self.velocities.iter_mut().find(|v| v.row == row) {
            Some(there) => {
                let together = powers.iter().find(|(other, _)| *other == row);
                let together = together.map_or(0.0 * share, |(_, power)| (2.0 * share) * *power);
                there.needed = there.needed.plus(added.needed);
                there.whole = there.whole + (together + added.whole);
                there.left = there.left + added.left;
            }
            None => self.velocities.push(added),
        }
    }

    /// Updates the velocities for the elimination of another one, which has U, 1/D, u and E by row.
    pub fn eliminate(
        &mut self,
        needed: &Wrench<'g>,
        (inverse, left): (Expr<'g>, Expr<'g>),
        crossing: &[(usize, Expr<'g>)],
    ) {
        for (i, &(row, e)) in crossing.iter().enumerate() {
            let gain = e * inverse;
            if let Some(v) = self.velocities.iter_mut().find(|v| v.row == row) {
                v.needed = Wrench {
                    force: v.needed.force - gain * needed.force,
                    moment: v.needed.moment - gain * needed.moment,
                };
                v.whole = v.whole - gain * e;
                v.left = v.left - gain * left;
            }
            for &(other, e) in &crossing[i + 1..] {
                self.add_between(row, other, -(gain * e));
            }
        }
    }

    /// Removes one velocity and returns it, with its D_rq by q.
    pub fn take(&mut self, row: usize) -> Option<(Velocity<'g>, Vec<(usize, Expr<'g>)>)> {
        let at = self.velocities.iter().position(|v| v.row == row)?;
        let velocity = self.velocities.remove(at);
        let mut crossing = Vec::new();
        self.between.retain(|&(r, q, value)| {
            if r != row && q != row {
                return true;
            }
            crossing.push((if r == row { q } else { r }, value));
            false
        });
        Some((velocity, crossing))
    }
}

//! Accelerations of systems with joint axes, in the frames of their links.
//!
//! In axes fixed to a link the inertia of its body is constant, much of it is 0 in the right frame, and a turn about the joint's axis
//! mixes two components only. What lies on the axis of a hinge is regrouped to the parent beforehand, and velocities
//! enter by a reference motion, so that they never meet an articulated inertia.
//!
//! | file | |
//! |---|---|
//! | `tree` | the links of a system |
//! | `body` | mass, first and second moment |
//! | `frames` | the frames of links, and regrouping |
//! | `turn` | turns between two frames |
//! | `motion` | the reference motion |
//! | `elimination` | the articulated-body algorithm |
//! | `search` | the choice of frames by count |

mod body;
mod elimination;
mod frames;
mod motion;
mod search;
#[cfg(test)]
mod tests;
mod tree;
mod turn;

use super::force::Loads;
use super::kinematics::inverse_rates;
use super::layout::Orientation;
use super::spatial::Spatial;
use crate::expression::{Expr, Symbol};
use elimination::Solved;
use frames::{Framed, natural_axes};
use tree::Tree;

/// v̇ of the system, by row; `None` where link frames cannot say it.
pub fn accelerations<'g>(
    spatial: &Spatial<'g, '_>,
    loads: &Loads<'g>,
) -> Option<Vec<(usize, Expr<'g>)>> {
    let tree = Tree::of(spatial, loads)?;
    let choice = search::choice(&tree);
    let framed = Framed::of(&tree, &natural_axes(&tree), &choice);
    let name = |link: &tree::Link<'g>| spatial.label(link.element);
    let solved = elimination::accelerations(&tree, &framed, &choice, &name);
    Some(rates(spatial, loads, &tree, &solved))
}

/// v̇ of what moves in the links, by row.
fn rates<'g>(
    spatial: &Spatial<'g, '_>,
    loads: &Loads<'g>,
    tree: &Tree<'g>,
    solved: &[Solved<'g>],
) -> Vec<(usize, Expr<'g>)> {
    let graph = spatial.graph;
    let mut rates = Vec::new();
    for (link, solved) in tree.links.iter().zip(solved) {
        if !link.joint.is_ball() {
            rates.push((link.row, solved.rotation.0[0]));
            continue;
        }
        let motion = spatial.motion_of(link.element);
        let turned = match spatial.layout.orientation {
            Orientation::Bryant => {
                let second = spatial.layout.element_coordinates(spatial.id(link.element));
                let cosine = graph
                    .symbol(Symbol::Coordinate(second.start as u32 + 1))
                    .cos();
                let nu = solved.rotation - motion.bias;
                inverse_rates(motion.axes[1], motion.axes[2], cosine, nu)
            }
            Orientation::Quaternion | Orientation::Angle => solved.rotation.0,
        };
        rates.extend(
            turned
                .into_iter()
                .enumerate()
                .map(|(i, rate)| (link.row + i, rate)),
        );
    }
    if let Some(rows) = spatial.layout.reference_velocities(spatial.system) {
        let field = loads.fields[spatial.system];
        for (row, &direction) in rows.zip(spatial.layout.directions) {
            rates.push((row, solved[0].base.0[direction] + field.0[direction]));
        }
    }
    rates
}

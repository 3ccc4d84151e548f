//! Damping faded in: w(x) = min(x/d, 1), so that no force jumps where x passes 0.

use crate::dynamics::numbers::number;
use crate::expression::{Expr, Graph};
use crate::model::Number;

/// Depths below this are taken for it: what fades in over nothing is there at once \[m or rad\].
const SHORTEST: f64 = 1e-15;

/// The part of a viscous force that is there at an abscissa x > 0: it grows linearly up to the depth d, and is full
/// beyond. Without a depth it is full at once. Below x = 0, where nothing touches, it is negative and of no meaning.
pub fn faded<'g>(graph: &'g Graph, abscissa: Expr<'g>, depth: Option<&Number>) -> Expr<'g> {
    match depth {
        // in this order of operands a NaN of the abscissa is passed on
        Some(depth) => {
            let depth = match depth.constant() {
                Some(depth) => graph.constant(depth),
                None => number(graph, depth).max(graph.constant(SHORTEST)),
            };
            (abscissa / depth).min(graph.constant(1.0))
        }
        None => graph.constant(1.0),
    }
}

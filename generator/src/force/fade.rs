//! Damping that is faded in by the factor w(x) = min(x/d, 1), so that the force does not jump where x passes 0.

use crate::expression::{Expr, Graph};
use crate::model::Number;
use crate::motion::numbers::number;

/// The smallest depth d; it replaces a smaller one, so that a depth of 0 gives full damping at once \[m or rad\].
const SHORTEST: f64 = 1e-15;

/// The factor w on a viscous force at the abscissa x > 0. It grows linearly up to 1 at the depth d, and stays 1 beyond;
/// without a depth it is 1 everywhere. Below x = 0 there is no contact, and the factor is negative and meaningless.
pub fn faded<'g>(graph: &'g Graph, abscissa: Expr<'g>, depth: Option<&Number>) -> Expr<'g> {
    match depth {
        // this order of operands passes on a NaN of the abscissa
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

//! A, B, C and D of a scene with all its forces.

use super::acceleration::under_loads;
use super::graph::Terms;
use super::loads::Loads;
use super::{DerivativeInputs, NotDifferentiable};
use crate::dynamics::outputs;
use crate::expression::differentiate::{Known, differentiate_almost_everywhere};
use crate::expression::{Expr, Node, NodeId, Symbol};
use crate::model::ElementId;

/// A matrix by rows.
pub type Matrix<'g> = Vec<Vec<Expr<'g>>>;

/// A scene near a state: δẋ = A δx + B δp, δy = C δx + D δp.
///
/// δx has the positions along the motions of v (see [this folder](super)), then δv, then δz, the continuous states of
/// force laws; no column is for the length of a quaternion. p are the chosen inputs, y the outputs of the model. The
/// memory m and time are constant. Where a law has a kink, the derivative is that of the side which is taken.
pub struct Linearisation<'g> {
    /// v, v̇ and ż: ẋ without the coordinates of q
    pub rates: Vec<Expr<'g>>,
    /// y
    pub outputs: Vec<Expr<'g>>,
    /// A, of the size of x
    pub a: Matrix<'g>,
    /// B, a row for each entry of x and a column for each input
    pub b: Matrix<'g>,
    /// C, a row for each output and a column for each entry of x
    pub c: Matrix<'g>,
    /// D, a row for each output and a column for each input
    pub d: Matrix<'g>,
}

/// The linearisation of a scene with all its forces with respect to these parameters, given by their index in the
/// model.
///
/// v̇ and its derivatives follow from ∂τ/∂q and ∂τ/∂v of the rigid bodies as in
/// [`acceleration_derivatives`](super::acceleration_derivatives); the forces of laws, ż and the outputs are
/// differentiated in symbols. A turn d of a ball joint changes with the angular velocity ω as ḋ = δω + ω × d, all in
/// absolute axes; so A is not (0, 1) in its rows.
///
/// # Errors
/// If a force or an output is a function of the user's, or has another function that cannot be differentiated in
/// symbols. Dual numbers can.
pub fn linearisation<'g>(
    scene: &DerivativeInputs<'g, '_>,
    inputs: &[usize],
) -> Result<Linearisation<'g>, NotDifferentiable> {
    let (graph, size) = (scene.graph, scene.state.v.len());
    let auxiliaries = &scene.applied.states.auxiliaries;
    let mut others: Vec<Symbol> = (0..auxiliaries.len())
        .map(|i| Symbol::Auxiliary(i as u32))
        .collect();
    others.extend(inputs.iter().map(|&i| Symbol::Parameter(i as u32)));
    let loads = Loads::of_laws(scene, &others)?;
    let terms: Vec<Terms<'g>> = (scene.systems.iter())
        .map(|spatial| Terms::of(scene, spatial))
        .collect();
    let needed = |accelerations: &[Expr<'g>]| {
        let of_input = |input: &Symbol| {
            let mut sums = vec![graph.constant(0.0); size];
            for terms in terms.iter().filter(|terms| !terms.is_empty()) {
                for (sum, term) in sums.iter_mut().zip(terms.by(*input, accelerations)?) {
                    *sum = *sum + term;
                }
            }
            Ok(sums)
        };
        others.iter().map(of_input).collect()
    };
    let none = vec![graph.constant(0.0); size];
    let (of_v, of_others) = under_loads(scene, &none, &loads, &needed)?;
    let outputs = outputs::outputs(&outputs::ModelInMotion {
        graph,
        model: scene.model,
        layout: scene.layout,
        motion: scene.motion,
        start: scene.start,
        applied: scene.applied,
        accelerations: &of_v.accelerations,
    });

    let count = 2 * size + auxiliaries.len();
    let mut a = vec![vec![graph.constant(0.0); count]; count];
    let mut b = vec![vec![graph.constant(0.0); inputs.len()]; count];
    let mut c = vec![vec![graph.constant(0.0); count]; outputs.len()];
    let mut d = vec![vec![graph.constant(0.0); inputs.len()]; outputs.len()];
    turns(scene, &mut a);
    for i in 0..size {
        a[i][size + i] = graph.constant(1.0);
        for j in 0..size {
            a[size + i][j] = of_v.by_position[i][j];
            a[size + i][size + j] = of_v.by_velocity[i][j];
        }
    }
    // ż and the outputs depend on v̇, whose derivatives are known
    let mut roots: Vec<NodeId> = auxiliaries.iter().map(|state| state.next.id()).collect();
    roots.extend(outputs.iter().map(|output| output.id()));
    let known = |column: &[Expr<'g>]| known(&of_v.accelerations, column);
    let column = |of: &Matrix<'g>, j: usize| of.iter().map(|row| row[j]).collect::<Vec<_>>();
    for j in 0..size {
        let both = [&of_v.by_position, &of_v.by_velocity].map(|of| known(&column(of, j)));
        for (i, values) in scene.along(j, &roots, &both)?.into_iter().enumerate() {
            let row = match i.checked_sub(auxiliaries.len()) {
                None => &mut a[2 * size + i],
                Some(i) => &mut c[i],
            };
            [row[j], row[size + j]] = values;
        }
    }
    for (k, (input, of_v)) in others.iter().zip(&of_others).enumerate() {
        let (x, place) = match k.checked_sub(auxiliaries.len()) {
            None => (true, 2 * size + k),
            Some(k) => (false, k),
        };
        for (i, value) in of_v.iter().enumerate() {
            let row = size + i;
            *(if x {
                &mut a[row][place]
            } else {
                &mut b[row][place]
            }) = *value;
        }
        let direction = |s| graph.constant(if s == *input { 1.0 } else { 0.0 });
        let found = differentiate_almost_everywhere(graph, &roots, &known(of_v), direction)?;
        for (i, id) in found.into_iter().enumerate() {
            let row = match (i.checked_sub(auxiliaries.len()), x) {
                (None, true) => &mut a[2 * size + i],
                (None, false) => &mut b[2 * size + i],
                (Some(i), true) => &mut c[i],
                (Some(i), false) => &mut d[i],
            };
            row[place] = graph.expr(id);
        }
    }
    let rates = scene.state.v.iter().chain(&of_v.accelerations).copied();
    let rates = rates.chain(auxiliaries.iter().map(|state| state.next));
    Ok(Linearisation {
        rates: rates.collect(),
        outputs,
        a,
        b,
        c,
        d,
    })
}

/// The derivatives of values that are not constant, by node. A negative is known by its operand, too.
fn known<'g>(values: &[Expr<'g>], derivatives: &[Expr<'g>]) -> Known<'g> {
    let mut known = Known::default();
    for (value, derivative) in values.iter().zip(derivatives) {
        if value.as_constant().is_some() {
            continue;
        }
        known.insert(value.id(), *derivative);
        if let Node::Neg(operand) = value.node() {
            known.insert(operand, -*derivative);
        }
    }
    known
}

/// ω × d in the rows of ball joints with quaternions.
fn turns<'g>(scene: &DerivativeInputs<'g, '_>, a: &mut Matrix<'g>) {
    let quaternions = scene.layout.quaternions();
    for spatial in scene.systems {
        for element in 0..spatial.of_system().elements.len() {
            let id = ElementId {
                system: spatial.system,
                element,
            };
            if !quaternions.contains(&spatial.layout.element_coordinates(id)) {
                continue;
            }
            let rows = spatial.layout.element_velocities(id);
            for i in 0..3 {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                let omega = scene.state.v[rows.start + i];
                // e_i × e_j = e_k
                a[rows.start + k][rows.start + j] = omega;
                a[rows.start + j][rows.start + k] = -omega;
            }
        }
    }
}

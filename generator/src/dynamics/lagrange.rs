//! Lagrange's equations, the route of the paper: differentiates the kinetic energy. It is slow, but independent of the
//! other routes.
//!
//! T = ½ Σ m ṙ·ṙ + ½ Σ ω'ᵀ I ω',   S = ∂²T/∂q̇²,   r_s = ∂T/∂q − (∂²T/∂q̇∂q) q̇ − ∂²T/∂q̇∂t
//!
//! It shares with the rest of the generator only the rotation matrices and the numbers of the model. Positions are
//! composed along the tree, velocities are ṙ = Σ (∂r/∂q_i) q̇_i by differentiation, and the angular velocity is read
//! from Aᵀ Ȧ = ω̂'. If the motion of a reference joint is prescribed, T depends on time, and r_s contains the inertia
//! against the prescribed acceleration, which the other routes count in r_k. Tests compare the equations with it, in
//! the plane and with Bryant angles (where v = q̇ in either chart).

use crate::expression::differentiate::{NotDifferentiable, differentiate_along, jacobian};
use crate::expression::vector::{Mat3, Vec3};
use crate::expression::{Expr, Graph, NodeId, Symbol, graph::sum};
use crate::model::{Element, ElementId, FieldComponent, Model, Reference, System, Vehicle};
use crate::model::{Freedom, Joint};
use crate::motion::Layout;
use crate::motion::ball::Orientation;
use crate::motion::kinematics::constant_rotation;
use crate::motion::numbers::time;
use crate::motion::numbers::{bryant, curve, number, vector};
use crate::motion::translation;

/// S and r_s by Lagrange's equations, over a graph of their own.
pub struct Lagrange {
    /// All expressions.
    pub graph: Graph,
    /// S, by rows.
    pub mass_matrix: Vec<Vec<NodeId>>,
    /// r_s, including the inertia against prescribed accelerations.
    pub velocity_forces: Vec<NodeId>,
}

/// Why Lagrange's equations of a model cannot be derived here.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoLagrange {
    /// The velocities are not the rates of the coordinates.
    #[error(
        "Lagrange's equations need v = q̇, which is not so of quaternions: derive the model in `coordinates: bryant`"
    )]
    Quaternions,
    /// Cannot occur: the kinetic energy of a model contains only algebra, sines, cosines and curves of time.
    #[error(transparent)]
    NotDifferentiable(#[from] NotDifferentiable),
}

/// Derives S and r_s of a model whose velocities are the rates of its coordinates.
///
/// # Errors
/// If the coordinates are quaternions.
pub fn lagrange(model: &Model) -> Result<Lagrange, NoLagrange> {
    let graph = Graph::new();
    let layout = Layout::of(model);
    if !layout.quaternions().is_empty() {
        return Err(NoLagrange::Quaternions);
    }
    let size = layout.coordinates.len();
    let symbols = |make: fn(u32) -> Symbol| (0..size as u32).map(make).collect::<Vec<_>>();
    let (q, v) = (symbols(Symbol::Coordinate), symbols(Symbol::Velocity));

    let energy = kinetic_energy(&graph, model, &layout)?.id();
    let momenta: Vec<NodeId> = jacobian(&graph, &[energy], &v)?.concat();
    let slopes: Vec<NodeId> = jacobian(&graph, &[energy], &q)?.concat();
    let mass_matrix = jacobian(&graph, &momenta, &v)?;
    // (∂²T/∂q̇∂q) q̇ + ∂²T/∂q̇∂t
    let convection = differentiate_along(&graph, &momenta, |symbol| following(&graph, symbol))?;
    let velocity_forces = slopes
        .iter()
        .zip(convection)
        .map(|(slope, along)| (graph.expr(*slope) - graph.expr(along)).id())
        .collect();
    Ok(Lagrange {
        graph,
        mass_matrix,
        velocity_forces,
    })
}

fn kinetic_energy<'g>(
    graph: &'g Graph,
    model: &Model,
    layout: &Layout,
) -> Result<Expr<'g>, NotDifferentiable> {
    let coordinate = |i: usize| graph.symbol(Symbol::Coordinate(i as u32));
    let mut energy = graph.constant(0.0);
    for (s, system) in model.systems.iter().enumerate() {
        let mut joints: Vec<(Vec3<'g>, Mat3<'g>)> = Vec::new();
        for (k, element) in system.elements.iter().enumerate() {
            let id = ElementId {
                system: s,
                element: k,
            };
            if let Joint::Freedoms(freedoms) = &element.joint {
                let carrier = match element.parent {
                    Some(parent) => joints[parent],
                    None => reference_frame(graph, model, layout, s),
                };
                let shares = layout.shares(graph, model, id);
                let q: Vec<_> = (shares.iter())
                    .map(|share| share.ratio * coordinate(share.coordinate) + share.offset)
                    .collect();
                for (freedom, share) in freedoms.iter().zip(&shares) {
                    let rate = graph.symbol(Symbol::Velocity(share.velocity as u32));
                    let armature = number(graph, &freedom.armature);
                    energy = energy + 0.5 * armature * (share.ratio * rate).squared();
                }
                let (at, turn) = placed(graph, freedoms, &q);
                let at = vector(graph, &element.at) + at;
                let joint = carrier.0 + carrier.1.times(at);
                joints.push((joint, carrier.1.product(&turn)));
                energy = energy + energy_of(graph, element, joints[k])?;
                continue;
            }
            let first = layout.element_coordinates(id).start;
            let zero = graph.constant(0.0);
            let angles = match layout.orientation {
                Orientation::Angle => [zero, coordinate(first), zero],
                _ => [0, 1, 2].map(|i| coordinate(first + i)),
            };
            let chart = layout.element_chart(id).map(|i| Symbol::Memory(i as u32));
            let rotation = match chart {
                Some(chart) => in_chart(&bryant(graph, angles).0, graph.symbol(chart)),
                None => bryant(graph, angles).0,
            };
            let joint = match element.parent {
                Some(parent) => {
                    joints[parent].0 + joints[parent].1.times(vector(graph, &element.at))
                }
                None => reference_frame(graph, model, layout, s).0,
            };
            joints.push((joint, rotation));
            energy = energy + energy_of(graph, element, joints[k])?;
        }
    }
    Ok(energy)
}

/// ½ m ṙ² + ½ ω'ᵀ I ω' of an element with this origin and rotation.
fn energy_of<'g>(
    graph: &'g Graph,
    element: &Element,
    (joint, rotation): (Vec3<'g>, Mat3<'g>),
) -> Result<Expr<'g>, NotDifferentiable> {
    let velocity = rate(
        graph,
        (joint + rotation.times(vector(graph, &element.cg))).0,
    )?;
    let energy = 0.5 * number(graph, &element.mass) * Vec3(velocity).squared();

    let [a, b, c] = rotation.0;
    let turning = Mat3([rate(graph, a)?, rate(graph, b)?, rate(graph, c)?]);
    let spin = rotation.transposed().product(&turning).0;
    let omega = Vec3([spin[2][1], spin[0][2], spin[1][0]]);
    let principal = constant_rotation(graph, &element.axes).transposed_times(omega);
    let moments = vector(graph, &element.inertia);
    let turns = (0..3).map(|i| 0.5 * moments.0[i] * principal.0[i].squared());
    Ok(energy + sum(graph, turns))
}

/// Position and rotation that the freedoms of a joint give an element, in the frame of its carrier, by
/// products of matrices: Rodrigues' formula for each.
fn placed<'g>(graph: &'g Graph, freedoms: &[Freedom], q: &[Expr<'g>]) -> (Vec3<'g>, Mat3<'g>) {
    let (zero, one) = (graph.constant(0.0), graph.constant(1.0));
    let mut turn = Mat3([[one, zero, zero], [zero, one, zero], [zero, zero, one]]);
    let mut at = Vec3::zero(graph);
    for (freedom, &q) in freedoms.iter().zip(q) {
        let axis = vector(graph, &freedom.axis);
        let position = q + number(graph, &freedom.zero);
        let advance = freedom.kind.advance().map_or(zero, |h| number(graph, h));
        at = at + turn.times((advance * position) * axis);
        if freedom.kind.turns() {
            let (sine, cosine) = (position.sin(), position.cos());
            let [x, y, z] = axis.0;
            let cross = [[zero, -z, y], [z, zero, -x], [-y, x, zero]];
            let rodrigues = Mat3([0, 1, 2].map(|i| {
                [0, 1, 2].map(|j| {
                    let same = if i == j { cosine } else { zero };
                    same + sine * cross[i][j] + (one - cosine) * axis.0[i] * axis.0[j]
                })
            }));
            turn = turn.product(&rodrigues);
        }
    }
    (at, turn)
}

/// The frame that carries the root of a system.
fn reference_frame<'g>(
    graph: &'g Graph,
    model: &Model,
    layout: &Layout,
    system: usize,
) -> (Vec3<'g>, Mat3<'g>) {
    let of_system = &model.systems[system];
    let mut position = reference_position(graph, model, of_system);
    if let Some(range) = layout.reference_coordinates(system) {
        for (&direction, i) in layout.directions.iter().zip(range) {
            position.0[direction] = graph.symbol(Symbol::Coordinate(i as u32));
        }
    }
    let angles = match &of_system.reference {
        Reference::Riding { vehicle, .. } => vehicle_angles(graph, &model.vehicles[*vehicle]),
        _ => [graph.constant(0.0); 3],
    };
    (position, bryant(graph, angles).0)
}

fn vehicle_angles<'g>(graph: &'g Graph, vehicle: &Vehicle) -> [Expr<'g>; 3] {
    std::array::from_fn(|i| match &vehicle.angles[i] {
        FieldComponent::Constant(angle) => number(graph, angle),
        FieldComponent::Curve(angle) => curve(graph, angle, time(graph)),
    })
}

/// R Ry(−90° c) for c = 0 or 1, as a sum of the columns in both charts, which can be differentiated.
fn in_chart<'g>(r: &Mat3<'g>, chart: Expr<'g>) -> Mat3<'g> {
    let other = chart.graph().constant(1.0) - chart;
    Mat3(r.0.map(|[x, y, z]| [other * x + chart * z, y, other * z - chart * x]))
}

/// The position of a reference joint that is not free.
fn reference_position<'g>(graph: &'g Graph, model: &Model, system: &System) -> Vec3<'g> {
    match &system.reference {
        Reference::Prescribed(translation) => {
            let (x, v) = (&system.position, &system.velocity);
            translation::motion(graph, translation, x, v, Some(time(graph))).0
        }
        Reference::Riding { vehicle, at } => {
            let vehicle = &model.vehicles[*vehicle];
            let angles = vehicle_angles(graph, vehicle);
            let (x, v) = (&vehicle.position, &vehicle.velocity);
            let moved = translation::motion(graph, &vehicle.translation, x, v, Some(time(graph)));
            moved.0 + bryant(graph, angles).0.times(vector(graph, at))
        }
        Reference::Free | Reference::Fixed => vector(graph, &system.position),
    }
}

/// The time derivative of three functions of q and t.
fn rate<'g>(graph: &'g Graph, of: [Expr<'g>; 3]) -> Result<[Expr<'g>; 3], NotDifferentiable> {
    let rates = differentiate_along(graph, &of.map(|e| e.id()), |symbol| {
        following(graph, symbol)
    })?;
    Ok(std::array::from_fn(|i| graph.expr(rates[i])))
}

/// The rate of a symbol: q̇ for q, 1 for time, 0 for any other.
fn following(graph: &Graph, symbol: Symbol) -> Expr<'_> {
    match symbol {
        Symbol::Coordinate(i) => graph.symbol(Symbol::Velocity(i)),
        Symbol::Time => graph.constant(1.0),
        _ => graph.constant(0.0),
    }
}

//! What vanishes by the structure of a model: asked of the expressions that its equations are made of, not of its numbers.
//!
//! w = 0, ω × Jω = 0, a field that no element feels by itself: each is the number 0 in the graph, or it is in.

use crate::dynamics::augmented::{AugmentedTree, constants};
use crate::dynamics::force;
use crate::dynamics::kinematics::{Motion, State, children};
use crate::dynamics::layout::Layout;
use crate::dynamics::{Options, derive_with};
use crate::equations::Route;
use crate::expression::live::Live;
use crate::expression::vector::{Sym3, Vec3};
use crate::expression::{Graph, Node, NodeId, Symbol};
use crate::model::{Dimension, ElementId, ForceKind, Model};

/// What was found.
pub struct Structure {
    /// By system and element: whether w is there.
    pub first_moment: Vec<Vec<bool>>,
    /// By system and element: what is there of ω × Jω.
    pub gyroscopic: Vec<Vec<Gyroscopic>>,
    /// By force and system: who feels a field; empty for other forces.
    pub felt: Vec<Vec<Felt>>,
}

/// ω × Jω of an element with what it carries.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Gyroscopic {
    /// ω and Jω are both along y.
    Plane,
    /// J is a multiple of 1.
    Spherical,
    /// It turns about one axis, a principal one.
    FixedAxis,
    /// Two moments are the same: "Ix = Iy".
    Axisymmetric(&'static str),
    /// Neither.
    Triaxial,
}

/// Who feels a field in a system.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Felt {
    /// No element.
    None,
    /// Some elements, one by one.
    Some,
    /// All, so many, as one.
    All(usize),
}

impl Structure {
    /// Of a model.
    pub fn of(model: &Model) -> Self {
        let graph = Graph::new();
        let layout = Layout::of(model);
        let state = State::symbols(&graph, &layout);
        let motion = Motion::of(&graph, model, &layout, &state);
        let mut structure = Structure {
            first_moment: Vec::new(),
            gyroscopic: Vec::new(),
            felt: (0..model.forces.len())
                .map(|force| felt(&graph, model, &motion, force))
                .collect(),
        };
        for (s, system) in model.systems.iter().enumerate() {
            let tree = AugmentedTree::of(&graph, model, s, &motion);
            let elements = &system.elements;
            let carried = match system.has_balls_alone() {
                true => children(elements),
                // what is carried is no point of its carrier
                false => vec![Vec::new(); elements.len()],
            };
            let local = constants(&graph, model.dimension, elements, &carried);
            let moments = tree.bodies.iter().map(|body| !is_zero(&body.first_moment));
            structure.first_moment.push(moments.collect());
            let gyroscopic = tree.bodies.iter().zip(local).enumerate();
            let gyroscopic = gyroscopic.map(|(element, (body, (_, _, inertia)))| {
                let id = ElementId { system: s, element };
                let moment = body.gyroscopic_moment(&graph, motion.element(id).omega);
                match (model.dimension, is_zero(&moment)) {
                    (Dimension::Plane, _) => Gyroscopic::Plane,
                    (Dimension::Space, true) if is_spherical(&inertia) => Gyroscopic::Spherical,
                    (Dimension::Space, true) => Gyroscopic::FixedAxis,
                    (Dimension::Space, false) => symmetry(&inertia),
                }
            });
            structure.gyroscopic.push(gyroscopic.collect());
        }
        structure
    }
}

fn is_zero(v: &Vec3<'_>) -> bool {
    v.0.iter().all(|component| component.is_zero())
}

fn is_spherical(inertia: &Sym3<'_>) -> bool {
    let [x, y, z] = inertia.diagonal.map(|moment| moment.id());
    x == y && y == z && inertia.off.iter().all(|product| product.is_zero())
}

fn symmetry(inertia: &Sym3<'_>) -> Gyroscopic {
    let [x, y, z] = inertia.diagonal.map(|moment| moment.id());
    let aligned = inertia.off.iter().all(|product| product.is_zero());
    match (x == y, x == z, y == z) {
        (true, _, _) if aligned => Gyroscopic::Axisymmetric("Ix = Iy"),
        (_, true, _) if aligned => Gyroscopic::Axisymmetric("Ix = Iz"),
        (_, _, true) if aligned => Gyroscopic::Axisymmetric("Iy = Iz"),
        _ => Gyroscopic::Triaxial,
    }
}

/// A field alone: what it does to elements, and what to the reference joint as one.
fn felt<'g>(graph: &'g Graph, model: &Model, motion: &Motion<'g>, force: usize) -> Vec<Felt> {
    let force = &model.forces[force];
    if !matches!(force.kind, ForceKind::Field(_)) {
        return Vec::new();
    }
    let alone = Model {
        forces: vec![force.clone()],
        ..model.clone()
    };
    let loads = force::loads(graph, &alone, motion, motion, Vec::new());
    let systems = model.systems.iter().enumerate();
    let felt = systems.map(|(s, system)| {
        if !is_zero(&loads.wrenches.fields[s]) {
            Felt::All(system.elements.len())
        } else if loads.wrenches.partial_fields[s].iter().all(is_zero) {
            Felt::None
        } else {
            Felt::Some
        }
    });
    felt.collect()
}

/// By parameter: true where nothing that is computed depends on it.
pub fn idle_parameters(model: &Model) -> Vec<bool> {
    if model.parameters.is_empty() {
        return Vec::new();
    }
    let options = Options {
        matrices: false,
        route: Some(Route::Elimination),
    };
    let equations = derive_with(model, options);
    let mut roots: Vec<NodeId> = equations.accelerations.clone();
    for more in [
        &equations.coordinate_rates,
        &equations.outputs,
        &equations.initial_coordinates,
        &equations.initial_velocities,
    ] {
        roots.extend(more);
    }
    for state in equations.auxiliaries.iter().chain(&equations.memory) {
        roots.extend([state.initial, state.next]);
    }
    let mut idle = vec![true; model.parameters.len()];
    for &id in Live::new(&equations.graph, &roots).nodes() {
        if let Node::Symbol(Symbol::Parameter(index)) = equations.graph.node(id) {
            idle[index as usize] = false;
        }
    }
    idle
}

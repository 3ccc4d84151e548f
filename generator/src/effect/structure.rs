//! Effects that vanish by the structure of a model. This is decided from the expressions of the equations, not from
//! numbers.
//!
//! w = 0, ω × Jω = 0, a field that acts on no single element: the effect is out if its expression is the number 0 in
//! the graph.

use crate::dynamics::augmented_body::{AugmentedTree, constants};
use crate::dynamics::{Options, derive_with};
use crate::equations::Route;
use crate::expression::liveness::Live;
use crate::expression::vector::{Sym3, Vec3};
use crate::expression::{Graph, Node, NodeId, Symbol};
use crate::law::{self, ForceKind};
use crate::model::{Dimension, ElementId, Model};
use crate::motion::kinematics::children;
use crate::motion::{Layout, Motion, State};

/// The structural properties of a model.
pub struct Structure {
    /// For each system and element, whether the first moment w is there.
    pub first_moment: Vec<Vec<bool>>,
    /// For each system and element, the kind of ω × Jω.
    pub gyroscopic: Vec<Vec<Gyroscopic>>,
    /// For each force and system, which elements a field acts on; empty for other forces.
    pub felt: Vec<Vec<Felt>>,
}

/// The gyroscopic moment ω × Jω of an element together with the bodies that it carries.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Gyroscopic {
    /// Zero: ω and Jω are both along y.
    Plane,
    /// Zero: J is a multiple of the identity.
    Spherical,
    /// Zero: the element turns about one axis, which is principal.
    FixedAxis,
    /// Two moments of inertia are equal: "Ix = Iy".
    Axisymmetric(&'static str),
    /// None of these.
    Triaxial,
}

/// The elements of a system that a field acts on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Felt {
    /// No element.
    None,
    /// Some elements, one by one.
    Some,
    /// All elements, so many, together.
    All(usize),
}

impl Structure {
    /// The structural properties of a model.
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
                // the carried body is no point of its carrier
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

/// For a field alone: how it acts on the elements, and how on the reference joint as a whole.
fn felt<'g>(graph: &'g Graph, model: &Model, motion: &Motion<'g>, force: usize) -> Vec<Felt> {
    let force = &model.forces[force];
    if !matches!(ForceKind::of(force), ForceKind::Field(_)) {
        return Vec::new();
    }
    let alone = Model {
        forces: vec![force.clone()],
        ..model.clone()
    };
    let applied = law::applied_forces(graph, &alone, motion, motion, Vec::new());
    let systems = model.systems.iter().enumerate();
    let felt = systems.map(|(s, system)| {
        if !is_zero(&applied.wrenches.fields[s]) {
            Felt::All(system.elements.len())
        } else if applied.wrenches.partial_fields[s].iter().all(is_zero) {
            Felt::None
        } else {
            Felt::Some
        }
    });
    felt.collect()
}

/// For each parameter, true if nothing that is computed depends on it.
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

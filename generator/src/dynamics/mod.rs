//! Derives the equations of motion of a model: S(q) v̇ = r_s(q, v) + r_k(t, q, v)   \[MADYMO 1980, eq. 2\]
//!
//! | here | standard words | file |
//! |---|---|---|
//! | S = Σ Jᵀ M J | mass matrix | `mass_matrix`, `spatial/mass_matrix` |
//! | r_s = −(bias forces) | Coriolis and centrifugal forces with the sign reversed | `bias_forces`, `spatial/inverse_dynamics` |
//! | r_k | generalised applied forces | `applied_forces`, `spatial/inverse_dynamics`; the laws are in `law/` |
//! | H = (s, e) | columns of a joint: motion subspace | `motion/` |
//! | M, b, J | augmented body | `augmented_body` |
//! | K, B, J | articulated inertia | `elimination/`, `spatial/articulated_body`, `link/` |
//! | D = Hᵀ I H | joint-space inertia, I being the articulated one | `Ldl` of `factorization`, called from `elimination/`, `spatial/articulated_body`, `link/` |
//! | what is asked for by name | inverse dynamics, Jacobians, … | `functions/` |
//! | L d Lᵀ | factorisation of S, and of each D; no inverse is formed | `factorization` |
//!
//! All derivations are written once, for space, in vectors of absolute axes; only `link/` uses the frames of links. In
//! the plane the components along y and the rotations about x and z are the number 0, so they leave no node behind. The
//! coordinates of an orientation differ only in the list of [axes] that give an element's angular velocity from its
//! generalised velocities: ω = Σ e_j v_j with
//!
//! | | axes e_j |
//! |---|---|
//! | plane | e_y |
//! | space, quaternion | e_x, e_y, e_z |
//! | space, Bryant | e_x, Rx e_y, Rx Ry e_z |
//!
//! Bryant angles are in one of two [charts](crate::motion::chart), which differ only in the order of the columns of A.
//!
//! Notation: m, g, I are mass, centre of gravity and inertia of an element; s is the place of a joint on its parent; A
//! is the rotation local → absolute; u = A s; w = A b; γ(v) is the velocity-product (bias) acceleration of a vector
//! fixed in an element; D(v) has the columns e_j × v.
//!
//! [axes]: crate::motion::ElementMotion::axes

mod applied_forces;
pub mod augmented_body;
mod bias_forces;
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod charts;
mod conditions;
mod curves_of_time;
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod derivatives;
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod elimination;
mod energy;
mod factorization;
pub mod functions;
pub mod lagrange;
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod link;
mod mass_matrix;
mod matrices;
mod momentum;
mod outputs;
mod sections;
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod spatial;

use crate::equations::{Equations, LawState, Named, Onset, Route};
use crate::expression::count::Count;
use crate::expression::passes::factor;
use crate::expression::{Expr, Graph, NodeId};
use crate::force::{self, AppliedForces};
use crate::law;
use crate::method::Method;
use crate::model::{Model, System};
use crate::motion::{Layout, Motion, State};
use augmented_body::{AugmentedTree, Omitted};
use functions::{Known, Request};
use matrices::{Matrices, with_axes};
use outputs::ModelInMotion;
use spatial::Spatial;

/// Options of the derivation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Whether to derive S, r_s and r_k as well. Their size grows with the number of elements times the depth of the
    /// tree; that of the accelerations grows with the number of elements alone.
    pub matrices: bool,
    /// The route of the accelerations; `None` takes the route with the fewest operations.
    pub route: Option<Route>,
}

impl Default for Options {
    fn default() -> Self {
        Options {
            matrices: true,
            route: None,
        }
    }
}

/// Number of freedoms up to which the factorised mass matrix is tried. Beyond, the articulated-body algorithm
/// always wins.
const LARGEST_FACTORIZED: usize = 12;

/// Derives the equations of a model: S, r_s, r_k, and the accelerations by the cheapest route.
pub fn derive(model: &Model) -> Equations {
    derive_with(model, Options::default())
}

/// Derives the equations of a model.
pub fn derive_with(model: &Model, options: Options) -> Equations {
    derive_without(model, options, None)
}

/// Derives the equations of a model, with the [functions] that are asked for; those that the model cannot have
/// are named in [`Equations::impossible`].
pub fn derive_functions(model: &Model, options: Options, requests: &[Request]) -> Equations {
    derive_in(model, options, requests, None, |graph, layout| {
        State::symbols(graph, layout)
    })
}

/// Derives the equations of a model without an effect of inertia.
pub fn derive_without(model: &Model, options: Options, omitted: Option<Omitted>) -> Equations {
    derive_in(model, options, &[], omitted, |graph, layout| {
        State::symbols(graph, layout)
    })
}

/// Derives the equations of a model for reading: Bryant angles are in chart 0, and charts are no symbols.
pub fn derive_in_first_chart(model: &Model) -> Equations {
    derive_in(model, Options::default(), &[], None, |graph, layout| {
        State::in_first_chart(graph, layout)
    })
}

/// A function that makes the symbols of the equations.
type Symbols = for<'g> fn(&'g Graph, &Layout) -> State<'g>;

fn derive_in(
    model: &Model,
    options: Options,
    requests: &[Request],
    omitted: Option<Omitted>,
    symbols: Symbols,
) -> Equations {
    match options.route {
        Some(route) => by_route(model, options, requests, route, omitted, symbols),
        None if model.systems.iter().all(System::is_coupled) => by_route(
            model,
            options,
            requests,
            Route::MassMatrix,
            omitted,
            symbols,
        ),
        None => {
            let elimination = by_route(
                model,
                options,
                requests,
                Route::Elimination,
                omitted,
                symbols,
            );
            if elimination.velocities.len() > LARGEST_FACTORIZED {
                return elimination;
            }
            let factorized = by_route(
                model,
                options,
                requests,
                Route::MassMatrix,
                omitted,
                symbols,
            );
            // Both routes have the same angles and calls, so only the operations that the factoring pass can reduce are
            // compared.
            let cost = |e: &Equations| factor::cost(&Count::of(&e.graph, &e.accelerations));
            if cost(&factorized) < cost(&elimination) {
                factorized
            } else {
                elimination
            }
        }
    }
}

fn by_route(
    model: &Model,
    options: Options,
    requests: &[Request],
    route: Route,
    omitted: Option<Omitted>,
    symbols: Symbols,
) -> Equations {
    let graph = Graph::new();
    let equations = in_graph(&graph, model, options, requests, route, omitted, symbols);
    Equations { graph, ..equations }
}

/// The equations with an empty graph; their nodes are in `graph`.
// Long: one line for each list of the equations, in the order in which their nodes are made.
fn in_graph(
    graph: &Graph,
    model: &Model,
    options: Options,
    requests: &[Request],
    route: Route,
    omitted: Option<Omitted>,
    symbols: Symbols,
) -> Equations {
    let layout = Layout::of(model);
    let started = layout.start(graph, model);
    graph.section("initial state");
    let start = Motion::at_start(graph, model, &layout, &started);

    let state = symbols(graph, &layout);
    let motion = Motion::of(graph, model, &layout, &state);
    let mut trees: Vec<AugmentedTree<'_>> = (0..model.systems.len())
        .map(|s| AugmentedTree::of(graph, model, s, &motion))
        .collect();
    if let Some(omitted) = omitted {
        omitted.omit(&mut trees);
    }
    let charts = charts::memory(model, &layout, &started, &state);
    let mut applied = law::applied_forces(graph, model, &motion, &start, charts);

    let zero = graph.constant(0.0).id();
    let of_system = |(system, tree)| Spatial {
        graph,
        model,
        layout: &layout,
        system,
        motion: &motion,
        tree,
    };
    let systems: Vec<Spatial<'_, '_>> = trees.iter().enumerate().map(of_system).collect();
    let matrices = match options.matrices || route == Route::MassMatrix {
        true => Matrices::of(graph, &layout, &systems, &applied, options.matrices),
        false => Matrices::default(),
    };
    let pivots = pivots(graph, model, &layout, &systems, &matrices.mass);
    let accelerations = accelerations(graph, &layout, route, &systems, &applied, &matrices);
    let rates = layout.coordinate_rates(graph, model, &state);
    let scene = ModelInMotion {
        graph,
        model,
        layout: &layout,
        motion: &motion,
        start: &start,
        applied: &applied,
        accelerations: &accelerations,
    };
    let outputs = outputs::outputs(&scene);
    let sections = sections::of(&scene);
    let derived = options.matrices.then_some(&matrices);
    let known = Known::new(&scene, &state, &systems, derived);
    let (functions, impossible) = known.functions(requests);
    let triggers = scene.triggers();
    force::switch::complete(graph, model, &mut applied, &triggers);
    let kinks = applied.kinks(graph);
    let onsets = applied.onsets(graph);
    let curves = applied.curves(graph);
    let conditions = conditions::of(graph, model, &start);
    let renewed = charts::renewed(graph, model, &layout, &motion, &state);
    for (memory, chart) in applied.states.memory.iter_mut().zip(&renewed.charts) {
        memory.next = *chart;
    }

    let mut needed = [&accelerations[..], &outputs, &matrices.applied_forces].concat();
    needed.extend(applied.states.auxiliaries.iter().map(|state| state.next));
    let mut needed = ids(&needed);
    let powers = sections.iter().filter(|of| of.method == Method::Powers);
    needed.extend(powers.flat_map(|of| &of.values).map(|of| of.value));
    Equations {
        initial_coordinates: ids(&started.q),
        initial_velocities: ids(&started.v),
        coordinate_rates: ids(&rates),
        mass_matrix: (matrices.mass.iter())
            .map(|row| row.iter().map(|e| e.map_or(zero, |e| e.id())).collect())
            .collect(),
        velocity_forces: ids(&matrices.velocity_forces),
        applied_forces: ids(&matrices.applied_forces),
        accelerations: ids(&accelerations),
        route,
        auxiliaries: states(&applied.states.auxiliaries),
        memory: states(&applied.states.memory),
        charts: layout.charts(),
        renewed_coordinates: ids(&renewed.q),
        renewed_velocities: ids(&renewed.v),
        event_functions: named(&applied.events.event_functions),
        kinks: named(&kinks),
        corners: onsets[1].len(),
        onsets: (onsets.iter().flatten())
            .map(|(name, onset)| Onset {
                name: name.clone(),
                gap: onset.gap.id(),
                speed: onset.speed.id(),
            })
            .collect(),
        curves,
        conditions,
        pivots: named(&pivots),
        sections,
        functions,
        impossible,
        outputs: ids(&outputs),
        curves_of_time: curves_of_time::of(graph, &needed),
        quaternions: layout.quaternions(),
        coordinates: layout.coordinates.clone(),
        velocities: layout.velocities.clone(),
        graph: Graph::new(),
    }
}

/// The pivots of S, each with the path of its element; empty if no pivot can vanish or if S is too large. Derives S
/// first if `matrix` is empty.
fn pivots<'g>(
    graph: &'g Graph,
    model: &Model,
    layout: &Layout,
    systems: &[Spatial<'g, '_>],
    matrix: &[Vec<Option<Expr<'g>>>],
) -> Vec<(String, Expr<'g>)> {
    let size = layout.velocities.len();
    if !factorization::may_vanish(model) || size > factorization::MOST_PIVOTS {
        return Vec::new();
    }
    match matrix.is_empty() {
        true => {
            let matrix = mass_matrix::mass_matrix(systems, size);
            factorization::pivots(graph, model, layout, &matrix)
        }
        false => factorization::pivots(graph, model, layout, matrix),
    }
}

/// v̇ by the given route.
fn accelerations<'g>(
    graph: &'g Graph,
    layout: &Layout,
    route: Route,
    systems: &[Spatial<'g, '_>],
    applied: &AppliedForces<'g>,
    matrices: &Matrices<'g>,
) -> Vec<Expr<'g>> {
    let (none, size) = (graph.constant(0.0), layout.velocities.len());
    if route == Route::Elimination {
        return elimination::accelerations(systems, applied, none, size);
    }
    let mut accelerations = factorization::accelerations(
        graph,
        layout,
        &matrices.mass,
        &matrices.velocity_forces,
        &matrices.applied_forces,
    );
    for spatial in with_axes(systems) {
        link::cheaper_accelerations(spatial, applied, &mut accelerations);
    }
    accelerations
}

fn ids(values: &[Expr<'_>]) -> Vec<NodeId> {
    values.iter().map(|e| e.id()).collect()
}

fn states(states: &[force::LawState<'_>]) -> Vec<LawState> {
    let state = |state: &force::LawState<'_>| LawState {
        name: state.name.clone(),
        unit: state.unit,
        initial: state.initial.id(),
        next: state.next.id(),
    };
    states.iter().map(state).collect()
}

fn named(values: &[(String, Expr<'_>)]) -> Vec<Named> {
    let name = |(name, value): &(String, Expr<'_>)| Named {
        name: name.clone(),
        value: value.id(),
    };
    values.iter().map(name).collect()
}

//! The functions of a mechanism that are asked for by name: inverse dynamics, poses, Jacobians, the centroidal
//! momentum. A model that is not asked for any has no trace of them.
//!
//! | file | |
//! |---|---|
//! | here | the table of all functions |
//! | `request` | what is asked for: a name with its argument |
//! | `forces` | inverse dynamics, S and the forces |
//! | `regressor` | how inverse dynamics depends on masses and inertias |
//! | `frame` | pose, velocity and Jacobian of a frame |
//! | `totals` | centre of mass, centroidal momentum, energies |
//! | `contacts` | where surfaces touch |
//! | `derivatives` | derivatives of inverse dynamics and of accelerations, linearisation |
//!
//! With v̇ = a, a mechanism needs the forces S a − r_s. Of r_k, `gravity_forces` r_g are those of all fields, and of
//! the given acceleration of what carries a system. So the joints and laws have to provide τ = S a − r_s − r_g, and in
//! the motion of the scene τ = r_k − r_g.
//!
//! Vectors are in absolute axes. Of a motion or a wrench the linear part comes first; the velocity of a frame is that
//! of its origin. Matrices are by rows.

mod contacts;
mod derivatives;
mod forces;
mod frame;
mod regressor;
mod request;
mod totals;

pub use request::{Frame, Request, request, requests};

use super::derivatives::NotDifferentiable;
use super::matrices::Matrices;
use super::outputs::ModelInMotion;
use super::spatial::Spatial;
use crate::equations;
use crate::expression::{Expr, Symbol};
use crate::method::argument::Argument;
use crate::motion::State;
use std::cell::OnceCell;

/// A function that gives names of rows or columns.
type Names = fn(&Known<'_, '_>) -> Vec<String>;

/// How the values of a function are derived, by rows.
enum Derive {
    /// Of the whole scene.
    Always(for<'g> fn(&Known<'g, '_>) -> Vec<Expr<'g>>),
    /// Of the whole scene, unless one of its laws cannot be differentiated in symbols.
    IfSmooth(for<'g> fn(&Known<'g, '_>) -> Result<Vec<Expr<'g>>, NotDifferentiable>),
    /// Of a frame, which is the argument of the function.
    PerFrame(for<'g> fn(&Known<'g, '_>, &Frame) -> Vec<Expr<'g>>),
}

use Derive::{Always, IfSmooth, PerFrame};

/// A row of the table.
pub struct Function {
    /// Its name in all targets.
    pub name: &'static str,
    /// What it computes.
    pub sentence: &'static str,
    /// The arguments that it has in any model; t, z and m come in where values depend on them.
    arguments: &'static [Argument],
    /// The names of the rows; a single one may have none.
    rows: Names,
    /// The names of the columns; a single one has none.
    columns: Names,
    derive: Derive,
}

impl Function {
    /// True if a model may not have it, because one of its laws cannot be differentiated in symbols.
    pub fn may_be_impossible(&self) -> bool {
        matches!(self.derive, IfSmooth(_))
    }

    /// True if its argument is a frame.
    pub fn is_of_frame(&self) -> bool {
        matches!(self.derive, PerFrame(_))
    }
}

const OF_PLACE: &[Argument] = &[Argument::Coordinates];
const OF_MOTION: &[Argument] = &[Argument::Coordinates, Argument::Velocities];
const OF_ACCELERATIONS: &[Argument] = &[
    Argument::Coordinates,
    Argument::Velocities,
    Argument::Accelerations,
];

/// All functions.
pub const FUNCTIONS: &[Function] = &[
    Function {
        name: "inverse_dynamics",
        sentence: "The generalised forces beside those of fields that the accelerations a need: S a - r_s - r_g.",
        arguments: OF_ACCELERATIONS,
        rows: velocities,
        columns: one,
        derive: Always(forces::inverse_dynamics),
    },
    Function {
        name: "inverse_dynamics_derivatives",
        sentence: "The derivatives of inverse dynamics along the motion of each velocity, and beside them those by each velocity.",
        arguments: OF_ACCELERATIONS,
        rows: velocities,
        columns: derivatives::motions_and_velocities,
        derive: IfSmooth(derivatives::of_inverse_dynamics),
    },
    Function {
        name: "acceleration_derivatives",
        sentence: "The accelerations, and beside them their derivatives along the motion of each velocity, by each velocity and by each generalised force (the inverse of S), with the forces of all laws but fields constant.",
        arguments: OF_MOTION,
        rows: velocities,
        columns: derivatives::value_and_derivatives,
        derive: IfSmooth(derivatives::of_accelerations),
    },
    Function {
        name: "linearisation",
        sentence: "A and B, and below them C and D, of the whole scene with its forces: the rates of positions, velocities and states of laws, and the outputs, by these and by the inputs.",
        arguments: OF_MOTION,
        rows: derivatives::rates_and_outputs,
        columns: derivatives::state_and_inputs,
        derive: IfSmooth(derivatives::of_scene),
    },
    Function {
        name: "mass_matrix",
        sentence: "S, the mass matrix.",
        arguments: OF_PLACE,
        rows: velocities,
        columns: velocities,
        derive: Always(forces::mass_matrix),
    },
    Function {
        name: "bias",
        sentence: "The bias forces -r_s: what the accelerations 0 need without any field.",
        arguments: OF_MOTION,
        rows: velocities,
        columns: one,
        derive: Always(forces::bias),
    },
    Function {
        name: "gravity_forces",
        sentence: "r_g, the generalised forces of all fields, and of the given acceleration of what carries the systems.",
        arguments: OF_PLACE,
        rows: velocities,
        columns: one,
        derive: Always(forces::gravity_forces),
    },
    Function {
        name: "applied_forces",
        sentence: "r_k, the generalised forces of all fields and laws.",
        arguments: OF_MOTION,
        rows: velocities,
        columns: one,
        derive: Always(forces::applied_forces),
    },
    Function {
        name: "regressor",
        sentence: "The matrix Y that gives inverse dynamics, but for armatures, from the inertia of the elements: Y p.",
        arguments: OF_ACCELERATIONS,
        rows: velocities,
        columns: inertial_parameters,
        derive: Always(regressor::regressor),
    },
    Function {
        name: "pose",
        sentence: "The rotation from the axes of the frame to absolute axes, and beside it its origin.",
        arguments: OF_PLACE,
        rows: axes,
        columns: rotation_and_origin,
        derive: PerFrame(frame::pose),
    },
    Function {
        name: "velocity",
        sentence: "The velocity of the frame's origin, and its angular velocity.",
        arguments: OF_MOTION,
        rows: motion,
        columns: one,
        derive: PerFrame(frame::velocity),
    },
    Function {
        name: "acceleration",
        sentence: "The acceleration of the frame's origin, and its angular acceleration, for the accelerations a.",
        arguments: OF_ACCELERATIONS,
        rows: motion,
        columns: one,
        derive: PerFrame(frame::acceleration),
    },
    Function {
        name: "jacobian",
        sentence: "The matrix J that gives the velocity of the frame's origin and its angular velocity: J v.",
        arguments: OF_PLACE,
        rows: motion,
        columns: velocities,
        derive: PerFrame(frame::jacobian),
    },
    Function {
        name: "bias_acceleration",
        sentence: "The rate of the frame's Jacobian times v: its acceleration and angular acceleration where a is 0.",
        arguments: OF_MOTION,
        rows: motion,
        columns: one,
        derive: PerFrame(frame::bias_acceleration),
    },
    Function {
        name: "center_of_mass",
        sentence: "The centre of mass of all systems.",
        arguments: OF_PLACE,
        rows: axes,
        columns: one,
        derive: Always(totals::center_of_mass),
    },
    Function {
        name: "centroidal_momentum",
        sentence: "The linear momentum of all systems, and their angular momentum about the centre of mass.",
        arguments: OF_MOTION,
        rows: motion,
        columns: one,
        derive: Always(totals::centroidal_momentum),
    },
    Function {
        name: "centroidal_matrix",
        sentence: "The matrix A that gives the centroidal momentum: A v.",
        arguments: OF_PLACE,
        rows: motion,
        columns: velocities,
        derive: Always(totals::centroidal_matrix),
    },
    Function {
        name: "contacts",
        sentence: "For each two surfaces that may touch: their gap, the point where the force acts, the normal, and the force on the first body.",
        arguments: OF_MOTION,
        rows: contacts::names,
        columns: contacts::columns,
        derive: Always(contacts::contacts),
    },
    Function {
        name: "kinetic_energy",
        sentence: "The kinetic energy of all elements.",
        arguments: OF_MOTION,
        rows: one,
        columns: one,
        derive: Always(totals::kinetic_energy),
    },
    Function {
        name: "potential_energy",
        sentence: "The potential energy in all fields, which is 0 for a mass at the origin.",
        arguments: OF_PLACE,
        rows: one,
        columns: one,
        derive: Always(totals::potential_energy),
    },
];

fn one(_: &Known<'_, '_>) -> Vec<String> {
    vec![String::new()]
}

fn velocities(known: &Known<'_, '_>) -> Vec<String> {
    let layout = known.scene.layout;
    layout.velocities.iter().map(|v| v.name.clone()).collect()
}

/// For each element m, h and J about its origin, in its axes.
fn inertial_parameters(known: &Known<'_, '_>) -> Vec<String> {
    let kinds = [
        "m", "hx", "hy", "hz", "jxx", "jxy", "jyy", "jxz", "jyz", "jzz",
    ];
    let systems = known.scene.model.systems.iter();
    let elements = systems.flat_map(|system| {
        let elements = system.elements.iter();
        elements.map(move |element| format!("{}/{}", system.name, element.name))
    });
    elements
        .flat_map(|path| kinds.map(|kind| format!("{path}.{kind}")))
        .collect()
}

fn axes(_: &Known<'_, '_>) -> Vec<String> {
    ["x", "y", "z"].map(String::from).into()
}

fn motion(_: &Known<'_, '_>) -> Vec<String> {
    let names = ["x", "y", "z", "about_x", "about_y", "about_z"];
    names.map(String::from).into()
}

fn rotation_and_origin(_: &Known<'_, '_>) -> Vec<String> {
    ["x_axis", "y_axis", "z_axis", "origin"]
        .map(String::from)
        .into()
}

/// What functions are derived from.
pub(super) struct Known<'g, 'a> {
    scene: &'a ModelInMotion<'g, 'a>,
    state: &'a State<'g>,
    systems: &'a [Spatial<'g, 'a>],
    /// S, r_s and r_k if they are derived already.
    derived: Option<&'a Matrices<'g>>,
    own: OnceCell<Matrices<'g>>,
    /// The given accelerations a.
    given: Vec<Expr<'g>>,
}

impl<'g, 'a> Known<'g, 'a> {
    pub fn new(
        scene: &'a ModelInMotion<'g, 'a>,
        state: &'a State<'g>,
        systems: &'a [Spatial<'g, 'a>],
        derived: Option<&'a Matrices<'g>>,
    ) -> Self {
        let symbol = |i: usize| scene.graph.symbol(Symbol::Acceleration(i as u32));
        Known {
            scene,
            state,
            systems,
            derived,
            own: OnceCell::new(),
            given: (0..scene.layout.velocities.len()).map(symbol).collect(),
        }
    }

    /// The functions that are asked for, and those of them that this model cannot have.
    pub fn functions(
        &self,
        requests: &[Request],
    ) -> (Vec<equations::Function>, Vec<equations::Impossible>) {
        let (mut functions, mut impossible) = (Vec::new(), Vec::new());
        for request in requests {
            let (function, name) = (request.function(), request.name().to_owned());
            self.scene.graph.section(name.clone());
            let values = match (&function.derive, request.frame()) {
                (Always(derive), _) => Ok(derive(self)),
                (IfSmooth(derive), _) => derive(self),
                (PerFrame(derive), Some(frame)) => Ok(derive(self, frame)),
                (PerFrame(_), None) => unreachable!("a request has the argument of its function"),
            };
            match values {
                Ok(values) => functions.push(equations::Function {
                    name,
                    sentence: function.sentence,
                    arguments: function.arguments,
                    rows: (function.rows)(self),
                    columns: (function.columns)(self),
                    values: values.iter().map(|value| value.id()).collect(),
                }),
                Err(NotDifferentiable { what, .. }) => impossible.push(equations::Impossible {
                    function: name,
                    what,
                }),
            }
        }
        (functions, impossible)
    }

    fn size(&self) -> usize {
        self.given.len()
    }

    /// S, r_s and r_k.
    fn matrices(&self) -> &Matrices<'g> {
        let ModelInMotion {
            graph,
            layout,
            applied,
            ..
        } = *self.scene;
        let own = || Matrices::of(graph, layout, self.systems, applied, true);
        self.derived.unwrap_or_else(|| self.own.get_or_init(own))
    }
}

//! All methods of a model as lists, from the same requests as the text.

use super::order::Order;
use super::schedule::Schedule;
use super::{Options, breakpoints, lower, plan};
use crate::equations::Equations;
use crate::expression::count::Table;
use crate::method::inputs::{Argument, Inputs};
use crate::model::{ForceKind, Interpolate, Model};
use crate::program::{Curve, Facts, List, Lists, Method, Routine, Start};
use crate::target::rust::items;
use crate::target::rust::method::Request;

/// The methods of a model as lists. They depend on nothing but the arguments and the version of this crate.
pub fn lists(model: &Model, equations: &Equations, options: &Options) -> Lists {
    counted_lists(model, equations, options, None).0
}

/// The operations of methods, by their name.
pub type Costs = Vec<(&'static str, Table)>;

/// The same of some methods of the text alone, the others without results; all where nothing is said. Beside them stands what each method of
/// the text costs, as [`costs`](super::costs) has it.
pub fn counted_lists(
    model: &Model,
    equations: &Equations,
    options: &Options,
    only: Option<&[&str]>,
) -> (Lists, Costs) {
    let mut inputs = Inputs::new(model, equations);
    let derived = plan::derived(model, equations, options, only, &mut inputs);
    let requests = plan::requests(model, equations, options, derived, &inputs, only);
    let costs = requests
        .iter()
        .map(|request| (request.name, Table::of(&request.graph, &request.roots)))
        .collect();
    let mut made = Made::default();
    let motion = plan::motion(&requests);
    for request in requests {
        if request.name != plan::ACCELERATIONS {
            made.add(request, &inputs);
        }
    }
    if let Some(motion) = motion {
        made.add(motion, &inputs);
    }
    let routines = Method::ALL.map(|method| made.routine(method));
    let lists = Lists {
        facts: Facts::of(model, equations),
        routines: routines.into(),
        curves: curves(model),
        users: users(model),
        rules: equations.conditions.iter().map(|c| c.rule).collect(),
        stretched: breakpoints::adjustable(equations)
            .map(|(curve, _)| curve as u32)
            .collect(),
        quaternions: items::neighbours(&equations.quaternions),
        renewed: renewed(equations),
        derived: inputs.derived.len(),
    };
    (lists, costs)
}

/// Lists by the names of the methods of the text.
#[derive(Default)]
struct Made(Vec<(&'static str, Routine)>);

impl Made {
    fn add(&mut self, request: Request<'_>, inputs: &Inputs) {
        let name = request.name;
        self.0.push((name, request.list(inputs)));
    }

    fn take(&mut self, name: &str) -> Option<Routine> {
        let found = self.0.iter_mut().find(|(of, _)| *of == name);
        found.map(|(_, routine)| std::mem::take(routine))
    }

    /// A method of the lists, made of one or several of the text.
    fn routine(&mut self, method: Method) -> Routine {
        let names: &[&str] = match method {
            Method::Derived => &["new"],
            Method::InitialState => &[
                "initial_conditions",
                "initial_auxiliaries",
                "initial_memory",
            ],
            Method::Derivative => &[plan::MOTION, "auxiliary_rates"],
            Method::CoordinateRates => &["coordinate_rates"],
            Method::Renewed => &["renewed", "renewed_memory"],
            Method::Guards => &["guards"],
            Method::Kinks => &["kinks"],
            Method::Onsets => &["onsets"],
            Method::Curves => &["curves"],
            Method::Pivots => &["pivots"],
            Method::Conditions => &["conditions"],
            Method::KinkRates => &["kink_rates"],
            Method::KineticEnergy => &["kinetic_energy"],
            Method::Powers => &["powers"],
            Method::Momentum => &["momentum"],
            Method::ExternalWrench => &["external_wrench"],
            Method::Outputs => &["outputs"],
            Method::MassMatrix => &["mass_matrix"],
            Method::VelocityForces => &["velocity_forces"],
            Method::AppliedForces => &["applied_forces"],
        };
        let mut found: Vec<Routine> = names.iter().filter_map(|name| self.take(name)).collect();
        match found.len() {
            1 => found.remove(0),
            _ => Routine {
                start: found.first().map_or(Start::State, |first| first.start),
                list: List::joined(found.iter().map(|routine| &routine.list)),
            },
        }
    }
}

impl Request<'_> {
    /// The method as a list.
    fn list(self, inputs: &Inputs) -> Routine {
        let order = match self.results.one_by_one() {
            true => Order::Need,
            false => Order::Section,
        };
        let starts_from = |argument| self.arguments.contains(&argument);
        let start = match (
            starts_from(Argument::Accelerations),
            starts_from(Argument::Guards),
        ) {
            (true, _) => Start::Accelerations,
            (_, true) => Start::Guards,
            _ => Start::State,
        };
        let schedule = Schedule::without_names(self.graph, self.roots, &self.labels, inputs, order);
        Routine {
            list: lower::list(&schedule, inputs),
            start,
        }
    }
}

fn curves(model: &Model) -> Vec<Curve> {
    let curves = model.curves.iter().map(|curve| {
        let points = 0..curve.points.len();
        let cubic = curve.interpolate == Interpolate::Cubic;
        Curve {
            name: curve.name.clone(),
            points: curve.points.clone(),
            tangents: cubic.then(|| points.map(|k| curve.tangent(k)).collect()),
            extrapolate: curve.extrapolate,
        }
    });
    curves.collect()
}

fn users(model: &Model) -> Vec<Option<String>> {
    let users = model.forces.iter().map(|force| match &force.kind {
        ForceKind::User(user) => Some(user.function.name.clone()),
        _ => None,
    });
    users.collect()
}

/// The entries of the state that are renewed when a step is accepted.
fn renewed(equations: &Equations) -> Vec<u32> {
    let [q, v, z, m] = [
        equations.coordinates.len(),
        equations.velocities.len(),
        equations.auxiliaries.len(),
        equations.memory.len(),
    ];
    let changed = match (m, equations.charts) {
        (0, _) | (_, 0) => 0,
        _ => q + v,
    };
    let memory = q + v + z..q + v + z + m;
    (0..changed).chain(memory).map(|i| i as u32).collect()
}

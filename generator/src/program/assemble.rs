//! All methods of a model as lists, made from the same schedules as the Rust text.

use super::lower;
use super::order::Order;
use super::plan::{Plan, Procedure};
use super::schedule::Schedule;
use super::{Costs, Curve, Facts, Function, List, Lists, Method, Options, Routine, Start};
use crate::equations::Equations;
use crate::law::ForceKind;
use crate::method::inputs::{Argument, Inputs};
use crate::model::Model;
use std::ops::Range;

/// The methods of a model as lists. The result depends only on the arguments and on the version of this crate.
pub fn lists(model: &Model, equations: &Equations, options: &Options) -> Lists {
    counted_lists(model, equations, options, None).0
}

/// The same for the methods named in `only` (`None`: all); the other methods get lists without results. Also returns
/// the operations of each method, as [`costs`](super::costs) does.
pub fn counted_lists(
    model: &Model,
    equations: &Equations,
    options: &Options,
    only: Option<&[&str]>,
) -> (Lists, Costs) {
    let plan = Plan::new(model, equations, options, only);
    let (costs, motion) = (plan.costs(), plan.motion());
    let Plan { inputs, procedures } = plan;
    let mut parts = Method::ALL.map(|_| Vec::new());
    let mut functions = Vec::new();
    for procedure in motion.into_iter().chain(procedures) {
        if let Some(index) = procedure.method.function {
            let function = &equations.functions[index];
            functions.push(Function {
                name: function.name.clone(),
                identifier: procedure.method.name.clone().into_owned(),
                sentence: function.sentence.into(),
                rows: function.rows.clone(),
                columns: function.columns.clone(),
                accelerations: function.arguments.contains(&Argument::Accelerations),
                list: routine(procedure, &inputs).list,
            });
        } else if let Some(method) = procedure.method.part_of {
            parts[method as usize].push(routine(procedure, &inputs));
        }
    }
    let lists = Lists {
        facts: Facts::of(model, equations),
        routines: parts.map(together).into(),
        functions,
        curves: model.curves.iter().map(Curve::from).collect(),
        users: users(model),
        rules: equations.conditions.iter().map(|c| c.rule).collect(),
        stretched: equations
            .stretched_curves_of_time()
            .map(|(curve, _)| curve as u32)
            .collect(),
        quaternions: neighbours(&equations.quaternions),
        renewed: renewed(equations),
        derived: inputs.derived.len(),
    };
    (lists, costs)
}

/// A method as a list.
fn routine(procedure: Procedure, inputs: &Inputs) -> Routine {
    let Procedure {
        method,
        graph,
        roots,
    } = procedure;
    let order = Order::of(method.results);
    let schedule = Schedule::new(graph, roots, &method.labels, inputs, order, false);
    Routine {
        list: lower::list(&schedule, inputs),
        start: method.start,
    }
}

/// The parts of a method as one routine.
fn together(mut parts: Vec<Routine>) -> Routine {
    match parts.len() {
        1 => parts.remove(0),
        _ => Routine {
            start: parts.first().map_or(Start::State, |first| first.start),
            list: List::joined(parts.iter().map(|routine| &routine.list)),
        },
    }
}

fn users(model: &Model) -> Vec<Option<String>> {
    let users = model.forces.iter().map(|force| match ForceKind::of(force) {
        ForceKind::User(user) => Some(user.function.name.clone()),
        _ => None,
    });
    users.collect()
}

/// Indices of the state's entries that are renewed after an accepted step.
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

/// Ranges of quaternions, with adjacent quaternions joined to one range, so that each range is normalised in one loop.
pub(crate) fn neighbours(quaternions: &[Range<usize>]) -> Vec<Range<usize>> {
    let mut ranges: Vec<Range<usize>> = Vec::new();
    for quaternion in quaternions {
        match ranges.last_mut() {
            Some(range) if range.end == quaternion.start => range.end = quaternion.end,
            _ => ranges.push(quaternion.clone()),
        }
    }
    ranges
}

//! Names of the values that a method computes and reads.

use crate::expression::{Node, NodeId, Symbol};
use crate::method::inputs::{Argument, Inputs};
use crate::names::{Names, snake};
use crate::program::schedule::{Schedule, index, labels_of, uses};
use rustc_hash::FxHashMap;

/// The identifier of each bound value and of each input in use, by index of the node.
pub(crate) struct Naming(Vec<Option<String>>);

impl Naming {
    /// Names the values that the lines bind, and the inputs. `labels` has a name for each root, which is used if the
    /// root has no name of its own.
    pub(crate) fn new(
        schedule: &Schedule,
        labels: &[String],
        inputs: &Inputs,
        arguments: &[Argument],
    ) -> Self {
        let labels = labels_of(&schedule.graph, &schedule.roots, labels);
        let mut reserved = vec!["q", "v", "a", "s", "num", "parameters", "writer"];
        // reserved only in models that have these arguments, so that a coordinate z keeps its name elsewhere
        for (argument, name) in [(Argument::Auxiliaries, "z"), (Argument::Memory, "m")] {
            if inputs.length(argument) > 0 {
                reserved.push(name);
            }
        }
        let mut names = Names::with(&reserved);
        let mut naming = Self(vec![None; schedule.graph.len()]);
        naming.name_inputs(schedule, inputs, arguments, &mut names);
        let mut temporaries = 0;
        for line in &schedule.lines {
            for bound in schedule.bound_values(line.statement) {
                let wanted = naming.wanted_name(schedule, bound);
                let wanted = wanted.or_else(|| labels.get(&bound).map(|label| snake(label)));
                let wanted = wanted.unwrap_or_else(|| {
                    temporaries += 1;
                    format!("t{temporaries}")
                });
                naming.0[index(bound)] = Some(names.take(&wanted));
            }
        }
        naming
    }

    /// The identifier of a bound value or an input; `None` for a value that is written out where it is used.
    pub(crate) fn of(&self, id: NodeId) -> Option<&str> {
        self.0[index(id)].as_deref()
    }

    /// Names the inputs. All elements of all arguments take their names, in use or not, so that an element has the same
    /// name in every function.
    fn name_inputs(
        &mut self,
        schedule: &Schedule,
        inputs: &Inputs,
        arguments: &[Argument],
        names: &mut Names,
    ) {
        let uses = uses(&schedule.graph, &schedule.roots);
        let mut used: FxHashMap<Symbol, NodeId> = FxHashMap::default();
        for (position, node) in schedule.graph.nodes().iter().enumerate() {
            if let Node::Symbol(symbol) = node
                && uses[position] > 0
            {
                used.entry(*symbol).or_insert(NodeId(position as u32));
            }
        }
        for (input, wanted) in inputs.variables() {
            if input
                .argument()
                .is_some_and(|argument| arguments.contains(&argument))
            {
                let name = names.take(&wanted);
                if let Some(&id) = used.get(&inputs.symbol(input)) {
                    self.0[index(id)] = Some(name);
                }
            }
        }
    }

    fn wanted_name(&self, schedule: &Schedule, id: NodeId) -> Option<String> {
        if let Some(name) = schedule.graph.name_of(id) {
            return Some(snake(&name));
        }
        let (function, argument) = match schedule.graph.node(id) {
            Node::Sin(argument) => ("sin", argument),
            Node::Cos(argument) => ("cos", argument),
            _ => return None,
        };
        let argument = self.of(argument)?;
        Some(format!("{function}_{argument}"))
    }
}

//! The charts of all elements with Bryant angles as discrete states: their memory, and how an accepted step renews
//! them.

use crate::expression::Graph;
use crate::force::LawState;
use crate::model::{ElementId, Model};
use crate::motion::ball::Orientation;
use crate::motion::chart::{Charted, changed};
use crate::motion::numbers::bryant;
use crate::motion::{Layout, Motion, State};

/// q, v and the charts after the discrete update that follows an accepted step.
pub fn renewed<'g>(
    graph: &'g Graph,
    model: &Model,
    layout: &Layout,
    motion: &Motion<'g>,
    state: &State<'g>,
) -> State<'g> {
    let mut renewed = State {
        q: state.q.clone(),
        v: state.v.clone(),
        charts: state.charts.clone(),
    };
    if layout.orientation != Orientation::Bryant {
        return renewed;
    }
    for (s, system) in model.systems.iter().enumerate() {
        for (element, name) in system.elements.iter().map(|e| &e.name).enumerate() {
            let id = ElementId { system: s, element };
            graph.section(format!("element {name}: chart"));
            let (q, v) = (
                layout.element_coordinates(id).start,
                layout.element_velocities(id).start,
            );
            let Some(chart) = layout.element_chart(id) else {
                continue;
            };
            let charted = Charted {
                angles: std::array::from_fn(|i| state.q[q + i]),
                rates: std::array::from_fn(|i| state.v[v + i]),
                chart: state.charts[chart],
            };
            let (r, _) = bryant(graph, charted.angles);
            let charted = changed(&charted, &r, motion.element(id).omega);
            renewed.q[q..q + 3].copy_from_slice(&charted.angles);
            renewed.v[v..v + 3].copy_from_slice(&charted.rates);
            renewed.charts[chart] = charted.chart;
        }
    }
    renewed
}

/// The charts as discrete states, for all elements in order. [`renewed`] gives their new values, once everything else
/// is derived.
pub fn memory<'g>(
    model: &Model,
    layout: &Layout,
    start: &State<'g>,
    state: &State<'g>,
) -> Vec<LawState<'g>> {
    let of = |s: usize, element: usize| {
        let id = ElementId { system: s, element };
        let (system, index) = (&model.systems[s], layout.element_chart(id)?);
        Some(LawState {
            name: format!("{}/{}: chart", system.name, system.elements[element].name),
            unit: "",
            initial: start.charts[index],
            next: state.charts[index],
        })
    };
    let elements = |s: usize| (0..model.systems[s].elements.len()).map(move |e| (s, e));
    (0..model.systems.len())
        .flat_map(elements)
        .filter_map(|(s, e)| of(s, e))
        .collect()
}

//! Notes about rings of belts in which the resistance to slip, and not friction, determines the tensions.
//!
//! The tension on the tight side of a ring is E T₋ + c s', with E = e^(μθ) due to friction, and the resistance c times
//! the rate of slip s'. The default of c is made for webbing with some kilonewtons. On a light rope it may take more of
//! the tension than friction.

use crate::equations;
use crate::simulation::Recording;
use bryant_generator::law::ForceKind;
use bryant_generator::law::types::{BeltOutput, BeltQuantity};
use bryant_generator::model::{Model, Number, Output, Quantity};
use bryant_runtime::program::Job;

/// The resistance of a ring for which the model gives none \[N s/m\].
const DEFAULT: f64 = 50.0;
/// Shares of the tension on the tight side: a note is written if the resistance takes more than the first, and proposes
/// one that takes the second.
const SHARE: f64 = 0.1;
const PROPOSED: f64 = 0.001;

/// A note for each ring whose default resistance takes a large share of the tension at the end of the run.
pub fn notes(model: &Model, job: &Job, recording: &Recording) -> Vec<String> {
    let mut rings = Vec::new();
    let mut asked = model.clone();
    asked.outputs.clear();
    for (force, one) in model.forces.iter().enumerate() {
        let ForceKind::Belt(belt) = ForceKind::of(one) else {
            continue;
        };
        for (part, ring) in belt.rings.iter().enumerate() {
            if ring.resistance != Number::Constant(DEFAULT) {
                continue;
            }
            rings.push((&one.name, &ring.name));
            for part in [part, part + 1] {
                asked.outputs.push(Output {
                    name: asked.outputs.len().to_string(),
                    quantity: Quantity::OfForce {
                        force,
                        what: Box::new(BeltOutput {
                            part,
                            what: BeltQuantity::Force,
                        }),
                    },
                    unit: "N".to_owned(),
                    code: None,
                    channel: None,
                    filter: None,
                });
            }
        }
    }
    let (t, state) = (recording.last_time(), &recording.last_state);
    if rings.is_empty() || state.is_empty() {
        return Vec::new();
    }
    let Ok(engine) = equations::of(&asked) else {
        return Vec::new();
    };
    let info = engine.info();
    let mut evaluated = engine.in_double();
    evaluated.set_parameters(&recording.parameters(job));
    let (mut tensions, mut rates) = (vec![0.0; info.outputs.len()], vec![0.0; state.len()]);
    evaluated.outputs(t, state, &mut tensions);
    evaluated.derivative(t, state, &mut rates);
    let told = rings.into_iter().zip(tensions.chunks(2));
    told.filter_map(|((belt, ring), sides)| {
        let slip = format!("belt {belt}: slip through {ring}");
        let index = (0..state.len()).find(|i| info.state_name(*i) == Some(slip.as_str()))?;
        let resistance = DEFAULT * rates[index].abs();
        let tight = sides.iter().copied().fold(0.0, f64::max);
        (resistance > SHARE * tight).then(|| {
            // one digit suffices
            let proposed = DEFAULT * PROPOSED * tight / resistance;
            format!(
                "belt {belt}, ring {ring}: at t = {t} s its resistance to slip, 50 N*s/m by default, takes {:.0} % of the {tight:.3} N on the \
                 tight side; write `resistance: {proposed:.0e}` for the ratio of tensions of the friction alone",
                100.0 * resistance / tight
            )
        })
    })
    .collect()
}

//! A study in the words of the runtime.

use bryant_generator::model::Model;
use bryant_runtime::batch::rows::{Asked, Job};
use bryant_runtime::batch::{Pace, Settings};
use bryant_runtime::{Response, Tolerances, Width};
use bryant_study::facts::{ModelFacts, OutputFact, ParameterFact};
use bryant_study::response::What;
use bryant_study::study::Study;

/// Tolerance for an accuracy of the responses. At 10⁻⁶ peaks, HIC and 3 ms values of child-seat are within 2·10⁻⁵ in half of the rows
/// of a study of six parameters, and within 10⁻⁴ in 999 of 1 000; what they are in another scene, the estimates of a study show.
const TOLERANCE: f64 = 1e-3;
/// Where nothing is said, a relative error of 0.1 % is aimed at.
const ACCURACY: f64 = 1e-3;
/// Samples between two rows of the model's own table, where nothing is said.
const FINER: f64 = 20.0;
/// Steps of a run, at most: a scene that needs more is stiff, and would hold up its lane for long.
const MOST_STEPS: u32 = 1_000_000;
/// Samples of a run at most: they are kept until its end, for each lane.
const MOST_SAMPLES: f64 = 1e6;

/// What a study must know of a model.
pub fn facts(model: &Model) -> ModelFacts {
    let parameters = model.parameters.iter().map(|parameter| ParameterFact {
        name: parameter.name.clone(),
        unit: parameter.unit.clone(),
        default: parameter.default,
        min: parameter.min,
        max: parameter.max,
    });
    let outputs = model.outputs.iter().map(|output| OutputFact {
        name: output.name.clone(),
        unit: output.unit.clone(),
    });
    ModelFacts {
        parameters: parameters.collect(),
        outputs: outputs.collect(),
    }
}

/// What to run of each row of a study.
///
/// # Errors
/// More samples than can be kept, in words with a remedy.
pub fn job(study: &Study, model: &Model, width: Width) -> Result<Job, String> {
    let index = |name: &str| model.parameters.iter().position(|p| p.name == name);
    let duration = study.run.duration.unwrap_or(model.run.duration);
    let sampling = study.run.sampling.unwrap_or(model.run.every / FINER);
    let intervals = (duration / sampling).round().max(1.0);
    if intervals >= MOST_SAMPLES {
        return Err(format!(
            "a sample every {sampling} s makes {intervals} of a run of {duration} s, and at most {MOST_SAMPLES} are kept\n  \
             help: give a longer time between samples, `run: {{ sampling: … }}`"
        ));
    }
    let pace = match study.run.step {
        Some(step) => Pace::Fixed(step),
        None => {
            let accuracy = study.run.accuracy.unwrap_or(ACCURACY);
            Pace::Adaptive(Tolerances::of(TOLERANCE * accuracy))
        }
    };
    let fixed = study.fixed.iter();
    let fixed = fixed.filter_map(|fixed| Some((index(&fixed.name)?, fixed.value)));
    Ok(Job {
        settings: Settings {
            duration,
            samples: intervals as usize + 1,
            pace,
            locate: false,
            max_steps: MOST_STEPS,
        },
        varied: study.varied.iter().filter_map(|v| index(&v.name)).collect(),
        fixed: fixed.collect(),
        responses: study
            .responses
            .iter()
            .map(|response| Asked {
                output: response.output,
                response: response_of(response.what),
            })
            .collect(),
        estimate: true,
        width,
    })
}

/// What is read off a run, as the runtime calls it.
pub fn response_of(what: What) -> Response {
    match what {
        What::Peak => Response::Peak,
        What::Minimum => Response::Minimum,
        What::Magnitude => Response::Magnitude,
        What::TimeOfPeak => Response::TimeOfPeak,
        What::TimeOfMinimum => Response::TimeOfMinimum,
        What::Range => Response::Range,
        What::Mean => Response::Mean,
        What::Final => Response::Final,
        What::Value { at } => Response::Value { at },
        What::Hic15 => Response::Hic { window: 15e-3 },
        What::Hic36 => Response::Hic { window: 36e-3 },
        What::Clip { duration } => Response::Clip { duration },
        What::ContiguousClip { duration } => Response::ContiguousClip { duration },
        What::Excursion => Response::Excursion,
        What::Integral => Response::Integral,
    }
}

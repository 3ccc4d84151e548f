//! Converts the settings of a study to those of the runtime.

use crate::accuracy::check::FAR;
use bryant_generator::model::Model;
use bryant_runtime::batch::rows::{Asked, Job};
use bryant_runtime::batch::{Fixed, LaneFormula, Pace, Settings};
use bryant_runtime::response::filter::MEAN;
use bryant_runtime::simulate::ENERGY_LIMIT;
use bryant_runtime::{Response, Tolerances, Width};
use bryant_study::facts::ModelFacts;
use bryant_study::response::What;
use bryant_study::study::{self, FixedSteps, Precision, RunSettings, Study};

/// Ratio of the tolerance of a step to the accuracy of responses. At a tolerance of 10⁻⁶, the errors of peaks, HIC and
/// 3 ms values of child-seat are below 2·10⁻⁵ in half of the rows of a study with six parameters, and below 10⁻⁴ in 999
/// of 1 000 rows. For other scenes, the error estimates of a study show the errors.
const TOLERANCE: f64 = 1e-3;
/// Largest number of steps of a run. A scene that needs more is stiff, and would occupy its lane for long.
const MOST_STEPS: u32 = 1_000_000;
/// Largest number of samples of a run, because they are kept until its end, for each lane.
const MOST_SAMPLES: f64 = 1e6;

/// The difference between 1 and the next number in single precision.
const OF_SINGLES: f64 = f32::EPSILON as f64;
/// Least length of steps in single precision, in units in the last place of the end time. The times of shorter steps
/// would be mostly rounding.
const COARSEST: f64 = 16.0;

/// The fixed steps or the tolerances of a run.
///
/// # Errors
/// A run would have too many steps, or steps or accuracies that single precision cannot resolve.
pub fn pace(run: &RunSettings, duration: f64) -> Result<Pace, String> {
    let single = run.precision == Precision::Single;
    if let Some(FixedSteps { length, method }) = run.step {
        // rounding must not add a step to a whole number of steps
        let steps = (duration / length - 1e-9).ceil();
        if steps > f64::from(MOST_STEPS) {
            return Err(format!(
                "steps of {length} s make {steps} of a run of {duration} s, and at most {MOST_STEPS} are taken\n  \
                 help: give longer steps, `run: {{ step: … }}`"
            ));
        }
        let shortest = COARSEST * OF_SINGLES * duration;
        if single && length < shortest {
            return Err(format!(
                "single precision resolves times to {:.1e} s at the end of a run of {duration} s, and steps of {length} s are hardly longer\n  \
                 help: give steps of {shortest:.1e} s at least, or `precision: double`",
                OF_SINGLES * duration
            ));
        }
        let method = match method {
            study::LaneFormula::Heun => LaneFormula::Heun,
            study::LaneFormula::Rk4 => LaneFormula::Rk4,
            study::LaneFormula::Merson => LaneFormula::Merson,
            study::LaneFormula::Dopri5 => LaneFormula::Dopri5,
        };
        let step = length;
        return Ok(Pace::Fixed(Fixed { method, step }));
    }
    let accuracy = run.accuracy();
    let tolerance = TOLERANCE * accuracy;
    if single && tolerance < OF_SINGLES {
        let finest = OF_SINGLES / TOLERANCE;
        return Err(format!(
            "an accuracy of {accuracy} is not possible in single precision: a step may err by {tolerance:.1e} of its result, \
             and single precision resolves {OF_SINGLES:.1e}\n  \
             help: aim at {finest:.1e} or more, `run: {{ accuracy: … }}`, or give `precision: double`"
        ));
    }
    Ok(Pace::Adaptive(Tolerances::of(tolerance)))
}

/// The job for each row of a study.
///
/// # Errors
/// Too many samples or steps, or numbers that single precision cannot resolve; the message has a remedy.
pub fn job(study: &Study, model: &Model, facts: &ModelFacts, width: Width) -> Result<Job, String> {
    let index = |name: &str| model.parameters.iter().position(|p| p.name == name);
    let duration = study.run.duration.unwrap_or(facts.run.duration);
    let sampling = study.sampling(facts);
    if let Some(class) = study
        .kept_filters(facts)
        .find(|class| !class.allows(sampling))
    {
        return Err(format!(
            "{class} of an output that is kept needs a sample every {} s at least, and there is one every {sampling} s\n  \
             help: give a shorter time between samples, `run: {{ sampling: … }}`",
            class.longest_interval()
        ));
    }
    let intervals = (duration / sampling).round().max(1.0);
    let filtered = study
        .responses
        .iter()
        .any(|one| one.channel.filter.is_some());
    if (filtered || study.kept_filters(facts).next().is_some()) && intervals < MEAN as f64 {
        return Err(format!(
            "a filter needs {MEAN} samples at least, and there is one every {sampling} s of a run of {duration} s\n  \
             help: give longer runs, or a shorter time between samples, `run: {{ sampling: … }}`"
        ));
    }
    if intervals >= MOST_SAMPLES {
        return Err(format!(
            "a sample every {sampling} s makes {intervals} of a run of {duration} s, and at most {MOST_SAMPLES} are kept\n  \
             help: give a longer time between samples, `run: {{ sampling: … }}`"
        ));
    }
    let pace = pace(&study.run, duration)?;
    let fixed = study.fixed.iter();
    let fixed = fixed.filter_map(|fixed| Some((index(&fixed.name)?, fixed.value)));
    Ok(Job {
        settings: Settings {
            duration,
            samples: intervals as usize + 1,
            pace,
            locate: false,
            max_steps: MOST_STEPS,
            time_limit: None,
            energy_limit: study.run.energy_limit.unwrap_or(ENERGY_LIMIT),
        },
        varied: study.varied.iter().filter_map(|v| index(&v.name)).collect(),
        fixed: fixed.collect(),
        responses: study
            .responses
            .iter()
            .map(|response| Asked {
                channel: response.channel,
                response: response_of(response.what),
            })
            .collect(),
        estimate: true,
        wanted: match study.run.step {
            Some(_) => FAR,
            None => study.run.accuracy(),
        },
        width,
    })
}

/// The response of the runtime for a response of a study.
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
        What::Olc => Response::Olc,
        What::Exceedance { limit } => Response::Exceedance { limit },
    }
}

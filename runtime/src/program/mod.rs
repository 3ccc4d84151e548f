//! A run described by a few words and delivered as rows of numbers: what a program needs around one model.
//!
//! The same path serves models that a program links ([`Entry`], one per model in a static table) and models compiled on
//! demand ([`main`] is the whole stand-alone program, [`StreamReader`] its counterpart in the calling program).
//!
//! ```ignore
//! fn main() -> std::process::ExitCode {
//!     bryant_runtime::program::main::<scene::Scene<f64>>()
//! }
//! ```

mod error;
mod finding;
mod job;
#[cfg(test)]
mod mutilated;
pub mod rows;
mod stream;

pub use error::{ErrorKind, RunError};
pub use finding::Finding;
pub use job::{Job, JobError, Scalar};
pub use rows::RowsEntry;
pub use stream::{
    Header, OutputHeader, ParameterHeader, StreamError, StreamReader, StreamWriter, read_stream,
};

use crate::simulate::{AllMethods, ENERGY_LIMIT, Methods, UsualMethods, Watch, run_from};
use crate::{DoubleDouble, Fast, Info, Model, Real, Report, Vector};
use std::io::{IsTerminal, Write};
use std::ops::ControlFlow;
use std::process::ExitCode;
use std::time::Instant;

/// Receives time, state and outputs of each sample; may break off the run.
pub type Sink<'a> = dyn FnMut(f64, &[f64], &[f64]) -> ControlFlow<()> + 'a;

/// A parameter by name, SI.
pub type Named = (String, f64);

/// A function of parameters, time and state that fills a slice.
pub type Evaluate = fn(&[Named], f64, &[f64], &mut [f64]) -> Result<(), RunError>;

/// A model behind function pointers, so that a table can hold many.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// Names, units, sizes.
    pub info: &'static Info,
    /// [`run`].
    pub run: fn(&Job, &mut Sink<'_>) -> Result<Report, RunError>,
    /// [`run_balanced`].
    pub run_balanced: fn(&Job, &mut Sink<'_>) -> Outcome,
    /// The state a run with these parameters starts from: coordinates, velocities, and what force laws add.
    pub initial_state: fn(&[Named]) -> Result<Vec<f64>, RunError>,
    /// ẏ, as many numbers as the state has.
    pub derivative: Evaluate,
    /// The outputs, in the order and units of [`Info::outputs`].
    pub outputs: Evaluate,
    /// The kinetic energy \[J\] followed by the powers, in the order and units of [`Info::powers`].
    pub energy: Evaluate,
    /// The guards, in the order of [`Info::guards`].
    pub guards: Evaluate,
    /// The kinks, in the order of [`Info::kinks`].
    pub kinks: Evaluate,
    /// The first time after one at which a curve of time has a kink that parameters place ([`Model::kink_after`]).
    pub kink_after: fn(&[Named], f64) -> Result<f64, RunError>,
    /// The momentum, six numbers, followed by its rate, the thrust.
    pub momentum: Evaluate,
    /// The state with the memory of force laws renewed.
    pub renewed: Evaluate,
}

impl Entry {
    /// The entry of a model.
    pub const fn of<M: Model<f64>>() -> Entry {
        Entry::with::<AllMethods, M>()
    }

    /// The entry of a model with Dormand & Prince 5(4) and Runge–Kutta 4 alone, which compiles several times faster: for
    /// tables of many models that no other method is wanted of.
    pub const fn of_usual_methods<M: Model<f64>>() -> Entry {
        Entry::with::<UsualMethods, M>()
    }

    const fn with<C: Methods, M: Model<f64>>() -> Entry {
        Entry {
            info: M::INFO,
            run: |job, sink| execute::<C, f64, M>(job, false, sink).result,
            run_balanced: |job, sink| execute::<C, f64, M>(job, true, sink),
            initial_state: initial_state::<M>,
            derivative: |p, t, y, out| {
                evaluate::<M, _>(p, y, out, "derivative", |m, y| m.derivative(t, &y))
            },
            outputs: |p, t, y, out| evaluate::<M, _>(p, y, out, "outputs", |m, y| m.outputs(t, &y)),
            energy: |p, t, y, out| {
                evaluate::<M, Vec<f64>>(p, y, out, "energy and powers", |m, y| {
                    let powers = m.powers(t, &y);
                    let energy = std::iter::once(m.kinetic_energy(t, &y));
                    energy.chain(powers.as_ref().iter().copied()).collect()
                })
            },
            guards: |p, t, y, out| evaluate::<M, _>(p, y, out, "guards", |m, y| m.guards(t, &y)),
            kinks: |p, t, y, out| evaluate::<M, _>(p, y, out, "kinks", |m, y| m.kinks(t, &y)),
            kink_after: kink_after::<M>,
            momentum: |p, t, y, out| {
                evaluate::<M, Vec<f64>>(p, y, out, "momentum and thrust", |m, y| {
                    [m.momentum(t, &y), m.thrust(t, &y)].concat()
                })
            },
            renewed: |p, t, y, out| {
                evaluate::<M, _>(p, y, out, "state", |m, mut y| {
                    m.renew(t, &mut y);
                    y
                })
            },
        }
    }
}

/// Runs a model as the job says, and hands every sample to `sink`. The arithmetic is that of `T`, whatever the job asks for.
///
/// # Errors
/// A job that does not fit the model; a run that fails ([`crate::Failure`]). All samples before have been delivered.
pub fn run<T: Real, M: Model<T>>(job: &Job, sink: &mut Sink<'_>) -> Result<Report, RunError> {
    execute::<AllMethods, T, M>(job, false, sink).result
}

/// [`run`], watched: where the energy went, and whether the run can be trusted.
pub fn run_balanced<T: Real, M: Model<T>>(job: &Job, sink: &mut Sink<'_>) -> Outcome {
    execute::<AllMethods, T, M>(job, true, sink)
}

/// Both in one place, so that each method is compiled once for a model.
#[inline(never)]
fn execute<C: Methods, T: Real, M: Model<T>>(
    job: &Job,
    balanced: bool,
    sink: &mut Sink<'_>,
) -> Outcome {
    let model = match job::model::<T, M>(&job.parameters) {
        Ok(model) => model,
        Err(error) => return Outcome::refused(error),
    };
    let settings = job.settings(M::INFO);
    let limit = job.energy_limit.unwrap_or(ENERGY_LIMIT);
    let mut watch = balanced.then(|| Watch::new(limit));
    let mut numbers = Numbers::new();
    let result = run_from::<C, T, M>(
        &model,
        model.initial_state(),
        &settings,
        watch.as_mut(),
        &mut |sample| numbers.send(sample.t, sample.state, sample.outputs, sink),
    );
    let doubts = watch.iter().flat_map(Watch::doubts);
    let doubts: Vec<Finding> = doubts.map(Finding::from).collect();
    let notes = watch.as_ref().map(finding::notes).unwrap_or_default();
    Outcome {
        result: result.map_err(|failure| RunError::from(failure).explained(&doubts)),
        doubts,
        notes,
        energy: watch.map(|watch| watch.balance).map(|balance| Energy {
            start: balance.start.to_f64(),
            end: balance.end.to_f64(),
            works: balance.works.as_ref().iter().map(|w| w.to_f64()).collect(),
            exchanged: balance.exchanged.to_f64(),
            momentum_gap: M::INFO.free.then(|| balance.momentum.relative_gap()),
        }),
    }
}

/// State and outputs of a sample, in double precision.
struct Numbers {
    state: Vec<f64>,
    outputs: Vec<f64>,
}

impl Numbers {
    fn new() -> Self {
        Numbers {
            state: Vec::new(),
            outputs: Vec::new(),
        }
    }

    fn send<T: Real>(
        &mut self,
        t: f64,
        state: &impl Vector<T>,
        outputs: &impl Vector<T>,
        sink: &mut Sink<'_>,
    ) -> ControlFlow<()> {
        for (numbers, scalars) in [
            (&mut self.state, state.as_ref()),
            (&mut self.outputs, outputs.as_ref()),
        ] {
            numbers.clear();
            numbers.extend(scalars.iter().map(|scalar| scalar.to_f64()));
        }
        sink(t, &self.state, &self.outputs)
    }
}

/// How a run ended, and where the energy went.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// What the run took, or why it failed.
    pub result: Result<Report, RunError>,
    /// The balance of energy up to the time reached; `None` where nothing ran.
    pub energy: Option<Energy>,
    /// Why it cannot be trusted, what causes the rest first.
    pub doubts: Vec<Finding>,
    /// What is worth knowing and no reason for doubt: curves that were left as far as they may be.
    pub notes: Vec<String>,
}

/// The balance of energy of a run, in J.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Energy {
    /// Kinetic energy at the start.
    pub start: f64,
    /// Kinetic energy at the time reached.
    pub end: f64,
    /// Work of each effect, in the order of [`Info::powers`].
    pub works: Vec<f64>,
    /// Σ ∫ |P| dt, what was exchanged one way or the other.
    pub exchanged: f64,
    /// Momentum of what moves freely that no force explains, as a share of what there is; `None` where nothing does.
    pub momentum_gap: Option<f64>,
}

impl Energy {
    /// What is missing in the balance: end − start − Σ works.
    pub fn gap(&self) -> f64 {
        self.end - self.start - self.works.iter().sum::<f64>()
    }

    /// The gap as a share of the largest energy there was to lose: what was exchanged, or the kinetic energy.
    pub fn relative_gap(&self) -> f64 {
        let scale = self.exchanged.max(self.start).max(self.end);
        if scale > 0.0 {
            self.gap().abs() / scale
        } else {
            0.0
        }
    }
}

impl Outcome {
    fn refused(error: JobError) -> Outcome {
        Outcome {
            result: Err(error.into()),
            energy: None,
            doubts: Vec::new(),
            notes: Vec::new(),
        }
    }
}

/// The stand-alone program around one model in double precision: words of a [`Job`] as arguments, a stream on standard output.
///
/// The single argument `describe` writes the header of the stream alone. Exit code 0: ran to its end; 2: the job does not
/// fit the model; 3: the run failed or cannot be trusted; 1: nobody reads. The message of a failure is in the stream, not on standard error.
pub fn main<M: Model<f64>>() -> ExitCode {
    on_a_large_stack::<M>(|job, sink| match job.scalar {
        Scalar::F64 => outcome::<f64, M>(job, sink),
        scalar => Outcome::refused(JobError::Scalar { scalar }),
    })
}

/// [`main`] with every arithmetic there is.
pub fn main_of_all_scalars<M: Model<f64>>() -> ExitCode {
    on_a_large_stack::<M>(|job, sink| match job.scalar {
        Scalar::F64 => outcome::<f64, M>(job, sink),
        Scalar::F32 => outcome::<f32, M::With<f32>>(job, sink),
        Scalar::Fast => outcome::<Fast, M::With<Fast>>(job, sink),
        Scalar::DoubleDouble => outcome::<DoubleDouble, M::With<DoubleDouble>>(job, sink),
    })
}

/// [`main`] with one arithmetic, whichever the job asks for.
pub fn main_of<T: Real, M: Model<f64>>() -> ExitCode {
    on_a_large_stack::<M>(|job, sink| outcome::<T, M::With<T>>(job, sink))
}

/// Runs a job with a certain arithmetic.
type Runner = fn(&Job, &mut Sink<'_>) -> Outcome;

/// What a job asks for, with the arithmetic of `T`.
fn outcome<T: Real, M: Model<T>>(job: &Job, sink: &mut Sink<'_>) -> Outcome {
    if !job.silent {
        return run_balanced::<T, M>(job, sink);
    }
    Outcome {
        result: run::<T, M>(job, &mut |_, _, _| ControlFlow::Continue(())),
        energy: None,
        doubts: Vec::new(),
        notes: Vec::new(),
    }
}

/// [`serve`] with the arguments and the standard output of the process. The Rosenbrock method keeps two matrices as large as
/// the state on the stack, which may be more than a process has.
fn on_a_large_stack<M: Model<f64>>(runner: Runner) -> ExitCode {
    let matrix = size_of::<<M::State as Vector<f64>>::Square>();
    // twice as large with double-doubles, and copied once or twice on the way to their places
    let stack = (16 << 20) + 16 * matrix;
    let thread = std::thread::Builder::new().stack_size(stack);
    let code = thread
        .spawn(move || with_process::<M>(runner))
        .map(std::thread::JoinHandle::join);
    match code {
        Ok(Ok(code)) => code,
        Ok(Err(panic)) => std::panic::resume_unwind(panic),
        Err(error) => {
            eprintln!("cannot start a thread with a stack of {stack} bytes: {error}");
            ExitCode::from(1)
        }
    }
}

fn with_process<M: Model<f64>>(runner: Runner) -> ExitCode {
    let words: Vec<String> = std::env::args_os()
        .skip(1)
        .map(|word| word.to_string_lossy().into_owned())
        .collect();
    let stdout = std::io::stdout();
    if stdout.is_terminal() {
        eprintln!(
            "This program runs the model \"{}\" for `bryant run` and writes binary records: redirect its output.\n\
             Arguments: {}, or describe.",
            M::INFO.name,
            Job::WORDS
        );
        return ExitCode::from(2);
    }
    serve::<M>(&words, &mut std::io::BufWriter::new(stdout.lock()), runner)
}

/// The program with its arguments and its output given.
fn serve<M: Model<f64>>(words: &[String], output: &mut dyn Write, runner: Runner) -> ExitCode {
    let nobody_reads = ExitCode::from(1);
    let Ok(mut writer) = StreamWriter::new(output, M::INFO) else {
        return nobody_reads;
    };
    if words == ["describe"] {
        return if writer.flush().is_ok() {
            ExitCode::SUCCESS
        } else {
            nobody_reads
        };
    }
    let mut broken = false;
    let start = Instant::now();
    let outcome = match Job::from_words(words) {
        Ok(job) => runner(&job, &mut |t, state, outputs| {
            if writer.sample(t, state, outputs).is_ok() {
                ControlFlow::Continue(())
            } else {
                broken = true;
                ControlFlow::Break(())
            }
        }),
        Err(error) => Outcome::refused(error),
    };
    if broken || writer.finish(&outcome, start.elapsed()).is_err() {
        return nobody_reads;
    }
    match outcome.result {
        Ok(_) if outcome.doubts.is_empty() => ExitCode::SUCCESS,
        Ok(_) => ExitCode::from(ErrorKind::Run.exit_code()),
        Err(error) => ExitCode::from(error.exit_code()),
    }
}

fn initial_state<M: Model<f64>>(parameters: &[Named]) -> Result<Vec<f64>, RunError> {
    let model: M = job::model::<f64, M>(parameters)?;
    Ok(model.initial_state().as_ref().to_vec())
}

fn kink_after<M: Model<f64>>(parameters: &[Named], t: f64) -> Result<f64, RunError> {
    let model: M = job::model::<f64, M>(parameters)?;
    Ok(model.kink_after(t))
}

/// What a function gives of a model at these parameters and a state, into a slice.
fn evaluate<M: Model<f64>, V: AsRef<[f64]>>(
    parameters: &[Named],
    y: &[f64],
    out: &mut [f64],
    what: &'static str,
    function: impl FnOnce(&M, M::State) -> V,
) -> Result<(), RunError> {
    let model: M = job::model::<f64, M>(parameters)?;
    fill(function(&model, state::<M>(y)?).as_ref(), out, what)
}

fn state<M: Model<f64>>(y: &[f64]) -> Result<M::State, RunError> {
    let mut state = M::State::splat(0.0);
    fill(y, state.as_mut(), "state")?;
    Ok(state)
}

fn fill(from: &[f64], to: &mut [f64], what: &'static str) -> Result<(), RunError> {
    if from.len() != to.len() {
        let (given, expected) = (from.len(), to.len());
        return Err(JobError::Size {
            what,
            given,
            expected,
        }
        .into());
    }
    to.copy_from_slice(from);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{Entry, ErrorKind, Job, StreamError, StreamReader, read_stream, run, serve};
    use crate::test_models::{Oscillator, Runaway};
    use crate::{Model, ParameterSet};
    use std::ops::ControlFlow;
    use std::process::ExitCode;

    static TABLE: [Entry; 2] = [Entry::of::<Oscillator>(), Entry::of::<Runaway>()];

    type Row = (f64, Vec<f64>, Vec<f64>);

    fn rows_of(entry: &Entry, job: &Job) -> (Vec<Row>, Result<crate::Report, super::RunError>) {
        let mut rows = Vec::new();
        let report = (entry.run)(job, &mut |t, y, o| {
            rows.push((t, y.to_vec(), o.to_vec()));
            ControlFlow::Continue(())
        });
        (rows, report)
    }

    fn stream_of<M: Model<f64>>(job: &Job) -> (Vec<u8>, ExitCode) {
        let mut bytes = Vec::new();
        let code = serve::<M>(&job.to_words(), &mut bytes, super::outcome::<f64, M>);
        (bytes, code)
    }

    #[test]
    fn a_stream_brings_what_the_run_delivered() {
        let mut job = Job {
            every: Some(0.25),
            ..Job::default()
        };
        job.parameters.push(("stiffness".into(), 9.0));
        let (direct, report) = rows_of(&TABLE[0], &job);
        let (bytes, code) = stream_of::<Oscillator>(&job);
        assert_eq!(code, ExitCode::SUCCESS);

        let mut reader = StreamReader::new(bytes.as_slice()).unwrap();
        assert_eq!(*reader.header(), super::Header::of(Oscillator::INFO));
        let mut read = Vec::new();
        let streamed = reader
            .read(&mut |t, y, o| {
                read.push((t, y.to_vec(), o.to_vec()));
                ControlFlow::Continue(())
            })
            .unwrap();
        assert_eq!(read, direct);
        assert_eq!(streamed, report.unwrap());
        assert!(!reader.took().is_zero());
    }

    #[test]
    fn a_failure_travels_with_the_samples_before_it() {
        let job = Job::default();
        let (direct, failure) = rows_of(&TABLE[1], &job);
        let failure = failure.unwrap_err();
        assert_eq!(failure.kind, ErrorKind::Run);
        let (bytes, code) = stream_of::<Runaway>(&job);
        assert_eq!(code, ExitCode::from(3));
        let mut count = 0;
        let result = read_stream(bytes.as_slice(), &mut |_, _, _| {
            count += 1;
            ControlFlow::Continue(())
        });
        let Err(StreamError::Run(read)) = result else {
            panic!("{result:?}")
        };
        assert_eq!(read, failure);
        assert_eq!(count, direct.len());
    }

    #[test]
    fn a_job_that_does_not_fit_travels_too() {
        let job = Job {
            parameters: vec![("stifness".into(), 1.0)],
            ..Job::default()
        };
        let (bytes, code) = stream_of::<Oscillator>(&job);
        assert_eq!(code, ExitCode::from(2));
        let result = read_stream(bytes.as_slice(), &mut |_, _, _| ControlFlow::Continue(()));
        let Err(StreamError::Run(error)) = result else {
            panic!("{result:?}")
        };
        assert_eq!(error.kind, ErrorKind::Job);
        assert!(error.message.contains("stifness") && error.message.contains("stiffness"));
    }

    #[test]
    fn a_torn_stream_is_no_success() {
        let (bytes, _) = stream_of::<Oscillator>(&Job::default());
        for length in 0..bytes.len() {
            let result = read_stream(&bytes[..length], &mut |_, _, _| ControlFlow::Continue(()));
            assert!(
                matches!(result, Err(StreamError::Torn)),
                "{length}: {result:?}"
            );
        }
    }

    #[test]
    fn a_foreign_stream_is_refused() {
        let result = read_stream(
            &b"Hello, this is not a stream of this kind"[..],
            &mut |_, _, _| ControlFlow::Continue(()),
        );
        assert!(matches!(result, Err(StreamError::Foreign)));
        let (mut bytes, _) = stream_of::<Oscillator>(&Job::default());
        bytes[8] = 99;
        let result = read_stream(bytes.as_slice(), &mut |_, _, _| ControlFlow::Continue(()));
        assert!(matches!(result, Err(StreamError::Version { found: 99 })));
    }

    #[test]
    fn describe_writes_the_header_alone() {
        let mut bytes = Vec::new();
        let runner = super::outcome::<f64, Oscillator>;
        serve::<Oscillator>(&["describe".into()], &mut bytes, runner);
        let reader = StreamReader::new(bytes.as_slice()).unwrap();
        assert_eq!(reader.header().parameters[0].name, "stiffness");
    }

    #[test]
    fn a_sink_that_breaks_off_ends_the_run() {
        let mut count = 0;
        let report = run::<f64, Oscillator>(&Job::default(), &mut |_, _, _| {
            count += 1;
            if count == 3 {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        })
        .unwrap();
        assert_eq!(report.samples, 3);
        assert!(report.t < Oscillator::INFO.duration);
    }

    #[test]
    fn an_entry_evaluates_its_model() {
        let entry = &TABLE[0];
        let parameters = [("stiffness".to_string(), 4.0)];
        let mut rate = [0.0; 2];
        (entry.derivative)(&parameters, 0.0, &[0.5, 3.0], &mut rate).unwrap();
        assert_eq!(rate, [3.0, -2.0]);
        let mut energy = [0.0];
        (entry.outputs)(&parameters, 0.0, &[0.5, 3.0], &mut energy).unwrap();
        assert_eq!(energy, [5.0]);
        assert_eq!((entry.initial_state)(&parameters).unwrap(), [1.0, 0.0]);
        assert!((entry.derivative)(&parameters, 0.0, &[0.5], &mut rate).is_err());
        assert!((entry.derivative)(&parameters, 0.0, &[0.5, 3.0], &mut energy).is_err());
        assert_eq!(
            <Oscillator as Model<f64>>::Parameters::defaults().get(1),
            None
        );
    }
}

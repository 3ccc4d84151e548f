//! Rows of a study behind function pointers, and as a program of its own: what a job looks like in words, and how rows go in and
//! responses come out.
//!
//! The program is given the words of a job. On its standard input it takes requests, a number of rows n (`u64`) and n rows of doubles, and
//! answers each on its standard output: for every row its status (`u8`), the time reached (`f64`), steps accepted and rejected (`u32`
//! each), the estimated error (`f64`), and the responses (`f64` each). Where n is the largest there is, one row follows, and all outputs
//! of its run come back instead: those five numbers, and the samples, output by output. Everything is little-endian.

use crate::batch::rows::{Asked, Gradients, Job, NoSuchRegisters, Results, Row, Sampled};
use crate::batch::rows::{gradients, rows, rows_of_singles, series, series_of_singles};
use crate::batch::{Fixed, Method, Pace, Settings, Status};
use crate::response::Response;
use crate::{Model, Tolerances, Width};
use std::fmt;
use std::io::{self, Read, Write};
use std::process::ExitCode;

/// What a study asks a model that is part of a program.
#[derive(Clone, Copy, Debug)]
pub struct RowsEntry {
    /// [`rows`]
    pub rows: fn(&Job, &[f64]) -> Result<Results, NoSuchRegisters>,
    /// [`series`]
    pub series: fn(&Job, &[f64], &[usize]) -> Sampled,
}

impl RowsEntry {
    /// That of a model.
    pub const fn of<M: Model<f64>>() -> RowsEntry {
        RowsEntry {
            rows: rows::<M>,
            series: series::<M>,
        }
    }

    /// That of a model in single precision.
    pub const fn of_singles<M: Model<f64>>() -> RowsEntry {
        RowsEntry {
            rows: rows_of_singles::<M>,
            series: series_of_singles::<M>,
        }
    }
}

/// Words that are no job of rows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WrongWord {
    /// Which.
    pub word: String,
    /// Why.
    pub problem: &'static str,
}

impl fmt::Display for WrongWord {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "\"{}\": {}", self.word.escape_debug(), self.problem)
    }
}

impl std::error::Error for WrongWord {}

/// As many rows mean: one, and its samples.
pub const ONE_FOR_ITS_SERIES: u64 = u64::MAX;

impl Job {
    /// The job as arguments, of which [`Job::from_words`] makes the same job. Of tolerances the relative one stands for all, as
    /// [`Tolerances::of`] has them.
    pub fn to_words(&self) -> Vec<String> {
        let Settings {
            duration,
            samples,
            pace,
            locate,
            max_steps,
        } = &self.settings;
        let mut words = vec![
            format!("duration={duration:?}"),
            format!("samples={samples}"),
            match pace {
                Pace::Fixed(Fixed { method, step }) => {
                    format!("steps={}:{step:?}", method.formula().name())
                }
                Pace::Adaptive(tolerances) => format!("relative={:?}", tolerances.relative),
            },
            format!("max-steps={max_steps}"),
            format!("width={}", self.width.name()),
        ];
        words.extend(locate.then(|| "kinks=located".to_owned()));
        words.extend(self.estimate.then(|| "estimate=yes".to_owned()));
        words.extend(self.varied.iter().map(|index| format!("varied={index}")));
        let fixed = self.fixed.iter();
        words.extend(fixed.map(|(index, value)| format!("fixed={index}:{value:?}")));
        let responses = self.responses.iter();
        words.extend(responses.map(|asked| {
            format!(
                "response={}:{}",
                asked.output,
                response_word(asked.response)
            )
        }));
        words
    }

    /// The job of these arguments.
    ///
    /// # Errors
    /// An unknown word, a number that is none, no duration, fewer than two samples, neither step nor tolerance, a tolerance of 1 or more.
    pub fn from_words<W: AsRef<str>>(words: &[W]) -> Result<Job, WrongWord> {
        let mut job = Job {
            settings: Settings {
                duration: f64::NAN,
                samples: 0,
                pace: Pace::Adaptive(Tolerances::of(f64::NAN)),
                locate: false,
                max_steps: u32::MAX,
            },
            varied: Vec::new(),
            fixed: Vec::new(),
            responses: Vec::new(),
            estimate: false,
            width: Width::widest(),
        };
        for word in words {
            let word = word.as_ref();
            let wrong = |problem| WrongWord {
                word: word.to_owned(),
                problem,
            };
            let (key, text) = word.split_once('=').ok_or(wrong("it is not key=value"))?;
            let number = |text: &str| text.parse::<f64>().map_err(|_| wrong("it is no number"));
            let whole = |text: &str| {
                let index = text.parse::<usize>();
                index.map_err(|_| wrong("it is no whole number"))
            };
            let settings = &mut job.settings;
            match key {
                "duration" => settings.duration = number(text)?,
                "samples" => settings.samples = whole(text)?,
                "steps" => {
                    let pair = text.split_once(':').ok_or(wrong("it is not METHOD:STEP"))?;
                    let method = Method::named(pair.0).ok_or(wrong("there is no such method"))?;
                    let step = number(pair.1)?;
                    settings.pace = Pace::Fixed(Fixed { method, step });
                }
                "relative" => settings.pace = Pace::Adaptive(Tolerances::of(number(text)?)),
                "max-steps" => {
                    let limit = u32::try_from(whole(text)?);
                    settings.max_steps = limit.map_err(|_| wrong("it is too large"))?;
                }
                "width" => job.width = Width::named(text).ok_or(wrong("no width has this name"))?,
                "kinks" => settings.locate = text == "located",
                "estimate" => job.estimate = text == "yes",
                "varied" => job.varied.push(whole(text)?),
                "fixed" => {
                    let pair = text.split_once(':').ok_or(wrong("it is not INDEX:VALUE"))?;
                    job.fixed.push((whole(pair.0)?, number(pair.1)?));
                }
                "response" => {
                    let pair = text.split_once(':').ok_or(wrong("it is not OUTPUT:WHAT"))?;
                    job.responses.push(Asked {
                        output: whole(pair.0)?,
                        response: response_of(pair.1).ok_or(wrong("there is no such response"))?,
                    });
                }
                _ => return Err(wrong("there is no such key")),
            }
        }
        let Settings {
            duration,
            samples,
            pace,
            ..
        } = job.settings;
        let missing = |word: &str, problem| WrongWord {
            word: word.to_owned(),
            problem,
        };
        let positive = |value: f64| value > 0.0 && value.is_finite();
        if !positive(duration) {
            return Err(missing("duration", "it is needed, and positive"));
        }
        if samples < 2 {
            return Err(missing("samples", "there are two at least"));
        }
        let (length, most) = match pace {
            Pace::Fixed(fixed) => (fixed.step, f64::INFINITY),
            Pace::Adaptive(tolerances) => (tolerances.relative, 1.0),
        };
        if !positive(length) {
            return Err(missing(
                "steps",
                "steps or a tolerance are needed, and positive",
            ));
        }
        if length >= most {
            return Err(missing("relative", "a tolerance is below 1, such as 1e-6"));
        }
        Ok(job)
    }
}

fn response_word(response: Response) -> String {
    match response {
        Response::Peak => "peak".into(),
        Response::Minimum => "minimum".into(),
        Response::Magnitude => "magnitude".into(),
        Response::TimeOfPeak => "time-of-peak".into(),
        Response::TimeOfMinimum => "time-of-minimum".into(),
        Response::Range => "range".into(),
        Response::Excursion => "excursion".into(),
        Response::Integral => "integral".into(),
        Response::Mean => "mean".into(),
        Response::Final => "final".into(),
        Response::Value { at } => format!("value:{at:?}"),
        Response::Hic { window } => format!("hic:{window:?}"),
        Response::Clip { duration } => format!("clip:{duration:?}"),
        Response::ContiguousClip { duration } => format!("contiguous-clip:{duration:?}"),
    }
}

fn response_of(word: &str) -> Option<Response> {
    let (name, time) = match word.split_once(':') {
        Some((name, time)) => (name, time.parse().ok()?),
        None => (word, f64::NAN),
    };
    Some(match name {
        "peak" => Response::Peak,
        "minimum" => Response::Minimum,
        "magnitude" => Response::Magnitude,
        "time-of-peak" => Response::TimeOfPeak,
        "time-of-minimum" => Response::TimeOfMinimum,
        "range" => Response::Range,
        "excursion" => Response::Excursion,
        "integral" => Response::Integral,
        "mean" => Response::Mean,
        "final" => Response::Final,
        "value" => Response::Value { at: time },
        "hic" => Response::Hic { window: time },
        "clip" => Response::Clip { duration: time },
        "contiguous-clip" => Response::ContiguousClip { duration: time },
        _ => return None,
    })
}

/// Status as a byte.
fn code(status: Status) -> u8 {
    match status {
        Status::Done => 0,
        Status::NonFinite => 1,
        Status::StepTooSmall => 2,
        Status::TooManySteps => 3,
        Status::Refused => 4,
    }
}

fn status_of(code: u8) -> Option<Status> {
    Some(match code {
        0 => Status::Done,
        1 => Status::NonFinite,
        2 => Status::StepTooSmall,
        3 => Status::TooManySteps,
        4 => Status::Refused,
        _ => return None,
    })
}

/// The program around one model that runs rows: words of a [`Job`] as arguments, requests and answers as said above. It ends where its
/// input does.
///
/// Exit code 2: the words are no job, or the processor has no such registers; 1: input or output broke.
pub fn main_of_rows<M: Model<f64>>() -> ExitCode {
    serve_process(RowsEntry::of::<M>(), M::INFO.outputs.len())
}

/// The same in single precision; what goes in and comes out are doubles here, too.
pub fn main_of_rows_in_single_precision<M: Model<f64>>() -> ExitCode {
    serve_process(RowsEntry::of_singles::<M>(), M::INFO.outputs.len())
}

fn serve_process(entry: RowsEntry, outputs: usize) -> ExitCode {
    let job = match job_of_process() {
        Ok(job) => job,
        Err(code) => return code,
    };
    let (stdin, stdout) = (io::stdin().lock(), io::stdout().lock());
    let mut input = io::BufReader::new(stdin);
    let mut output = io::BufWriter::new(stdout);
    match serve(entry, outputs, &job, &mut input, &mut output) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) if error.kind() == io::ErrorKind::Unsupported => {
            eprintln!("{error}");
            ExitCode::from(2)
        }
        Err(_) => ExitCode::from(1),
    }
}

fn job_of_process() -> Result<Job, ExitCode> {
    let words: Vec<String> = std::env::args_os()
        .skip(1)
        .map(|word| word.to_string_lossy().into_owned())
        .collect();
    Job::from_words(&words).map_err(|error| {
        eprintln!("{error}");
        ExitCode::from(2)
    })
}

fn serve(
    entry: RowsEntry,
    outputs: usize,
    job: &Job,
    input: &mut impl Read,
    output: &mut impl Write,
) -> io::Result<()> {
    let unsupported = |error: NoSuchRegisters| io::Error::new(io::ErrorKind::Unsupported, error);
    let across = job.varied.len();
    loop {
        let mut count = [0; 8];
        match input.read_exact(&mut count) {
            Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => return Ok(()),
            result => result?,
        }
        match u64::from_le_bytes(count) {
            ONE_FOR_ITS_SERIES => {
                let row = doubles(input, across)?;
                let all: Vec<usize> = (0..outputs).collect();
                let (row, samples) = (entry.series)(job, &row, &all).map_err(unsupported)?;
                write_row(output, &row)?;
                write_doubles(output, &samples)?;
            }
            count => {
                let count = usize::try_from(count).map_err(io::Error::other)?;
                let asked = doubles(input, count * across)?;
                let results = (entry.rows)(job, &asked).map_err(unsupported)?;
                let width = job.responses.len();
                for (index, row) in results.rows.iter().enumerate() {
                    write_row(output, row)?;
                    write_doubles(output, &results.responses[index * width..][..width])?;
                }
            }
        }
        output.flush()?;
    }
}

fn write_row(output: &mut impl Write, row: &Row) -> io::Result<()> {
    output.write_all(&[code(row.status)])?;
    output.write_all(&row.t.to_le_bytes())?;
    output.write_all(&row.steps.to_le_bytes())?;
    output.write_all(&row.rejected.to_le_bytes())?;
    output.write_all(&row.error.to_le_bytes())
}

/// Writes doubles.
///
/// # Errors
/// Nobody reads.
pub fn write_doubles(output: &mut impl Write, values: &[f64]) -> io::Result<()> {
    let bytes = values.iter().map(|value| value.to_le_bytes());
    bytes
        .into_iter()
        .try_for_each(|bytes| output.write_all(&bytes))
}

/// Reads doubles.
///
/// # Errors
/// There are fewer.
pub fn doubles(input: &mut impl Read, count: usize) -> io::Result<Vec<f64>> {
    let mut values = Vec::with_capacity(count.min(1 << 20));
    let mut bytes = [0; 8];
    for _ in 0..count {
        input.read_exact(&mut bytes)?;
        values.push(f64::from_le_bytes(bytes));
    }
    Ok(values)
}

/// Reads how a row ended, as [`main_of_rows`] writes it.
///
/// # Errors
/// It is cut off, or no such thing.
pub fn read_row(input: &mut impl Read) -> io::Result<Row> {
    let (mut byte, mut four, mut eight) = ([0; 1], [0; 4], [0; 8]);
    input.read_exact(&mut byte)?;
    let unknown = || io::Error::new(io::ErrorKind::InvalidData, "no such status");
    let status = status_of(byte[0]).ok_or_else(unknown)?;
    input.read_exact(&mut eight)?;
    let t = f64::from_le_bytes(eight);
    input.read_exact(&mut four)?;
    let steps = u32::from_le_bytes(four);
    input.read_exact(&mut four)?;
    let rejected = u32::from_le_bytes(four);
    input.read_exact(&mut eight)?;
    let error = f64::from_le_bytes(eight);
    Ok(Row {
        status,
        t,
        steps,
        rejected,
        error,
    })
}

/// The program around one model that differentiates a run: words of a [`Job`] as arguments; on standard input a row and, behind it, as
/// many directions as there are. It answers for every direction how its run ended, then the responses, then their derivatives.
///
/// Exit codes as of [`main_of_rows`].
pub fn main_of_gradients<M: Model<f64>>() -> ExitCode {
    let job = match job_of_process() {
        Ok(job) => job,
        Err(code) => return code,
    };
    let run = || -> io::Result<Result<Gradients, NoSuchRegisters>> {
        let mut bytes = Vec::new();
        io::stdin().lock().read_to_end(&mut bytes)?;
        let all = doubles(&mut bytes.as_slice(), bytes.len() / 8)?;
        let (row, directions) = all.split_at(job.varied.len().min(all.len()));
        Ok(gradients::<M>(&job, row, directions))
    };
    let answer = |gradients: Gradients| -> io::Result<()> {
        let mut output = io::stdout().lock();
        for row in &gradients.rows {
            write_row(&mut output, row)?;
        }
        write_doubles(&mut output, &gradients.values)?;
        write_doubles(&mut output, &gradients.slopes)?;
        output.flush()
    };
    match run() {
        Ok(Ok(gradients)) => match answer(gradients) {
            Ok(()) => ExitCode::SUCCESS,
            Err(_) => ExitCode::from(1),
        },
        Ok(Err(error)) => {
            eprintln!("{error}");
            ExitCode::from(2)
        }
        Err(_) => ExitCode::from(1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_models::Oscillator;

    fn job() -> Job {
        Job {
            settings: Settings {
                duration: 0.5,
                samples: 11,
                pace: Pace::Adaptive(Tolerances::of(1e-9)),
                locate: true,
                max_steps: 5000,
            },
            varied: vec![0],
            fixed: vec![(3, -1.5e-7)],
            responses: vec![
                Asked {
                    output: 0,
                    response: Response::Peak,
                },
                Asked {
                    output: 0,
                    response: Response::Value { at: 0.1 },
                },
                Asked {
                    output: 0,
                    response: Response::Hic { window: 0.015 },
                },
            ],
            estimate: true,
            width: Width::Plain,
        }
    }

    #[test]
    fn words_make_the_same_job() {
        assert_eq!(Job::from_words(&job().to_words()), Ok(job()));
        for method in Method::ALL {
            let fixed = Job {
                settings: Settings {
                    pace: Pace::Fixed(Fixed { method, step: 1e-4 }),
                    ..job().settings
                },
                estimate: false,
                ..job()
            };
            assert_eq!(Job::from_words(&fixed.to_words()), Ok(fixed));
        }
    }

    #[test]
    fn words_that_are_none_are_named() {
        for (word, problem) in [
            ("duration", "it is not key=value"),
            ("duration=x", "it is no number"),
            ("samples=-1", "it is no whole number"),
            ("width=16", "no width has this name"),
            ("fixed=2", "it is not INDEX:VALUE"),
            ("steps=1e-4", "it is not METHOD:STEP"),
            ("steps=rk5:1e-4", "there is no such method"),
            ("steps=rk4:x", "it is no number"),
            ("response=2", "it is not OUTPUT:WHAT"),
            ("response=2:best", "there is no such response"),
            ("colour=red", "there is no such key"),
        ] {
            let error = Job::from_words(&[word]).unwrap_err();
            assert_eq!((error.word.as_str(), error.problem), (word, problem));
        }
        let missing = |words: &[&str]| Job::from_words(words).unwrap_err().word;
        assert_eq!(missing(&[]), "duration");
        assert_eq!(missing(&["duration=1"]), "samples");
        assert_eq!(missing(&["duration=1", "samples=3"]), "steps");
        let none = ["duration=1", "samples=3", "steps=rk4:0"];
        assert_eq!(missing(&none), "steps");
        let coarse = ["duration=1", "samples=3", "relative=1"];
        assert_eq!(missing(&coarse), "relative");
    }

    #[test]
    fn rows_come_back_as_they_were_computed() {
        let job = Job {
            fixed: Vec::new(),
            width: Width::widest(),
            ..job()
        };
        let asked = [1.0, 4.0, 9.0];
        let expected = rows::<Oscillator>(&job, &asked).unwrap();
        let mut input = 3u64.to_le_bytes().to_vec();
        write_doubles(&mut input, &asked).unwrap();
        input.extend(ONE_FOR_ITS_SERIES.to_le_bytes());
        write_doubles(&mut input, &[4.0]).unwrap();
        let mut output = Vec::new();
        let entry = RowsEntry::of::<Oscillator>();
        serve(entry, 1, &job, &mut input.as_slice(), &mut output).unwrap();
        let mut answer = output.as_slice();
        for (row, responses) in expected.rows.iter().zip(expected.responses.chunks(3)) {
            assert_eq!(&read_row(&mut answer).unwrap(), row);
            assert_eq!(doubles(&mut answer, 3).unwrap(), responses);
            // the energy k/2 of x = cos(√k t) stays
            assert_eq!(row.status, Status::Done);
            assert!(row.error < 1e-6, "{row:?}");
        }
        let row = read_row(&mut answer).unwrap();
        let samples = doubles(&mut answer, 11).unwrap();
        assert_eq!((row.status, row.t), (Status::Done, 0.5));
        assert!(samples.iter().all(|energy| (energy - 2.0).abs() < 1e-7));
        assert!(answer.is_empty());
    }
}

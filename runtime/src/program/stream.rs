//! The stream that a stand-alone program writes and the calling program reads.
//!
//! All numbers little-endian; a string is its length (u32) and that many bytes of UTF-8; a list its length (u32) and its
//! items.
//!
//! ```text
//! header   "BRYANT\x1a\n", version u32, name, digest, dimension u32, coordinates [name], velocities [name],
//!          auxiliaries [name], memory [name], guards [name], kinks [name], powers [name], outputs [name, unit],
//!          parameters [name, unit, default f64, min f64, max f64], duration f64, every f64
//! sample   1 u8, t f64, state f64 …, outputs f64 …                             any number
//! took     4 u8, time that the computation took in seconds f64                 before the outcome
//! energy   5 u8, kinetic energy at the start f64, at the end f64, exchanged f64, gap of momentum f64 (NaN: none), works [f64]     before the outcome, if anything ran
//! doubt    6 u8, since f64, amount f64, kind, coordinate ("": none), message, remedy     any number, before the outcome
//! note     7 u8, text                                                          any number, before the outcome
//! report   2 u8, t f64, steps u64, rejected u64, evaluations u64, jacobians u64, events u64, samples u64,
//!          smallest step f64, where it begins f64, what forced it (kind u8, index u32), largest step f64
//!                                                                              at the end of a run that succeeded
//! error    3 u8, kind u8, t f64 (NaN: none), coordinate ("": none), cause, message     at the end of one that did not
//! ```

use super::{Energy, ErrorKind, Finding, Outcome, RunError, Sink};
use crate::{Cause, Info, Report};
use std::fmt;
use std::io::{self, BufReader, Read, Write};
use std::ops::ControlFlow;
use std::time::Duration;

const MAGIC: [u8; 8] = *b"BRYANT\x1a\n";
const VERSION: u32 = 6;
const SAMPLE: u8 = 1;
const REPORT: u8 = 2;
const ERROR: u8 = 3;
const TOOK: u8 = 4;
const ENERGY: u8 = 5;
const DOUBT: u8 = 6;
const NOTE: u8 = 7;

/// Longest string or list that a reader takes for meant.
const LONGEST: u32 = 1 << 20;

/// What a stream says of its model: [`Info`] as owned values, less the kinks.
#[derive(Clone, Debug, PartialEq)]
pub struct Header {
    /// Name of the model.
    pub name: String,
    /// SHA-256 of the YAML, hexadecimal.
    pub digest: String,
    /// 2 or 3.
    pub dimension: u32,
    /// Names of q.
    pub coordinates: Vec<String>,
    /// Names of v.
    pub velocities: Vec<String>,
    /// Names of the states of force laws.
    pub auxiliaries: Vec<String>,
    /// Names of what force laws remember.
    pub memory: Vec<String>,
    /// Names of the guards.
    pub guards: Vec<String>,
    /// Names of the kinks of force laws.
    pub kinks: Vec<String>,
    /// Names of the effects that do work.
    pub powers: Vec<String>,
    /// Column headings and units.
    pub outputs: Vec<OutputHeader>,
    /// Names, units, bounds.
    pub parameters: Vec<ParameterHeader>,
    /// Length of a run \[s\] where the job gives none.
    pub duration: f64,
    /// Time between samples \[s\] where the job gives none.
    pub every: f64,
}

/// A column of the output table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutputHeader {
    /// Heading.
    pub name: String,
    /// SI unit, "" for a pure number.
    pub unit: String,
}

/// An adjustable number.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterHeader {
    /// Name.
    pub name: String,
    /// SI unit, "" where unknown.
    pub unit: String,
    /// Default (SI).
    pub default: f64,
    /// Smallest value allowed (SI), −∞ where unbounded.
    pub min: f64,
    /// Largest value allowed (SI), +∞ where unbounded.
    pub max: f64,
}

impl Header {
    /// The header of a model.
    pub fn of(info: &Info) -> Header {
        let names = |names: &[&str]| names.iter().map(|name| name.to_string()).collect();
        let outputs = info.outputs.iter().map(|output| OutputHeader {
            name: output.name.into(),
            unit: output.unit.into(),
        });
        let parameters = info.parameters.iter().map(|parameter| ParameterHeader {
            name: parameter.name.into(),
            unit: parameter.unit.into(),
            default: parameter.default,
            min: parameter.min,
            max: parameter.max,
        });
        Header {
            name: info.name.into(),
            digest: info.digest.into(),
            dimension: info.dimension.into(),
            coordinates: names(info.coordinates),
            velocities: names(info.velocities),
            auxiliaries: names(info.auxiliaries),
            memory: names(info.memory),
            guards: names(info.guards),
            kinks: names(info.kinks),
            powers: names(info.powers),
            outputs: outputs.collect(),
            parameters: parameters.collect(),
            duration: info.duration,
            every: info.every,
        }
    }

    fn write(&self, w: &mut impl Write) -> io::Result<()> {
        put_text(w, &self.name)?;
        put_text(w, &self.digest)?;
        put_u32(w, self.dimension)?;
        let states = [
            &self.coordinates,
            &self.velocities,
            &self.auxiliaries,
            &self.memory,
            &self.guards,
            &self.kinks,
            &self.powers,
        ];
        for names in states {
            put_length(w, names.len())?;
            names.iter().try_for_each(|name| put_text(w, name))?;
        }
        put_length(w, self.outputs.len())?;
        for output in &self.outputs {
            put_text(w, &output.name)?;
            put_text(w, &output.unit)?;
        }
        put_length(w, self.parameters.len())?;
        for parameter in &self.parameters {
            put_text(w, &parameter.name)?;
            put_text(w, &parameter.unit)?;
            put_f64s(w, &[parameter.default, parameter.min, parameter.max])?;
        }
        put_f64s(w, &[self.duration, self.every])
    }

    fn read(r: &mut impl Read) -> Result<Header, StreamError> {
        Ok(Header {
            name: text(r)?,
            digest: text(r)?,
            dimension: u32::from_le_bytes(bytes(r)?),
            coordinates: list(r, text)?,
            velocities: list(r, text)?,
            auxiliaries: list(r, text)?,
            memory: list(r, text)?,
            guards: list(r, text)?,
            kinks: list(r, text)?,
            powers: list(r, text)?,
            outputs: list(r, |r| {
                Ok(OutputHeader {
                    name: text(r)?,
                    unit: text(r)?,
                })
            })?,
            parameters: list(r, |r| {
                Ok(ParameterHeader {
                    name: text(r)?,
                    unit: text(r)?,
                    default: float(r)?,
                    min: float(r)?,
                    max: float(r)?,
                })
            })?,
            duration: float(r)?,
            every: float(r)?,
        })
    }
}

/// Writes a stream.
pub struct StreamWriter<W: Write> {
    output: W,
}

impl<W: Write> StreamWriter<W> {
    /// Begins a stream with its header.
    ///
    /// # Errors
    /// Those of the output, as everywhere in the writer.
    pub fn new(mut output: W, info: &Info) -> io::Result<Self> {
        output.write_all(&MAGIC)?;
        put_u32(&mut output, VERSION)?;
        Header::of(info).write(&mut output)?;
        Ok(StreamWriter { output })
    }

    /// Adds a sample; its lengths are those of the header.
    ///
    /// # Errors
    /// Those of the output.
    pub fn sample(&mut self, t: f64, state: &[f64], outputs: &[f64]) -> io::Result<()> {
        self.output.write_all(&[SAMPLE])?;
        put_f64s(&mut self.output, &[t])?;
        put_f64s(&mut self.output, state)?;
        put_f64s(&mut self.output, outputs)
    }

    /// Ends the stream with the outcome of the run and the time that it took, and flushes it.
    ///
    /// # Errors
    /// Those of the output.
    pub fn finish(mut self, outcome: &Outcome, took: Duration) -> io::Result<()> {
        let w = &mut self.output;
        w.write_all(&[TOOK])?;
        put_f64s(w, &[took.as_secs_f64()])?;
        if let Some(energy) = &outcome.energy {
            w.write_all(&[ENERGY])?;
            put_f64s(w, &[energy.start, energy.end, energy.exchanged])?;
            put_f64s(w, &[energy.momentum_gap.unwrap_or(f64::NAN)])?;
            put_length(w, energy.works.len())?;
            put_f64s(w, &energy.works)?;
        }
        for doubt in &outcome.doubts {
            w.write_all(&[DOUBT])?;
            put_f64s(w, &[doubt.since, doubt.amount])?;
            let texts = [
                &doubt.kind,
                &doubt.coordinate,
                &doubt.message,
                &doubt.remedy,
            ];
            texts.iter().try_for_each(|text| put_text(w, text))?;
        }
        for note in &outcome.notes {
            w.write_all(&[NOTE])?;
            put_text(w, note)?;
        }
        match &outcome.result {
            Ok(report) => {
                w.write_all(&[REPORT])?;
                put_f64s(w, &[report.t])?;
                for count in [
                    report.steps,
                    report.rejected,
                    report.evaluations,
                    report.jacobians,
                    report.events,
                    report.samples,
                ] {
                    w.write_all(&count.to_le_bytes())?;
                }
                put_f64s(w, &[report.smallest_step, report.smallest_step_at])?;
                put_cause(w, report.smallest_step_for)?;
                put_f64s(w, &[report.largest_step])?;
            }
            Err(error) => {
                w.write_all(&[ERROR, error.exit_code()])?;
                put_f64s(w, &[error.t.unwrap_or(f64::NAN)])?;
                put_text(w, error.coordinate.as_deref().unwrap_or(""))?;
                put_text(w, &error.cause)?;
                put_text(w, &error.message)?;
            }
        }
        w.flush()
    }

    /// Hands on what is buffered.
    ///
    /// # Errors
    /// Those of the output.
    pub fn flush(&mut self) -> io::Result<()> {
        self.output.flush()
    }
}

/// Reads a stream.
#[derive(Debug)]
pub struct StreamReader<R> {
    input: BufReader<R>,
    header: Header,
    took: Duration,
    energy: Option<Energy>,
    doubts: Vec<Finding>,
    notes: Vec<String>,
}

/// Why no report came out of a stream.
#[derive(Debug)]
pub enum StreamError {
    /// The run ended with this.
    Run(RunError),
    /// The stream ends before the run does: the program at its other end has died.
    Torn,
    /// Not a stream of this kind, or one that makes no sense.
    Foreign,
    /// A stream of another version of this format.
    Version {
        /// Its version.
        found: u32,
    },
    /// The receiver of the samples broke off.
    Stopped,
    /// Reading failed.
    Io(io::Error),
}

impl<R: Read> StreamReader<R> {
    /// Reads the header.
    ///
    /// # Errors
    /// [`StreamError::Torn`], [`StreamError::Foreign`], [`StreamError::Version`], [`StreamError::Io`].
    pub fn new(input: R) -> Result<Self, StreamError> {
        let mut input = BufReader::new(input);
        if bytes(&mut input)? != MAGIC {
            return Err(StreamError::Foreign);
        }
        let found = u32::from_le_bytes(bytes(&mut input)?);
        if found != VERSION {
            return Err(StreamError::Version { found });
        }
        let header = Header::read(&mut input)?;
        Ok(StreamReader {
            input,
            header,
            took: Duration::ZERO,
            energy: None,
            doubts: Vec::new(),
            notes: Vec::new(),
        })
    }

    /// What the stream says of its model.
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// Time that the computation took, where the program at the other end did it; known after [`read`](Self::read).
    pub fn took(&self) -> Duration {
        self.took
    }

    /// The balance of energy, where anything ran; known after [`read`](Self::read).
    pub fn energy(&self) -> Option<&Energy> {
        self.energy.as_ref()
    }

    /// Why the run cannot be trusted; known after [`read`](Self::read).
    pub fn doubts(&self) -> &[Finding] {
        &self.doubts
    }

    /// What is worth knowing of it; known after [`read`](Self::read).
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Hands every sample to `sink` and returns the report at the end.
    ///
    /// # Errors
    /// [`StreamError::Run`] where the run failed, after the samples before it; [`StreamError::Stopped`] where the sink
    /// breaks off; those of [`StreamReader::new`].
    pub fn read(&mut self, sink: &mut Sink<'_>) -> Result<Report, StreamError> {
        let r = &mut self.input;
        let header = &self.header;
        let states = [
            &header.coordinates,
            &header.velocities,
            &header.auxiliaries,
            &header.memory,
        ];
        let states: usize = states.iter().map(|names| names.len()).sum();
        let mut numbers = vec![0.0; 1 + states + self.header.outputs.len()];
        loop {
            match bytes::<1>(r)?[0] {
                SAMPLE => {
                    for number in &mut numbers {
                        *number = float(r)?;
                    }
                    let (state, outputs) = numbers[1..].split_at(states);
                    if let ControlFlow::Break(()) = sink(numbers[0], state, outputs) {
                        return Err(StreamError::Stopped);
                    }
                }
                TOOK => {
                    let seconds = Duration::try_from_secs_f64(float(r)?);
                    self.took = seconds.map_err(|_| StreamError::Foreign)?;
                }
                ENERGY => {
                    self.energy = Some(Energy {
                        start: float(r)?,
                        end: float(r)?,
                        exchanged: float(r)?,
                        momentum_gap: Some(float(r)?).filter(|gap| !gap.is_nan()),
                        works: list(r, float)?,
                    });
                }
                DOUBT => self.doubts.push(Finding {
                    since: float(r)?,
                    amount: float(r)?,
                    kind: text(r)?,
                    coordinate: text(r)?,
                    message: text(r)?,
                    remedy: text(r)?,
                }),
                NOTE => self.notes.push(text(r)?),
                REPORT => {
                    return Ok(Report {
                        t: float(r)?,
                        steps: count(r)?,
                        rejected: count(r)?,
                        evaluations: count(r)?,
                        jacobians: count(r)?,
                        events: count(r)?,
                        samples: count(r)?,
                        smallest_step: float(r)?,
                        smallest_step_at: float(r)?,
                        smallest_step_for: cause(r)?,
                        largest_step: float(r)?,
                    });
                }
                ERROR => {
                    let kind = match bytes::<1>(r)?[0] {
                        2 => ErrorKind::Job,
                        3 => ErrorKind::Run,
                        _ => return Err(StreamError::Foreign),
                    };
                    let t = Some(float(r)?).filter(|t| !t.is_nan());
                    let coordinate = Some(text(r)?).filter(|name| !name.is_empty());
                    let (cause, message) = (text(r)?, text(r)?);
                    return Err(StreamError::Run(RunError {
                        kind,
                        t,
                        coordinate,
                        cause,
                        message,
                    }));
                }
                _ => return Err(StreamError::Foreign),
            }
        }
    }
}

/// Reads a whole stream: [`StreamReader::new`], then [`StreamReader::read`].
///
/// # Errors
/// As these.
pub fn read_stream(input: impl Read, sink: &mut Sink<'_>) -> Result<Report, StreamError> {
    StreamReader::new(input)?.read(sink)
}

fn put_u32(w: &mut impl Write, value: u32) -> io::Result<()> {
    w.write_all(&value.to_le_bytes())
}

fn put_length(w: &mut impl Write, length: usize) -> io::Result<()> {
    put_u32(w, u32::try_from(length).map_err(io::Error::other)?)
}

fn put_text(w: &mut impl Write, text: &str) -> io::Result<()> {
    put_length(w, text.len())?;
    w.write_all(text.as_bytes())
}

fn put_f64s(w: &mut impl Write, values: &[f64]) -> io::Result<()> {
    values
        .iter()
        .try_for_each(|value| w.write_all(&value.to_le_bytes()))
}

fn put_cause(w: &mut impl Write, cause: Cause) -> io::Result<()> {
    let (kind, index) = match cause {
        Cause::First => (0, 0),
        Cause::Tolerance(index) => (1, index),
        Cause::Largest => (2, 0),
        Cause::Fixed => (3, 0),
        Cause::Breakpoint => (4, 0),
        Cause::Sample => (5, 0),
        Cause::Kink(index) => (6, index),
        Cause::Guard(index) => (7, index),
        Cause::End => (8, 0),
    };
    w.write_all(&[kind])?;
    put_length(w, index)
}

fn cause(r: &mut impl Read) -> Result<Cause, StreamError> {
    let [kind] = bytes(r)?;
    let index = length(r)? as usize;
    Ok(match kind {
        0 => Cause::First,
        1 => Cause::Tolerance(index),
        2 => Cause::Largest,
        3 => Cause::Fixed,
        4 => Cause::Breakpoint,
        5 => Cause::Sample,
        6 => Cause::Kink(index),
        7 => Cause::Guard(index),
        8 => Cause::End,
        _ => return Err(StreamError::Foreign),
    })
}

fn bytes<const N: usize>(r: &mut impl Read) -> Result<[u8; N], StreamError> {
    let mut buffer = [0; N];
    r.read_exact(&mut buffer)?;
    Ok(buffer)
}

fn float(r: &mut impl Read) -> Result<f64, StreamError> {
    Ok(f64::from_le_bytes(bytes(r)?))
}

fn count(r: &mut impl Read) -> Result<u64, StreamError> {
    Ok(u64::from_le_bytes(bytes(r)?))
}

fn length(r: &mut impl Read) -> Result<u32, StreamError> {
    let length = u32::from_le_bytes(bytes(r)?);
    if length > LONGEST {
        Err(StreamError::Foreign)
    } else {
        Ok(length)
    }
}

fn text(r: &mut impl Read) -> Result<String, StreamError> {
    let mut buffer = vec![0; length(r)? as usize];
    r.read_exact(&mut buffer)?;
    String::from_utf8(buffer).map_err(|_| StreamError::Foreign)
}

fn list<R: Read, X>(
    r: &mut R,
    mut item: impl FnMut(&mut R) -> Result<X, StreamError>,
) -> Result<Vec<X>, StreamError> {
    (0..length(r)?).map(|_| item(r)).collect()
}

impl From<io::Error> for StreamError {
    fn from(error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::UnexpectedEof => StreamError::Torn,
            _ => StreamError::Io(error),
        }
    }
}

impl fmt::Display for StreamError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            StreamError::Run(error) => error.fmt(f),
            StreamError::Torn => f.write_str("the program that runs the model ended unexpectedly"),
            StreamError::Foreign => {
                f.write_str("what the program that runs the model wrote is not a run")
            }
            StreamError::Version { found } => write!(
                f,
                "the program that runs the model writes version {found} of the stream, not {VERSION}: compile it again"
            ),
            StreamError::Stopped => f.write_str("the receiver of the samples broke off"),
            StreamError::Io(error) => write!(f, "the program that runs the model: {error}"),
        }
    }
}

impl std::error::Error for StreamError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            StreamError::Run(error) => Some(error),
            StreamError::Io(error) => Some(error),
            _ => None,
        }
    }
}

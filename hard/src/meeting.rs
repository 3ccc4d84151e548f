//! Random scenes in which a ball, a belt or a wheel moves freely for a second, and meets something on its way or not.
//!
//! A method of order 2 or more could take a single step over the free motion, and the end of this step does not show
//! whether something was met within it. The straight line or parabola of the free motion tells this in closed form. If
//! a body goes deeper than a hundredth of its size into another, the end of the run must differ from that of free
//! flight; if it meets nothing, both must agree.

mod shapes;

use crate::bench::{Bench, Trouble};
use crate::case::{Case as HardCase, Group};
use crate::case_model::CaseModel;
use crate::jobs::adaptive;
use crate::random::Random;
use bryant_runtime::program::Job;
use bryant_runtime::{Formula, Tolerances};
use std::f64::consts::TAU;

/// The cases of this group.
pub(crate) const CASES: &[HardCase] = &[HardCase {
    group: Group::NonSmoothness,
    name: "a thousand scenes in which something is met in flight, or not",
    law: "Bodies fly at balls, ellipsoids, plates with edges and corners, belts and stops of 1 mm to 1 m, at 0.1 to 500 m/s. A meeting \
          turns the motion; without a meeting the motion stays as it is. The free flight in closed form tells which of the two must \
          happen.",
    run: meetings,
}];

/// Length of a run \[s\].
pub const DURATION: f64 = 1.0;
/// Methods of single runs, in turn.
pub const FORMULAS: [Formula; 5] = [
    Formula::Dopri5,
    Formula::Tsit5,
    Formula::Dop853,
    Formula::Rodas5,
    Formula::Merson,
];
/// Times between samples of single runs \[s\].
pub const EVERY: [f64; 3] = [1.0, 0.1, 1e-3];
/// Tolerance of all runs.
pub const TOLERANCE: f64 = 1e-6;
/// Number of scenes of each shape.
const SCENES: usize = 170;

/// Whether a free motion meets something.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Met {
    /// The body would go deeper than a hundredth of its size.
    Yes,
    /// Not at all.
    No,
    /// The body would go too little deep to be seen, or the depth is not known.
    Hardly,
}

/// A scene of a shape.
#[derive(Clone, Debug)]
pub struct Case {
    /// The parameters of the shape, in their order.
    pub parameters: Vec<f64>,
    /// The outputs at the end of free flight.
    pub free: Vec<f64>,
    /// Differences of outputs are relative to this.
    pub scale: f64,
    /// Whether the free motion meets something.
    pub met: Met,
}

/// The stiffness that stops and returns a mass of 1 at this speed within a tenth of a size.
fn stiffness(speed: f64, size: f64) -> f64 {
    (speed / (0.1 * size)).powi(2)
}

fn met(depth: f64, size: f64) -> Met {
    match depth / size {
        share if share > 0.01 => Met::Yes,
        share if share < -1e-6 => Met::No,
        _ => Met::Hardly,
    }
}

/// A random number, uniform in its logarithm.
fn of_size(random: &mut Random, low: f64, high: f64) -> f64 {
    low * (high / low).powf(random.uniform(0.0, 1.0))
}

/// A random size \[m\].
fn size(random: &mut Random) -> f64 {
    of_size(random, 1e-3, 1.0)
}

/// A random speed \[m/s\].
fn speed(random: &mut Random) -> f64 {
    of_size(random, 0.1, 500.0)
}

fn direction(random: &mut Random) -> [f64; 2] {
    let angle = random.uniform(0.0, TAU);
    [angle.cos(), angle.sin()]
}

impl Case {
    /// The error in the outputs at the end of a run; `None` if they are as expected.
    pub fn judge(&self, end: &[f64]) -> Option<String> {
        let pairs = self.free.iter().zip(end);
        let away = pairs.map(|(free, end)| (free - end).abs());
        // NaN is kept, too
        let away = away.fold(0.0, |most: f64, x| if x <= most { most } else { x }) / self.scale;
        let wrong = match self.met {
            // a body that goes a hundredth of its size deep is turned by a tenth or more
            Met::Yes => away < 1e-3,
            // the bound is for rounding of positions of hundreds of metres
            Met::No => away > 1e-6,
            Met::Hardly => false,
        };
        (wrong || away.is_nan() || end.len() != self.free.len())
            .then(|| format!("{:?}, but {away:e} away: {:?}", self.met, self.parameters))
    }
}

/// A shape and its scenes.
#[derive(Clone, Debug)]
pub struct Shape {
    /// Its name.
    pub name: &'static str,
    /// Its model.
    pub scene: CaseModel,
    /// Its scenes; all of them clearly meet something or clearly meet nothing.
    pub cases: Vec<Case>,
}

/// All shapes, with `scenes` scenes each.
pub fn shapes(scenes: usize) -> Vec<Shape> {
    let mut random = Random::new(20);
    let all = shapes::all().into_iter();
    all.map(|(name, text, make)| {
        let cases = std::iter::repeat_with(|| make(&mut random))
            .filter(|case| case.met != Met::Hardly)
            .take(scenes);
        Shape {
            name,
            cases: cases.collect(),
            scene: CaseModel::new(name, text),
        }
    })
    .collect()
}

fn meetings(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    for Shape { name, scene, cases } in shapes(SCENES) {
        bench.variant(name);
        let model = scene
            .model()
            .map_err(|problems| Trouble::Refused(problems.to_string()))?;
        let names: Vec<&String> = model.parameters.iter().map(|p| &p.name).collect();
        let (mut wrong, mut met) = (0, 0);
        for (i, case) in cases.iter().enumerate() {
            let values = names.iter().zip(&case.parameters);
            let job = Job {
                parameters: values
                    .map(|(name, value)| ((*name).clone(), *value))
                    .collect(),
                every: Some(EVERY[i % EVERY.len()]),
                ..adaptive(FORMULAS[i % FORMULAS.len()], Tolerances::of(TOLERANCE))
            };
            let run = bench.succeed(&scene, &job)?;
            let end = run.outputs.last().map(Vec::as_slice).unwrap_or_default();
            wrong += usize::from(case.judge(end).is_some());
            met += usize::from(case.met == Met::Yes);
        }
        bench.at_most(
            format!("scenes of {SCENES} whose end is wrong"),
            wrong as f64,
            0.0,
            "",
            "a meeting changes the motion by a tenth or more, a miss by nothing",
        );
        bench.at_least(
            format!("scenes of {SCENES} that meet something"),
            met as f64,
            (SCENES / 5) as f64,
            "",
            "otherwise the family of scenes would prove nothing",
        );
    }
    Ok(())
}

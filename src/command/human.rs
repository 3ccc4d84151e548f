//! `bryant human`: a person as a system of a model.

use super::Error;
use super::outputs::{Outputs, Replacing, is_standard};
use super::terminal::Terminal;
use crate::signature::{self, ContentKind};
use crate::{files, quantity};
use bryant_generator::human::{JOINTS, NAMES, Neutral, Person, Posture, Sex, Size, Written, yaml};
use clap::ValueEnum;
use clap::builder::PossibleValuesParser;
use std::path::PathBuf;

/// Write a person as a system that models include: an adult of a sex, a stature and a mass, a dummy or a child by name
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
16 elements in space, 10 in the plane, where one arm and one leg are both: pelvis, abdomen, thorax, head, arms, hands, legs and feet, hips and shoulders of three hinges, knees and elbows of one, an ellipsoid on each but the hands. The file says of each
group of numbers whether it is derived or assumed. docs/humans.md says how a body is made.

Examples:
  bryant human --sex f --stature '1.62 m' --mass '60 kg' -o woman.yaml
  bryant human --like male-50 --posture seated --name driver -o driver.yaml
  bryant human --like child-6 --posture seated --angle 'trunk=-20 deg' --angle 'thighs=-80 deg'")]
pub struct Arguments {
    /// The sex that the data describe
    #[arg(long, value_enum, required_unless_present = "like")]
    sex: Option<SexName>,

    /// Stature, from sole to vertex
    #[arg(long, value_name = "LENGTH", value_parser = length, required_unless_present_any = ["like", "percentile"], allow_hyphen_values = true)]
    stature: Option<f64>,

    /// Mass of the whole body
    #[arg(long, value_name = "MASS", value_parser = mass, required_unless_present_any = ["like", "percentile"], allow_hyphen_values = true)]
    mass: Option<f64>,

    /// Percentile of stature and of mass, in place of both: from 1 to 99, by ANSUR II (soldiers of the US Army, 2012)
    #[arg(long, value_name = "NUMBER", conflicts_with_all = ["stature", "mass"], requires = "sex")]
    percentile: Option<f64>,

    /// A usual size, in place of sex, stature and mass: a man of 1.753 m and 77.7 kg, one of 1.877 m and 101.2 kg, a
    /// woman of 1.501 m and 49 kg (adults with the masses of the Hybrid III dummies); children of six and of three
    /// years like the Hybrid III
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(NAMES), conflicts_with_all = ["sex", "stature", "mass", "percentile"])]
    like: Option<String>,

    /// Name of the system
    #[arg(long, value_name = "NAME", default_value = "man")]
    name: String,

    /// Posture at the start
    #[arg(long, value_enum, default_value_t = PostureName::Standing)]
    posture: PostureName,

    /// Angle about y, of both sides, that replaces that of the posture: trunk, head, upper_arms, forearms, hands,
    /// thighs, shanks or feet
    #[arg(long = "angle", value_name = "NAME=ANGLE", allow_hyphen_values = true)]
    angles: Vec<String>,

    /// Where the elastic torques of spine and neck are 0: in the posture, or upright whatever the posture
    #[arg(long, value_enum, default_value_t = NeutralName::Posture)]
    neutral: NeutralName,

    /// Write a model in the plane: x forward, z up
    #[arg(long)]
    planar: bool,

    /// Write to this file, instead of to standard output
    #[arg(long, short, alias = "output", value_name = "FILE")]
    out: Option<PathBuf>,

    #[command(flatten)]
    replacing: Replacing,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum SexName {
    /// Female
    #[value(alias = "female")]
    F,
    /// Male
    #[value(alias = "male")]
    M,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum PostureName {
    /// Upright, arms hanging
    Standing,
    /// Thighs forward, shanks down
    Seated,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum NeutralName {
    /// In the posture at the start
    Posture,
    /// Upright
    Upright,
}

fn length(text: &str) -> Result<f64, quantity::QuantityError> {
    quantity::quantity(text, "m")
}

fn mass(text: &str) -> Result<f64, quantity::QuantityError> {
    quantity::quantity(text, "kg")
}

impl Arguments {
    /// Makes the body and writes it.
    pub fn execute(self, terminal: &mut Terminal) -> Result<(), Error> {
        let sex = match self.sex {
            Some(SexName::F) => Sex::Female,
            _ => Sex::Male,
        };
        let named = self.like.as_deref().and_then(Person::named);
        let person = match (named, self.percentile) {
            (Some(person), _) => person,
            (None, Some(percentile)) => {
                let size = Size::percentile(sex, percentile);
                Person::Size(size.ok_or_else(|| {
                    Error::Input(format!("--percentile {percentile}: it is from 1 to 99"))
                })?)
            }
            (None, None) => Person::Size(Size {
                sex,
                stature: self.stature.unwrap_or(f64::NAN),
                mass: self.mass.unwrap_or(f64::NAN),
            }),
        };
        let is_name = self.name.starts_with(|c: char| c.is_ascii_lowercase())
            && self
                .name
                .chars()
                .all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-')
            && !self.name.ends_with('-');
        if !is_name {
            return Err(Error::Input(format!(
                "--name \"{}\": a system has a name of small letters, digits and dashes, such as driver or man-2",
                self.name
            )));
        }
        let mut posture = match self.posture {
            PostureName::Standing => Posture::STANDING,
            PostureName::Seated => Posture::seated(),
        };
        for given in &self.angles {
            posture = with(posture, given)?;
        }
        let written = Written {
            name: &self.name,
            posture,
            planar: self.planar,
            neutral: match self.neutral {
                NeutralName::Posture => Neutral::Posture,
                NeutralName::Upright => Neutral::Upright,
            },
        };
        let text = yaml(&person, written).map_err(Error::Input)?;
        match &self.out {
            Some(path) if !is_standard(path) => {
                let mut outputs = Outputs::of([], self.replacing);
                outputs.take("--out", path, ContentKind::Model)?;
                files::replace(path, |out| {
                    out.write_all(signature::signed(&text).as_bytes())
                })
                .map_err(Error::system)?;
                terminal.note(&format!("wrote {}", path.display()));
                Ok(())
            }
            _ => terminal.print(&text),
        }
    }
}

/// The posture with another angle, which is given as "thighs=-80 deg".
fn with(posture: Posture, given: &str) -> Result<Posture, Error> {
    let (name, angle) = given.split_once('=').ok_or_else(|| {
        Error::Input(format!(
            "--angle \"{given}\": write a name, `=` and an angle, such as 'thighs=-80 deg'"
        ))
    })?;
    let angle = quantity::quantity(angle, "rad")
        .map_err(|error| Error::Input(format!("--angle \"{given}\": {error}")))?;
    posture.with(name, angle).ok_or_else(|| {
        Error::Input(format!(
            "--angle \"{given}\": a body has no angle \"{name}\", but {}",
            JOINTS.join(", ")
        ))
    })
}

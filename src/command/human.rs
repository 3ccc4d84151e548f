//! `bryant human`: an adult as a system of a model.

use super::Error;
use super::outputs::is_standard;
use super::terminal::Terminal;
use crate::human::{Posture, Sex, body, yaml};
use crate::{files, quantity};
use clap::ValueEnum;
use std::path::PathBuf;

/// Write an adult of a sex, a stature and a mass as a system that models include
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
16 elements in space: pelvis, abdomen, thorax, head, arms, hands, legs and feet, hips and shoulders of three hinges, knees and elbows of one, an ellipsoid on each but the hands. The file says of each
group of numbers whether it is derived or assumed. docs/humans.md says how a body is made.

Examples:
  bryant human --sex f --stature '1.62 m' --mass '60 kg' -o woman.yaml
  bryant human --like male-50 --posture seated --name driver -o driver.yaml")]
pub struct Arguments {
    /// The sex that the data are of
    #[arg(long, value_enum, required_unless_present = "like")]
    sex: Option<SexName>,

    /// From sole to vertex
    #[arg(long, value_name = "LENGTH", value_parser = length, required_unless_present = "like", allow_hyphen_values = true)]
    stature: Option<f64>,

    /// Of the whole body
    #[arg(long, value_name = "MASS", value_parser = mass, required_unless_present = "like", allow_hyphen_values = true)]
    mass: Option<f64>,

    /// A usual size instead
    #[arg(long, value_enum, conflicts_with_all = ["sex", "stature", "mass"])]
    like: Option<Like>,

    /// Name of the system
    #[arg(long, value_name = "NAME", default_value = "man")]
    name: String,

    /// How the body is placed at the start
    #[arg(long, value_enum, default_value_t = PostureName::Standing)]
    posture: PostureName,

    /// Write to this file, instead of to standard output
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
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

/// Sizes of dummies' adults.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Like {
    /// A man of 1.753 m and 77.7 kg
    #[value(name = "male-50")]
    Male50,
    /// A man of 1.877 m and 101.2 kg
    #[value(name = "male-95")]
    Male95,
    /// A woman of 1.501 m and 49 kg
    #[value(name = "female-5")]
    Female5,
}

fn length(text: &str) -> Result<f64, quantity::QuantityError> {
    quantity::quantity(text, "m")
}

fn mass(text: &str) -> Result<f64, quantity::QuantityError> {
    quantity::quantity(text, "kg")
}

impl Arguments {
    /// Makes the body, and writes it.
    pub fn execute(self, terminal: &mut Terminal) -> Result<(), Error> {
        let sex = match self.sex {
            Some(SexName::F) => Sex::Female,
            _ => Sex::Male,
        };
        let size = match (self.like, self.stature, self.mass) {
            (Some(Like::Male50), ..) => (Sex::Male, 1.753, 77.7),
            (Some(Like::Male95), ..) => (Sex::Male, 1.877, 101.2),
            (Some(Like::Female5), ..) => (Sex::Female, 1.501, 49.0),
            (None, stature, mass) => (sex, stature.unwrap_or(f64::NAN), mass.unwrap_or(f64::NAN)),
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
        let (sex, stature, mass) = size;
        let body = body(sex, stature, mass).map_err(Error::Input)?;
        let posture = match self.posture {
            PostureName::Standing => Posture::Standing,
            PostureName::Seated => Posture::Seated,
        };
        let text = yaml(&body, &self.name, size, posture);
        match &self.output {
            Some(path) if !is_standard(path) => {
                files::replace(path, |out| out.write_all(text.as_bytes())).map_err(Error::system)
            }
            _ => terminal.print(&text),
        }
    }
}

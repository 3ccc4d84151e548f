//! `bryant human`: an adult as a system of a model.

use super::Error;
use super::outputs::is_standard;
use super::terminal::Terminal;
use crate::{files, quantity};
use bryant_generator::human::{NAMES, Posture, Sex, Size, yaml};
use clap::ValueEnum;
use clap::builder::PossibleValuesParser;
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
    #[arg(long, value_name = "LENGTH", value_parser = length, required_unless_present_any = ["like", "percentile"], allow_hyphen_values = true)]
    stature: Option<f64>,

    /// Of the whole body
    #[arg(long, value_name = "MASS", value_parser = mass, required_unless_present_any = ["like", "percentile"], allow_hyphen_values = true)]
    mass: Option<f64>,

    /// Of stature and of mass instead, from 1 to 99, of ANSUR II: soldiers of the US Army, 2012
    #[arg(long, value_name = "NUMBER", conflicts_with_all = ["stature", "mass"], requires = "sex")]
    percentile: Option<f64>,

    /// A usual size instead: a man of 1.753 m and 77.7 kg, a man of 1.877 m and 101.2 kg, a woman of 1.501 m and 49 kg
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(NAMES), conflicts_with_all = ["sex", "stature", "mass", "percentile"])]
    like: Option<String>,

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
        let size = match (self.like.as_deref().and_then(Size::like), self.percentile) {
            (Some(size), _) => size,
            (None, Some(percentile)) => Size::percentile(sex, percentile).ok_or_else(|| {
                Error::Input(format!("--percentile {percentile}: it is from 1 to 99"))
            })?,
            (None, None) => Size {
                sex,
                stature: self.stature.unwrap_or(f64::NAN),
                mass: self.mass.unwrap_or(f64::NAN),
            },
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
        let posture = match self.posture {
            PostureName::Standing => Posture::Standing,
            PostureName::Seated => Posture::Seated,
        };
        let text = yaml(size, &self.name, posture).map_err(Error::Input)?;
        match &self.output {
            Some(path) if !is_standard(path) => {
                files::replace(path, |out| out.write_all(text.as_bytes())).map_err(Error::system)
            }
            _ => terminal.print(&text),
        }
    }
}

//! `bryant import`: writes a URDF file as a model.

use super::Error;
use super::outputs::{Outputs, Replacing};
use super::terminal::Terminal;
use crate::files;
use crate::signature::{self, ContentKind};
use bryant_generator::description::load::{read_file, shown};
use bryant_generator::model_text::{ModelText, read_text};
use bryant_generator::read;
use bryant_generator::urdf::{Base, Options};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// Write a robot's URDF file, the format of ROS, as a model in YAML
#[derive(Debug, Args)]
#[command(after_long_help = "\
Links become elements and keep their names, with full inertia tensors; joints become joints with their axes; damping and friction
become joint forces, each joint gets a motor with an input, <mimic> becomes `follows`, rotors of transmissions become `armature`. Links without mass that a fixed joint holds become `points`. What is
not taken over, such as shapes and sensors, is listed with its lines. Gravity of 9.81 m/s2 along -z is added.

With --repair-inertias a file without masses can be tried out: links get stand-in masses, joints that move no mass become fixed, tensors of no body become
the nearest ones. Each change is listed, here and in the model: it is then another robot.

Other commands read a URDF file, too: as this one makes it without options.

Examples:
  bryant import panda.urdf -o panda.yaml
  bryant import anymal.urdf --base free --right-angles -o anymal.yaml
  bryant import arm.urdf --stops 1e4 -o arm.yaml
  bryant import industrial-arm.urdf --repair-inertias -o arm.yaml")]
pub struct Arguments {
    /// Path of a URDF file
    file: PathBuf,

    /// Write the model to this file, instead of to standard output
    #[arg(long, short, alias = "output", value_name = "FILE")]
    out: Option<PathBuf>,

    /// What the root link does
    #[arg(long, value_enum, default_value_t = RootLink::Fixed)]
    base: RootLink,

    /// Make stops of this stiffness at the limits of joints [N m/rad, N/m]; without it, limits do not act
    #[arg(long, value_name = "STIFFNESS", value_parser = positive, allow_negative_numbers = true)]
    stops: Option<f64>,

    /// Take angles within 0.001 rad of a multiple of 90 degrees as that multiple
    #[arg(long)]
    right_angles: bool,

    /// Let joints that follow others (<mimic>) move by themselves
    #[arg(long)]
    uncouple: bool,

    /// Leave the joints without motors. Otherwise each has one whose torque or force is an input, within its limit of
    /// effort
    #[arg(long)]
    no_inputs: bool,

    /// Replace masses and inertias that no mechanism can have, and list each change
    #[arg(long)]
    repair_inertias: bool,

    #[command(flatten)]
    replacing: Replacing,
}

/// What the root link does.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum RootLink {
    /// It stands still
    Fixed,
    /// It moves as the forces make it
    Free,
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(value) if f64::is_finite(value) && value > 0.0 => Ok(value),
        _ => Err("give a positive number".to_owned()),
    }
}

impl Arguments {
    /// Reads the robot and writes the model.
    pub fn execute(self, terminal: &mut Terminal) -> Result<(), Error> {
        let name = shown(&self.file);
        let text = read_text(&self.file).map_err(Error::Model)?;
        let options = Options {
            base: match self.base {
                RootLink::Fixed => Base::Fixed,
                RootLink::Free => Base::Free,
            },
            right_angles: self.right_angles,
            stops: self.stops,
            uncouple: self.uncouple,
            inputs: !self.no_inputs,
            repair_inertias: self.repair_inertias.then_some(read::check_str),
        };
        let imported = ModelText::of_urdf(name, text, &options).map_err(Error::Model)?;
        // reads the model once, so that a body that no model can have is found here
        bryant_generator::read_str(&imported.name, &imported.text, &read_file)
            .map_err(|found| Error::Model(imported.in_file(found)))?;
        match &self.out {
            None => terminal.print(&imported.text)?,
            Some(path) => {
                let mut outputs = Outputs::of([&self.file], self.replacing);
                outputs.take("--out", path, ContentKind::Model)?;
                let text = signature::signed(&imported.text);
                files::replace(path, |file| file.write_all(text.as_bytes()))
                    .map_err(Error::system)?;
            }
        }
        for note in imported.notes() {
            terminal.note(note);
        }
        if let Some(path) = &self.out {
            terminal.note(&format!("wrote {}", path.display()));
        }
        Ok(())
    }
}

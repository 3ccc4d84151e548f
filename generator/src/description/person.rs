//! People among the included: a person by size and posture, as the text of a file.

use super::place::At;
use super::quantity::Quantity;
use super::shape::Problems;
use super::shape::Shape as _;
use super::short_forms::{Human, HumanAngles, HumanName, HumanNeutral, HumanPosture, HumanSex};
use super::tree::NodeKind;
use super::unit::{Dimension, unit};
use crate::diagnostic::quoted;
use crate::human::{Neutral, Person, Posture, Sex, Size, Written, yaml};

/// The text of a person who stands at `at`, with the keys `human` and `system`; what is wrong is reported.
pub fn text(at: At<'_>, planar: bool, problems: &Problems) -> Option<String> {
    let human = at.key("human");
    let written = Human::read(&human.node.value()).ok()?;
    let person = person(&written, human, problems)?;
    let mut posture = match written.posture {
        Some(HumanPosture::Seated) => Posture::seated(),
        Some(HumanPosture::Standing) | None => Posture::STANDING,
    };
    if let Some(angles) = &written.angles {
        posture = with(posture, angles, human.key("angles"), problems)?;
    }
    let system = at.key("system");
    let name = system.node.text().unwrap_or_default().to_owned();
    if !is_word(&name, '-') {
        problems.add(system.problem(
            format!("{} is no name", quoted(&name)),
            "write small letters, digits and dashes, a letter first, such as driver or man-2",
        ));
        return None;
    }
    let how = Written {
        name: &name,
        posture,
        planar,
        neutral: match written.neutral {
            Some(HumanNeutral::Upright) => Neutral::Upright,
            Some(HumanNeutral::Posture) | None => Neutral::Posture,
        },
    };
    match yaml(&person, how) {
        Ok(text) => Some(text),
        Err(reason) => {
            let help = "give another size; `bryant human` writes a body to a file, where every number can be changed";
            problems.add(human.problem(reason, help));
            None
        }
    }
}

/// A posture with other angles.
fn with(
    posture: Posture,
    angles: &HumanAngles,
    at: At<'_>,
    problems: &Problems,
) -> Option<Posture> {
    let angles = [
        ("trunk", &angles.trunk),
        ("head", &angles.head),
        ("upper_arms", &angles.upper_arms),
        ("forearms", &angles.forearms),
        ("hands", &angles.hands),
        ("thighs", &angles.thighs),
        ("shanks", &angles.shanks),
        ("feet", &angles.feet),
    ];
    let mut all = Some(posture);
    for (joint, angle) in angles {
        let Some(angle) = angle else { continue };
        let number = plain(angle, "rad", at.key(joint), problems);
        all = all.and_then(|posture| posture.with(joint, number?));
    }
    all
}

/// A finite number of a unit of SI; anything else is reported.
pub fn plain(quantity: &Quantity, of: &str, at: At<'_>, problems: &Problems) -> Option<f64> {
    let number = number(quantity, of);
    if number.is_none() {
        let unit = match of {
            "" => "a number".to_owned(),
            of => format!("a number of {of}, or one with its unit"),
        };
        problems.add(at.problem(
            "this is no number that a body can be made of",
            format!("write {unit}; parameters cannot stand here"),
        ));
    }
    number
}

fn person(written: &Human, at: At<'_>, problems: &Problems) -> Option<Person> {
    const HELP: &str = "write `{ like: male-50 }`, `{ sex: f, percentile: 5 }` or `{ sex: f, stature: 1.62 m, mass: 60 kg }`";
    let sex = written.sex.map(|sex| match sex {
        HumanSex::Female => Sex::Female,
        HumanSex::Male => Sex::Male,
    });
    let number =
        |key: &str, quantity: &Quantity, of: &str| plain(quantity, of, at.key(key), problems);
    match (
        written.like,
        sex,
        &written.percentile,
        &written.stature,
        &written.mass,
    ) {
        (Some(like), None, None, None, None) => Person::named(match like {
            HumanName::Male50 => "male-50",
            HumanName::Male95 => "male-95",
            HumanName::Female5 => "female-5",
            HumanName::Hybrid50 => "hybrid-3-50",
            HumanName::Hybrid5 => "hybrid-3-5",
            HumanName::Child6 => "child-6",
            HumanName::Child3 => "child-3",
        }),
        (None, Some(sex), Some(percentile), None, None) => {
            let percentile = number("percentile", percentile, "")?;
            let size = Size::percentile(sex, percentile);
            if size.is_none() {
                problems.add(at.key("percentile").problem(
                    format!("there is no percentile {percentile} in the data"),
                    "give a number from 1 to 99",
                ));
            }
            size.map(Person::Size)
        }
        (None, Some(sex), None, Some(stature), Some(mass)) => {
            let (stature, mass) = (number("stature", stature, "m"), number("mass", mass, "kg"));
            Some(Person::Size(Size {
                sex,
                stature: stature?,
                mass: mass?,
            }))
        }
        _ => {
            problems.add(at.problem(
                "it is not said, or said twice, what size the person has",
                HELP,
            ));
            None
        }
    }
}

/// A finite number of a unit of SI; a text has a unit of its dimension.
fn number(quantity: &Quantity, of: &str) -> Option<f64> {
    let (number, given) = match quantity {
        Quantity::Number(number) => (*number, of),
        Quantity::Text(text) => {
            let (number, unit) = text.trim().split_once(' ')?;
            (number.parse().ok()?, unit.trim())
        }
        Quantity::Param(_) => return None,
    };
    let dimension = |name: &str| match name {
        "" => Some((1.0, Dimension::ONE)),
        name => unit(name).map(|unit| (unit.factor, unit.dimension)),
    };
    let ((factor, given), (_, wanted)) = (dimension(given)?, dimension(of)?);
    let number = number * factor;
    (given == wanted && number.is_finite()).then_some(number)
}

/// Whether a text is a name of small letters and digits, with a letter first, whose words are joined so.
pub fn is_word(text: &str, joint: char) -> bool {
    let may = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == joint;
    text.starts_with(|c: char| c.is_ascii_lowercase())
        && text.chars().all(may)
        && !text.ends_with(joint)
}

/// Whether an entry of `include` is a person.
pub fn is_person(at: At<'_>) -> bool {
    matches!(at.node.kind, NodeKind::Map(_)) && at.node.get("human").is_some()
}

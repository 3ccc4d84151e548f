//! Outputs of a belt: of the whole, of a segment, of a ring.

use super::check::{Belt, check_length};
use crate::description::output::Output as Written;
use crate::description::place::At;
use crate::diagnostic::quoted;
use crate::expression::Expr;
use crate::expression::vector::Vec3;
use crate::force::{Measures, Value};
use crate::model::law::{OfLaw, Visible};
use crate::model::look::{Line, Look};
use crate::model::resolve::Resolver;
use crate::model::resolve::law::Outputs;
use crate::model::resolve::output::has_direction;
use crate::model::{Body, Quantity};
use serde::Serialize;

/// A quantity of a belt.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum BeltQuantity {
    /// Tension \[N\].
    Force,
    /// Distance of the attachments \[m\].
    Length,
    /// (L − L₀)/L₀.
    Elongation,
    /// L₀ \[m\].
    UntensionedLength,
    /// Growth of L₀ since the start \[m\]; if the belt runs through rings, the sum over all segments.
    Payout,
    /// Untensioned length of webbing that has slipped through a ring since the start, positive from the side of `from`
    /// \[m\].
    Slip,
    /// Elongation at which the force on the unloading line is 0; 0 without hysteresis.
    PermanentSet,
}

/// A quantity of a belt, and the part that it belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct BeltOutput {
    /// Index of the segment or ring, counted from the end `from`; 0 in a belt without rings.
    pub part: usize,
    /// The quantity.
    pub what: BeltQuantity,
}

impl OfLaw for BeltOutput {
    fn boxed(&self) -> Box<dyn OfLaw> {
        Box::new(*self)
    }
}

const TABLE: [(&str, &str, BeltQuantity); 7] = [
    ("force", "N", BeltQuantity::Force),
    ("length", "m", BeltQuantity::Length),
    ("elongation", "", BeltQuantity::Elongation),
    ("untensioned_length", "m", BeltQuantity::UntensionedLength),
    ("payout", "m", BeltQuantity::Payout),
    ("permanent_set", "", BeltQuantity::PermanentSet),
    ("slip", "m", BeltQuantity::Slip),
];

impl Outputs for Belt {
    fn output(
        &self,
        resolver: &Resolver<'_>,
        written: &Written,
        force: usize,
        at: At<'_>,
    ) -> Option<(Quantity, &'static str)> {
        resolver.without(at, &["at", "about", "relative_to"], "a belt");
        let (what, unit) = resolver.look_up(written, &TABLE, "a belt", at)?;
        if what == BeltQuantity::Force && has_direction(written) {
            resolver.without(at, &["segment", "ring"], "the force on a body");
            let quantity = match self.rings.is_empty() {
                true => resolver.force_on(written, force, [self.from.on, self.to.on], at)?,
                false => {
                    let bodies: Vec<Body> = self.points().map(|point| point.on).collect();
                    resolver.on_points(written, force, &bodies, at)?
                }
            };
            return Some((quantity, unit));
        }
        let part = match what {
            BeltQuantity::Slip => {
                resolver.without(at, &["segment"], "the slip through a ring");
                ring(resolver, written, self, at)
            }
            BeltQuantity::Payout => {
                resolver.without(at, &["segment", "ring"], "the whole belt");
                Some(0)
            }
            _ => {
                resolver.without(at, &["ring"], "anything but `what: slip`");
                segment(resolver, written, self, at)
            }
        };
        let asked = BeltOutput {
            part: part.unwrap_or_default(),
            what,
        };
        let quantity = resolver.scalar(force, asked, at);
        part.map(|_| (quantity, unit))
    }

    fn check_start(&self, resolver: &Resolver<'_>, name: &str, at: At<'_>) {
        check_length(self, resolver, name, at);
    }
}

impl Visible for Belt {
    fn looks(&self) -> Vec<Look<'_>> {
        vec![Look::Line(Line::Belt(self), self.points().collect())]
    }
}

/// The ring that an output names.
fn ring(resolver: &Resolver<'_>, written: &Written, belt: &Belt, at: At<'_>) -> Option<usize> {
    let names: Vec<String> = belt.rings.iter().map(|ring| quoted(&ring.name)).collect();
    let help = match names.is_empty() {
        true => "write the rings of the belt in its `through`".to_owned(),
        false => format!("name one by `ring:`; the belt has {}", names.join(", ")),
    };
    let Some(name) = &written.ring else {
        let problem = "the slip of a belt is that through one of its rings";
        resolver.problems.add(at.key("what").problem(problem, help));
        return None;
    };
    let found = belt.rings.iter().position(|ring| ring.name == *name);
    if found.is_none() {
        let problem = format!("the belt has no ring {}", quoted(name));
        resolver.problems.add(at.key("ring").problem(problem, help));
    }
    found
}

/// Index of the segment that an output asks for.
fn segment(resolver: &Resolver<'_>, written: &Written, belt: &Belt, at: At<'_>) -> Option<usize> {
    let count = belt.rings.len() + 1;
    match written.segment {
        None if count == 1 => Some(0),
        Some(number) if (1..=count).contains(&(number as usize)) => Some(number as usize - 1),
        None => {
            resolver.problems.add(at.key("what").problem(
                format!(
                    "the belt runs through rings, and each of its {count} segments has its own {}",
                    written.what
                ),
                format!("add `segment: 1` for that at its end `from`, up to `segment: {count}`"),
            ));
            None
        }
        Some(number) => {
            resolver.problems.add(at.key("segment").problem(
                format!("the belt has no segment {number}"),
                format!("segments are counted from 1, at the end `from`, to {count}"),
            ));
            None
        }
    }
}

/// Expressions of the quantities of a belt.
pub struct BeltMeasures<'g> {
    /// The force on each point of the belt, from the end `from` to the end `to` \[N\].
    pub on: Vec<Vec3<'g>>,
    /// The straight parts, from `from` on.
    pub segments: Vec<SegmentMeasures<'g>>,
    /// Length that has slipped through each ring, positive from the side of `from` \[m\].
    pub slipped: Vec<Expr<'g>>,
    /// Growth of the untensioned length since the start \[m\].
    pub payout: Expr<'g>,
}

/// Expressions of the quantities of a straight part of a belt.
#[derive(Clone, Copy)]
pub struct SegmentMeasures<'g> {
    /// Tension \[N\].
    pub tension: Expr<'g>,
    /// Distance of the end points \[m\].
    pub length: Expr<'g>,
    /// Relative elongation.
    pub elongation: Expr<'g>,
    /// Untensioned length \[m\].
    pub untensioned: Expr<'g>,
    /// Elongation at which the force on the unloading line is 0; 0 without hysteresis.
    pub permanent_set: Expr<'g>,
}

impl<'g> Measures<'g> for BeltMeasures<'g> {
    fn on(&self) -> Vec<Vec3<'g>> {
        self.on.clone()
    }

    fn value(&self, asked: &dyn OfLaw) -> Option<Value<'g>> {
        let BeltOutput { part, what } = asked.get()?;
        Some(Value::Scalar(match what {
            BeltQuantity::Force => self.segments[*part].tension,
            BeltQuantity::Length => self.segments[*part].length,
            BeltQuantity::Elongation => self.segments[*part].elongation,
            BeltQuantity::UntensionedLength => self.segments[*part].untensioned,
            BeltQuantity::Payout => self.payout,
            BeltQuantity::PermanentSet => self.segments[*part].permanent_set,
            BeltQuantity::Slip => self.slipped[*part],
        }))
    }
}

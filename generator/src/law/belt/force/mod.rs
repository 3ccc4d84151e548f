//! Belt: a tension along the line between two attachments, or along the lines between successive rings. \[MADYMO 1980,
//! force model 4\]
//!
//! d = p_to − p_from,   L = |d|,   n = d/L,   L̇ = n · ḋ,   ε = (L − ℓ)/ℓ
//!
//! T = tension(ε, curve(ε), damping · min((L − ℓ)/stretch, 1) · (L̇ + ṙ))
//!
//! +T n acts on `from`, −T n on `to`. The untensioned length ℓ is L₀, which is given, or is the initial distance plus
//! slack, or is such that the belt pulls with its pretension at the initial distance: L₀ = L_start/(1 + ε_p) with
//! curve(ε_p) = pretension. A retractor, pretensioner or limiter (`webbing`) changes ℓ, taking in webbing at the rate
//! ṙ. Until the retractor locks, T is the tension of its spool; T is never larger than the force of the limiter.
//!
//! In a belt with rings, each line between two successive points is a segment with a tension of its own. Webbing slips
//! from one segment to the next (`ring.rs`); sᵢ is the length that has slipped out of segment i through the ring at its
//! end. For segment i
//!
//! ℓᵢ = L₀ᵢ + sᵢ₋₁ − sᵢ,   ε̇ᵢ = (L̇ᵢ − (Lᵢ/ℓᵢ) ℓ̇ᵢ)/ℓᵢ,   Tᵢ = tension(εᵢ, curve(εᵢ), damping · min(…, 1) · L₀ ε̇ᵢ)
//!
//! where L₀ = Σ L₀ᵢ: segments with equal strain rates are damped alike, whatever their lengths. The devices change ℓ₁.
//!
//! The power −T L̇ on the bodies is split up: the part that stretches the webbing, −T (L̇ − ℓ̇), goes to `elastic`,
//! `damping` and `limiter`, T ṙ to the `pretensioner`, and all of it to the `retractor` until the retractor locks; the
//! power lost in slip, ṡ (T_before − T_behind), goes to the ring.

mod ring;
mod webbing;

use super::check::SHORTEST;
use super::check::must_have_length;
use super::outputs::{BeltMeasures, SegmentMeasures};
use crate::expression::choose;
use crate::expression::vector::Vec3;
use crate::expression::{Expr, Graph};
use crate::force::branches::one_sided;
use crate::force::fade::faded;
use crate::force::hysteresis;
use crate::force::onset::{FAR, Onset, absolute, size};
use crate::force::switch::Gate;
use crate::force::{Acts, AppliedForces, Product};
use crate::force::{Equations, Measures, Setting};
use crate::law::belt::check::{Belt, BeltLength};
use crate::model::{Attachment, Model};
use crate::motion::numbers::{curve, inverse, number, vector};
use crate::motion::{Motion, Point};
use ring::Ring;
use webbing::{Limiter, NOISE, Webbing, webbing};

/// Lower bound of the squared length in divisions \[m²\]: ends that are closer than 1e-10 m give a direction of
/// (nearly) 0 and so no force, instead of NaN.
///
/// Generated text has no branches, so both the slack and the taut case are computed, and every divisor must be nonzero
/// in every state. The untensioned length is positive by the rules for its numbers (`terms.rs` of this law,
/// `dynamics/conditions.rs`), and at least [`SHORTEST`] if a pretensioner or slip through a ring takes webbing in. 1 +
/// ε and the resistance of a ring (`webbing.rs`, `ring.rs`), the slope of unloading and the stretch of damping are
/// positive by their rules.
const SMALLEST_SQUARED_LENGTH: f64 = 1e-20;

/// A belt that is being applied.
#[derive(Clone, Copy)]
pub struct Law<'a, 'g> {
    /// The graph of the expressions.
    pub graph: &'g Graph,
    /// The model that the belt belongs to.
    pub model: &'a Model,
    /// Name of the belt.
    pub name: &'a str,
    /// Condition under which the belt acts.
    pub gate: Gate<'g>,
    /// The checked form of the belt.
    pub belt: &'a Belt,
}

/// A straight part of a belt, between two successive points.
pub struct Segment<'g> {
    /// Name of the segment in messages.
    owner: String,
    /// Unit vector from the first point to the second.
    pub direction: Vec3<'g>,
    /// Velocity of the second point relative to the first \[m/s\].
    moving: Vec3<'g>,
    /// Distance of the points \[m\].
    span: Expr<'g>,
    /// Rate of the distance \[m/s\].
    rate: Expr<'g>,
    /// The webbing of the segment.
    pub webbing: Webbing<'g>,
    /// (L − ℓ)/ℓ
    elongation: Expr<'g>,
    /// Elastic tension, not yet limited \[N\].
    elastic: Expr<'g>,
    /// Elongation at which the force on the unloading line is 0.
    permanent_set: Expr<'g>,
    /// Number of curves registered before those of this segment.
    curves: usize,
    /// Tension without damping, valid once a retractor has locked \[N\].
    undamped: Expr<'g>,
    /// Rate at which webbing leaves the segment: through its rings, less the rate at which it comes off the reel
    /// \[m/s\].
    leaving: Expr<'g>,
}

impl Equations for Belt {
    fn apply<'g>(
        &self,
        setting: Setting<'_, 'g>,
        applied: &mut AppliedForces<'g>,
    ) -> Box<dyn Measures<'g> + 'g> {
        let Setting {
            graph,
            model,
            motion,
            start,
            name,
            gate,
            ..
        } = setting;
        let law = Law {
            graph,
            model,
            name,
            gate,
            belt: self,
        };
        Box::new(apply(law, motion, start, applied))
    }

    fn condition<'g>(
        &self,
        graph: &'g Graph,
        start: &Motion<'g>,
        name: &str,
    ) -> Option<(String, Expr<'g>)> {
        let length = length_at_start(graph, start, self);
        Some((must_have_length(name), length))
    }
}

/// Applies a belt. `start` is the motion that determines its initial lengths.
fn apply<'g>(
    law: Law<'_, 'g>,
    motion: &Motion<'g>,
    start: &Motion<'g>,
    applied: &mut AppliedForces<'g>,
) -> BeltMeasures<'g> {
    let Law { graph, belt, .. } = law;
    let points: Vec<Point<'g>> = belt
        .points()
        .map(|point| motion.attachment(graph, point))
        .collect();
    let rings = ring::rings(law, applied);
    let slipped = |index: Option<usize>| Some(rings.get(index?)?.slipped);
    let mut segments = Vec::new();
    let mut initials: Vec<Expr<'g>> = Vec::new();
    for (index, ends) in points.windows(2).enumerate() {
        let rigid = between(graph, nth(belt, index), nth(belt, index + 1));
        let (span, direction, rate) = straight(graph, [&ends[0], &ends[1]], rigid);
        if initials.is_empty() {
            initials = initial_lengths(graph, start, belt);
        }
        let fed = [slipped(index.checked_sub(1)), slipped(Some(index))];
        let moving = match rigid {
            Some(_) => Vec3::zero(graph),
            None => ends[1].velocity - ends[0].velocity,
        };
        let line = (span, direction, rate, moving);
        segments.push(segment(law, applied, index, line, &initials, fed));
    }
    let slips = ring::slip(law, applied, &rings, &mut segments);
    for segment in &segments {
        segment.watch(law, applied);
    }
    let whole = segments[1..]
        .iter()
        .fold(segments[0].webbing.initial, |sum, s| {
            sum + s.webbing.initial
        });
    let mut pulls = Vec::new();
    let mut measures = Vec::new();
    for (index, segment) in segments.iter().enumerate() {
        let whole = (!rings.is_empty()).then_some(whole);
        let tension = segment.pull(law, applied, whole);
        let pull = tension * segment.direction;
        applied.apply(nth(belt, index).on, points[index].offset, pull);
        applied.apply(nth(belt, index + 1).on, points[index + 1].offset, -pull);
        pulls.push(pull);
        measures.push(SegmentMeasures {
            tension,
            length: segment.span,
            elongation: segment.elongation,
            untensioned: segment.webbing.length,
            permanent_set: segment.permanent_set,
        });
    }
    ring::works(law, applied, &slips, &measures);
    let first = &segments[0].webbing;
    let payout = segments[1..]
        .iter()
        .fold(first.length - first.initial, |sum, s| {
            sum + (s.webbing.length - s.webbing.initial)
        });
    BeltMeasures {
        on: on_points(&pulls),
        segments: measures,
        slipped: rings.iter().map(|ring: &Ring<'g>| ring.slipped).collect(),
        payout,
    }
}

/// The force on each point of a belt. `pulls` are the force vectors of its segments.
fn on_points<'g>(pulls: &[Vec3<'g>]) -> Vec<Vec3<'g>> {
    let last = pulls.len();
    let on = |index: usize| match index {
        0 => pulls[0],
        _ if index == last => -pulls[last - 1],
        _ => pulls[index] - pulls[index - 1],
    };
    (0..=last).map(on).collect()
}

fn nth(belt: &Belt, index: usize) -> &Attachment {
    belt.points().nth(index).unwrap_or(&belt.to)
}

/// Distance of two points of the same body, which is constant; `None` if they are on different bodies.
fn between<'g>(graph: &'g Graph, from: &Attachment, to: &Attachment) -> Option<Expr<'g>> {
    let apart = || vector(graph, &to.at) - vector(graph, &from.at);
    (from.on == to.on).then(|| length(graph, apart().squared()))
}

/// Distance of two points, unit vector from the first to the second, and rate of the distance. `rigid` is the distance
/// if both points are on the same body: a rate computed from their motions would be rounding, whose sign changes at
/// every step.
fn straight<'g>(
    graph: &'g Graph,
    [from, to]: [&Point<'g>; 2],
    rigid: Option<Expr<'g>>,
) -> (Expr<'g>, Vec3<'g>, Expr<'g>) {
    let between = to.position - from.position;
    let span = rigid.unwrap_or_else(|| length(graph, between.squared()));
    let direction = span.recip() * between;
    let rate = match rigid {
        Some(_) => graph.constant(0.0),
        None => direction.dot(to.velocity - from.velocity),
    };
    (span, direction, rate)
}

/// A segment with its elastic tension. A length `fed[0]` of webbing has slipped into it, and `fed[1]` out of it.
fn segment<'g>(
    law: Law<'_, 'g>,
    applied: &mut AppliedForces<'g>,
    index: usize,
    (span, direction, rate, moving): (Expr<'g>, Vec3<'g>, Expr<'g>, Vec3<'g>),
    initials: &[Expr<'g>],
    fed: [Option<Expr<'g>>; 2],
) -> Segment<'g> {
    let Law {
        graph, name, belt, ..
    } = law;
    let untensioned = untensioned_length(graph, belt, initials, index);
    let webbing = match index {
        0 => webbing(law, applied, [span, initials[0]], untensioned, fed[1]),
        _ => Webbing::without_devices(untensioned, fed),
    };
    let elongation = span / webbing.length - graph.constant(1.0);
    let owner = match belt.rings.is_empty() {
        true => format!("belt {name}"),
        false => format!("belt {name} segment {}", index + 1),
    };
    let curves = applied.curves_so_far();
    let one = graph.constant(1.0);
    let below = move || webbing.once_locked(elongation, -one);
    applied.curve_of_state(&owner, "curve", "", &belt.force, Acts::AboveFirst, below);
    let (elastic, permanent_set) = elastic(law, applied, &owner, span / webbing.length, below);
    let mut segment = Segment {
        owner,
        direction,
        moving,
        span,
        rate,
        webbing,
        elongation,
        elastic,
        permanent_set,
        curves,
        undamped: graph.constant(0.0),
        leaving: graph.constant(0.0),
    };
    segment.undamped = segment.tension(law, graph.constant(0.0));
    segment
}

impl<'g> Segment<'g> {
    /// Tension with a viscous force, valid once a retractor has locked \[N\].
    fn tension(&self, law: Law<'_, 'g>, viscous: Expr<'g>) -> Expr<'g> {
        let tension = one_sided(self.elongation, self.elastic, viscous);
        let limit = self.webbing.limiter.map(|limiter| limiter.force);
        law.gate
            .of(limit.map_or(tension, |limit| tension.min(limit)))
    }

    /// Tension without damping; that of the reel while it is not locked \[N\].
    pub fn held(&self, law: Law<'_, 'g>) -> Expr<'g> {
        match self.webbing.retractor {
            Some((_, spool)) => self.webbing.once_locked(self.undamped, law.gate.of(spool)),
            None => self.undamped,
        }
    }

    /// Watches where the limiter begins and ends to pay out, and where a hysteresis changes between loading and
    /// unloading.
    fn watch(&self, law: Law<'_, 'g>, applied: &mut AppliedForces<'g>) {
        let (webbing, graph) = (self.webbing, law.graph);
        webbing.watch_limiter(applied, law.name, [self.rate, self.leaving]);
        if law.belt.hysteresis.is_some() {
            let (zero, one) = (graph.constant(0.0), graph.constant(1.0));
            let ratio = self.span / webbing.length;
            let growing = self.rate + ratio * (webbing.taken_in + self.leaving);
            let growing = webbing.once_locked(growing, one);
            let growing = match law.belt.rings.is_empty() {
                true => growing,
                false => self.beyond_noise(applied, growing),
            };
            let elongation = (ratio - one).max(zero);
            hysteresis::watch_turns(applied, &self.owner, elongation, growing);
        }
    }

    /// An event function for the turns of `growing`, with a dead band of ± [`NOISE`]: it changes its sign when a
    /// segment that was lengthening shortens faster than the noise, or the other way round. A memory holds which of the
    /// two the segment did last.
    fn beyond_noise(&self, applied: &mut AppliedForces<'g>, growing: Expr<'g>) -> Expr<'g> {
        let graph = growing.graph();
        let (zero, one, half) = (
            graph.constant(0.0),
            graph.constant(1.0),
            graph.constant(0.5),
        );
        let (index, lengthens) = applied.memory(format!("{}: lengthens", self.owner), "", one);
        let noise = graph.constant(NOISE);
        let event_function = choose(half, lengthens, growing + noise, noise - growing);
        let turned = choose(half, lengthens, zero, one);
        applied.states.memory[index].next = choose(event_function, zero, turned, lengthens);
        event_function
    }

    /// Adds the kinks of the tension without damping, which drives the slip of webbing.
    pub fn tell_held(&self, applied: &mut AppliedForces<'g>) {
        let (webbing, elongation, elastic) = (self.webbing, self.elongation, self.elastic);
        let one = elongation.graph().constant(1.0);
        applied.kink(format!("{}: goes taut", self.owner), move || {
            webbing.once_locked(elongation, one)
        });
        if let Some(limiter) = webbing.limiter {
            applied.kink(format!("{}: reaches the limiter", self.owner), move || {
                webbing.once_locked(elastic - limiter.force, one)
            });
        }
    }

    /// Adds a rate at which webbing leaves the segment \[m/s\].
    pub fn leaves(&mut self, rate: Expr<'g>) {
        self.leaving = self.leaving + rate;
    }

    /// The tension; adds kinks, events and powers of the segment. `whole` is the untensioned length of the whole belt,
    /// if it runs through rings \[m\].
    fn pull(
        &self,
        law: Law<'_, 'g>,
        applied: &mut AppliedForces<'g>,
        whole: Option<Expr<'g>>,
    ) -> Expr<'g> {
        let Law {
            graph, gate, belt, ..
        } = law;
        let (webbing, span, elongation) = (self.webbing, self.span, self.elongation);
        let one = graph.constant(1.0);
        let stretching = self.rate + webbing.taken_in + self.leaving;
        let stretched = match &belt.damping {
            Some(damping) => {
                let damped = match whole {
                    Some(whole) => {
                        let rate = (self.rate
                            + span / webbing.length * (webbing.taken_in + self.leaving))
                            / webbing.length;
                        whole * rate
                    }
                    None => stretching,
                };
                self.damped(law, applied, number(graph, damping), damped)
            }
            None => {
                applied.kink(format!("{}: goes taut", self.owner), move || {
                    webbing.once_locked(elongation, one)
                });
                self.undamped
            }
        };
        self.tell(law, applied);
        let spool = webbing.retractor.map(|(_, spool)| gate.of(spool));
        let tension = spool.map_or(stretched, |spool| webbing.once_locked(stretched, spool));
        applied.curves_act(self.curves, tension);
        let tensions = [self.undamped, stretched];
        works(graph, applied, self, tensions, spool, stretching);
        tension
    }

    /// The tension with a damping force: the coefficient `damping` times the rate `rate`, faded in.
    fn damped(
        &self,
        law: Law<'_, 'g>,
        applied: &mut AppliedForces<'g>,
        damping: Expr<'g>,
        rate: Expr<'g>,
    ) -> Expr<'g> {
        let Law { graph, belt, .. } = law;
        let (webbing, span, owner) = (self.webbing, self.span, &self.owner);
        let (elongation, elastic) = (self.elongation, self.elastic);
        let (zero, one) = (graph.constant(0.0), graph.constant(1.0));
        let fade = faded(
            graph,
            span - webbing.undamped,
            belt.damping_stretch.as_ref(),
        );
        // after the retractor has locked, the belt may be shorter than its undamped length and yet taut
        let fade = match webbing.retractor {
            Some(_) => fade.max(graph.constant(0.0)),
            None => fade,
        };
        let viscous = damping * fade * rate;
        // the tension begins where the belt goes taut; it ends while the belt is still stretched if damping would make
        // it negative
        applied.kink(format!("{owner}: pulls"), move || {
            let pulls = choose(zero, elongation, elastic + viscous, elongation);
            webbing.once_locked(pulls, one)
        });
        if let Some(limiter) = webbing.limiter {
            applied.kink(
                format!("{owner}: pulls with the force of the limiter"),
                move || webbing.once_locked(elastic + viscous - limiter.force, one),
            );
        }
        if let Some(stretch) = belt.damping_stretch.clone() {
            let beyond = move || span - webbing.undamped;
            if webbing.retractor.is_some() {
                applied.kink(format!("{owner}: damping sets in"), move || {
                    webbing.once_locked(beyond(), one)
                });
            }
            applied.kink(format!("{owner}: damping is full"), move || {
                webbing.once_locked(beyond() - number(graph, &stretch), one)
            });
        }
        self.tension(law, viscous)
    }

    /// Adds the corners of the segment's curves, and the distance from going taut.
    fn tell(&self, law: Law<'_, 'g>, applied: &mut AppliedForces<'g>) {
        let Law {
            graph, gate, belt, ..
        } = law;
        let (webbing, span, moving) = (self.webbing, self.span, self.moving);
        let (elongation, leaving) = (self.elongation, self.leaving);
        let one = graph.constant(1.0);
        let below = move || webbing.once_locked(elongation, -one);
        // webbing leaves only through rings, or comes off a film spool
        let speed = move || match leaving.is_zero() {
            true => size(moving) + absolute(webbing.taken_in),
            false => size(moving) + absolute(webbing.taken_in) + absolute(leaving),
        };
        let unloading = belt.hysteresis.as_ref().map(|law| &law.unloading);
        let belt_curves = [
            (Some(&belt.force), "curve"),
            (unloading.and_then(Option::as_ref), "unloading curve"),
        ];
        for (curve, which) in belt_curves {
            let Some(curve) = curve else { continue };
            applied.corners(&self.owner, which, gate, curve, below, move || {
                speed() / webbing.length
            });
        }
        applied.onset(format!("{}: goes taut", self.owner), move || {
            gate.of_onset(Onset {
                gap: webbing.once_locked(webbing.length - span, graph.constant(FAR)),
                speed: speed(),
            })
        });
    }
}

impl<'g> Webbing<'g> {
    /// `then` once the retractor has locked, or if there is none; `otherwise` before.
    pub fn once_locked(&self, then: Expr<'g>, otherwise: Expr<'g>) -> Expr<'g> {
        self.retractor
            .map_or(then, |(lock, _)| lock.once(then, otherwise))
    }
}

/// The elastic tension, and the permanent elongation.
fn elastic<'g>(
    law: Law<'_, 'g>,
    applied: &mut AppliedForces<'g>,
    owner: &str,
    ratio: Expr<'g>,
    below: impl Fn() -> Expr<'g> + Copy + 'g,
) -> (Expr<'g>, Expr<'g>) {
    let Law {
        graph, gate, belt, ..
    } = law;
    let (zero, one) = (graph.constant(0.0), graph.constant(1.0));
    match &belt.hysteresis {
        Some(law) => {
            // the memory of a hysteresis must be finite, and a curve need not have a value while the belt is slack
            let elongation = (ratio - one).max(zero);
            let loading = curve(graph, &belt.force, elongation);
            hysteresis::apply(applied, owner, "", law, gate, elongation, loading, below)
        }
        None => (curve(graph, &belt.force, ratio - one), zero),
    }
}

/// Adds the powers of a segment. The webbing pulls with `undamped`, or with damping with `stretched`, and is stretched
/// at the rate `stretching`.
fn works<'g>(
    graph: &'g Graph,
    applied: &mut AppliedForces<'g>,
    segment: &Segment<'g>,
    [undamped, stretched]: [Expr<'g>; 2],
    spool: Option<Expr<'g>>,
    stretching: Expr<'g>,
) {
    let (zero, half) = (graph.constant(0.0), graph.constant(0.5));
    let (webbing, owner) = (&segment.webbing, &segment.owner);
    let locked = |tension: Expr<'g>| webbing.once_locked(tension, zero);
    let elastic = locked(undamped);
    match webbing.limiter {
        Some(Limiter { pays, .. }) => {
            let (stores, yields) = (
                choose(pays, half, elastic, zero),
                choose(pays, half, zero, elastic),
            );
            applied.work(
                format!("{owner}: elastic"),
                Product::Scalars(-stores, stretching),
            );
            applied.work(
                format!("{owner}: limiter"),
                Product::Scalars(-yields, stretching),
            );
        }
        None => applied.work(
            format!("{owner}: elastic"),
            Product::Scalars(-elastic, stretching),
        ),
    }
    if undamped.id() != stretched.id() {
        let damping = locked(stretched) - elastic;
        applied.work(
            format!("{owner}: damping"),
            Product::Scalars(-damping, stretching),
        );
    }
    if !webbing.taken_in.is_zero() {
        let work = format!("{owner}: pretensioner");
        applied.work(work, Product::Scalars(locked(stretched), webbing.taken_in));
    }
    if let Some(spool) = spool {
        let free = webbing.once_locked(zero, spool);
        applied.work(
            format!("{owner}: retractor"),
            Product::Scalars(-free, segment.rate + segment.leaving),
        );
    }
}

/// √ of a squared distance, with a lower bound above 0.
pub fn length<'g>(graph: &'g Graph, squared: Expr<'g>) -> Expr<'g> {
    squared.max(graph.constant(SMALLEST_SQUARED_LENGTH)).sqrt()
}

/// Distances of the points of the segments at the start.
fn initial_lengths<'g>(graph: &'g Graph, start: &Motion<'g>, belt: &Belt) -> Vec<Expr<'g>> {
    let points: Vec<&Attachment> = belt.points().collect();
    let pairs = points.windows(2);
    pairs
        .map(|ends| {
            between(graph, ends[0], ends[1]).unwrap_or_else(|| {
                let point = |end: &Attachment| start.attachment(graph, end).position;
                length(graph, (point(ends[1]) - point(ends[0])).squared())
            })
        })
        .collect()
}

fn sum<'g>(lengths: &[Expr<'g>]) -> Expr<'g> {
    lengths[1..].iter().fold(lengths[0], |sum, &l| sum + l)
}

/// An expression that parameters must not make negative: the untensioned length at the start less its least value
/// \[m\]. A given length has a rule of its own.
pub fn length_at_start<'g>(graph: &'g Graph, start: &Motion<'g>, belt: &Belt) -> Expr<'g> {
    let slack = match &belt.length {
        BeltLength::Given(_) => return graph.constant(0.0),
        BeltLength::Slack(slack) => number(graph, slack),
        BeltLength::Pretension(_) => graph.constant(0.0),
    };
    sum(&initial_lengths(graph, start, belt)) + slack - graph.constant(SHORTEST)
}

/// L₀ of a segment. The given length or slack of a belt of several segments is divided in proportion to their distances
/// at the start, so that all have the same tension.
fn untensioned_length<'g>(
    graph: &'g Graph,
    belt: &Belt,
    initials: &[Expr<'g>],
    index: usize,
) -> Expr<'g> {
    let (initial, alone) = (initials[index], initials.len() == 1);
    let under = |tension| {
        let elongation = inverse(graph, &belt.force, number(graph, tension));
        initial / (graph.constant(1.0) + elongation)
    };
    match (&belt.length, &belt.retractor) {
        // other segments start with the tension that the reel holds
        (_, Some(retractor)) if index > 0 && !retractor.spool.is_zero() => under(&retractor.spool),
        (BeltLength::Given(length), _) if alone => number(graph, length),
        (BeltLength::Given(length), _) => number(graph, length) * (initial / sum(initials)),
        (BeltLength::Slack(slack), _) if alone || slack.is_zero() => initial + number(graph, slack),
        (BeltLength::Slack(slack), _) => initial + number(graph, slack) * (initial / sum(initials)),
        (BeltLength::Pretension(force), _) => under(force),
    }
}

//! Airbag: an ellipsoid of perfect gas at one pressure, which pushes the ellipsoids that overlap with it.
//!
//! V = V₀ − Σ ΔV(δₖ),   p = max(p_a, (γ − 1) U/V),   T = (γ − 1) U/(m R)
//!
//! ṁ = ṁ_in − ṁ_out,   U̇ = H − p V̇ while full,  H/γ while slack;   H = c_p (ṁ_in T_in − ṁ_out T)
//!
//! F_k = (p − p_a) A(δₖ),   A = dΔV/dδ,   so that Σ F_k δ̇ₖ = −(p − p_a) V̇: the work of the forces is exactly that of
//! the gas, less that of the air around it
//!
//! m and U are states. While (γ − 1) U < p_a V the bag is slack: its gas is at p_a, this determines its volume, and
//! because of the work against p_a, only H/γ of H remains. V₀ is the volume of the ellipsoid. δ is the least overlap
//! with an ellipsoid that the bag meets, as for a [contact](crate::law::contact::force), and the force acts along its
//! direction, half-way between the deepest points. ΔV and A are those of two spheres with the volumes of the ellipsoids
//! and the overlap δ: A is the area of the circle in which the spheres meet; once the smaller sphere is inside up to
//! its equator, A is the area of its equator.
//!
//! With r = max(p_a/p, (2/(γ + 1))^(γ/(γ − 1))), where the flow is choked if the second is larger (Saint-Venant and
//! Wantzel, 1839):
//!
//! ṁ_out = C A_v p/√(R T) ψ,   ψ² = 2γ/(γ − 1) (r^(2/γ) − r^((γ + 1)/γ)). For ψ² below ψ₀² = 10⁻⁴ (a pressure
//! difference of 5 Pa), where the root is steep, ψ is replaced by ψ²/√ψ₀².

use super::check::FOLDED;
use super::outputs::AirbagMeasures;
use crate::equations::LEAST_VOLUME;
use crate::expression::choose;
use crate::expression::vector::Vec3;
use crate::expression::{Expr, Function, Graph};
use crate::force::onset::absolute;
use crate::force::switch::{Gate, Remembered};
use crate::force::{AppliedForces, Product};
use crate::force::{Equations, Measures, Setting};
use crate::law::airbag::check::{Airbag, Inflow};
use crate::law::contact::check::{Against, Contact};
use crate::law::contact::force::pair::{direction, on_ellipsoid};
use crate::law::contact::force::{Touch, begins};
use crate::law::contact::onset::Pair;
use crate::model::{Ellipsoid, Model};
use crate::motion::Motion;
use crate::motion::numbers::time;
use crate::motion::numbers::{curve, number, vector};
use std::f64::consts::PI;

/// ψ₀²
const STEEP: f64 = 1e-4;

/// Smallest part of its volume that remains for the gas of a bag. A run in which less would remain reports so.
const LEAST: f64 = LEAST_VOLUME;

/// Lower bound of the mass of gas in divisions \[kg\].
const LEAST_MASS: f64 = 1e-9;

/// Lower bound of the distance of two spheres in divisions \[m\].
const LEAST_RADIUS: f64 = 1e-9;

/// Steps end at the points of the curve of an inflow if it has at most this many; a curve with more points is treated
/// as smooth.
const MOST_KINKS: usize = 32;

/// An ellipsoid that the bag meets.
struct Meeting<'g> {
    touch: Touch<'g>,
    /// A \[m²\]
    area: Expr<'g>,
    /// ΔV \[m³\]
    volume: Expr<'g>,
}

impl Equations for Airbag {
    fn apply<'g>(
        &self,
        setting: Setting<'_, 'g>,
        applied: &mut AppliedForces<'g>,
    ) -> Box<dyn Measures<'g> + 'g> {
        Box::new(apply(self, setting, applied))
    }
}

fn apply<'g>(
    airbag: &Airbag,
    setting: Setting<'_, 'g>,
    applied: &mut AppliedForces<'g>,
) -> AirbagMeasures<'g> {
    let Setting {
        graph,
        model,
        motion,
        start,
        name,
        ..
    } = setting;
    let owner = format!("airbag {name}");
    let curves = applied.curves_so_far();
    let meetings: Vec<Meeting<'g>> = airbag
        .against
        .iter()
        .map(|other| {
            let meeting = meet(graph, model, motion, airbag, other);
            tell(
                graph,
                model,
                motion,
                applied,
                &owner,
                (airbag, other),
                &meeting,
            );
            meeting
        })
        .collect();
    let at_start = airbag
        .against
        .iter()
        .map(|other| meet(graph, model, start, airbag, other).volume);
    let [left, left_at_start] = [
        left(graph, airbag, meetings.iter().map(|m| m.volume)),
        left(graph, airbag, at_start),
    ];
    let shrinking = meetings.iter().fold(graph.constant(0.0), |sum, m| {
        sum + m.area * m.touch.approach
    });
    let gas = Gas::of(graph, applied, &owner, airbag, [left, left_at_start]);
    let over = gas.pressure - gas.around;
    // a slack bag exerts no force, so a jump of its direction does not matter
    applied.curves_act(curves, over);
    let taken = meetings
        .iter()
        .fold(graph.constant(0.0), |sum, m| sum + m.volume);
    let share = taken / volume(graph, &airbag.ellipsoid);
    applied.volume(&owner, move || share, over);
    let outflow = gas.flow(graph, model, applied, &owner, airbag, shrinking);
    AirbagMeasures {
        on: push(applied, &owner, airbag, &meetings, over),
        names: names(model, name, airbag),
        pressure: gas.pressure,
        temperature: gas.heat / number(graph, &airbag.gas.constant),
        mass: gas.mass.1,
        volume: gas.less * gas.energy.1 / gas.pressure,
        outflow,
        area: meetings
            .iter()
            .fold(graph.constant(0.0), |sum, m| sum + m.area),
        touches: meetings.into_iter().map(|m| m.touch).collect(),
    }
}

/// "bag on dummy/head" for each ellipsoid that a bag meets.
fn names(model: &Model, name: &str, airbag: &Airbag) -> Vec<String> {
    let bodies = airbag.against.iter().map(|other| other.center.on);
    bodies
        .map(|body| format!("{name} on {}", model.name_of(body)))
        .collect()
}

/// The volume that remains for the gas of a bag that gives up these volumes.
fn left<'g>(
    graph: &'g Graph,
    airbag: &Airbag,
    displaced: impl Iterator<Item = Expr<'g>>,
) -> Expr<'g> {
    let whole = volume(graph, &airbag.ellipsoid);
    let displaced = displaced.fold(graph.constant(0.0), |sum, volume| sum + volume);
    (whole - displaced).max(graph.constant(LEAST) * whole)
}

/// Applies the overpressure `over` to the bodies that the bag meets. Returns the force on the body of the bag, and on
/// each that it meets.
fn push<'g>(
    applied: &mut AppliedForces<'g>,
    owner: &str,
    airbag: &Airbag,
    meetings: &[Meeting<'g>],
    over: Expr<'g>,
) -> Vec<Vec3<'g>> {
    let mut on = vec![Vec3::zero(over.graph())];
    for (meeting, other) in meetings.iter().zip(&airbag.against) {
        let force = over * meeting.area;
        // the normal points from the other body to the bag
        let push = -(force * meeting.touch.normal);
        applied.apply(other.center.on, meeting.touch.offset_on_second, push);
        applied.apply(airbag.ellipsoid.center.on, meeting.touch.offset, -push);
        applied.work(
            format!("{owner}: gas"),
            Product::Scalars(-force, meeting.touch.approach),
        );
        on[0] = on[0] - push;
        on.push(push);
    }
    on
}

/// A bag and an ellipsoid that it meets, as a contact without force: for its geometry.
fn contact(airbag: &Airbag, other: &Ellipsoid) -> Contact {
    Contact {
        ellipsoid: airbag.ellipsoid.clone(),
        degree: 2,
        against: Against::Ellipsoid(other.clone()),
        elastic: None,
        hysteresis: None,
        damping: None,
        damping_depth: None,
        friction: None,
        bristle: None,
    }
}

/// The overlap of a bag with an ellipsoid that it meets.
fn meet<'g>(
    graph: &'g Graph,
    model: &Model,
    motion: &Motion<'g>,
    airbag: &Airbag,
    other: &Ellipsoid,
) -> Meeting<'g> {
    let contact = contact(airbag, other);
    let touch = on_ellipsoid(graph, model.dimension, motion, &contact, other);
    let (area, volume) = lens(graph, radii(graph, airbag, other), touch.penetration);
    Meeting {
        touch,
        area,
        volume,
    }
}

/// Adds the event where the push of a bag begins, its kinks, and the watch on its direction.
fn tell<'g>(
    graph: &'g Graph,
    model: &Model,
    motion: &Motion<'g>,
    applied: &mut AppliedForces<'g>,
    owner: &str,
    (airbag, other): (&Airbag, &Ellipsoid),
    meeting: &Meeting<'g>,
) {
    let (contact, touch) = (contact(airbag, other), &meeting.touch);
    let pair = Pair::of(graph, model.dimension, motion, &contact);
    begins(applied, owner, Gate::default(), &contact, touch, pair);
    if let Some(between) = touch.between {
        applied.direction(owner, direction(model.dimension, touch.normal, between));
    }
    let overlap = touch.overlap;
    applied.kink(format!("{owner}: touches"), move || overlap);
    let deep = overlap - equator(radii(graph, airbag, other));
    applied.kink(format!("{owner}: is around what it meets"), move || deep);
}

/// Radii of the spheres with the volumes of the bag and of an ellipsoid \[m\].
fn radii<'g>(graph: &'g Graph, airbag: &Airbag, other: &Ellipsoid) -> [Expr<'g>; 2] {
    [&airbag.ellipsoid, other].map(|ellipsoid| radius(graph, ellipsoid))
}

/// (4/3) π a b c \[m³\]
fn volume<'g>(graph: &'g Graph, ellipsoid: &Ellipsoid) -> Expr<'g> {
    let [a, b, c] = vector(graph, &ellipsoid.semi_axes).0;
    graph.constant(4.0 / 3.0 * PI) * (a * b * c)
}

/// Radius of the sphere with the volume of an ellipsoid \[m\].
fn radius<'g>(graph: &'g Graph, ellipsoid: &Ellipsoid) -> Expr<'g> {
    let [a, b, c] = vector(graph, &ellipsoid.semi_axes).0;
    if a.id() == b.id() && b.id() == c.id() {
        return a;
    }
    graph.call(Function::Power, &[a * b * c, graph.constant(1.0 / 3.0)])
}

/// Overlap δ of two spheres at which the smaller one is inside up to its equator: d² = |a² − b²| \[m\].
fn equator<'g>([a, b]: [Expr<'g>; 2]) -> Expr<'g> {
    let both = a + b;
    both - absolute((a - b) * both).sqrt()
}

/// Area A of the circle in which two spheres with the overlap δ meet, and the volume ΔV that the bag gives up,
/// A = dΔV/dδ. Both are 0 while the spheres are apart.
///
/// ρ² = (a + b + d)(a + b − d)(d + a − b)(d + b − a)/(2 d)²,  d = a + b − δ, until the smaller sphere is inside up to
/// its equator, d² = |a² − b²|. From there on the fabric lies around it, and it sweeps a tube with the section of its
/// equator.
fn lens<'g>(graph: &'g Graph, [a, b]: [Expr<'g>; 2], overlap: Expr<'g>) -> (Expr<'g>, Expr<'g>) {
    let zero = graph.constant(0.0);
    let both = a + b;
    let depth = overlap.max(zero).min(equator([a, b]));
    let apart = (both - depth).max(graph.constant(LEAST_RADIUS));
    let square = depth * (both + apart) * (apart + a - b) * (apart + b - a);
    let area = graph.constant(PI / 4.0) * square / apart.squared();
    // V = π δ² (d² + 2 d (a + b) − 3 (a − b)²)/(12 d)
    let sum = apart.squared() + graph.constant(2.0) * apart * both
        - graph.constant(3.0) * (a - b).squared();
    let cap = graph.constant(PI / 12.0) * depth.squared() * sum / apart;
    let tube = area * (overlap.max(zero) - depth);
    (area, cap + tube)
}

/// Mass flow into a bag; 0 until its switch acts. Adds an event function at each point of its curve.
fn flow_in<'g>(
    graph: &'g Graph,
    model: &Model,
    applied: &mut AppliedForces<'g>,
    owner: &str,
    inflow: &Inflow,
) -> Expr<'g> {
    let fire: Remembered<'g> = applied.states.switches[inflow.fire];
    let (zero, now) = (graph.constant(0.0), time(graph));
    let since = (now - fire.since).max(zero);
    let points = &model.curves[inflow.flow.curve].points;
    if points.len() <= MOST_KINKS {
        for (index, point) in points.iter().enumerate() {
            let kink = point[0] * number(graph, &inflow.flow.stretch);
            let name_of_event = format!("{owner}: point {} of the inflow", index + 1);
            applied.event_function(name_of_event, fire.since + kink - now);
        }
    }
    fire.once(curve(graph, &inflow.flow, since), zero)
}

/// The gas of a bag.
struct Gas<'g> {
    /// The state m: its index, and its value \[kg\].
    mass: (usize, Expr<'g>),
    /// The state U: its index, and its value \[J\].
    energy: (usize, Expr<'g>),
    gamma: Expr<'g>,
    /// γ − 1
    less: Expr<'g>,
    /// Pressure around the bag \[Pa\].
    around: Expr<'g>,
    /// Pressure that the gas would have if it filled the whole remaining volume; lower than the pressure around the bag
    /// if the bag is slack \[Pa\].
    filled: Expr<'g>,
    /// Pressure of the gas \[Pa\].
    pressure: Expr<'g>,
    /// R T \[J/kg\]
    heat: Expr<'g>,
}

impl<'g> Gas<'g> {
    /// The gas of a bag. `left` is the volume that remains for it, `left_at_start` that at the start \[m³\].
    fn of(
        graph: &'g Graph,
        applied: &mut AppliedForces<'g>,
        owner: &str,
        airbag: &Airbag,
        [left, left_at_start]: [Expr<'g>; 2],
    ) -> Self {
        let [constant, gamma, around] = [
            &airbag.gas.constant,
            &airbag.gas.gamma,
            &airbag.ambient.pressure,
        ]
        .map(|given| number(graph, given));
        let less = gamma - graph.constant(1.0);
        let (pressure, temperature, size) = match &airbag.start {
            Some(start) => (
                number(graph, &start.pressure),
                number(graph, &start.temperature),
                left_at_start,
            ),
            None => (
                around,
                number(graph, &airbag.ambient.temperature),
                graph.constant(FOLDED) * volume(graph, &airbag.ellipsoid),
            ),
        };
        let initial = pressure * size / (constant * temperature);
        let mass = applied.auxiliary(format!("{owner}: mass of gas"), "kg", initial);
        let initial = pressure * size / less;
        let energy = applied.auxiliary(format!("{owner}: energy of gas"), "J", initial);
        let filled = less * energy.1 / left;
        Gas {
            mass,
            energy,
            gamma,
            less,
            around,
            filled,
            pressure: filled.max(around),
            heat: less * energy.1 / mass.1.max(graph.constant(LEAST_MASS)),
        }
    }

    /// Lets gas flow in and out, while the remaining volume shrinks at the rate `shrinking` \[m³/s\]. Returns the mass
    /// flow out \[kg/s\].
    fn flow(
        &self,
        graph: &'g Graph,
        model: &Model,
        applied: &mut AppliedForces<'g>,
        owner: &str,
        airbag: &Airbag,
        shrinking: Expr<'g>,
    ) -> Expr<'g> {
        let (filled, around) = (self.filled, self.around);
        let (mut into, mut out) = (graph.constant(0.0), graph.constant(0.0));
        if let Some(area) = &airbag.vent {
            out = self.outflow(applied, owner, number(graph, area));
        }
        // c_p T = γ/(γ − 1) R T
        let per_mass = self.gamma / self.less;
        let mut enthalpy = -(per_mass * out * self.heat);
        if let Some(inflow) = &airbag.inflow {
            into = flow_in(graph, model, applied, owner, inflow);
            let hot = number(graph, &airbag.gas.constant) * number(graph, &inflow.temperature);
            enthalpy = per_mass * into * hot + enthalpy;
        }
        let full = enthalpy + self.pressure * shrinking;
        applied.states.auxiliaries[self.mass.0].next = into - out;
        applied.states.auxiliaries[self.energy.0].next =
            choose(around, filled, full, enthalpy / self.gamma);
        applied.kink(format!("{owner}: is full"), move || filled - around);
        out
    }

    /// Mass flow out of a hole whose jet has the area `area`.
    fn outflow(&self, applied: &mut AppliedForces<'g>, owner: &str, area: Expr<'g>) -> Expr<'g> {
        let graph = area.graph();
        let (one, two) = (graph.constant(1.0), graph.constant(2.0));
        let power = |base, exponent| graph.call(Function::Power, &[base, exponent]);
        let Gas {
            gamma,
            less,
            around,
            pressure,
            heat,
            ..
        } = *self;
        let choked = power(two / (gamma + one), gamma / less);
        let through = around / pressure;
        let ratio = through.max(choked);
        let first = power(ratio, two / gamma);
        let second = power(ratio, (gamma + one) / gamma);
        let square = two * gamma / less * (first - second);
        let steep = graph.constant(STEEP);
        let psi = square / square.max(steep).sqrt();
        applied.kink(format!("{owner}: flow out is choked"), move || {
            through - choked
        });
        applied.kink(format!("{owner}: flow out is slow"), move || square - steep);
        area * pressure / heat.max(graph.constant(f64::MIN_POSITIVE)).sqrt() * psi
    }
}

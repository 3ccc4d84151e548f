//! Contact of an ellipsoid with a plane, or with another ellipsoid ([pair]).   \[MADYMO 1980, force model 3\]
//!
//! n is the plane's normal, h the reach of the ellipsoid from its centre towards the plane, and p its deepest point
//! ([support]); the penetration is δ = h − n·(centre − plane). v is the velocity of the ellipsoid's material at p
//! relative to that of the plane at p. Then
//!
//! δ̇ = −n·v,   N = one_sided(δ, elastic(δ), damping · min(δ/depth, 1) · δ̇),   F = N n + friction
//!
//! F acts on the ellipsoid at p, −F on the plane's body.

mod edge;
mod friction;
pub(crate) mod pair;
mod support;

use super::outputs::ContactMeasures;
use crate::expression::choose;
use crate::expression::vector::Vec3;
use crate::expression::{Expr, Function, Graph, sum};
use crate::force::branches::one_sided;
use crate::force::fade::faded;
use crate::force::hysteresis;
use crate::force::switch::Gate;
use crate::force::{Acts, AppliedForces, Product, point_on};
use crate::force::{ContactPoint, Equations, Measures, Setting};
use crate::law::contact::check::{Against, Contact};
use crate::law::contact::onset::Pair;
use crate::model::{Dimension, EdgeRule, Plane};
use crate::motion::Motion;
use crate::motion::numbers::{curve, derivative, number, vector};
use friction::{Rubbing, friction};
use pair::{Search, on_ellipsoid};
use std::rc::Rc;
use support::Support;

/// Place and motion of the touch of two bodies, in absolute axes.
pub(crate) struct Touch<'g> {
    /// δ \[m\]; any negative number while the bodies do not touch.
    pub(crate) penetration: Expr<'g>,
    /// δ while the bodies touch, minus their distance while they do not \[m\].
    pub(crate) overlap: Expr<'g>,
    /// Unit vector from the second body to the first.
    pub(crate) normal: Vec3<'g>,
    /// The point where forces act.
    place: Vec3<'g>,
    /// The search for it and for the normal, which ends early while the bodies are apart, and the centre of the first
    /// body; `None` if both are known without one.
    search: Option<(Search<'g>, Vec3<'g>)>,
    /// Vector from the joint of the first body to the point where forces act.
    pub(crate) offset: Vec3<'g>,
    /// Vector from the joint of the second body to the point where forces act.
    pub(crate) offset_on_second: Vec3<'g>,
    /// Velocity of the first body's material at this point, relative to the second's \[m/s\].
    velocity: Vec3<'g>,
    /// δ̇ \[m/s\]
    pub(crate) approach: Expr<'g>,
    /// For two ellipsoids: vector from the centre of the first to that of the second.
    pub(crate) between: Option<Vec3<'g>>,
    /// Vectors from the joint of the first body, and from that of the second, to the centre of the first ellipsoid.
    centre: Vec3<'g>,
    centre_on_second: Vec3<'g>,
    /// Coordinates of the deepest point along the tangents of the plane \[m\]; empty if the plane has no edges.
    along: Vec<Expr<'g>>,
    /// For a fading edge: each tangent t, and the vector m of the motion of the deepest point along t.
    moving: Vec<[Vec3<'g>; 2]>,
    /// For an ellipsoid of a degree other than 2: expressions that are 0 when the deepest point passes from one flat
    /// side to another.
    flats: Vec<Expr<'g>>,
    /// In space, if friction or an edge needs them: axes fixed in the second body, either two along the plane, or
    /// three.
    tangents: Vec<Vec3<'g>>,
}

impl<'g> Touch<'g> {
    /// The one tangent in the plane x–z.
    fn planar_tangent(&self) -> Vec3<'g> {
        planar_tangent(self.normal)
    }

    /// The contact point, with the force on the first body. `inside` is positive if it is inside the edges of a plane.
    pub(crate) fn point(
        &self,
        name: String,
        force: Vec3<'g>,
        inside: Option<Expr<'g>>,
    ) -> ContactPoint<'g> {
        let gap = -self.overlap;
        let (normal, place) = match &self.search {
            None => (self.normal, self.place),
            Some((search, centre)) => {
                let [normal, from_centre] = search.nearest();
                (normal, *centre + from_centre)
            }
        };
        ContactPoint {
            name,
            gap: inside.map_or(gap, |inside| gap.max(-inside)),
            place,
            normal,
            force,
        }
    }

    /// Sliding velocity: the part of the relative velocity in the tangent plane.
    fn slip(&self) -> Vec3<'g> {
        self.velocity + self.approach * self.normal
    }
}

fn planar_tangent(normal: Vec3<'_>) -> Vec3<'_> {
    let zero = normal.0[0].graph().constant(0.0);
    Vec3([normal.0[2], zero, -normal.0[0]])
}

impl Equations for Contact {
    fn apply<'g>(
        &self,
        setting: Setting<'_, 'g>,
        applied: &mut AppliedForces<'g>,
    ) -> Box<dyn Measures<'g> + 'g> {
        Box::new(apply(self, setting, applied))
    }
}

/// Applies a contact: the normal force, reduced at an edge; friction; and the push of a fading edge.
// Long: the parts of the force in the order in which their nodes are made; each needs those before it.
fn apply<'g>(
    contact: &Contact,
    setting: Setting<'_, 'g>,
    applied: &mut AppliedForces<'g>,
) -> ContactMeasures<'g> {
    let Setting {
        graph,
        motion,
        name,
        gate,
        ..
    } = setting;
    let dimension = setting.model.dimension;
    let extent = contact.against.plane();
    let extent = extent.and_then(|plane| plane.extent.as_ref());
    let touch = match &contact.against {
        Against::Plane(plane) => on_plane(graph, dimension, motion, contact, plane),
        Against::Ellipsoid(second) => on_ellipsoid(graph, dimension, motion, contact, second),
    };
    let (on, on_second) = (contact.ellipsoid.center.on, contact.against.place().on);
    let owner = format!("contact {name}");
    let curves = applied.curves_so_far();
    for &flat in &touch.flats {
        applied.kink(format!("{owner}: passes a flat side"), move || flat);
    }
    let Pressed {
        force: mut pressure,
        elastic,
        mut stored,
        permanent_set,
    } = pressed(graph, applied, &owner, gate, contact, &touch);
    pressure = gate.of(pressure);
    let pair = Pair::of(graph, dimension, motion, contact);
    begins(applied, &owner, gate, contact, &touch, pair);
    let weight = extent.map(|extent| edge::weight(extent, &touch.along));
    if let (Some(weight), Some(extent)) = (&weight, extent) {
        pressure = weight.weight * pressure;
        // beyond the edge there is no force, not even NaN where a curve has no value
        let unloading = contact.hysteresis.as_ref().map(|law| &law.unloading);
        let curves = [Some(&contact.elastic), unloading].into_iter().flatten();
        if curves.flatten().any(|curve| applied.ends(curve)) {
            let zero = graph.constant(0.0);
            pressure = choose(zero, weight.weight, pressure, zero);
            stored = choose(zero, weight.weight, stored, zero);
        }
        edge::kinks(applied, &owner, extent, weight);
    }

    if let Some(between) = touch.between {
        applied.direction(&owner, pair::direction(dimension, touch.normal, between));
    }
    applied.curves_act(curves, pressure);
    applied.work(
        format!("{owner}: normal force"),
        Product::Scalars(-pressure, touch.approach),
    );
    let displacement = contact.bristle.as_ref().map(|b| &b.displacement);
    let rubbing = match &contact.friction {
        Some(law) => friction(
            applied,
            dimension,
            &owner,
            law,
            displacement,
            pressure,
            &touch,
        ),
        None => Rubbing {
            force: Vec3::zero(graph),
            magnitude: graph.constant(0.0),
        },
    };
    let force = pressure * touch.normal + rubbing.force;
    applied.apply(on, touch.offset, force);
    applied.apply(on_second, touch.offset_on_second, -force);
    let (mut on_first, mut resultant) = (
        force,
        match &contact.friction {
            Some(_) => (pressure.squared() + rubbing.magnitude.squared()).sqrt(),
            None => pressure,
        },
    );
    if let (Some(weight), false) = (&weight, touch.moving.is_empty()) {
        let (first, second) = (motion.body(on), motion.body(on_second));
        let relative = [
            first.velocity_at(touch.centre) - second.velocity_at(touch.centre_on_second),
            first.omega - second.omega,
        ];
        let stored = gate.of(stored);
        let slopes = weight.slopes.clone();
        let steep = move || sum(graph, slopes.iter().map(|slope| slope.squared())).sqrt();
        let surface = gate.of(elastic);
        applied.edge(
            &owner,
            move || stored * steep() / surface.max(graph.constant(f64::MIN_POSITIVE)),
            surface,
        );
        let push = push_of_edge(contact, applied, &owner, weight, stored, &touch, relative);
        on_first = force + push;
        resultant = on_first.squared().sqrt();
    }
    ContactMeasures {
        on_first,
        force: resultant,
        normal: pressure,
        friction: rubbing.magnitude,
        penetration: touch.overlap,
        permanent_set,
        name: name.to_owned(),
        touch,
        inside: weight.map(|weight| weight.inside),
    }
}

/// Applies the push of a fading edge, and returns the force on the first body.
fn push_of_edge<'g>(
    contact: &Contact,
    applied: &mut AppliedForces<'g>,
    owner: &str,
    weight: &edge::Weight<'g>,
    stored: Expr<'g>,
    touch: &Touch<'g>,
    relative: [Vec3<'g>; 2],
) -> Vec3<'g> {
    let (on, on_second) = (contact.ellipsoid.center.on, contact.against.place().on);
    let push = edge::push(applied, owner, weight, stored, &touch.moving, relative);
    applied.apply(on, touch.centre, push.force);
    applied.apply(on_second, touch.centre_on_second, -push.force);
    applied.turn(on, push.moment);
    applied.turn(on_second, -push.moment);
    push.force
}

/// Adds the event of the beginning of a contact, and the corners of its curves.
pub(crate) fn begins<'g>(
    applied: &mut AppliedForces<'g>,
    owner: &str,
    gate: Gate<'g>,
    contact: &Contact,
    touch: &Touch<'g>,
    pair: Pair<'g>,
) {
    let graph = touch.penetration.graph();
    let lead = match (&contact.elastic, &contact.damping) {
        (Some(curve), None) => applied.lead(graph, curve),
        _ => graph.constant(0.0),
    };
    let (penetration, normal, along) = (touch.penetration, touch.normal, touch.along.clone());
    let tangents = touch.tangents.clone();
    let pair = Rc::new(pair);
    let unloading = contact.hysteresis.as_ref().map(|law| &law.unloading);
    let curves = [
        (contact.elastic.as_ref(), "curve"),
        (unloading.and_then(Option::as_ref), "unloading curve"),
    ];
    for (curve, which) in curves {
        let Some(curve) = curve else { continue };
        let pair = Rc::clone(&pair);
        let closing = move || pair.closing(normal);
        applied.corners(owner, which, gate, curve, move || penetration, closing);
    }
    applied.onset(format!("{owner}: touches"), move || {
        let tangents = match tangents[..] {
            [] => vec![planar_tangent(normal)],
            _ => tangents.clone(),
        };
        gate.of_onset(pair.touches(lead - penetration, normal, &tangents, &along))
    });
}

/// The results of the penetration.
struct Pressed<'g> {
    /// Normal force \[N\].
    force: Expr<'g>,
    /// Elastic part of the normal force while the bodies touch, otherwise 0 \[N\].
    elastic: Expr<'g>,
    /// Energy that unloading gives back \[J\]; 0 unless a fading edge needs it.
    stored: Expr<'g>,
    /// Penetration at which the force would vanish in unloading \[m\].
    permanent_set: Expr<'g>,
}

/// The normal force, before the weight of an edge is applied.
fn pressed<'g>(
    graph: &'g Graph,
    applied: &mut AppliedForces<'g>,
    owner: &str,
    gate: Gate<'g>,
    contact: &Contact,
    touch: &Touch<'g>,
) -> Pressed<'g> {
    let (zero, penetration, approach) = (graph.constant(0.0), touch.penetration, touch.approach);
    // the memory of a hysteresis must be finite, and a curve need not have a value while the bodies are apart
    let depth = match contact.hysteresis {
        Some(_) => penetration.max(zero),
        None => penetration,
    };
    let loading = contact
        .elastic
        .as_ref()
        .map_or(zero, |c| curve(graph, c, depth));
    let (elastic, permanent_set) = match &contact.hysteresis {
        Some(law) => {
            let elastic =
                hysteresis::apply(applied, owner, "m", law, gate, depth, loading, move || {
                    penetration
                });
            hysteresis::watch_turns(applied, owner, depth, approach);
            elastic
        }
        None => (loading, zero),
    };
    let viscous = contact.damping.as_ref().map_or(zero, |c| {
        number(graph, c) * faded(graph, penetration, contact.damping_depth.as_ref()) * approach
    });
    let force = one_sided(penetration, elastic, viscous);
    if contact.damping.is_some() {
        // where damping would pull, the force ends while the bodies still overlap
        applied.kink(format!("{owner}: pushes"), move || {
            choose(zero, penetration, elastic + viscous, penetration)
        });
        if let Some(depth) = contact.damping_depth.clone() {
            applied.kink(format!("{owner}: damping is full"), move || {
                penetration - number(graph, &depth)
            });
        }
    } else {
        applied.kink(format!("{owner}: touches"), move || penetration);
    }
    if let Some(curve) = &contact.elastic {
        applied.curve_of_state(owner, "curve", "m", curve, Acts::AboveFirst, move || {
            penetration
        });
    }
    let stored = match (&contact.elastic, &contact.hysteresis) {
        _ if touch.moving.is_empty() => zero,
        (None, _) => zero,
        // the energy under the unloading line of slope s; no unloading curve lies below it here
        (Some(_), Some(law)) => elastic.squared() / (2.0 * number(graph, &law.slope)),
        (Some(c), None) => derivative(graph, c, Function::CurveIntegral, penetration.max(zero)),
    };
    Pressed {
        force,
        elastic: choose(zero, penetration, elastic, zero),
        stored,
        permanent_set,
    }
}

/// The touch of an ellipsoid and a plane.
fn on_plane<'g>(
    graph: &'g Graph,
    dimension: Dimension,
    motion: &Motion<'g>,
    contact: &Contact,
    flat: &Plane,
) -> Touch<'g> {
    let (ellipsoid, plane) = (
        motion.body(contact.ellipsoid.center.on),
        motion.body(flat.at.on),
    );
    let centre = motion.attachment(graph, &contact.ellipsoid.center);
    let on_plane = motion.attachment(graph, &flat.at);
    let local_normal = vector(graph, &flat.normal);
    let normal = plane.rotation.times(local_normal);

    let support = Support::of(graph, dimension, motion, contact, normal);
    let deepest = support.deepest;
    let penetration = support.reach - normal.dot(centre.position - on_plane.position);
    let offset = centre.offset - deepest;
    let point = centre.position - deepest;
    let (offset_on_second, plane_velocity) = point_on(plane, point);
    let velocity = ellipsoid.velocity_at(offset) - plane_velocity;
    let wanted = contact.bristle.is_some() || flat.extent.is_some();
    let tangents = match dimension {
        Dimension::Space if wanted => {
            let first = vector(graph, &flat.tangent);
            let local = [first, local_normal.cross(first)];
            local.map(|axis| plane.rotation.times(axis)).to_vec()
        }
        _ => Vec::new(),
    };
    let mut touch = Touch {
        penetration,
        overlap: penetration,
        normal,
        place: point,
        search: None,
        offset,
        offset_on_second,
        velocity,
        approach: -normal.dot(velocity),
        between: None,
        centre: centre.offset,
        centre_on_second: centre.position - plane.position,
        along: Vec::new(),
        moving: Vec::new(),
        flats: support.flats.clone(),
        tangents,
    };
    if let Some(extent) = &flat.extent {
        let tangents = match dimension {
            Dimension::Plane => vec![touch.planar_tangent()],
            Dimension::Space => touch.tangents.clone(),
        };
        let from_middle = point - on_plane.position;
        touch.along = tangents.iter().map(|t| t.dot(from_middle)).collect();
        if let EdgeRule::Fade(_) = extent.rule {
            let turning = |t: &Vec3<'g>| [*t, support.turning(normal, *t)];
            touch.moving = tangents.iter().map(turning).collect();
        }
    }
    touch
}

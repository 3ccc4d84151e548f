//! The motion of an element on a joint with coordinates of its own, one freedom after the other from the carrier
//! outwards.
//!
//! A freedom of advance h slides along its axis by h θ, and then turns about it by θ; or it does only one of
//! the two. R, p, ω, ε and γ are the rotation, the position, the angular velocity, the angular acceleration and the
//! relative acceleration of its inner side: γ is the acceleration of p minus that of the carrier's origin, and ε and γ
//! hold for v̇ = 0. With θ = q + zero and the axis e = R a,
//!
//! | | origin | orientation | column H = (s, e) |
//! |---|---|---|---|
//! | it slides | p ← p + h e θ,   γ ← γ + ε × h e θ + ω × (ω × h e θ) + 2 ω × h e q̇ | | s = h e, and e = 0 if it does not turn |
//! | it turns | | R ← R Rot(a, θ),   ε ← ε + ω × e q̇,   ω ← ω + e q̇ | s += e × (p_end − p) |
//!
//! s q̇ moves the origin p_end of the element relative to the carrier, and e q̇ turns it. The sums in ε and γ give Ḣ v.
//! A freedom does not change its own axis.   \[Featherstone 2008, ch. 3\]

use super::element::ElementMotion;
use super::numbers::{number, vector};
use crate::expression::vector::{Mat3, Vec3};
use crate::expression::{Expr, Graph};
use crate::model::Freedom;
use crate::model::{FreedomKind, Number};

/// The angle by which a kind of freedom turns per unit of its coordinate, 1 or 0, and its advance.
pub fn turn_and_advance<'g>(graph: &'g Graph, kind: &FreedomKind) -> (f64, Expr<'g>) {
    let advance = kind.advance().unwrap_or(&Number::ZERO);
    (f64::from(kind.turns()), number(graph, advance))
}

/// The motion of an element. `at` is the place of its joint in the carrier's frame.
pub fn motion<'g>(
    graph: &'g Graph,
    freedoms: &[Freedom],
    carrier: &ElementMotion<'g>,
    at: Vec3<'g>,
    q: &[Expr<'g>],
    v: &[Expr<'g>],
) -> ElementMotion<'g> {
    let none = Vec3::zero(graph);
    let freedoms_in_motion = q.iter().copied().zip(v.iter().copied()).collect();
    let mut motion = ElementMotion::frame(graph);
    motion.rotation = carrier.rotation;
    motion.angle = carrier.angle;
    motion.freedoms = freedoms_in_motion;
    motion.turns_with_carrier = true;
    motion.bias = carrier.bias;
    motion.offset = carrier.rotation.times(at);
    motion.turns(carrier.omega);
    motion.slide_bias = motion.gamma(motion.offset);
    // displacement and its rate, relative to the place of the joint on the carrier
    let mut slid = none;
    let mut slid_rate = none;
    let mut centers: Vec<Option<Vec3<'g>>> = Vec::new();
    for (freedom, (&q, &rate)) in freedoms.iter().zip(q.iter().zip(v)) {
        let position = q + number(graph, &freedom.zero);
        let axis = vector(graph, &freedom.axis);
        let e = motion.rotation.times(axis);
        let mut slide = none;
        if let Some(advance) = freedom.kind.advance() {
            slide = number(graph, advance) * e;
            let step = position * slide;
            let speed = rate * slide;
            slid = slid + step;
            slid_rate = slid_rate + speed + motion.omega.cross(step);
            let coriolis = graph.constant(2.0) * motion.omega.cross(speed);
            motion.slide_bias = motion.slide_bias + motion.gamma(step) + coriolis;
        }
        if freedom.kind.turns() {
            motion.bias = motion.bias + motion.omega.cross(rate * e);
            motion.turns(motion.omega + rate * e);
            motion.rotation = turned(&motion.rotation, axis, e, position);
            // in the plane every axis is along +y or −y
            motion.angle = motion.angle + axis.0[1] * position;
            motion.axes.push(e);
            centers.push(Some(slid));
        } else {
            motion.axes.push(none);
            centers.push(None);
        }
        motion.slides.push(slide);
    }
    for ((slide, center), axis) in motion.slides.iter_mut().zip(centers).zip(&motion.axes) {
        if let Some(center) = center {
            *slide = *slide + axis.cross(slid - center);
        }
    }
    motion.position = carrier.position + motion.offset + slid;
    motion.velocity = carrier.velocity_at(motion.offset) + slid_rate;
    motion.offset = motion.offset + slid;
    motion
}

/// R Rot(a, θ), with e = R a: its columns are those of R, rotated about e.
fn turned<'g>(rotation: &Mat3<'g>, axis: Vec3<'g>, e: Vec3<'g>, angle: Expr<'g>) -> Mat3<'g> {
    let graph = angle.graph();
    let (sine, cosine) = (angle.sin(), angle.cos());
    let a = axis.0;
    // for each column r = R e_j: r cos θ + (e × r) sin θ + e (a_j) (1 − cos θ), with e · r = a_j; e × r follows from
    // the other columns
    Mat3::from_columns(std::array::from_fn(|j| {
        let (k, l) = ((j + 1) % 3, (j + 2) % 3);
        let r = |i: usize| rotation.column(i);
        let across = a[l] * r(k) - a[k] * r(l);
        let one = graph.constant(1.0);
        match a[j].as_constant() {
            // it is not enough that one component is 1: a tilt of 1e-8 by the others would be below its rounding
            _ if a[k].is_zero() && a[l].is_zero() => r(j),
            Some(0.0) => cosine * r(j) + sine * across,
            _ => cosine * r(j) + sine * across + (a[j] * (one - cosine)) * e,
        }
    }))
}

//! The sections of a model that nothing else is made of: what each computes, and from what it may start.

use super::outputs::ModelInMotion;
use super::{energy, momentum, named};
use crate::equations::Section;
use crate::expression::Expr;
use crate::method::{Method, Start};

/// The values of a section with their names; none if the model does not have it.
type Values<'g> = Vec<(String, Expr<'g>)>;

/// A function that derives the values of a section.
type Derive = for<'g> fn(&ModelInMotion<'g, '_>) -> Values<'g>;

/// A row for each section. The runtime has a row of the same name in its own table (`section.rs`).
const SECTIONS: &[(Method, Start, Derive)] = &[
    (Method::KineticEnergy, Start::State, |scene| {
        vec![(String::new(), energy::kinetic_energy(scene))]
    }),
    (Method::Powers, Start::Accelerations, energy::powers),
    (Method::Momentum, Start::State, |scene| {
        on_axes(momentum::momentum(scene))
    }),
    (Method::ExternalWrench, Start::State, |scene| {
        on_axes(momentum::external_wrench(scene))
    }),
];

/// The sections that a model has.
pub(super) fn of(scene: &ModelInMotion<'_, '_>) -> Vec<Section> {
    let sections = SECTIONS.iter().map(|&(method, start, values)| Section {
        method,
        values: named(&values(scene)),
        start,
    });
    let there = |section: &Section| !section.values.is_empty();
    sections.filter(there).collect()
}

/// Components of a linear and an angular vector.
fn on_axes(components: Vec<Expr<'_>>) -> Values<'_> {
    let axes = ["x", "y", "z", "about_x", "about_y", "about_z"];
    axes.map(String::from).into_iter().zip(components).collect()
}

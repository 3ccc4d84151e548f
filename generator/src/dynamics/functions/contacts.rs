//! Where surfaces touch, or may: contacts, and what airbags meet.

use super::Known;
use crate::expression::Expr;
use crate::force::ContactPoint;

/// Gap, place, normal and force.
pub fn contacts<'g>(known: &Known<'g, '_>) -> Vec<Expr<'g>> {
    let row = |point: ContactPoint<'g>| {
        let vectors = [point.place, point.normal, point.force];
        std::iter::once(point.gap).chain(vectors.into_iter().flat_map(|vector| vector.0))
    };
    points(known).into_iter().flat_map(row).collect()
}

pub fn names(known: &Known<'_, '_>) -> Vec<String> {
    points(known).into_iter().map(|point| point.name).collect()
}

pub fn columns(_: &Known<'_, '_>) -> Vec<String> {
    let vectors = ["place", "normal", "force"];
    let components = vectors
        .into_iter()
        .flat_map(|vector| ["x", "y", "z"].map(|axis| format!("{vector}_{axis}")));
    std::iter::once("gap".to_owned())
        .chain(components)
        .collect()
}

fn points<'g>(known: &Known<'g, '_>) -> Vec<ContactPoint<'g>> {
    let measures = known.scene.applied.measures.iter();
    measures.flat_map(|of| of.contact_points()).collect()
}

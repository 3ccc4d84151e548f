//! Lines from joint to joint.

use super::{Bodies, BodyPoint};
use crate::pose::{Numbers, Vec3, bryant_rotation, dot};
use bryant_generator::model::{Body, Dimension, Element, ElementId, Freedom, Number};

/// Lines from the joint of each element to the joints that it carries, or to its ends, and the centres of gravity of
/// elements that carry no other. Where a joint slides, a line leads from its place to the part that has slid away from
/// it.
pub fn bones(bodies: &Bodies<'_>, numbers: Numbers<'_>) -> (Vec<[BodyPoint; 2]>, Vec<BodyPoint>) {
    let (mut bones, mut masses) = (Vec::new(), Vec::new());
    for id in bodies.ids() {
        let elements = &bodies.model.systems[id.system].elements;
        let body = bodies.index(Body::Element(id));
        let on = |at: Vec3| BodyPoint { body, at };
        let mut tip = true;
        for (index, child) in elements.iter().enumerate() {
            if child.parent != Some(id.element) {
                continue;
            }
            let at = numbers.vector(&child.at);
            if child.joint.freedoms().iter().any(Freedom::slides) {
                let child = Body::Element(ElementId {
                    element: index,
                    ..id
                });
                let origin = BodyPoint {
                    body: bodies.index(child),
                    at: [0.0; 3],
                };
                bones.push([on(at), origin]);
            }
            if dot(at, at) > 0.0 {
                bones.push([on([0.0; 3]), on(at)]);
                tip = false;
            }
        }
        if tip {
            let element = &elements[id.element];
            let ends = ends(numbers, element).into_iter();
            bones.extend(ends.map(|end| [on([0.0; 3]), on(end)]));
            masses.push(on(numbers.vector(&element.cg)));
        }
    }
    (bones, masses)
}

/// Ends of an element that carries no other element, in its local frame: the ends of the uniform rod with the same mass
/// and the same largest moment about the joint; for an element that turns about its centre of gravity, the ends along
/// its axes.
fn ends(numbers: Numbers<'_>, element: &Element) -> Vec<Vec3> {
    let value = |number: &Number| number.value(numbers.parameters);
    let cg = numbers.vector(&element.cg);
    let moments = numbers.vector(&element.inertia);
    let mass = value(&element.mass);
    let to_cg = dot(cg, cg).sqrt();
    let planar = numbers.model.dimension == Dimension::Plane;
    let largest = if planar {
        moments[1]
    } else {
        moments.into_iter().fold(0.0, f64::max)
    };
    // A uniform rod of half-length h has I = m h²/3.
    let half = (3.0 * largest / mass).max(0.0).sqrt();
    if to_cg > 0.05 * half {
        let factor = 1.0 + half.min(to_cg) / to_cg;
        return vec![cg.map(|c| c * factor)];
    }
    let axes = bryant_rotation(numbers.vector(&element.axes));
    let along =
        |axis: usize, length: f64| -> Vec3 { std::array::from_fn(|i| axes[i][axis] * length) };
    if planar {
        return vec![along(0, half), along(2, half / 2.0)];
    }
    let [a, b, c] = moments;
    // Semi-axes of the homogeneous ellipsoid: a² = 5 (I_y + I_z − I_x) / 2m.
    let squares = [b + c - a, a + c - b, a + b - c];
    let semi = squares.map(|s| (2.5 * s / mass).max(0.0).sqrt());
    (0..3).map(|axis| along(axis, semi[axis])).collect()
}

//! The terms of a contact, and the conditions that the numbers of a plane must meet together.

use super::check::{Against, Contact};
use crate::model::declared::{Declaration, declared_terms};
use crate::model::law::Terms;
use crate::model::requirement::{Curves, List};
use crate::model::rule::Rule;
use crate::model::{Dimension, EdgeRule, Number, Plane};

/// Largest product of tangent and normal, squared, that counts as rounding: up to this they are perpendicular.
const SQUARE_TO: f64 = 1e-12;

impl Terms for Contact {
    declared_terms!();

    fn settle_terms(&mut self) {
        if self.elastic.is_none() {
            self.hysteresis = None;
        }
        if self.damping.is_none() {
            self.damping_depth = None;
        }
        if self.elastic.is_none() && self.damping.is_none() {
            self.friction = None;
        }
        if self.friction.is_none() {
            self.bristle = None;
        }
        let idle = self.elastic.is_none() && self.damping.is_none();
        if let Against::Plane(plane) = &mut self.against {
            if idle {
                plane.extent = None;
            }
            if self.bristle.is_none() && plane.extent.is_none() {
                plane.tangent = [Number::ZERO; 3];
            }
        }
    }

    fn forget_directions(&mut self, dimension: Dimension) {
        let [x, y, z] = &self.ellipsoid.semi_axes;
        if x == z && (dimension == Dimension::Plane || x == y) {
            self.ellipsoid.axes = [Number::ZERO; 3];
        }
    }

    fn require_first(&self, dimension: Dimension, list: &mut List<'_>) {
        if let Against::Plane(plane) = &self.against {
            // before the conditions of the components, which are NaN if the normal has no direction
            let directed = dimension == Dimension::Space && self.bristle.is_some();
            let ends = dimension == Dimension::Space && plane.extent.is_some();
            list.plane(plane, directed || ends);
        }
    }

    fn require(&self, _: Dimension, curves: Curves<'_>, list: &mut List<'_>) {
        if let (Some(loading), Some(law)) = (&self.elastic, &self.hysteresis) {
            list.hysteresis("elastic", loading, law, curves);
        }
    }

    fn flatten(&mut self) -> bool {
        Declaration::flatten(self);
        // a plane with its normal along y would fill the whole plane x–z, so the contact is left out
        let plane = self.against.plane();
        plane.is_none_or(|plane| !plane.normal.iter().all(Number::is_zero))
    }

    fn embed(&mut self, defaults: &[f64]) {
        let mean = |[x, _, z]: &[Number; 3]| {
            Number::Constant(0.5 * (x.value(defaults) + z.value(defaults)))
        };
        self.ellipsoid.semi_axes[1] = mean(&self.ellipsoid.semi_axes);
        match &mut self.against {
            Against::Plane(plane) => {
                let [x, _, z] = plane.normal.clone();
                plane.tangent = [z, Number::ZERO, Number::negative(x)];
                if let Some(extent) = &mut plane.extent {
                    extent.half_lengths.push(Number::Constant(ENDLESS));
                }
            }
            Against::Ellipsoid(second) => second.semi_axes[1] = mean(&second.semi_axes),
        }
    }
}

/// Extent along y of a planar scene in space: nothing moves out of it \[m\].
const ENDLESS: f64 = 1e3;

impl List<'_> {
    fn plane(&mut self, plane: &Plane, directed: bool) {
        let product = |a: &[Number; 3], b: &[Number; 3]| {
            let products = a.iter().zip(b);
            let products = products.map(|(a, b)| Number::product(a.clone(), b.clone()));
            products.fold(Number::ZERO, Number::sum)
        };
        let length = |vector| Number::difference(product(vector, vector), 0.5.into());
        self.together(
            "plane.normal",
            "must have a direction",
            length(&plane.normal),
            Rule::Positive,
            "write a vector of any finite length that points to the side where the ellipsoid belongs, such as `[1, 0]`",
        );
        let tangent = &plane.tangent;
        if directed {
            let along = product(tangent, &plane.normal);
            let slanting = Number::product(along.clone(), along);
            for value in [
                length(tangent),
                Number::difference(SQUARE_TO.into(), slanting),
            ] {
                self.together(
                    "plane.along",
                    "must be a direction along the plane",
                    value,
                    Rule::NotNegative,
                    "write a vector of any finite length that is not parallel to `normal`, such as `[1, 0, 0]`",
                );
            }
        }
        if let Some(extent) = &plane.extent
            && let EdgeRule::Fade(width) = &extent.rule
        {
            for half in &extent.half_lengths {
                self.together(
                    "plane.edge.width",
                    "must be at most the shorter half-length",
                    Number::difference(half.clone(), width.clone()),
                    Rule::NotNegative,
                    "the force fades inside the edge: give at most the shorter half-length",
                );
            }
        }
    }
}

//! The terms of a contact, and the conditions that the numbers of a plane must meet together.

use super::check::{Against, Contact};
use crate::model::law::Terms;
use crate::model::part::{Field, Term, attachment, finite};
use crate::model::requirement::{Curves, List};
use crate::model::rule::Rule;
use crate::model::{Body, Dimension, EdgeRule, Ellipsoid, Number, Plane};

/// Largest product of tangent and normal, squared, that counts as rounding: up to this they are perpendicular.
const SQUARE_TO: f64 = 1e-12;

impl Terms for Contact {
    fn add_fields<'a>(&'a mut self, dimension: Dimension, fields: &mut Vec<Field<'a>>) {
        let Contact {
            ellipsoid,
            semi_axes,
            axes,
            degree: _,
            against,
            elastic,
            hysteresis,
            damping,
            damping_depth,
            friction,
            bristle,
        } = self;
        attachment(ellipsoid, "ellipsoid.center", fields);
        shape(semi_axes, axes, "ellipsoid", dimension, fields);
        let mut edge = None;
        match against {
            Against::Plane(Plane {
                at,
                normal,
                tangent,
                extent,
            }) => {
                attachment(at, "plane.at", fields);
                finite(normal, "plane.normal", fields);
                // only edges and bristles depend on the direction of the tangent
                if extent.is_some() || bristle.is_some() {
                    finite(tangent, "plane.along", fields);
                }
                edge = Some(extent);
            }
            Against::Ellipsoid(Ellipsoid {
                center,
                semi_axes,
                axes,
            }) => {
                attachment(center, "with.center", fields);
                shape(semi_axes, axes, "with", dimension, fields);
            }
        }
        let term = |name: &str, key: &str| Term::new(name, key, Rule::NotNegative);
        let mut elastics = term("elastic", "elastic");
        elastics.keys.push("stiffness".into());
        fields.push(Field::Term(elastics, elastic));
        let mut unloading = term("hysteresis", "unloading").needs("there is no elastic force");
        unloading.keys.push("unloading_slope".into());
        fields.push(Field::Term(unloading, hysteresis));
        fields.push(Field::Term(term("damping", "damping"), damping));
        let fade = term("damping fades in", "damping_depth").needs("there is no damping");
        fields.push(Field::Term(fade.only_as_written(), damping_depth));
        let sliding = term("friction", "friction").needs("nothing presses");
        fields.push(Field::Term(sliding, friction));
        let holds = term("friction holds", "friction_displacement");
        let holds = holds.needs("there is no friction");
        fields.push(Field::Term(holds, bristle));
        if let Some(extent) = edge {
            let ends = term("edge", "plane.extent").needs("nothing presses");
            fields.push(Field::Term(ends, extent));
        }
    }

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
        let [x, y, z] = &self.semi_axes;
        if x == z && (dimension == Dimension::Plane || x == y) {
            self.axes = [Number::ZERO; 3];
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

    fn bodies_mut(&mut self) -> Vec<&mut Body> {
        vec![&mut self.ellipsoid.on, &mut self.against.place_mut().on]
    }

    fn flatten(&mut self) -> bool {
        self.ellipsoid.at[1] = Number::ZERO;
        self.against.place_mut().at[1] = Number::ZERO;
        self.semi_axes[1] = Number::ZERO;
        (self.axes[0], self.axes[2]) = (Number::ZERO, Number::ZERO);
        match &mut self.against {
            Against::Plane(plane) => {
                if let Some(extent) = &mut plane.extent {
                    // Of the two half-lengths, keeps the one that is seen in the plane.
                    let away = plane.tangent[1].constant().is_some_and(|y| y.abs() > 0.5);
                    extent.half_lengths.remove(usize::from(!away));
                }
                plane.normal[1] = Number::ZERO;
                plane.tangent = [Number::ZERO; 3];
                // A plane with its normal along y would fill the whole plane x–z, so the contact is left out.
                !plane.normal.iter().all(Number::is_zero)
            }
            Against::Ellipsoid(second) => {
                second.semi_axes[1] = Number::ZERO;
                (second.axes[0], second.axes[2]) = (Number::ZERO, Number::ZERO);
                true
            }
        }
    }

    fn embed(&mut self, defaults: &[f64]) {
        let mean = |[x, _, z]: &[Number; 3]| {
            Number::Constant(0.5 * (x.value(defaults) + z.value(defaults)))
        };
        self.semi_axes[1] = mean(&self.semi_axes);
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

/// Adds the numbers of the shape of an ellipsoid.
pub(crate) fn shape<'a>(
    semi_axes: &'a mut [Number; 3],
    axes: &'a mut [Number; 3],
    key: &str,
    dimension: Dimension,
    fields: &mut Vec<Field<'a>>,
) {
    for (axis, number) in semi_axes.iter_mut().enumerate() {
        // in the plane the second semi-axis is not used
        let (place, rule) = match (dimension, axis) {
            (Dimension::Space, _) => (axis, Rule::Positive),
            (Dimension::Plane, 1) => (axis, Rule::Finite),
            (Dimension::Plane, _) => (axis / 2, Rule::Positive),
        };
        let key = format!("{key}.semi_axes[{place}]");
        fields.push(Field::Number(key, rule, number));
    }
    finite(axes, &format!("{key}.axes"), fields);
}

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

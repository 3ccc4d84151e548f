//! Outputs of a bushing.

use super::keys::{Bushing, Direction};
use crate::description::output::Output as Written;
use crate::description::place::At;
use crate::expression::Expr;
use crate::expression::vector::Vec3;
use crate::force::{Measures, Value};
use crate::model::law::{OfLaw, Visible};
use crate::model::look::{Line, Look};
use crate::model::resolve::Resolver;
use crate::model::resolve::law::Outputs;
use crate::model::{Body, Component, Projection, Quantity};
use serde::Serialize;

/// A quantity of a bushing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum BushingQuantity {
    /// Force on a body \[N\]; true for the second body, on which the opposite of the force on the first acts.
    Force(bool, Projection),
    /// Moment on a body \[N m\]; true for the second body.
    Moment(bool, Projection),
    /// Displacement of the second frame in the axes of the first \[m\].
    Displacement(Component),
    /// Bryant angle of the second frame relative to the first \[rad\], by its index. With a law of the whole rotation:
    /// a component of the vector of this rotation, in the axes of the first frame.
    Angle(usize),
    /// Angle of the whole rotation \[rad\].
    Turn,
}

impl OfLaw for BushingQuantity {
    fn boxed(&self) -> Box<dyn OfLaw> {
        Box::new(*self)
    }

    fn projection_mut(&mut self) -> Option<&mut Projection> {
        match self {
            BushingQuantity::Force(_, projection) | BushingQuantity::Moment(_, projection) => {
                Some(projection)
            }
            BushingQuantity::Displacement(_)
            | BushingQuantity::Angle(_)
            | BushingQuantity::Turn => None,
        }
    }

    fn component(&self) -> Option<Component> {
        match self {
            BushingQuantity::Force(_, projection) | BushingQuantity::Moment(_, projection) => {
                Some(projection.component)
            }
            BushingQuantity::Displacement(component) => Some(*component),
            BushingQuantity::Angle(_) | BushingQuantity::Turn => None,
        }
    }

    fn exists_in_plane(&self) -> bool {
        match self {
            BushingQuantity::Force(_, projection) => projection.lies_in_plane(),
            BushingQuantity::Moment(_, projection) => projection.is_about_y(),
            BushingQuantity::Displacement(component) => *component != Component::Y,
            BushingQuantity::Angle(axis) => *axis == 1,
            BushingQuantity::Turn => false,
        }
    }
}

/// Name, unit, and two flags: the quantity needs a body; the quantity is about an axis.
const TABLE: [(&str, &str, [bool; 2]); 4] = [
    ("force", "N", [true, false]),
    ("moment", "N*m", [true, true]),
    ("displacement", "m", [false, false]),
    ("angle", "rad", [false, true]),
];

impl Outputs for Bushing {
    fn output(
        &self,
        resolver: &Resolver<'_>,
        written: &Written,
        force: usize,
        at: At<'_>,
    ) -> Option<(Quantity, &'static str)> {
        resolver.of_law(at, "a bushing");
        let (what, unit) = resolver.look_up(written, &TABLE, "a bushing", at)?;
        let [of_body, turns] = what;
        let component = match turns {
            true => resolver.component_of_rotation(written, !of_body, at)?,
            false => resolver.component_of_vector(written, at)?,
        };
        let what = if of_body {
            let bodies = [self.from.on.on, self.to.on.on];
            let on_second = resolver.on_second(written, bodies, at)?;
            let local = bodies[usize::from(on_second)];
            let axes = resolver.axes(written, Some(local), Body::Frame, at)?;
            let projection = Projection { component, axes };
            match turns {
                true => BushingQuantity::Moment(on_second, projection),
                false => BushingQuantity::Force(on_second, projection),
            }
        } else {
            resolver.without(
                at,
                &["axes", "on"],
                "what is measured in the bushing's axes",
            );
            match (turns, component) {
                (false, component) => BushingQuantity::Displacement(component),
                (true, Component::X) => BushingQuantity::Angle(0),
                (true, Component::Y) => BushingQuantity::Angle(1),
                (true, Component::Z) => BushingQuantity::Angle(2),
                (true, Component::Resultant) if self.turn != Direction::default() => {
                    BushingQuantity::Turn
                }
                (true, Component::Resultant) => {
                    resolver.problems.add(at.key("component").problem(
                        "a bushing has three Bryant angles, and no resultant of them",
                        "write `component: x`, `y` or `z`",
                    ));
                    return None;
                }
            }
        };
        Some((Quantity::of_force(force, what), unit))
    }
}

impl Visible for Bushing {
    fn looks(&self) -> Vec<Look<'_>> {
        vec![Look::Line(Line::Bushing, vec![&self.from.on, &self.to.on])]
    }
}

/// Expressions of the quantities of a bushing.
pub struct BushingMeasures<'g> {
    /// Force on the first body \[N\].
    pub force: Vec3<'g>,
    /// Moment on the first body \[N m\].
    pub moment: Vec3<'g>,
    /// Displacement of the second frame in the axes of the first \[m\].
    pub displacement: Vec3<'g>,
    /// Bryant angles of the second frame relative to the first, or the vector of the whole rotation \[rad\].
    pub angles: [Expr<'g>; 3],
    /// Angle of the whole rotation, if there is a law of it \[rad\].
    pub turn: Expr<'g>,
}

impl<'g> Measures<'g> for BushingMeasures<'g> {
    fn on(&self) -> Vec<Vec3<'g>> {
        vec![self.force]
    }

    fn value(&self, asked: &dyn OfLaw) -> Option<Value<'g>> {
        let what = asked.get::<BushingQuantity>()?;
        let on = |second: bool, vector: Vec3<'g>| if second { -vector } else { vector };
        Some(match *what {
            BushingQuantity::Force(second, projection) => {
                Value::Along(projection, on(second, self.force))
            }
            BushingQuantity::Moment(second, projection) => {
                Value::Along(projection, on(second, self.moment))
            }
            BushingQuantity::Displacement(component) => {
                Value::Along(Projection::absolute(component), self.displacement)
            }
            BushingQuantity::Angle(axis) => Value::Scalar(self.angles[axis]),
            BushingQuantity::Turn => Value::Scalar(self.turn),
        })
    }
}

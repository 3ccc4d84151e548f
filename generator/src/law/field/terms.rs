//! The terms of a field: its components.

use super::check::Field as Law;
use crate::model::law::Terms;
use crate::model::part::{Field, components};
use crate::model::{Body, Dimension, FieldComponent, Number};

impl Terms for Law {
    fn add_fields<'a>(&'a mut self, dimension: Dimension, fields: &mut Vec<Field<'a>>) {
        let Law { on, acceleration } = self;
        fields.extend(on.iter().map(|&id| Field::Body(Body::Element(id))));
        components(acceleration, "", "acceleration", dimension, fields);
    }

    fn flatten(&mut self) -> bool {
        self.acceleration[1] = FieldComponent::Constant(Number::ZERO);
        true
    }
}

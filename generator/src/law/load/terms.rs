//! The terms of a given load: the components of its force and its moment.

use super::check::Load;
use crate::model::law::Terms;
use crate::model::part::{Field, Part, Term, attachment, components};
use crate::model::rule::Rule;
use crate::model::{Body, Dimension, FieldComponent, Number};

impl Terms for Load {
    fn add_fields<'a>(&'a mut self, dimension: Dimension, fields: &mut Vec<Field<'a>>) {
        let Load { on, force, moment } = self;
        attachment(on, "at", fields);
        components(force, "force ", "force", dimension, fields);
        match dimension {
            Dimension::Plane => {
                fields.push(Field::Term(
                    Term::new("moment", "moment", Rule::Finite),
                    &mut moment[1],
                ));
            }
            Dimension::Space => components(moment, "moment ", "moment", dimension, fields),
        }
    }

    fn settle_terms(&mut self) {
        if !self.force.iter().any(Part::is_in) {
            self.on.at = [Number::ZERO; 3];
        }
    }

    fn bodies_mut(&mut self) -> Vec<&mut Body> {
        vec![&mut self.on.on]
    }

    fn flatten(&mut self) -> bool {
        self.on.at[1] = Number::ZERO;
        self.force[1] = FieldComponent::Constant(Number::ZERO);
        for axis in [0, 2] {
            self.moment[axis] = FieldComponent::Constant(Number::ZERO);
        }
        true
    }
}

//! The terms of a spring.

use super::check::Spring;
use crate::model::law::Terms;
use crate::model::part::{Field, Term, attachment};
use crate::model::rule::Rule;
use crate::model::{Body, Dimension, Number};

impl Terms for Spring {
    fn add_fields<'a>(&'a mut self, _: Dimension, fields: &mut Vec<Field<'a>>) {
        let Spring {
            from,
            to,
            elastic,
            length,
            damping,
        } = self;
        attachment(from, "from.at", fields);
        attachment(to, "to.at", fields);
        let term = |name: &str, key: &str| Term::new(name, key, Rule::NotNegative);
        let mut elastics = term("elastic", "elastic");
        elastics.keys.push("stiffness".into());
        fields.push(Field::Term(elastics, elastic));
        if let Some(length) = length {
            fields.push(Field::Number("length".into(), Rule::NotNegative, length));
        }
        fields.push(Field::Term(term("damping", "damping"), damping));
    }

    fn settle_terms(&mut self) {
        if self.elastic.is_none() {
            self.length = None;
        }
    }

    fn bodies_mut(&mut self) -> Vec<&mut Body> {
        vec![&mut self.from.on, &mut self.to.on]
    }

    fn flatten(&mut self) -> bool {
        self.from.at[1] = Number::ZERO;
        self.to.at[1] = Number::ZERO;
        true
    }
}

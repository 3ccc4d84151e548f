//! The terms of a bushing: elastic and viscous, for each direction.

use super::check::{Bushing, Direction, Mount};
use crate::model::law::Terms;
use crate::model::part::{AXES, Field, Term, attachment, finite};
use crate::model::rule::Rule;
use crate::model::{Body, Dimension, Number};

impl Terms for Bushing {
    fn add_fields<'a>(&'a mut self, dimension: Dimension, fields: &mut Vec<Field<'a>>) {
        let Bushing {
            from,
            to,
            along,
            about,
            turn,
        } = self;
        for (key, mount) in [("from", from), ("to", to)] {
            let Mount { on, axes } = mount;
            attachment(on, &format!("{key}.at"), fields);
            finite(axes, &format!("{key}.axes"), fields);
        }
        for (key, laws) in [("along", along), ("about", about)] {
            for (axis, law) in laws.iter_mut().enumerate() {
                if dimension == Dimension::Space || (axis == 1) == (key == "about") {
                    direction(law, key, AXES[axis], fields);
                }
            }
        }
        if dimension == Dimension::Space {
            direction(turn, "about", "turn", fields);
        }
    }

    fn bodies_mut(&mut self) -> Vec<&mut Body> {
        vec![&mut self.from.on.on, &mut self.to.on.on]
    }

    fn flatten(&mut self) -> bool {
        for mount in [&mut self.from, &mut self.to] {
            mount.on.at[1] = Number::ZERO;
            (mount.axes[0], mount.axes[2]) = (Number::ZERO, Number::ZERO);
        }
        self.along[1] = Direction::default();
        if self.turn != Direction::default() {
            self.about[1] = std::mem::take(&mut self.turn);
        }
        (self.about[0], self.about[2]) = (Direction::default(), Direction::default());
        true
    }
}

/// Adds the terms of the law along or about an axis, or of the whole rotation.
fn direction<'a>(law: &'a mut Direction, key: &str, axis: &str, fields: &mut Vec<Field<'a>>) {
    let Direction { elastic, damping } = law;
    let term = |term: &str| {
        let name = format!("{term} {key} {axis}");
        Term::new(name, format!("{key}.{axis}.{term}"), Rule::NotNegative)
    };
    let mut elastics = term("elastic");
    elastics.keys.push(format!("{key}.{axis}.stiffness"));
    fields.push(Field::Term(elastics, elastic));
    fields.push(Field::Term(term("damping"), damping));
}

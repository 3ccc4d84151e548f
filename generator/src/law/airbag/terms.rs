//! The terms of an airbag: its inflow, its gas at the start, its outflow.

use super::check::{Airbag, Filled, Inflow};
use crate::law::contact::terms::shape;
use crate::model::law::Terms;
use crate::model::part::{Field, Fresh, Part, Term, as_written, attachment};
use crate::model::requirement::{Curves, List};
use crate::model::rule::{Rule, Ruled};
use crate::model::{Body, Dimension, Ellipsoid, Number, ScaledCurve};

impl Terms for Airbag {
    fn add_fields<'a>(&'a mut self, dimension: Dimension, fields: &mut Vec<Field<'a>>) {
        let Airbag {
            bag,
            against,
            inflow,
            vent,
            constant,
            gamma,
            ambient_pressure,
            ambient_temperature,
            start,
        } = self;
        let mut ellipsoid = |ellipsoid: &'a mut Ellipsoid, key: &str| {
            let Ellipsoid {
                center,
                semi_axes,
                axes,
            } = ellipsoid;
            attachment(center, &format!("{key}.center"), fields);
            shape(semi_axes, axes, key, dimension, fields);
        };
        ellipsoid(bag, "ellipsoid");
        for (index, other) in against.iter_mut().enumerate() {
            ellipsoid(other, &format!("against[{index}]"));
        }
        for (key, number) in [
            ("gas.constant", constant),
            ("gas.gamma", gamma),
            ("ambient.pressure", ambient_pressure),
            ("ambient.temperature", ambient_temperature),
        ] {
            fields.push(Field::Number(key.into(), Rule::Positive, number));
        }
        let flows = Term::new("inflow", "inflow", Rule::Finite).only_as_written();
        fields.push(Field::Term(flows, inflow));
        let filled = Term::new("gas at the start", "start", Rule::Positive).only_as_written();
        fields.push(Field::Term(filled, start));
        let leaves = Term::new("vent", "vent.area", Rule::NotNegative);
        fields.push(Field::Term(leaves.needs("there is no gas"), vent));
    }

    fn require(&self, _: Dimension, _: Curves<'_>, list: &mut List<'_>) {
        if let Some(inflow) = &self.inflow {
            let path = "inflow.flow.times".into();
            list.number(path, &inflow.flow.times, Rule::NotNegative);
        }
        list.together(
            "gas.gamma",
            "must be more than 1",
            Number::difference(self.gamma.clone(), 1.0.into()),
            Rule::Positive,
            "give the ratio of specific heats: 1.4 of air",
        );
        if let Some(start) = &self.start {
            list.together(
                "start.pressure",
                "must be at least that around the bag",
                Number::difference(start.pressure.clone(), self.ambient_pressure.clone()),
                Rule::NotNegative,
                "a full bag has at least the pressure around it; leave `start` out for one that is folded",
            );
        }
    }

    fn bodies_mut(&mut self) -> Vec<&mut Body> {
        let ellipsoids = self.ellipsoids_mut();
        ellipsoids
            .map(|ellipsoid| &mut ellipsoid.center.on)
            .collect()
    }

    fn switches_mut(&mut self) -> Vec<&mut usize> {
        self.inflow.iter_mut().map(|i| &mut i.fire).collect()
    }

    /// A bag has no volume in the plane.
    fn exists_in_plane(&self) -> bool {
        false
    }

    fn flatten(&mut self) -> bool {
        false
    }
}

as_written! {
    Inflow { temperature: Positive } {} [flow] - fire;
    Filled { pressure: Positive, temperature: Positive } {} [];
}

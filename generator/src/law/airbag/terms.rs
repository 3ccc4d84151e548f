//! The terms of an airbag: its inflow, its gas at the start, its outflow.

use super::check::Airbag;
use crate::model::declared::declared_terms;
use crate::model::law::Terms;
use crate::model::requirement::{Curves, List};
use crate::model::rule::Rule;
use crate::model::{Dimension, Number};

impl Terms for Airbag {
    declared_terms!();

    fn require(&self, _: Dimension, _: Curves<'_>, list: &mut List<'_>) {
        if let Some(inflow) = &self.inflow {
            let path = "inflow.flow.times".into();
            list.number(path, &inflow.flow.times, Rule::NotNegative);
        }
        list.together(
            "gas.gamma",
            "must be more than 1",
            Number::difference(self.gas.gamma.clone(), 1.0.into()),
            Rule::Positive,
            "give the ratio of specific heats: 1.4 of air",
        );
        if let Some(start) = &self.start {
            list.together(
                "start.pressure",
                "must be at least that around the bag",
                Number::difference(start.pressure.clone(), self.ambient.pressure.clone()),
                Rule::NotNegative,
                "a full bag has at least the pressure around it; leave `start` out for one that is folded",
            );
        }
    }

    /// A bag has no volume in the plane.
    fn exists_in_plane(&self) -> bool {
        false
    }

    fn flatten(&mut self) -> bool {
        false
    }
}

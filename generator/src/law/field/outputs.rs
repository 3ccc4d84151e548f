//! A field is given, and has no outputs.

use super::keys::Field;
use crate::description::output::Output as Written;
use crate::description::place::At;
use crate::model::Quantity;
use crate::model::law::Visible;
use crate::model::resolve::Resolver;
use crate::model::resolve::law::Outputs;

impl Outputs for Field {
    fn output(
        &self,
        _: &Resolver<'_>,
        _: &Written,
        _: usize,
        _: At<'_>,
    ) -> Option<(Quantity, &'static str)> {
        None
    }
}

impl Visible for Field {}

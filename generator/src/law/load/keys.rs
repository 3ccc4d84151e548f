//! The keys of a given load.

use crate::description::force::Acting;
use crate::description::measure::{Force, Moment};
use crate::description::point::Point;
use crate::description::shape::Flat;
use crate::diagnostic::quoted;
use crate::model::Number;
use crate::model::declared::{
    AxialVector, DeclaredLaw, PointOfElement, PolarVector, Reader, Written, declare, declared_terms,
};
use crate::model::law::Terms;
use crate::model::part::Part;

/// The keys of a load.
pub type LoadKeys = Written<Load>;

declare! {
    /// A given force and moment in absolute axes: thrust, actuation, a reaction known from a test.
    Load as "a load" only written {
        /// name, unique among the loads
        load: String,
        /// when it acts
        acting: Flat<Acting>,
        /// `true` adds its [mirror image](#a-mirror)
        mirror: Option<bool> = "`false`",
    } and kept {
        /// the element, as `system/element`
        on: PointOfElement {
            /// where the force acts: `cg`, or coordinates in the local frame
            at: Option<Point> = "the joint of the element",
        },
        /// per absolute axis: a number, or a curve of time (s → N)
        force: Option<PolarVector<Force>> = "0",
        /// a number, or a curve of time (s → N·m): about +y in the plane; `[x, y, z]` in absolute axes in space
        moment: Option<AxialVector<Moment>> = "0",
    }
}

impl DeclaredLaw for Load {
    const KEY: &'static str = "load";
    const OBSERVABLE: bool = false;

    fn check_keys(name: &str, reader: &Reader<'_, '_, '_>) {
        if !reader.has("force") && !reader.has("moment") {
            reader
                .resolver
                .problems
                .add(reader.at.key("load").key_problem(
                format!("the load {} has neither force nor moment", quoted(name)),
                "add `force: …` or `moment: …`; a load that is switched off says `enabled: false`",
            ));
        }
    }
}

impl Terms for Load {
    declared_terms!(flatten);

    fn settle_terms(&mut self) {
        if !self.force.iter().any(Part::is_in) {
            self.on.at = [Number::ZERO; 3];
        }
    }
}

//! The keys of a given load.

use crate::description::expand::{Expander, Node};
use crate::description::force::Acting;
use crate::description::measure::{Force, Moment};
use crate::description::place::At;
use crate::description::point::Point;
use crate::description::shape::Flat;
use crate::diagnostic::quoted;
use crate::model::declared::{
    About, Along, DeclaredLaw, Kind, Names, Reader, Written, declare, declared_terms,
};
use crate::model::law::Terms;
use crate::model::part::{Field, Part, attachment};
use crate::model::resolve::{NOWHERE, Resolver};
use crate::model::{Attachment, Body, ElementId, Number};

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
        force: Option<Along<Force>> = "0",
        /// a number, or a curve of time (s → N·m): about +y in the plane; `[x, y, z]` in absolute axes in space
        moment: Option<About<Moment>> = "0",
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

/// A point of an element at the key `at`, by default its joint.
pub struct PointOfElement;

impl Kind for PointOfElement {
    type Written = String;
    type Kept = Attachment;

    fn keep(reader: &mut Reader<'_, '_, '_>, key: &'static str) -> Option<Attachment> {
        let path: String = reader.written(key)?;
        let element = loaded_element(reader.resolver, &path, reader.at.key(key))?;
        let point: Option<Point> = reader.written("at")?;
        let place = reader.at.key("at");
        Some(Attachment {
            on: Body::Element(element),
            at: point.map_or(NOWHERE, |point| {
                reader.resolver.point(&point, element, place)
            }),
        })
    }

    fn add_fields<'a>(kept: &'a mut Attachment, _: &Names<'_>, to: &mut Vec<Field<'a>>) {
        attachment(kept, "at", to);
    }

    fn add_bodies<'a>(kept: &'a mut Attachment, bodies: &mut Vec<&'a mut Body>) {
        Attachment::add_bodies(kept, bodies);
    }

    fn flatten(kept: &mut Attachment) {
        Attachment::flatten(kept);
    }

    fn mirror(expander: &Expander<'_>, record: &mut Node, key: &str) {
        record.change(key, |element| expander.body(element));
        record.change("at", |point| expander.polar(point));
    }
}

/// The element that a load acts on. The absolute frame is refused.
fn loaded_element(resolver: &Resolver<'_>, path: &str, at: At<'_>) -> Option<ElementId> {
    if path == "frame" {
        resolver.problems.add(at.problem(
            "a load on the absolute frame moves nothing",
            "name an element, as `system/element`",
        ));
        return None;
    }
    resolver.element_id(path, at)
}

//! The YAML as written: a type for each record, one file per concept, and the places of everything in the text.
//!
//! ```text
//! text ─tree→ located tree ─shape→ checked ─expand→ long form ─read→ Model, Included ─load→ all files of a model
//! ```
//!
//! One mistake hides no other: what is wrong is reported and [taken out](mend), and the rest is read and resolved.
//! [`slip`] names slips of the pen, [`file_content`] what a file is that is no model.
//!
//! Unknown keys are errors. Limits keep hostile text from costing time: files up to 16 MiB, nesting up to 32, 2000
//! elements, 10 000 points of a curve, 10 000 entries of any other list, 64 files; no aliases, anchors and tags.

pub mod criteria;
pub mod curve;
pub mod element;
pub mod expand;
pub mod expression;
pub mod file_content;
pub mod force;
pub mod joint;
pub mod language;
pub mod load;
pub mod long_form;
pub mod measure;
pub mod mend;
pub mod mesh;
pub mod output;
pub mod parameter;
pub mod part;
pub mod person;
pub mod place;
pub mod point;
pub mod quantity;
pub mod rule;
pub mod run;
pub mod schema;
pub mod shape;
pub mod short_forms;
pub mod slip;
pub mod surface;
pub mod switch;
pub mod system;
pub mod table;
mod token;
pub mod tree;
mod value;
pub mod vehicle;

pub use bryant_table::unit;

use language::Language;
use shape::{Key, Record};

/// Every record of the language: what it is called and its keys, in the order of the reference page.
pub fn vocabulary(language: &Language) -> Vec<(&'static str, Vec<Key>)> {
    fn of<R: Record>() -> (&'static str, Vec<Key>) {
        (R::TITLE, R::keys())
    }
    let mut all = vec![
        of::<load::Model>(),
        of::<load::Included>(),
        of::<short_forms::Instance>(),
        of::<short_forms::Person>(),
        of::<short_forms::Human>(),
        of::<short_forms::HumanAngles>(),
        of::<short_forms::Part>(),
        of::<short_forms::Mirror>(),
        of::<parameter::Parameter>(),
        of::<quantity::Param>(),
        of::<curve::Curve>(),
        of::<curve::ScaledCurve>(),
        of::<vehicle::Vehicle>(),
        of::<vehicle::Start>(),
        of::<system::System>(),
        of::<system::Prescribed>(),
        of::<system::Riding>(),
        of::<system::Start>(),
        of::<element::Element>(),
        of::<element::NamedPoint>(),
        of::<element::Anatomy>(),
        of::<mesh::Mesh>(),
        joint::keys(language),
        of::<joint::Follows>(),
    ];
    let laws = language.laws.iter().flat_map(|law| (law.records)());
    all.extend(laws);
    all.extend([
        of::<switch::Switch>(),
        of::<switch::Trigger>(),
        of::<output::Output>(),
        of::<output::Formula>(),
        of::<run::Run>(),
        of::<criteria::Criteria>(),
    ]);
    all
}

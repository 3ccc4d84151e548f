//! What the equations of a variant cost: operations of the emitted text, after all passes.

use super::Variant;
use crate::emit;
use crate::expression::count::{Count, Table};
use crate::formalism::{self, derive_without};

/// Operations of one evaluation.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    /// Of `accelerations`.
    pub accelerations: Count,
    /// Of `outputs`; where it calls `accelerations`, without them.
    pub outputs: Count,
}

/// Operations of a variant.
pub fn cost(variant: &Variant) -> Cost {
    let equations = derive_without(&variant.model, OPTIONS, variant.omitted);
    let tables = emit::costs(&variant.model, &equations, &EMITTED);
    let of = |method: &str| {
        let found = tables.iter().find(|(name, _)| *name == method);
        found.map_or_else(Count::default, |(_, table): &(_, Table)| {
            table.total.clone()
        })
    };
    Cost {
        accelerations: of("accelerations"),
        outputs: of("outputs"),
    }
}

/// The module of a variant, without matrices.
pub fn source(variant: &Variant) -> String {
    let equations = derive_without(&variant.model, OPTIONS, variant.omitted);
    emit::module(&variant.model, &equations, &EMITTED)
}

/// A module without what names the model that it is of: two variants with the same equations have the same.
pub fn anonymous(source: &str) -> String {
    let lines = source.lines().skip_while(|line| line.starts_with("//"));
    let lines = lines.map(|line| match line.trim_start().starts_with("digest: ") {
        true => "    digest: \"\",",
        false => line,
    });
    lines.collect::<Vec<_>>().join("\n")
}

const EMITTED: emit::Options = emit::Options {
    matrices: false,
    ..emit::Options::DEFAULT
};

const OPTIONS: formalism::Options = formalism::Options {
    matrices: false,
    route: None,
};

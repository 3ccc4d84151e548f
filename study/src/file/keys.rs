//! The keys of a study, as declarations: from them follow the check of a file, the tables of its page, and the schema.
//!
//! What numbers are measured in depends on the parameter that they belong to, so that values are read from the located
//! tree, once the file has this shape.

use crate::response;
use crate::study::{LaneFormula, Precision, TableKind};
use bryant_generator::description::measure::Time;
use bryant_generator::description::place::At;
use bryant_generator::description::schema::{Schema, any_of, list_of, mapping_of, typed};
use bryant_generator::description::shape::{
    In, Key, Misfit, Named, Problems, Record, Shape, Value, check_record, record, words,
};
use bryant_generator::description::tree::NodeKind;
use bryant_runtime::response::filter::Filter;

record! {
    /// A study.
    Keys as "a study" {
        /// a bundled model, or the path of a file, relative to the study
        model: String,
        /// [which rows](#designs)
        design: Design,
        /// how many, up to 1e9; not for `grid` and `list`
        runs: Option<Scalar> = "required but for `grid` and `list`",
        /// start of the random numbers
        seed: Option<Scalar> = "0",
        /// [what differs between runs](#parameters); not for `list`
        parameters: Option<Named<Varied>> = "required but for `list`",
        /// parameters that have another value than the model's, the same in all runs
        fixed: Option<Named<Scalar>>,
        /// [the rows of a list](#designs)
        rows: Option<Rows> = "required for `list`",
        /// [how each run is computed](#the-runs-of-a-study)
        run: Option<Run> = "as the model says",
        /// [what is read off each run](#responses): [responses](#a-response) and [criteria](#a-criterion)
        responses: Vec<Asked>,
        /// [time series that are kept](#series-that-are-kept) as CSV
        keep: Option<Keep>,
        /// `parquet`, `csv`
        tables: Option<Vec<TableKind>> = "`[parquet]`",
    }
}

words! {
    /// How rows are chosen.
    Design {
        /// All combinations.
        Grid = "grid",
        /// As written.
        List = "list",
        /// Equally probable parts.
        LatinHypercube = "latin hypercube",
        /// A Sobol' sequence.
        Sobol = "sobol",
        /// Independent.
        MonteCarlo = "monte carlo",
        /// Groups for Sobol' indices.
        Saltelli = "saltelli",
    }
}

record! {
    /// The values of a parameter.
    Varied as "a varied parameter" {
        /// lower end of an interval
        from: Option<Scalar>,
        /// upper end of an interval
        to: Option<Scalar>,
        /// in a grid: number of values from `from` to `to`, both included
        steps: Option<Scalar>,
        /// the only values
        values: Option<Vec<Scalar>>,
        /// how probable each of the `values` is, in any proportion; not in a grid
        weights: Option<Vec<Scalar>> = "equally probable",
        /// a [normal distribution](#a-normal-distribution)
        normal: Option<Normal>,
        /// a [lognormal distribution](#a-lognormal-distribution)
        lognormal: Option<Lognormal>,
        /// a [triangle](#a-triangular-distribution)
        triangular: Option<Triangular>,
        /// where a normal or lognormal distribution is cut off
        min: Option<Scalar> = "not cut off",
        /// where it is cut off above
        max: Option<Scalar> = "not cut off",
    }
}

record! {
    /// A normal distribution.
    Normal as "a normal distribution" {
        /// its mean
        mean: Scalar,
        /// its standard deviation, more than 0
        deviation: Scalar,
    }
}

record! {
    /// A distribution whose logarithm is normal.
    Lognormal as "a lognormal distribution" {
        /// its median, more than 0
        median: Scalar,
        /// the standard deviation of its natural logarithm, more than 0
        deviation: Scalar,
    }
}

record! {
    /// A density of straight lines.
    Triangular as "a triangular distribution" {
        /// the smallest value
        from: Scalar,
        /// the most probable value
        mode: Scalar,
        /// the largest value
        to: Scalar,
    }
}

record! {
    /// Settings of all runs.
    Run as "the runs of a study" {
        /// length of a run
        duration: Option<In<Scalar, Time>> = "the model's",
        /// relative error of the responses that is aimed at
        accuracy: Option<Scalar> = "0.1 %",
        /// time between the samples that responses are read off
        sampling: Option<In<Scalar, Time>> = "20 between two rows of the model's table, more where a filter needs them",
        /// [fixed steps](#fixed-steps) of this length, instead of `accuracy`
        step: Option<In<Scalar, Time>>,
        /// of fixed steps: `heun`, `rk4`, `merson` or `dopri5`
        method: Option<LaneFormula> = "`rk4`",
        /// of fixed steps: share of energy and momentum that may be missing
        energy_limit: Option<Scalar> = "2 %",
        /// `double`, or [`single`](#single-precision)
        precision: Option<Precision> = "`double`",
    }
}

record! {
    /// A number that is read off each run.
    Response as "a response" {
        /// heading of its column
        name: Option<String> = "such as `peak of NAME`",
        /// an output of the model
        of: String,
        /// which [number](#responses)
        what: What,
        /// of `value`: the time
        at: Option<In<Scalar, Time>> = "required for `value`",
        /// of clips: for how long
        duration: Option<In<Scalar, Time>> = "required for clips",
        /// `CFC60` to `CFC1000`, or `SAE CFC60` to `SAE CFC1000`: filters the output first
        filter: Option<Class> = "that of the output",
    }
}

record! {
    /// An injury criterion, or all of them.
    Criterion as "a criterion" {
        /// a [criterion](reference.md#a-set-of-criteria) of the model by its name, or `all`
        criterion: String,
        /// heading of its column; not with `all`
        name: Option<String> = "that of the criterion",
    }
}

record! {
    /// Runs whose time series are kept.
    Keep as "series that are kept" {
        /// these runs, by their index from 0
        runs: Option<Vec<Scalar>> = "this or `every`",
        /// runs 0, n, 2 n, …
        every: Option<Scalar> = "this or `runs`",
        /// of each run these outputs
        outputs: Option<Vec<String>> = "all outputs",
    }
}

record! {
    /// Rows in a file.
    File as "rows from a file" {
        /// a CSV file whose heading names parameters, relative to the study
        csv: String,
    }
}

/// Every record of a study, in the order of its page.
pub fn vocabulary() -> Vec<(&'static str, Vec<Key>)> {
    fn of<R: Record>() -> (&'static str, Vec<Key>) {
        (R::TITLE, R::keys())
    }
    vec![
        of::<Keys>(),
        of::<File>(),
        of::<Varied>(),
        of::<Normal>(),
        of::<Lognormal>(),
        of::<Triangular>(),
        of::<Response>(),
        of::<Criterion>(),
        of::<Run>(),
        of::<Keep>(),
    ]
}

/// Declares shapes whose values are read from the located tree.
macro_rules! shapes {
    ($($(#[$meta:meta])* $name:ident |$to:ident| $schema:expr, |$at:ident, $problems:ident| $check:expr;)*) => {$(
        $(#[$meta])*
        #[derive(Clone, Copy, Debug)]
        pub struct $name;

        impl Shape for $name {
            fn schema($to: &mut Schema) -> Value {
                $schema
            }

            fn check($at: At<'_>, $problems: &Problems) {
                $check;
            }

            fn read(_: &Value) -> Result<Self, Misfit> {
                Ok($name)
            }
        }
    )*};
}

shapes! {
    /// A number, with its unit or in SI.
    Scalar |_to| any_of([typed("number"), typed("string")]), |at, problems| {
        if !matches!(at.node.kind, NodeKind::Scalar { .. }) || at.node.is_null() {
            problems.add(at.problem(
                format!("here stands {}, but a number is needed", at.node.article()),
                "write a number, or one with its unit such as `10 mm`",
            ));
        }
    };

    /// Rows as written, or the file that has them.
    Rows |to| any_of([list_of(mapping_of(Scalar::schema(to))), File::schema(to)]), |at, problems| match at.node.kind {
        NodeKind::Map(_) => check_record::<File>(at, problems),
        _ => Vec::<Named<Scalar>>::check(at, problems),
    };

    /// A response, or a criterion.
    Asked |to| any_of([Response::schema(to), Criterion::schema(to)]), |at, problems| match at.node.get("criterion") {
        Some(_) => check_record::<Criterion>(at, problems),
        None => check_record::<Response>(at, problems),
    };

    /// The number that is read off a run. Reading suggests other words.
    What |_to| bryant_generator::description::schema::words(&response::NAMES.map(|(name, _)| name)),
        |at, problems| String::check(at, problems);

    /// A filter.
    Class |_to| {
        let names: Vec<String> = Filter::all().map(|filter| filter.to_string()).collect();
        let words: Vec<&str> = names.iter().map(String::as_str).collect();
        bryant_generator::description::schema::words(&words)
    }, |at, problems| String::check(at, problems);
}

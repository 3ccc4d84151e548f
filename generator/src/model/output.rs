//! Columns of the output table.

use super::quantity::Quantity;
use serde::Serialize;

/// A column of the output table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Output {
    /// Heading, unique.
    pub name: String,
    /// The quantity that is measured.
    pub quantity: Quantity,
    /// SI unit of the values.
    pub unit: String,
    /// Channel code of ISO-MME, 16 letters and digits, unique.
    pub code: Option<String>,
    /// The filter that tables, responses and studies apply: `CFC60`, `CFC180`, `CFC600` or `CFC1000`; those of SAE
    /// J211-1 with `SAE` in front. Generated code returns unfiltered values.
    pub filter: Option<&'static str>,
    /// The output as a channel of a test, for an output whose code gives a direction, or that the criteria name.
    pub channel: Option<Channel>,
}

/// An output in the axes and signs of SAE J211-1 and ISO 6487: x forward, y to the right, z down. Loads are those of
/// the lower part on the upper part of a body that stands upright.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Channel {
    /// True if the channel has the opposite sign of the quantity.
    pub reversed: bool,
    /// A remark on the place of measurement.
    #[serde(skip)]
    pub remark: Option<&'static str>,
}

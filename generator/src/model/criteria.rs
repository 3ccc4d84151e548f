//! The criteria by which a run is judged.

/// The criteria by which a run is judged.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Criteria {
    /// The regulation.
    pub standard: String,
    /// The dummy.
    pub dummy: String,
    /// True for the filters of SAE J211-1, false for those of ISO 6487.
    pub sae: bool,
    /// Test object and position of the occupant: the first two characters of the codes of its outputs; `None` if there
    /// is only one occupant.
    pub occupant: Option<String>,
    /// The known places of the dummy, such as `neck-fx`, each with the name of the output that measures there.
    pub places: Vec<(String, String)>,
}

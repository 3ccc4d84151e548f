//! Corridors of a regulation: boxes in plots over time that a curve should pass through.

use crate::quantity::quantity;

/// A box in the plots of one column over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Corridor {
    /// Name of the column.
    pub of: String,
    /// From and to, of time \[s\] and of the column in its unit; infinite on an open side.
    pub bounds: [[f64; 2]; 2],
}

impl Corridor {
    /// Reads 'rotation: 57 ms to 64 ms, 64 deg to 78 deg' for a table with these columns, each given as (name, unit);
    /// `any` leaves a side open.
    ///
    /// # Errors
    /// A message that says what is wrong.
    pub fn read(text: &str, columns: &[(&str, &str)]) -> Result<Corridor, String> {
        let usage = "write 'NAME: TIME to TIME, VALUE to VALUE', such as 'rotation: 57 ms to 64 ms, 64 deg to 78 deg'; `any` leaves a side open";
        let malformed = || format!("--corridor '{text}' is not understood\n  help: {usage}");
        let (of, bounds) = text.rsplit_once(':').ok_or_else(malformed)?;
        let of = of.trim();
        let Some((_, unit)) = columns.iter().find(|(name, _)| *name == of) else {
            let names: Vec<&str> = columns.iter().map(|(name, _)| *name).collect();
            return Err(format!(
                "--corridor '{text}': there is no column \"{of}\"\n  help: the columns are {}",
                names.join(", ")
            ));
        };
        let (times, values) = bounds.split_once(',').ok_or_else(malformed)?;
        let side = |text: &str, unit: &str| -> Result<[f64; 2], String> {
            if text.trim() == "any" {
                return Ok([f64::NEG_INFINITY, f64::INFINITY]);
            }
            let (from, to) = text.split_once(" to ").ok_or_else(malformed)?;
            let number = |number: &str| {
                quantity(number.trim(), unit)
                    .map_err(|error| format!("--corridor '{text}': {error}"))
            };
            let bounds = [number(from)?, number(to)?];
            match bounds[0] <= bounds[1] {
                true => Ok(bounds),
                false => Err(format!(
                    "--corridor '{text}' ends before it begins\n  help: {usage}"
                )),
            }
        };
        Ok(Corridor {
            of: of.to_owned(),
            bounds: [side(times, "s")?, side(values, unit)?],
        })
    }
}

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
    /// Reads 'rotation: 57 ms to 64 ms, 64 deg to 78 deg' for a table with these columns, each given as (name, unit); `any` leaves a side
    /// open.
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

#[cfg(test)]
mod tests {
    use super::Corridor;

    #[test]
    fn corridors_are_read_in_units_and_refused_with_the_reason() {
        let columns = [("time", "s"), ("neck: rotation", "rad"), ("moment", "N*m")];
        let read = |text| Corridor::read(text, &columns);
        let found = read("neck: rotation: 57 ms to 0.064 s, 0.5 to 90 deg").unwrap();
        assert_eq!(found.of, "neck: rotation");
        assert_eq!(found.bounds[0], [0.057, 0.064]);
        assert_eq!(found.bounds[1], [0.5, std::f64::consts::FRAC_PI_2]);
        let open = read("moment: any, -1 to 2 N*m").unwrap();
        assert_eq!(open.bounds[0], [f64::NEG_INFINITY, f64::INFINITY]);
        for (text, told) in [
            ("moment", "not understood"),
            ("moment: 1 ms to 2 ms", "not understood"),
            ("moment: 1 ms, 2 to 3", "not understood"),
            ("force: any, any", "no column \"force\""),
            ("moment: any, 3 N to 4 N", "N*m"),
            ("moment: any, 4 to 3", "ends before"),
        ] {
            let error = read(text).unwrap_err();
            assert!(error.contains(told), "{text}: {error}");
        }
    }
}

//! Filters signals by channel frequency classes (ISO 6487, SAE J211-1); [`bryant_runtime::response::filter`] has the
//! mathematics.

use crate::Signal;
use crate::mme::is_code;
use bryant_runtime::response::filter;
pub use bryant_runtime::response::filter::{Class, Standard, coefficients};
use thiserror::Error;

/// The letter of a class in a channel code of ISO-MME.
pub fn letter(class: Class) -> char {
    match class {
        Class::Cfc60 => 'D',
        Class::Cfc180 => 'C',
        Class::Cfc600 => 'B',
        Class::Cfc1000 => 'A',
    }
}

/// The class with which the samples of a channel were filtered, by its channel code of ISO-MME; `None` if the code
/// names no class, or is not a channel code.
pub fn class_of_code(code: &str) -> Option<Class> {
    let last = last_of_code(code)?;
    // E to H are the classes A to D by the editions of 1987 and 1988
    let last = match last {
        'E'..='H' => char::from(last as u8 - b'E' + b'A'),
        last => last,
    };
    Class::ALL.into_iter().find(|class| letter(*class) == last)
}

/// The filter of a channel in words, by its channel code of ISO-MME, if it forbids a further filter: it removes more
/// than every class, or is not known well enough. `None` for other filters.
pub fn narrow_filter(code: &str) -> Option<&'static str> {
    match last_of_code(code)? {
        '1' => Some("the filter FIR 100"),
        'L' => Some("CFC20"),
        'Q' => Some("a filter below CFC60"),
        'X' => Some("nothing, for it is no time history"),
        _ => None,
    }
}

/// The last character of a channel code, which stands for the filter.
fn last_of_code(code: &str) -> Option<char> {
    code.chars().nth(15).filter(|_| is_code(code))
}

/// Reads a class, written as `CFC180`, `cfc 180` or `180`.
///
/// # Errors
/// There is no such class.
pub fn class(text: &str) -> Result<Class, UnknownClass> {
    let upper = text.trim().to_ascii_uppercase();
    let number = upper.strip_prefix("CFC").unwrap_or(&upper).trim();
    let known = Class::ALL
        .into_iter()
        .find(|class| class.number().to_string() == number);
    known.ok_or_else(|| UnknownClass(text.to_owned()))
}

/// The text is not a class.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("there is no filter class `{0}`: give CFC60, CFC180, CFC600 or CFC1000")]
pub struct UnknownClass(pub String);

/// Why a signal cannot be filtered.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum FilterError {
    /// The samples are too far apart for the class.
    #[error("{class} needs a sample every {:.3} ms at least, but there is one every {:.3} ms", 1e3 * class.longest_interval(), 1e3 * interval)]
    TooCoarse {
        /// The class.
        class: Class,
        /// Time between the samples \[s\].
        interval: f64,
    },
    /// There are too few samples.
    #[error("a filter needs ten samples at least, but there are only {0}")]
    TooFew(usize),
    /// Samples are missing.
    #[error("the sample at {0} s is missing, and a filter needs all")]
    Missing(f64),
}

/// The filtered signal. The sampling frequency must be at least ten times the number of the class in Hz, as both
/// standards require.
///
/// # Errors
/// The samples are too far apart, there are too few, or some are missing.
pub fn filtered(signal: &Signal, class: Class, standard: Standard) -> Result<Signal, FilterError> {
    let interval = signal.interval;
    if !class.allows(interval) {
        return Err(FilterError::TooCoarse { class, interval });
    }
    if let Some(index) = signal.values.iter().position(|value| !value.is_finite()) {
        return Err(FilterError::Missing(signal.time(index)));
    }
    match filter::filtered(&signal.values, interval, class, standard) {
        Some(values) => Ok(Signal { values, ..*signal }),
        None => Err(FilterError::TooFew(signal.values.len())),
    }
}

#[cfg(test)]
mod tests {
    use super::{Class, FilterError, Standard, class, coefficients, filtered};
    use crate::Signal;
    use std::f64::consts::PI;

    /// a₀, b₁, b₂ at 1e-4 s and 1e-5 s, computed by others with many digits.
    #[test]
    fn coefficients_are_those_of_the_standards() {
        let given = [
            (
                Standard::SaeJ211,
                1e-4,
                Class::Cfc60,
                [
                    0.0014523674735534124,
                    1.8893432242215735,
                    -0.8951526941157872,
                ],
            ),
            (
                Standard::SaeJ211,
                1e-4,
                Class::Cfc1000,
                [
                    0.2192314172190018,
                    0.31189654499598485,
                    -0.18882221387199205,
                ],
            ),
            (
                Standard::SaeJ211,
                1e-5,
                Class::Cfc180,
                [
                    0.00013575359485869462,
                    1.9667746608219463,
                    -0.9673176752013812,
                ],
            ),
            (
                Standard::Iso6487,
                1e-4,
                Class::Cfc60,
                [
                    0.0014603163055277343,
                    1.8890330793945247,
                    -0.8948743446166356,
                ],
            ),
            (
                Standard::Iso6487,
                1e-4,
                Class::Cfc600,
                [0.0976310729378175, 0.9428090415820632, -0.33333333333333326],
            ),
            (
                Standard::Iso6487,
                1e-5,
                Class::Cfc1000,
                [
                    0.003916126660547371,
                    1.8153410827045682,
                    -0.8310055893467576,
                ],
            ),
        ];
        for (standard, interval, class, [a0, b1, b2]) in given {
            let found = coefficients(class, standard, interval);
            for (found, expected) in found.into_iter().zip([a0, 2.0 * a0, a0, b1, b2]) {
                // the tangent and a dozen operations, of which 1 − ω² loses no digit
                assert!(
                    (found - expected).abs() < 1e-15,
                    "{class} {found} {expected}"
                );
            }
        }
    }

    fn signal(of: impl Fn(f64) -> f64) -> Signal {
        Signal {
            first: 0.0,
            interval: 1e-4,
            values: (0..=1000).map(|i| of(f64::from(i) * 1e-4)).collect(),
        }
    }

    /// A half-sine of 10 ms, computed by others: its peak, and its beginning, filtered.
    #[test]
    fn a_pulse_is_filtered_as_by_others() {
        let pulse = signal(|t| match (0.02..=0.03).contains(&t) {
            true => 100.0 * (PI * (t - 0.02) / 0.01).sin(),
            false => 0.0,
        });
        let given = [
            (Class::Cfc60, [95.13662030370222, 16.06337769288918]),
            (Class::Cfc180, [99.96587334500548, 4.773787442412663]),
            (Class::Cfc600, [99.99979311727543, 1.3427946662371086]),
            (Class::Cfc1000, [99.99998243288582, 0.7241225026297047]),
        ];
        for (class, [peak, begin]) in given {
            let found = filtered(&pulse, class, Standard::Iso6487).unwrap().values;
            let largest = found.iter().copied().fold(f64::MIN, f64::max);
            assert!(
                (largest - peak).abs() < 1e-9 && found[250] == largest,
                "{class} {largest}"
            );
            assert!((found[200] - begin).abs() < 1e-9, "{class} {}", found[200]);
        }
    }

    #[test]
    fn the_ends_of_a_ramp_stay_where_they_are() {
        let ramp = signal(|t| 50.0 + 200.0 * t);
        for (class, bound) in Class::ALL.into_iter().zip([1.1e-3, 1.2e-8, 1e-12, 1e-12]) {
            let found = filtered(&ramp, class, Standard::Iso6487).unwrap();
            let errors = found
                .values
                .iter()
                .zip(&ramp.values)
                .map(|(a, b)| (a - b).abs());
            let largest = errors.fold(0.0, f64::max);
            assert!(largest < bound, "{class} {largest:e}");
        }
    }

    /// Two passes weaken a vibration of CFC/0.6 by 3.01 dB in SAE J211-1 and by 2.98 dB in ISO 6487.
    #[test]
    fn vibrations_are_weakened_as_the_class_says() {
        for (standard, decibel) in [(Standard::SaeJ211, 3.01), (Standard::Iso6487, 2.98)] {
            let class = Class::Cfc60;
            let vibration = signal(|t| (2.0 * PI * 100.0 * t).sin());
            let found = filtered(&vibration, class, standard).unwrap().values;
            let largest = found[300..700].iter().copied().fold(f64::MIN, f64::max);
            assert!(
                (-20.0 * largest.log10() - decibel).abs() < 0.01,
                "{largest}"
            );
        }
    }

    #[test]
    fn what_cannot_be_filtered_is_refused() {
        let mut coarse = signal(|t| t);
        coarse.interval = 1.01e-4;
        let error = filtered(&coarse, Class::Cfc1000, Standard::Iso6487).unwrap_err();
        assert!(
            error.to_string().contains("every 0.100 ms at least"),
            "{error}"
        );
        assert!(filtered(&coarse, Class::Cfc600, Standard::Iso6487).is_ok());
        coarse.values[7] = f64::NAN;
        let missing = filtered(&coarse, Class::Cfc60, Standard::Iso6487);
        assert!(matches!(missing, Err(FilterError::Missing(_))));
        coarse.values.truncate(5);
        let few = filtered(&coarse, Class::Cfc60, Standard::Iso6487);
        assert_eq!(few, Err(FilterError::TooFew(5)));
        assert!(class("CFC61").is_err());
        for known in Class::ALL {
            assert_eq!(class(&known.to_string()), Ok(known));
        }
    }
}

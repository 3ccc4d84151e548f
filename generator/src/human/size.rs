//! Sizes of people: by numbers, by name, and by percentile.

use super::data::Sex;

/// Sex, stature and mass of an adult.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Size {
    /// The sex whose data are used.
    pub sex: Sex,
    /// Height from sole to vertex \[m\].
    pub stature: f64,
    /// Mass of the whole body \[kg\].
    pub mass: f64,
}

/// The person that a body represents.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Person {
    /// An adult.
    Size(Size),
    /// The crash dummy with this name.
    Dummy(&'static str),
}

/// Names of usual sizes of adults, of adult crash dummies, and of children.
pub const NAMES: [&str; 7] = [
    "male-50",
    "male-95",
    "female-5",
    "hybrid-3-50",
    "hybrid-3-5",
    "child-6",
    "child-3",
];

impl Person {
    /// The person with this name; `None` if there is none.
    pub fn named(name: &str) -> Option<Person> {
        let name = NAMES.into_iter().find(|one| *one == name)?;
        Some(Size::like(name).map_or(Person::Dummy(name), Person::Size))
    }
}

/// Stature \[m\] and mass \[kg\] at the 5th, 50th and 95th percentile of ANSUR II (US Army, 2012), of men and of women.
const ANSUR: [[[f64; 3]; 2]; 2] = [
    [[1.648, 1.755, 1.870], [64.4, 84.6, 110.7]],
    [[1.525, 1.626, 1.740], [51.3, 66.8, 87.1]],
];

/// z at the 95th percentile of a normal distribution.
const Z95: f64 = 1.644_853_626_951_472_2;

impl Size {
    /// A usual size of adults by its name: a man of 1.753 m and 77.7 kg, a man of 1.877 m and 101.2 kg, a woman
    /// of 1.501 m and 49 kg.
    pub fn like(name: &str) -> Option<Size> {
        let (sex, stature, mass) = match name {
            "male-50" => (Sex::Male, 1.753, 77.7),
            "male-95" => (Sex::Male, 1.877, 101.2),
            "female-5" => (Sex::Female, 1.501, 49.0),
            _ => return None,
        };
        Some(Size { sex, stature, mass })
    }

    /// The size with this percentile of stature and mass for a sex, from 1 to 99; `None` beyond. Stature and mass are
    /// linear in the z of a normal distribution between the 5th, 50th and 95th percentile of ANSUR II, and are
    /// continued linearly beyond.
    pub fn percentile(sex: Sex, percentile: f64) -> Option<Size> {
        if !(1.0..=99.0).contains(&percentile) {
            return None;
        }
        let of_sex = ANSUR[usize::from(sex == Sex::Female)];
        let z = normal(percentile / 100.0) / Z95;
        let at = |[low, middle, high]: [f64; 3]| match z < 0.0 {
            true => middle + z * (middle - low),
            false => middle + z * (high - middle),
        };
        let round = |x: f64, digits: f64| (x * digits).round() / digits;
        Some(Size {
            sex,
            stature: round(at(of_sex[0]), 1000.0),
            mass: round(at(of_sex[1]), 10.0),
        })
    }
}

/// z with Φ(z) = p, by bisection; Φ(z) = 1/2 + φ(z) (z + z³/3 + z⁵/(3 · 5) + …).
pub fn normal(p: f64) -> f64 {
    let phi = |z: f64| {
        let (mut term, mut sum, mut n) = (z, z, 1.0);
        while term.abs() > 1e-17 * sum.abs() {
            n += 2.0;
            term *= z * z / n;
            sum += term;
        }
        0.5 + sum * libm::exp(-0.5 * z * z) / f64::sqrt(2.0 * std::f64::consts::PI)
    };
    let (mut low, mut high) = (-5.0, 5.0);
    while high - low > 1e-12 {
        let middle = 0.5 * (low + high);
        match phi(middle) < p {
            true => low = middle,
            false => high = middle,
        }
    }
    0.5 * (low + high)
}

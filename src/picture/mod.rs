//! Stick figures of a motion as a self-contained SVG or as PNG, like figure 6 of the paper.
//!
//! A model in space is seen from the side unless another [`View`] is requested: x to the right, z upwards, y into the
//! page. An element is a line from its joint to the joints that it carries, a belt a line between its attachments, an
//! ellipsoid its outline, a plane its edge or its corners within its extent; a plane without end is drawn where it is
//! needed. All figures have the same scale.

pub mod corridor;
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod figure;
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod plan;
pub mod plot;
mod sheet;
mod view;
pub mod work_precision;

pub use bryant_picture::{Drawing, Format};
pub use figure::Figure;
pub use sheet::{Arrangement, Sheet};
pub use view::View;

use crate::scene::Scene;
use bryant_generator::model::Model;

/// Coordinates at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct Instant {
    /// \[s\]
    pub time: f64,
    /// q, in the order of the names given with it.
    pub coordinates: Vec<f64>,
    /// The whole state: q, v, z, m.
    pub state: Vec<f64>,
}

/// Draws a motion at those of its times that are in `times`. A figure is left out where little has moved since the one
/// before; the heading of that says until when.
pub fn draw(
    model: &Model,
    scene: &Scene,
    times: &[f64],
    arrangement: Arrangement,
    view: View,
) -> Drawing {
    // of figures on top of each other the way of what moves is what they show, unless a vehicle takes all of it along
    let is_vehicle = |body: &usize| scene.bodies[*body].system.is_none();
    let followed = scene.followed();
    let followed = followed.filter(|body| arrangement == Arrangement::Row || is_vehicle(body));
    let moves = followed.map(|body| format!("the view moves with {}", scene.bodies[body].name));
    let words = view.words(scene.planar).into_iter().chain(moves);
    let words: Vec<String> = words.collect();
    Sheet::new(
        match model.title.as_str() {
            "" => model.name.clone(),
            title => format!("{} — {title}", model.name),
        },
        (!words.is_empty()).then(|| words.join(", ")),
        view.names(),
        model.systems.iter().map(|s| s.name.clone()).collect(),
        (figure::figures(scene, view, followed), times),
        arrangement,
    )
    .drawing()
}

/// Times for about `count` figures between `first` and `last`: multiples of 1, 2, 2.5 or 5 times a power of ten, and
/// both ends. If some of these steps are multiples of `every`, the time between samples, only those are used.
pub fn times([first, last]: [f64; 2], count: usize, every: f64) -> Vec<f64> {
    if !(last.is_finite() && last > first) || count < 2 {
        return vec![first];
    }
    let power = bryant_picture::chart::power_of_ten(
        libm::log10((last - first) / count as f64).floor() as i32,
    );
    let steps = [1.0, 2.0, 2.5, 5.0, 10.0, 20.0].map(|factor| factor * power);
    let sampled = |step: &f64| {
        let samples = step / every;
        samples > 0.5 && (samples - samples.round()).abs() < 1e-6 * samples
    };
    let any = steps.iter().any(sampled);
    // Of two equally good steps the larger is taken: fewer figures are larger figures.
    let steps = steps.into_iter().rev().filter(|step| !any || sampled(step));
    let choices = steps.map(|step| multiples([first, last], step));
    choices
        .min_by_key(|times| times.len().abs_diff(count))
        .unwrap_or_default()
}

/// The multiples of a step between `first` and `last`, and these two unless a multiple is close to them.
fn multiples([first, last]: [f64; 2], step: f64) -> Vec<f64> {
    let before = (first / step * (1.0 - 1e-9)).ceil();
    let whole = (last / step * (1.0 + 1e-9)).floor();
    let mut times = Vec::new();
    if before * step - first > 0.35 * step {
        times.push(first);
    }
    times.extend((before as u64..=whole as u64).map(|i| i as f64 * step));
    if last - whole * step > 0.35 * step {
        times.push(last);
    }
    times
}

/// The smallest of 1, 2, 5 times a power of ten that is not below `value` (positive).
fn nice_above(value: f64) -> f64 {
    let power = bryant_picture::chart::power_of_ten(libm::log10(value).floor() as i32);
    let factor = [1.0, 2.0, 5.0].into_iter().find(|f| f * power >= value);
    factor.unwrap_or(10.0) * power
}

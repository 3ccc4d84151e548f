//! Values by set of methods, made when a set is used for the first time.

use bryant_generator::program::{Method, Methods};
use std::sync::OnceLock;

/// A value for each method alone, and for each of the first sets of several methods that are used. Reading needs no
/// lock.
#[derive(Debug)]
pub struct Sets<V> {
    alone: [OnceLock<V>; Method::ALL.len()],
    several: [OnceLock<(Methods, V)>; SEVERAL],
}

/// The number of sets of several methods. Runs and batches use five; others are evaluated one method after the other.
const SEVERAL: usize = 16;

impl<V> Default for Sets<V> {
    fn default() -> Self {
        Sets {
            alone: [const { OnceLock::new() }; Method::ALL.len()],
            several: [const { OnceLock::new() }; SEVERAL],
        }
    }
}

impl<V> Sets<V> {
    /// The value of a set, made by `make` if it is new; `None` if there are too many sets, but never for one method.
    #[inline]
    pub fn get(&self, set: Methods, make: impl Fn() -> V) -> Option<&V> {
        if let Some(method) = set.one() {
            return Some(self.alone[method as usize].get_or_init(make));
        }
        self.several.iter().find_map(|place| {
            // an empty place is taken by this set, unless another thread is quicker
            let (of, value) = place.get_or_init(|| (set, make()));
            (*of == set).then_some(value)
        })
    }
}

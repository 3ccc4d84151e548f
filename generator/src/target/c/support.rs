//! The functions that generated C calls: laws and curves, as small static functions, each in a file of its own.
//!
//! Each of them does the same as the function of the runtime for one double, operation for operation.

/// A C function, and the names of the functions that it calls.
pub struct Part {
    pub name: &'static str,
    pub needs: &'static [&'static str],
    text: &'static str,
}

macro_rules! parts {
    ($($name:literal $([$($need:literal)*])?;)*) => {
        &[$(Part {
            name: $name,
            needs: &[$($($need),*)?],
            text: include_str!(concat!("support/", $name, ".c")),
        }),*]
    };
}

/// All functions. Each comes after the functions that it needs.
pub const PARTS: &[Part] = parts! {
    "multiply_add";
    "horner" ["multiply_add"];
    "sin_cos" ["multiply_add"];
    "angle" ["horner"];
    "maximum";
    "minimum";
    "choose";
    "power" ["horner"];
    "support" ["maximum" "power"];
    "approach_space" ["multiply_add"];
    "approach_plane" ["multiply_add"];
    "curve";
    "curve_piece";
    "curve_guard" ["curve"];
    "curve_value" ["multiply_add" "curve_piece" "curve_guard"];
    "curve_slope" ["multiply_add" "curve_piece" "curve_guard"];
    "curve_second_derivative" ["multiply_add" "curve_piece" "curve_guard"];
    "curve_once" ["multiply_add" "curve_piece" "curve_guard"];
    "curve_twice" ["multiply_add" "curve_piece" "curve_guard"];
    "curve_integral" ["curve_once"];
    "curve_double_integral" ["curve_once" "curve_twice"];
    "curve_breakpoint_indicator" ["curve" "curve_piece" "minimum"];
    "curve_inverse" ["curve" "multiply_add"];
    "curve_stop" ["curve_value" "curve_integral"];
    "kink_after" ["curve"];
};

/// The functions that a source needs, and those that they call in turn.
#[derive(Default)]
pub(super) struct Support {
    wanted: Vec<&'static str>,
}

impl Support {
    /// Adds a function, and the functions that it needs.
    pub fn want(&mut self, name: &'static str) {
        let Some(part) = PARTS.iter().find(|part| part.name == name) else {
            unreachable!("there is a part for each function");
        };
        if !self.wanted.contains(&name) {
            self.wanted.push(name);
            part.needs.iter().for_each(|need| self.want(need));
        }
    }

    /// True if a function was added.
    pub fn has(&self, name: &str) -> bool {
        self.wanted.contains(&name)
    }

    /// The text of all added functions; each comes after those that it calls.
    pub fn text(&self) -> String {
        let wanted = PARTS.iter().filter(|part| self.has(part.name));
        wanted.map(|part| format!("{}\n", part.text)).collect()
    }
}

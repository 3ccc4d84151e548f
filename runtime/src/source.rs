//! The source text of this crate, so that `rustc` alone can compile a scene on demand.
//!
//! Written to a directory under the given paths, it builds without any dependency:
//! `rustc --edition 2024 --crate-type rlib --crate-name bryant_runtime --cfg 'feature="std"' lib.rs`.

macro_rules! files {
    ($($path:literal,)*) => {
        /// (path below the source directory, text) of every source file of this crate.
        pub const FILES: &[(&str, &str)] = &[$(($path, include_str!($path)),)*];
    };
}

files! {
    "batch/acceleration.rs",
    "batch/bend.rs",
    "batch/control.rs",
    "batch/event.rs",
    "batch/jump.rs",
    "batch/landing.rs",
    "batch/mod.rs",
    "batch/models.rs",
    "batch/onset.rs",
    "batch/onset_cache.rs",
    "batch/place.rs",
    "batch/reach.rs",
    "batch/rows.rs",
    "batch/run.rs",
    "batch/sample.rs",
    "batch/scenario.rs",
    "batch/search.rs",
    "batch/settings.rs",
    "batch/step.rs",
    "batch/tolerance.rs",
    "batch/watch.rs",
    "curve.rs",
    "curve/breakpoint_indicator.rs",
    "curve/cubic.rs",
    "curve/integral.rs",
    "curve/kink.rs",
    "curve/lines.rs",
    "curve/stop.rs",
    "curve/table.rs",
    "dynamics.rs",
    "equations.rs",
    "failure.rs",
    "ffi.rs",
    "force/approach/mod.rs",
    "force/approach/plane.rs",
    "force/approach/space.rs",
    "force/approach/tests.rs",
    "force/ellipsoid.rs",
    "force/mod.rs",
    "force/power.rs",
    "force/switch.rs",
    "integrate/acceleration.rs",
    "integrate/adams.rs",
    "integrate/control.rs",
    "integrate/euler.rs",
    "integrate/explicit.rs",
    "integrate/linear.rs",
    "integrate/march.rs",
    "integrate/mod.rs",
    "integrate/order.rs",
    "integrate/rosenbrock.rs",
    "integrate/switching.rs",
    "integrate/tableau/dormand_prince.rs",
    "integrate/tableau/kutta.rs",
    "integrate/tableau/mod.rs",
    "integrate/tableau/tsitouras.rs",
    "integrate/workspace.rs",
    "leap.rs",
    "lib.rs",
    "model.rs",
    "patience.rs",
    "program/error.rs",
    "program/finding.rs",
    "program/header.rs",
    "program/job.rs",
    "program/mod.rs",
    "program/reading.rs",
    "real.rs",
    "real/array.rs",
    "real/core_arithmetic.rs",
    "real/double_double.rs",
    "real/double_double/elementary.rs",
    "real/double_double/tests.rs",
    "real/dual.rs",
    "real/fast_scalar.rs",
    "real/lanes/avx2.rs",
    "real/lanes/avx2/singles.rs",
    "real/lanes/avx512.rs",
    "real/lanes/avx512/singles.rs",
    "real/lanes/elementary/angle.rs",
    "real/lanes/elementary/circle.rs",
    "real/lanes/elementary/exponential.rs",
    "real/lanes/elementary/logarithm.rs",
    "real/lanes/elementary/mod.rs",
    "real/lanes/elementary/power.rs",
    "real/lanes/elementary/remainder.rs",
    "real/lanes/elementary/singles.rs",
    "real/lanes/elementary/tests.rs",
    "real/lanes/elementary/tests/angle.rs",
    "real/lanes/elementary/tests/circle.rs",
    "real/lanes/elementary/tests/exponential.rs",
    "real/lanes/elementary/tests/power.rs",
    "real/lanes/mod.rs",
    "real/lanes/neon.rs",
    "real/lanes/neon/singles.rs",
    "real/lanes/register.rs",
    "real/lanes/scalar_register.rs",
    "real/lanes/several.rs",
    "real/layout.rs",
    "real/number.rs",
    "real/words.rs",
    "response/answer.rs",
    "response/channel.rs",
    "response/clip.rs",
    "response/exceedance.rs",
    "response/extremes.rs",
    "response/filter.rs",
    "response/hic.rs",
    "response/integrals.rs",
    "response/jumps.rs",
    "response/mod.rs",
    "response/olc.rs",
    "response/value.rs",
    "section.rs",
    "simulate/balance.rs",
    "simulate/diagnostic.rs",
    "simulate/driven_model.rs",
    "simulate/event.rs",
    "simulate/excursion.rs",
    "simulate/mod.rs",
    "simulate/onset.rs",
    "simulate/run.rs",
    "simulate/schedule.rs",
    "simulate/settings.rs",
    "simulate/stuck_events.rs",
    "simulate/time_loop.rs",
    "simulate/time_loop/count.rs",
    "simulate/time_loop/fail.rs",
    "simulate/time_loop/onset.rs",
    "simulate/time_loop/sample.rs",
    "simulate/time_loop/search.rs",
    "simulate/watch.rs",
    "simulate/watch/account.rs",
    "simulate/watch/error.rs",
    "source.rs",
    "version.rs",
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    fn collect(root: &Path, below: &Path, found: &mut Vec<String>) {
        for entry in std::fs::read_dir(below).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                collect(root, &path, found);
            } else {
                let relative = path.strip_prefix(root).unwrap().to_str().unwrap();
                found.push(relative.replace('\\', "/"));
            }
        }
    }

    #[test]
    fn every_file_is_listed() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
        let mut found = Vec::new();
        collect(&root, &root, &mut found);
        found.sort();
        let listed: Vec<&str> = super::FILES.iter().map(|(path, _)| *path).collect();
        assert_eq!(listed, found);
    }
}

//! Studies by the real command: `bryant sweep` and `bryant merge`, as a user calls them.
//!
//! | file | what |
//! |---|---|
//! | `folder` | a folder of results as bytes, and as a table |
//! | `same` | threads, lanes, shards and killed processes do not change any file |
//! | `own` | models that are not bundled |
//! | `reasons` | why rows have no result |
//! | `steps` | fixed steps and single precision |
//! | `agrees` | responses and series are those of `bryant run` |
//! | `wrong` | studies, folders and options that make no sense |
//! | `fails` | disks that are full, folders that cannot be written |

mod agreement;
mod disk_failures;
mod folder;
mod invalid_studies;
mod own_models;
mod reasons;
mod reproducibility;
mod steps;

/// 160 short runs of the bundled child seat, in ten blocks.
const SEAT: &str = "\
model: child-seat
design: sobol
runs: 160
seed: 3
parameters:
  lap_slack: { from: 0 mm, to: 60 mm }
  friction: { from: 0, to: 0.6 }
run: { duration: 60 ms, sampling: 0.1 ms }
responses:
  - { name: lap, of: lap belt force, what: peak }
  - { name: injury, of: head accelerometer, what: HIC15 }
  - { name: three, of: head accelerometer, what: clip, duration: 3 ms }
  - { name: late, of: head excursion, what: value, at: 50 ms }
keep: { runs: [0, 117], outputs: [head excursion, lap belt force] }
tables: [parquet, csv]
";

/// A directory with that study.
fn directory() -> tempfile::TempDir {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("seat.yaml"), SEAT).unwrap();
    directory
}

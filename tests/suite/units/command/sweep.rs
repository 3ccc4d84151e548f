use bryant::command::Error;
use bryant::command::sweep::{of_study, shard};
use std::path::Path;

fn found(asked: Option<&str>, set: &[(&str, &str)]) -> Result<String, String> {
    let variable = |name: &str| {
        let found = set.iter().find(|(n, _)| *n == name);
        found.map(|(_, value)| (*value).to_owned())
    };
    match shard(asked, variable) {
        Ok(shard) => Ok(shard.to_string()),
        Err(Error::Input(message)) => Err(message),
        Err(error) => Err(format!("{error:?}")),
    }
}

#[test]
fn a_shard_is_as_said_or_that_of_the_task() {
    let ok = |text: &str| Ok(text.to_owned());
    assert_eq!(found(None, &[]), ok("0/1"));
    assert_eq!(found(Some("2/8"), &[("HQ_TASK_ID", "5")]), ok("2/8"));
    assert_eq!(found(Some("8"), &[("HQ_TASK_ID", "5")]), ok("5/8"));
    assert_eq!(
        found(Some("8"), &[("JOB_COMPLETION_INDEX", "0")]),
        ok("0/8")
    );
    let slurm = [
        ("SLURM_ARRAY_TASK_ID", "3"),
        ("SLURM_ARRAY_TASK_MIN", "1"),
        ("SLURM_ARRAY_TASK_COUNT", "4"),
    ];
    assert_eq!(found(None, &slurm), ok("2/4"));
    assert_eq!(found(Some("8"), &slurm), ok("2/8"));
}

#[test]
fn a_shard_that_is_not_said_is_asked_for() {
    assert!(found(Some("8"), &[]).unwrap_err().contains("--shard I/8"));
    assert!(found(Some("8/8"), &[]).unwrap_err().contains("8/8"));
    let task = [("HQ_TASK_ID", "1")];
    assert!(found(None, &task).unwrap_err().contains("of how many"));
    let task = [("HQ_TASK_ID", "one")];
    assert!(found(Some("2"), &task).unwrap_err().contains("no number"));
}

#[test]
fn a_folder_is_named_after_its_study() {
    assert_eq!(
        of_study(Path::new("a/seat.yaml")),
        Path::new("seat-results")
    );
}

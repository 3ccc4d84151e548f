use bryant::command::model_argument::find;
use bryant::command::prepare::prepare;
use bryant::command::run::scene::{APART, Shown};
use bryant::command::terminal::{Kept, Terminal};
use bryant::simulation::{Recording, run};
use bryant_runtime::program::Job;

/// Forces of other equations are left out, with one note: outputs that are computed at the states of the run, beside
/// those that the scene asks for, are not those of the run.
#[test]
fn forces_are_left_out_where_outputs_are_not_those_of_the_run() {
    let Ok(found) = find("child-seat") else {
        panic!("no child-seat");
    };
    let terminal = Terminal::keeping(Kept::default(), Kept::default());
    let job = Job {
        duration: Some(40e-3),
        ..Job::default()
    };
    let Ok(engine) = prepare(&found, &terminal) else {
        panic!("no equations");
    };
    let whole = run(&*engine, &job, &mut |_| ());
    assert!(whole.result.is_ok() && whole.table.columns.len() > 3);
    // the scene with forces, twice, and the notes
    let shown = |recording: &Recording| {
        let shown = Shown::new(&found, &job);
        let mut with_forces = [0, 1].map(|_| {
            let scene = shown.scene(recording, &recording.instants, &terminal);
            let scene = scene.unwrap_or_else(|_| panic!("no scene"));
            let mut pulls = scene.lines.iter().flat_map(|line| &line.pulls).flatten();
            pulls.any(|pull| *pull > 0.0)
        });
        with_forces.sort_unstable();
        (with_forces, shown.notes.take())
    };
    assert_eq!(shown(&whole), ([true; 2], Vec::new()));
    // the column of a force, off by less than what other roundings make, and by more
    let column = (whole.table.columns.iter())
        .position(|column| column.name == "lap belt force")
        .unwrap();
    let largest = whole.table.columns[column]
        .values
        .iter()
        .fold(0.0, |a: f64, b| a.max(b.abs()));
    let off = |share: f64| {
        let mut other = whole.clone();
        let values = &mut other.table.columns[column].values;
        let middle = values.len() / 2;
        values[middle] += share * largest;
        shown(&other)
    };
    assert_eq!(off(1e-6), ([true; 2], Vec::new()));
    assert_eq!(off(1e-2), ([false; 2], vec![APART.to_owned()]));
}

mod accuracy;
mod effects;
mod error_report;
mod export;
mod gradient;
mod help;
mod model_argument;
mod outputs;
mod progress;
mod response;
mod run;
mod sweep;
mod terminal;

use bryant::bundled;
use bryant::command::Cli;
use clap::CommandFactory as _;

#[test]
fn the_command_line_is_consistent() {
    Cli::command().debug_assert();
}

/// The words of a line as a shell splits it, up to a pipe, a redirection, or a remark after two spaces.
fn words(line: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let (mut quoted, mut before) = (false, ' ');
    for c in line.chars() {
        match c {
            '\'' => quoted = !quoted,
            _ if quoted => words.last_mut().unwrap().push(c),
            '|' | '>' => break,
            ' ' if before == ' ' => break,
            ' ' => words.push(String::new()),
            c => words.last_mut().unwrap().push(c),
        }
        before = c;
    }
    words.retain(|word| !word.is_empty());
    words
}

/// All examples are valid. Their models are bundled, so that parameters and outputs are checked, or are files of the
/// reader.
#[test]
fn examples_of_help_are_commands() {
    let whole = Cli::command();
    let mut commands: Vec<_> = whole.get_subcommands().cloned().collect();
    commands.push(whole.clone());
    for command in &mut commands {
        let help = command.render_long_help().to_string();
        let examples = help
            .lines()
            .filter_map(|line| match line.split_once("| bryant ") {
                Some((_, rest)) => Some(words(&format!("bryant {rest}"))),
                None => line
                    .starts_with("  bryant ")
                    .then(|| words(line.trim_start())),
            });
        for words in examples {
            assert!(
                whole.clone().try_get_matches_from(&words).is_ok(),
                "{words:?}"
            );
            let found = words.iter().find_map(|word| bundled::find(word));
            let of_no_model = [
                "models",
                "stability",
                "merge",
                "compare",
                "criteria",
                "human",
                "schema",
            ]
            .contains(&words[1].as_str());
            let own = words.iter().any(|word| word.contains(".yaml"));
            assert!(of_no_model || own || found.is_some(), "{words:?}");
            let Some(model) = found.map(|found| bundled::model(found).unwrap()) else {
                continue;
            };
            for pair in words.windows(2) {
                let known = match pair[0].as_str() {
                    "--set" => model
                        .parameters
                        .iter()
                        .any(|p| pair[1].starts_with(&format!("{}=", p.name))),
                    "--plot" => pair[1]
                        .split(", ")
                        .all(|name| model.outputs.iter().any(|o| o.name == name)),
                    _ => true,
                };
                assert!(known, "{pair:?}");
            }
        }
    }
}

#[test]
fn every_option_says_what_it_does() {
    for command in Cli::command().get_subcommands() {
        assert!(command.get_about().is_some(), "{}", command.get_name());
        for argument in command.get_arguments() {
            assert!(
                argument.get_help().is_some(),
                "{} {}",
                command.get_name(),
                argument.get_id()
            );
        }
    }
}

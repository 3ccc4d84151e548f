use bryant::command::Cli;
use bryant::command::help::{fit, of_width};

const TEXT: &str = "\
An effect is a term of the equations that may be in
or out: a force and each of its terms.

Columns:
  operations  of one evaluation of the accelerations, all
              less those without the effect
  with        its time

Examples:
  bryant effects child-seat
  bryant effects my.yaml --only belt --all --and-a-long-option     what it is";

#[test]
fn paragraphs_and_entries_are_broken_once() {
    assert_eq!(
        fit(TEXT, 40),
        "\
An effect is a term of the equations
that may be in or out: a force and each
of its terms.

Columns:
  operations  of one evaluation of the
              accelerations, all less
              those without the effect
  with        its time

Examples:
  bryant effects child-seat
  bryant effects my.yaml --only belt --all --and-a-long-option     what it is"
    );
    // lines that fit are put together, too
    assert!(
        fit(TEXT, 100)
            .starts_with("An effect is a term of the equations that may be in or out: a force")
    );
}

/// At each width, no line of any help ends early: the first word of the next line of a paragraph would not have fitted.
#[test]
fn no_line_of_help_is_broken_early() {
    use clap::CommandFactory;
    for width in [80, 100] {
        let mut command = of_width(Cli::command(), width).term_width(width);
        let commands = command.get_subcommands().cloned().collect::<Vec<_>>();
        for help in commands.into_iter().chain([command.clone()]) {
            let Some(text) = help.get_after_long_help() else {
                continue;
            };
            let text = text.to_string();
            let lines: Vec<&str> = text.lines().collect();
            for pair in lines.windows(2) {
                let [line, next] = [pair[0], pair[1]];
                let prose = |line: &str| !line.is_empty() && !line.starts_with(' ');
                if prose(line) && prose(next) {
                    let word = next.split(' ').next().unwrap_or_default().chars().count();
                    let length = line.chars().count();
                    assert!(length <= width, "{line}");
                    assert!(length + 1 + word > width, "{line}\n{next}");
                }
            }
        }
        command.build();
    }
}

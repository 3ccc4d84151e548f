use bryant::command::terminal::fitted;

#[test]
fn a_long_line_is_broken_between_words_and_hangs() {
    let text = "short  line\n  4050 evaluations; 160 ms simulated in 19 ms";
    assert_eq!(
        fitted(text, 24),
        "short  line\n  4050 evaluations;\n    160 ms simulated in\n    19 ms"
    );
    assert!(
        fitted(text, 24)
            .lines()
            .all(|line| line.chars().count() <= 24)
    );
    assert_eq!(fitted(text, 80), text);
}

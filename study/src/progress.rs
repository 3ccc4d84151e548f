//! A bar that shows how far a study is, with its rate and the time left.

use crate::run::Progress;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use std::fmt::Write;

/// What the bar says.
const TEMPLATE: &str = "{bar:30} {human_pos} of {human_len} runs  {rate}  {left}";

/// A bar on the terminal's error stream; nothing where that is none.
#[derive(Debug)]
pub struct Bar(ProgressBar);

impl Default for Bar {
    fn default() -> Self {
        Bar::on(ProgressDrawTarget::stderr())
    }
}

impl Bar {
    /// A bar on a target.
    pub fn on(target: ProgressDrawTarget) -> Bar {
        let bar = ProgressBar::with_draw_target(None, target);
        // a template that cannot be read would be a mistake in this file; the usual bar then
        if let Ok(style) = ProgressStyle::with_template(TEMPLATE) {
            bar.set_style(style);
        }
        Bar(bar)
    }

    /// Shows how far it is. To be called by [`run`](crate::run::run).
    pub fn show(&self, progress: &Progress) {
        match progress {
            Progress::Rows {
                done,
                found,
                total,
                elapsed,
            } => {
                let seconds = elapsed.as_secs_f64();
                let rate = (done - found) as f64 / seconds;
                let left = (total - done) as f64 / rate;
                let known = done > found && seconds > 0.0;
                let (rate, left) = if known {
                    words(rate, left)
                } else {
                    Default::default()
                };
                let style = self.0.style();
                let say = |text: String| {
                    move |_: &ProgressState, out: &mut dyn Write| {
                        // writing to a text cannot fail
                        let _ = out.write_str(&text);
                    }
                };
                self.0.set_style(
                    style
                        .with_key("rate", say(rate))
                        .with_key("left", say(left)),
                );
                self.0.set_length(*total);
                self.0.set_position(*done);
            }
            Progress::Damaged { path, error } => {
                self.0
                    .println(format!("{} is run again: {error}", path.display()));
            }
        }
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        self.0.finish_and_clear();
    }
}

/// Rate and time left in words.
fn words(rate: f64, left: f64) -> (String, String) {
    let rate = match rate {
        10.0.. => format!("{rate:.0} runs/s"),
        _ => format!("{rate:.2} runs/s"),
    };
    let seconds = left.ceil() as u64;
    let (hours, minutes) = (seconds / 3600, seconds / 60 % 60);
    let left = match (hours, minutes) {
        (0, 0) => format!("{seconds} s left"),
        (0, _) => format!("{minutes} min {} s left", seconds % 60),
        _ => format!("{hours} h {minutes} min left"),
    };
    (rate, left)
}

#[cfg(test)]
mod tests {
    use super::words;

    #[test]
    fn time_left_is_told_in_two_units() {
        let (rate, left) = words(0.5, 3.2);
        assert_eq!((rate.as_str(), left.as_str()), ("0.50 runs/s", "4 s left"));
        assert_eq!(words(1e5, 61.0).1, "1 min 1 s left");
        assert_eq!(words(1e5, 7260.0).1, "2 h 1 min left");
    }
}

//! How a run is going, told on stderr: a bar on a terminal, plain lines elsewhere.

use std::io::{IsTerminal, Write, stderr};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use prf_dqn::record::{EvaluationRecord, Event, Progress, Recorder};

/// Positions of the bar from the beginning of a run to its end.
const RESOLUTION: u64 = 10_000;
const TEMPLATE: &str = "{bar:24} {percent:>3}%  {msg}  {eta} left";

pub(crate) struct ProgressReporter {
    /// Absent when stderr is no terminal.
    bar: Option<ProgressBar>,
    started: std::time::Instant,
    first_step: Option<u64>,
}

impl ProgressReporter {
    pub(crate) fn new() -> Self {
        let bar = stderr().is_terminal().then(|| {
            let style = ProgressStyle::with_template(TEMPLATE).expect("the template is a literal");
            let bar = ProgressBar::new(RESOLUTION).with_style(style.progress_chars("█▉▊▋▌▍▎▏ "));
            bar.enable_steady_tick(Duration::from_millis(500));
            bar
        });
        Self { bar, started: std::time::Instant::now(), first_step: None }
    }

    fn progress(&mut self, progress: &Progress) {
        let Some(bar) = &self.bar else { return };
        let first = *self.first_step.get_or_insert_with(|| {
            // A resumed run must not count as sped through.
            bar.set_position(position(progress));
            bar.reset_eta();
            progress.steps
        });
        let speed = (progress.steps - first) as f64 / self.started.elapsed().as_secs_f64();
        let greedy = progress.evaluation_score.map_or(String::new(), |score| format!(" (greedy {score:.2})"));
        bar.set_position(position(progress));
        let recent = |value: Option<f64>| value.map_or("–".to_owned(), |value| format!("{value:.2}"));
        bar.set_message(format!(
            "episode {}  score {}{greedy}  reward {}  ε {:.2}  {speed:.0} steps/s",
            progress.episodes,
            recent(progress.recent_score),
            recent(progress.recent_reward),
            progress.epsilon
        ));
    }

    fn evaluation(&self, record: &EvaluationRecord) {
        if self.bar.is_none() {
            let EvaluationRecord { step, episode, mean_score, std_score, mean_reward, .. } = record;
            // With stderr closed there is nobody to tell, which is no reason to stop.
            let _ = writeln!(
                stderr(),
                "step {step}  episode {episode}  greedy score {mean_score:.2} ± {std_score:.2}  \
                 reward {mean_reward:.2}  {:.0} s",
                record.time_s
            );
        }
    }

    /// Leaves the terminal as it was.
    pub(crate) fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

fn position(progress: &Progress) -> u64 {
    (progress.done * RESOLUTION as f64) as u64
}

impl Recorder for ProgressReporter {
    fn record(&mut self, event: &Event<'_>) -> prf_dqn::Result<()> {
        match event {
            Event::Progress(progress) => self.progress(progress),
            Event::Evaluation(record) => self.evaluation(record),
            Event::Train(_) | Event::Step(_) | Event::Checkpoint(_) => {}
        }
        Ok(())
    }
}

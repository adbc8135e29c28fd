//! A run that trains when it is asked to, and waits in between.

use std::cell::Cell;
use std::error::Error;
use std::fs;
use std::path::Path;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::JoinHandle;
use std::time::Instant;

use prf_core::{Goal, io};
use prf_dqn::config::RunConfig;
use prf_dqn::record::{Event, Recorder};
use prf_dqn::run_dir::RunDir;
use prf_dqn::trainer::{Ending, Trainer};

use super::nanoseconds;

/// The first updates plan and allocate.
const UNTIMED_UPDATES: u64 = 32;

pub(super) struct Session {
    steps_per_update: u64,
    /// `None` once nothing will be asked any more.
    questions: Option<Sender<u64>>,
    answers: Receiver<(u64, u64)>,
    /// `None` once it is over.
    run: Option<JoinHandle<prf_dqn::Result<Ending>>>,
}

impl Session {
    /// Begins a run and takes it to where it learns.
    pub(super) fn start(config: RunConfig, folder: &Path) -> Result<Self, Box<dyn Error>> {
        if folder.exists() {
            fs::remove_dir_all(folder)?;
        }
        let goal = config.reward.goal.as_ref().map(io::read_frame).transpose()?.map(Goal::from);
        let run = RunDir::create(folder, &config, goal.as_ref())?;
        let (questions, asked) = channel();
        let (answer, answers) = channel();
        let (steps_per_update, learning_starts) = (config.train.steps_per_update, config.train.learning_starts);
        let run = std::thread::spawn(move || {
            let over = Cell::new(false);
            let mut stretches = Stretches { asked, answer, end: 0, begun: (0, Instant::now()), over: &over };
            Trainer::open(config, goal.as_ref(), &run, tch::Device::Cpu)?.run(&mut stretches, &|| over.get())
        });
        let session = Self { steps_per_update, questions: Some(questions), answers, run: Some(run) };
        session.ask(learning_starts + UNTIMED_UPDATES * steps_per_update)?;
        Ok(session)
    }

    /// Trains for so many updates, or steps, and gives how many there were with their nanoseconds.
    pub(super) fn turns(&self, turns: u64, of_updates: bool) -> Result<(u64, u64), Box<dyn Error>> {
        let each = if of_updates { self.steps_per_update } else { 1 };
        let (steps, ns) = self.ask(turns * each)?;
        Ok((steps / each, ns))
    }

    fn ask(&self, steps: u64) -> Result<(u64, u64), Box<dyn Error>> {
        self.questions.as_ref().ok_or("the run is over")?.send(steps)?;
        Ok(self.answers.recv()?)
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        // The run ends when nothing can be asked any more.
        self.questions = None;
        match self.run.take().map(JoinHandle::join) {
            Some(Ok(Err(error))) => eprintln!("the run failed: {error}"),
            Some(Err(_)) => eprintln!("the run panicked"),
            Some(Ok(Ok(_))) | None => {}
        }
    }
}

/// Stops the clock, and the run, where a stretch ends.
struct Stretches<'a> {
    asked: Receiver<u64>,
    answer: Sender<(u64, u64)>,
    /// Steps at which the stretch is over.
    end: u64,
    /// Steps and time at its beginning.
    begun: (u64, Instant),
    /// Set once nothing can be asked any more.
    over: &'a Cell<bool>,
}

impl Recorder for Stretches<'_> {
    fn record(&mut self, event: &Event<'_>) -> prf_dqn::Result<()> {
        let Event::Progress(progress) = event else { return Ok(()) };
        if progress.steps < self.end {
            return Ok(());
        }
        let (steps, start) = self.begun;
        if self.end > 0 {
            // Whoever asked may be gone.
            let _ = self.answer.send((progress.steps - steps, nanoseconds(start)));
        }
        // As long as nothing is asked, the run waits here.
        match self.asked.recv() {
            Ok(more) => (self.end, self.begun) = (progress.steps + more, (progress.steps, Instant::now())),
            Err(_) => self.over.set(true),
        }
        Ok(())
    }
}

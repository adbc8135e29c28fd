//! A world that is being played, episode by episode.

use prf_envs::{Environment, Status};

use super::recorder::{Recorder, Recording};
use crate::error::Result;

/// How far an episode has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Episode {
    pub(crate) seed: u64,
    pub(crate) steps: u32,
    pub(crate) score: f32,
    /// The world's own reward for the last step.
    pub(crate) last_reward: f32,
    /// The sum of the rewards.
    pub(crate) reward: f64,
    pub(crate) status: Status,
}

impl Episode {
    fn start(seed: u64) -> Episode {
        Episode { seed, steps: 0, score: 0.0, last_reward: 0.0, reward: 0.0, status: Status::Running }
    }
}

/// The world, the episode it is in, and what is recorded of it.
pub(crate) struct Session {
    world: Box<dyn Environment>,
    recorder: Recorder,
    now: Episode,
    /// The last episode in which a step was taken: what the results are about.
    played: Option<Episode>,
}

impl Session {
    /// Begins with the episode of `seed`.
    pub(crate) fn new(world: Box<dyn Environment>, recorder: Recorder, seed: u64) -> Session {
        let mut session = Session { world, recorder, now: Episode::start(seed), played: None };
        session.begin(seed);
        session
    }

    /// Begins the episode of `seed`.
    pub(crate) fn begin(&mut self, seed: u64) {
        self.world.reset(seed);
        self.now = Episode::start(seed);
        self.recorder.begin(self.world.as_ref());
    }

    /// Plays one step.
    ///
    /// # Errors
    ///
    /// Those of [`Environment::step`], and if there is no memory for the recording.
    pub(crate) fn step(&mut self, action: usize) -> Result<()> {
        let step = self.world.step(action)?;
        self.now.steps += 1;
        self.now.score = step.score;
        self.now.last_reward = step.reward;
        self.now.reward += f64::from(step.reward);
        self.now.status = step.status;
        self.played = Some(self.now);
        self.recorder.step(self.world.as_ref())
    }

    pub(crate) fn world(&self) -> &dyn Environment {
        self.world.as_ref()
    }

    pub(crate) fn now(&self) -> Episode {
        self.now
    }

    /// The last episode in which a step was taken, or the first one; and what was recorded of it.
    ///
    /// # Errors
    ///
    /// As [`Recorder::finish`].
    pub(crate) fn finish(self) -> Result<(Episode, Option<Recording>)> {
        Ok((self.played.unwrap_or(self.now), self.recorder.finish()?))
    }
}

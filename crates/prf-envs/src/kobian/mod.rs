//! A robot's face in the manner of Kobian's, whose brows and mouth move (paper, section "Motion template task").
//! `docs/worlds/kobian.md` describes it for users.

mod curve;
mod draw;
mod face;
mod oracle;
mod state;
#[cfg(test)]
mod tests;

use std::sync::LazyLock;

use prf_core::{FrameMut, Label};

use self::draw::Album;
pub use self::face::{Displacement, Face, MOVEMENTS, Point, VERTICES};
use self::face::{FIELD, mean_distance};
use crate::{Environment, Error, Spec, Status, Step};

/// Steps of an episode unless the config says otherwise: the paper's.
pub const LIMIT_STEPS: u32 = 10;

pub(crate) const REST: usize = 0;
const ACTIONS: [&str; 1 + 2 * MOVEMENTS] = [
    "rest",
    "raise-brows",
    "lower-brows",
    "raise-inner-brows",
    "lower-inner-brows",
    "raise-outer-brows",
    "lower-outer-brows",
    "widen-mouth",
    "narrow-mouth",
    "raise-mouth-corners",
    "lower-mouth-corners",
    "open-mouth",
    "close-mouth",
];

/// What the face is to express. Each is a world of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expression {
    /// A wide mouth, slightly open, with its corners up, and the brows raised.
    Happy,
    /// Brows raised high, and a mouth that is narrow and wide open.
    Surprise,
}

impl Expression {
    /// Name of the world, in a config.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Expression::Happy => "kobian-happy",
            Expression::Surprise => "kobian-surprise",
        }
    }

    /// The expression that the world of this name is for.
    #[must_use]
    pub fn of_world(name: &str) -> Option<Expression> {
        [Expression::Happy, Expression::Surprise].into_iter().find(|expression| expression.name() == name)
    }

    /// The face to be made.
    #[must_use]
    pub fn target(self) -> Face {
        let levels = match self {
            Expression::Happy => [2, 0, 0, 3, 2, 1],
            Expression::Surprise => [3, 0, 0, -1, 0, 4],
        };
        Face::new(levels).unwrap_or_default()
    }
}

/// The world of one expression.
#[derive(Clone, Debug)]
pub struct Kobian {
    spec: Spec,
    expression: Expression,
    target: Face,
    closeness: &'static [f32],
    album: &'static Album,
    /// The most actions that may be missing where an episode ends by success.
    solved_within: Option<u32>,
    episode: Option<Episode>,
}

/// The variable reward of every face, by its position: 1 at the target, 0 as far from it as the neutral face is, and below 0 beyond. They
/// are measured once, with the first world, since 24 vertices take longer than a drawing.
fn closeness(expression: Expression) -> &'static [f32] {
    static ALL: [LazyLock<Vec<f32>>; 2] = [
        LazyLock::new(|| closeness_to(Expression::Happy.target())),
        LazyLock::new(|| closeness_to(Expression::Surprise.target())),
    ];
    &ALL[expression as usize]
}

fn closeness_to(target: Face) -> Vec<f32> {
    let vertices = target.vertices();
    let neutral = mean_distance(&Face::default().vertices(), &vertices);
    let faces = Face::all(0..MOVEMENTS);
    faces.map(|face| 1.0 - mean_distance(&face.vertices(), &vertices) / neutral).collect()
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Episode {
    face: Face,
    steps: u32,
    status: Status,
}

impl Kobian {
    /// A world whose episodes are truncated after `limit_steps` steps.
    ///
    /// # Errors
    /// `limit_steps` is 0.
    pub fn new(expression: Expression, limit_steps: u32) -> Result<Kobian, Error> {
        if limit_steps == 0 {
            return Err(Error::param("env.limit_steps", "0", "at least 1"));
        }
        let side = FIELD as usize;
        let spec =
            Spec { name: expression.name(), width: side, height: side, actions: &ACTIONS, limit_steps, chance: false };
        let (target, closeness) = (expression.target(), closeness(expression));
        Ok(Kobian { spec, expression, target, closeness, album: Album::get(), solved_within: None, episode: None })
    }

    /// This world, but an episode terminates once no more than `actions` are missing to the target.
    ///
    /// # Errors
    /// As many are missing at the beginning.
    pub fn solved_within(self, actions: u32) -> Result<Kobian, Error> {
        let most = Face::default().actions_to(self.target) - 1;
        if actions > most {
            let expected = format!("0 to {most}, fewer than are missing at the beginning");
            return Err(Error::param("env.solved_within", actions.to_string(), expected));
        }
        Ok(Kobian { solved_within: Some(actions), ..self })
    }

    /// Whether an episode with this face has come to its own end.
    fn is_solved(&self, face: Face) -> bool {
        self.solved_within.is_some_and(|most| face.actions_to(self.target) <= most)
    }

    /// The face now; none before the first episode.
    #[must_use]
    pub fn face(&self) -> Option<Face> {
        self.episode.map(|episode| episode.face)
    }
}

impl Environment for Kobian {
    fn spec(&self) -> &Spec {
        &self.spec
    }

    /// Every episode begins with the neutral face, whatever the seed.
    fn reset(&mut self, _: u64) {
        self.episode = Some(Episode { face: Face::default(), steps: 0, status: Status::Running });
    }

    fn step(&mut self, action: usize) -> Result<Step, Error> {
        let world = self.spec.name;
        if action >= ACTIONS.len() {
            return Err(Error::UnknownAction { world, got: action, last: ACTIONS.len() - 1 });
        }
        let Episode { mut face, steps, status } = self.episode.ok_or(Error::NotReset { world })?;
        if status.is_over() {
            return Err(Error::EpisodeOver { world });
        }
        if action != REST {
            face.shift((action - 1) / 2, action % 2 == 1);
        }
        let steps = steps + 1;
        let status = if self.is_solved(face) {
            Status::Terminated
        } else if steps >= self.spec.limit_steps {
            Status::Truncated
        } else {
            Status::Running
        };
        self.episode = Some(Episode { face, steps, status });
        let score = 0.0 - face.actions_to(self.target) as f32;
        Ok(Step { reward: self.closeness[face.position(0..MOVEMENTS)], score, status })
    }

    fn draw(&self, frame: &mut FrameMut<'_>) {
        match self.episode {
            Some(Episode { face, .. }) if self.album.draw(face, frame) => {}
            Some(Episode { face, .. }) => draw::draw(face, frame),
            None => frame.fill(0),
        }
    }

    fn save_state(&self) -> Vec<u8> {
        state::save(self.expression, self.episode.as_ref())
    }

    fn load_state(&mut self, bytes: &[u8]) -> Result<(), Error> {
        self.episode = state::load(self, bytes)?;
        Ok(())
    }

    fn oracle_action(&self) -> usize {
        let missing = self.face().and_then(|face| oracle::next(face, self.target));
        missing.map_or(REST, |(movement, up)| 1 + 2 * movement + usize::from(!up))
    }

    /// The score is minus the mean distance of the vertices from the target's, in pixels; a success is to be within one action of it.
    fn label(&self, _: f32) -> Label {
        let (face, target) = (self.face(), self.target);
        Label {
            score: face.map(|face| 0.0 - f64::from(face.distance_to(target))),
            success: face.map(|face| face.actions_to(target) <= 1),
        }
    }
}

//! What a person needs to know to play a world.

/// How time passes for somebody who plays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pace {
    /// The world waits for each action.
    TurnBased,
    /// The world goes on by itself. An action is an impulse, such as a flap: pressing its key gives it once.
    Impulses,
    /// The world goes on by itself. An action lasts as long as its key is held, such as moving a paddle.
    Held,
}

impl Pace {
    /// Whether the world goes on by itself while no key is pressed.
    pub fn is_real_time(self) -> bool {
        self != Pace::TurnBased
    }
}

/// How a person plays a world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Controls {
    /// How time passes.
    pub pace: Pace,
    /// The action to take while no key is pressed, an index into [`Spec::actions`](crate::Spec::actions).
    pub idle_action: usize,
}

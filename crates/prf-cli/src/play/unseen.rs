//! An episode that nobody watches.

use prf_envs::players::Player;

use super::session::Session;
use crate::error::Result;
use crate::interrupt::Interrupt;

/// Lets `player` play the episode to its end, or until the interrupt.
///
/// # Errors
///
/// As [`Session::step`].
pub(crate) fn play(session: &mut Session, player: &mut dyn Player, interrupt: &Interrupt) -> Result<()> {
    player.begin(session.now().seed);
    while !session.now().status.is_over() && !interrupt.came() {
        let action = player.action(session.world());
        session.step(action)?;
    }
    Ok(())
}

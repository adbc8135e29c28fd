//! A world on the screen, played by a person or watched.

use std::time::{Duration, Instant};

use crossterm::event::Event;
use prf_envs::players::Player;
use prf_envs::{Controls, Pace};

use super::events::Events;
pub(crate) use super::game::Ending;
use super::game::Game;
use super::screen::Screen;
pub(crate) use super::screen::is_there;
use super::session::Session;
use crate::error::Result;
use crate::interrupt::Interrupt;

/// Shows the session until the person quits. Without a `player` the person plays.
///
/// # Errors
///
/// The terminal cannot be talked to, and those of [`Session::step`]. The terminal is given back in any case.
pub(crate) fn play(
    session: &mut Session,
    player: Option<Box<dyn Player>>,
    controls: Controls,
    steps_per_second: u32,
    interrupt: &Interrupt,
) -> Result<Ending> {
    let wants_releases = player.is_none() && controls.pace == Pace::Held;
    let mut screen = Screen::open(wants_releases)?;
    let mut game = Game::new(session, player, controls, steps_per_second, screen.reports_releases());
    let events = Events::listen()?;
    while !interrupt.came() {
        screen.draw(game.world(), &game.panel())?;
        let mut patience = game.until_due(Instant::now());
        while let Some(event) = events.next(patience)? {
            if let Event::Key(key) = event
                && let Some(ending) = game.key(key, Instant::now())?
            {
                return Ok(ending);
            }
            // Further events are taken along only if they are there already.
            patience = Duration::ZERO;
        }
        game.advance(Instant::now())?;
    }
    Ok(Ending::Interrupted)
}

//! A world on the screen, played by a person or watched.

use std::time::{Duration, Instant};

use crossterm::event::{Event, KeyEvent, KeyEventKind};
use prf_envs::Controls;
use prf_envs::players::Player;

use super::events::Events;
use super::hand::Hand;
use super::keys::{Keys, Request};
use super::panel::Panel;
use super::screen::Screen;
pub(crate) use super::screen::is_there;
use super::session::Session;
use crate::error::Result;
use crate::interrupt::Interrupt;

/// How long to wait for a key at most, so that a signal to end is noticed.
const PATIENCE: Duration = Duration::from_millis(200);

/// How somebody ended it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ending {
    Quit,
    /// By Ctrl-C or a signal.
    Interrupted,
}

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
    let mut screen = Screen::open(player.is_none())?;
    let mut game = Game::new(session, player, controls, steps_per_second, screen.reports_releases());
    let events = Events::listen()?;
    while !interrupt.came() {
        screen.draw(game.session.world(), &game.panel())?;
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

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// A person gets ready: the world stands until the first key.
    Ready,
    Running,
    Paused,
    Over,
}

struct Game<'a> {
    session: &'a mut Session,
    player: Option<Box<dyn Player>>,
    keys: Keys,
    hand: Hand,
    /// Whether the world goes on by itself, as it does for somebody who only watches.
    ticks: bool,
    step_time: Duration,
    /// When the next step is due, if the world goes on by itself.
    due: Instant,
    phase: Phase,
}

impl<'a> Game<'a> {
    fn new(
        session: &'a mut Session,
        player: Option<Box<dyn Player>>,
        controls: Controls,
        steps_per_second: u32,
        reports_releases: bool,
    ) -> Game<'a> {
        let mut game = Game {
            keys: Keys::new(session.world().spec().actions, controls),
            hand: Hand::new(controls, reports_releases),
            ticks: player.is_some() || controls.pace.is_real_time(),
            step_time: Duration::from_secs(1) / steps_per_second,
            due: Instant::now(),
            phase: Phase::Ready,
            session,
            player,
        };
        game.begin(game.session.now().seed);
        game
    }

    fn begin(&mut self, seed: u64) {
        self.session.begin(seed);
        self.hand.let_go();
        if let Some(player) = &mut self.player {
            player.begin(seed);
        }
        let waits_for_a_person = self.ticks && self.player.is_none();
        self.phase = if waits_for_a_person { Phase::Ready } else { Phase::Running };
        self.due = Instant::now() + self.step_time;
    }

    /// How long to wait for a key.
    fn until_due(&self, now: Instant) -> Duration {
        let is_due = self.ticks && self.phase == Phase::Running;
        if is_due { self.due.saturating_duration_since(now).min(PATIENCE) } else { PATIENCE }
    }

    /// Does what a key asks for; says how it ends if it does.
    fn key(&mut self, key: KeyEvent, now: Instant) -> Result<Option<Ending>> {
        let request = self.keys.request(key);
        if key.kind == KeyEventKind::Release {
            if let Some(Request::Act(action)) = request {
                self.hand.release(action);
            }
            return Ok(None);
        }
        let seed = self.session.now().seed;
        match request {
            Some(Request::Interrupt) => return Ok(Some(Ending::Interrupted)),
            Some(Request::Quit) => return Ok(Some(Ending::Quit)),
            Some(Request::Again) => self.begin(seed),
            Some(Request::Next) => self.begin(seed.wrapping_add(1)),
            Some(Request::Pause) if self.ticks && self.phase == Phase::Running => self.phase = Phase::Paused,
            Some(Request::Pause) if self.phase == Phase::Paused => self.go_on(now),
            Some(Request::Act(action)) => self.act(action, now)?,
            Some(Request::Pause) | None if self.phase == Phase::Ready => self.go_on(now),
            Some(Request::Pause) | None => {}
        }
        Ok(None)
    }

    fn go_on(&mut self, now: Instant) {
        self.hand.let_go();
        self.phase = Phase::Running;
        self.due = now + self.step_time;
    }

    fn act(&mut self, action: usize, now: Instant) -> Result<()> {
        if self.player.is_some() {
            return Ok(());
        }
        if matches!(self.phase, Phase::Ready | Phase::Paused) {
            self.go_on(now);
        }
        match (self.phase, self.ticks) {
            (Phase::Running, true) => self.hand.press(action, now),
            (Phase::Running, false) => self.step(action)?,
            _ => {}
        }
        Ok(())
    }

    /// Plays the step that is due, if one is.
    fn advance(&mut self, now: Instant) -> Result<()> {
        if !self.ticks || self.phase != Phase::Running || now < self.due {
            return Ok(());
        }
        // Steps that a stopped or slow terminal has missed are not made up for.
        self.due = (self.due + self.step_time).max(now);
        let action = match &mut self.player {
            Some(player) => player.action(self.session.world()),
            None => self.hand.action(now),
        };
        self.step(action)
    }

    fn step(&mut self, action: usize) -> Result<()> {
        self.session.step(action)?;
        if self.session.now().status.is_over() {
            self.phase = Phase::Over;
        }
        Ok(())
    }

    fn panel(&self) -> Panel<'_> {
        let message = match self.phase {
            Phase::Ready => "any key begins",
            Phase::Running => "",
            Phase::Paused => "paused: p goes on",
            Phase::Over => "over: r, n or q",
        };
        let keys = self.player.is_none().then_some(&self.keys);
        Panel { spec: self.session.world().spec(), episode: self.session.now(), message, keys }
    }
}

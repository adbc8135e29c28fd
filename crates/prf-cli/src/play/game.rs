//! A session in front of a person, but without the terminal.

use std::time::{Duration, Instant};

use crossterm::event::{KeyEvent, KeyEventKind};
use prf_envs::players::Player;
use prf_envs::{Controls, Environment};

use super::hand::Hand;
use super::keys::{Keys, Request};
use super::panel::Panel;
use super::session::Session;
use crate::error::Result;

/// How long to wait for a key at most, so that a signal to end is noticed.
const PATIENCE: Duration = Duration::from_millis(200);

/// How somebody ended it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ending {
    Quit,
    /// By Ctrl-C or a signal.
    Interrupted,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// A person gets ready: the world stands until the first key.
    Ready,
    Running,
    Paused,
    Over,
}

/// What happens in front of the screen: steps when they are due, and what keys ask for.
pub(super) struct Game<'a> {
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
    pub(super) fn new(
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
    pub(super) fn until_due(&self, now: Instant) -> Duration {
        let is_due = self.ticks && self.phase == Phase::Running;
        if is_due { self.due.saturating_duration_since(now).min(PATIENCE) } else { PATIENCE }
    }

    /// Does what a key asks for; says how it ends if it does.
    pub(super) fn key(&mut self, key: KeyEvent, now: Instant) -> Result<Option<Ending>> {
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
    pub(super) fn advance(&mut self, now: Instant) -> Result<()> {
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

    pub(super) fn world(&self) -> &dyn Environment {
        self.session.world()
    }

    pub(super) fn panel(&self) -> Panel<'_> {
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

#[cfg(test)]
mod tests {
    use crossterm::event::{KeyCode, KeyModifiers};
    use prf_envs::players::Oracle;
    use prf_envs::{EnvConfig, Pace, registry};

    use super::super::recorder::{Plan, Recorder};
    use super::*;

    fn breakout() -> Session {
        let world = registry::make(&EnvConfig::new("breakout")).expect("there is Breakout");
        Session::new(world, Recorder::new(Plan::default()), 5)
    }

    fn game(session: &mut Session, pace: Pace, player: Option<Box<dyn Player>>) -> Game<'_> {
        Game::new(session, player, Controls { pace, idle_action: 0 }, 10, false)
    }

    impl Game<'_> {
        fn press(&mut self, code: KeyCode, now: Instant) -> Option<Ending> {
            self.key(KeyEvent::new(code, KeyModifiers::NONE), now).expect("the world can be played")
        }

        fn steps(&self) -> u32 {
            self.session.now().steps
        }
    }

    #[test]
    fn a_turn_based_world_takes_a_step_a_key_and_none_by_itself() {
        let mut session = breakout();
        let mut game = game(&mut session, Pace::TurnBased, None);
        let later = Instant::now() + Duration::from_secs(60);
        game.advance(later).expect("nothing happens");
        assert_eq!((game.steps(), game.panel().message), (0, ""));
        game.press(KeyCode::Left, later);
        game.press(KeyCode::Char('3'), later);
        game.press(KeyCode::Char('z'), later);
        game.press(KeyCode::Char('p'), later);
        game.advance(later).expect("nothing happens");
        assert_eq!((game.steps(), game.phase), (2, Phase::Running));
    }

    #[test]
    fn a_real_time_world_begins_with_a_key_and_then_goes_on() {
        let mut session = breakout();
        let mut game = game(&mut session, Pace::Held, None);
        let start = Instant::now();
        let at = |ms| start + Duration::from_millis(ms);
        game.advance(at(1_000)).expect("nothing happens");
        assert_eq!(game.steps(), 0);
        game.press(KeyCode::Right, at(2_000));
        assert_eq!(game.until_due(at(2_050)), Duration::from_millis(50));
        for ms in [2_099, 2_100, 2_199, 2_200] {
            game.advance(at(ms)).expect("it goes on");
        }
        assert_eq!(game.steps(), 2);
        game.press(KeyCode::Char('p'), at(2_250));
        game.advance(at(2_400)).expect("nothing happens");
        assert_eq!((game.steps(), game.phase), (2, Phase::Paused));
        game.press(KeyCode::Char('p'), at(2_500));
        game.advance(at(2_600)).expect("it goes on");
        assert_eq!(game.steps(), 3);
        game.advance(at(9_000)).expect("it goes on");
        game.advance(at(9_001)).expect("it goes on");
        assert_eq!(game.steps(), 5, "what was missed is not made up for");
    }

    #[test]
    fn again_is_the_same_episode_and_next_the_following() {
        let mut session = breakout();
        let mut game = game(&mut session, Pace::TurnBased, None);
        let now = Instant::now();
        game.press(KeyCode::Left, now);
        game.press(KeyCode::Char('n'), now);
        assert_eq!((game.session.now().seed, game.steps()), (6, 0));
        game.press(KeyCode::Char('r'), now);
        assert_eq!(game.session.now().seed, 6);
        assert_eq!(game.press(KeyCode::Esc, now), Some(Ending::Quit));
        let (episode, _) = session.finish().expect("nothing is recorded");
        assert_eq!((episode.seed, episode.steps), (5, 1), "the last one in which a step was taken");
    }

    #[test]
    fn after_the_end_actions_do_nothing() {
        let mut session = breakout();
        let mut game = game(&mut session, Pace::TurnBased, None);
        let now = Instant::now();
        for _ in 0..200 {
            game.press(KeyCode::Left, now);
        }
        assert!(game.session.now().status.is_over() && game.phase == Phase::Over);
        assert_eq!(game.panel().message, "over: r, n or q");
    }

    #[test]
    fn who_watches_cannot_meddle() {
        let mut session = breakout();
        let mut game = game(&mut session, Pace::TurnBased, Some(Box::new(Oracle)));
        let later = Instant::now() + Duration::from_secs(1);
        game.press(KeyCode::Left, later);
        assert_eq!(game.steps(), 0);
        game.advance(later).expect("it goes on");
        assert_eq!(game.steps(), 1);
        assert!(game.panel().keys.is_none());
    }
}

//! Which action a player's keys ask for at each step of a world that goes on by itself.

use std::time::{Duration, Instant};

use prf_envs::{Controls, Pace};

/// How long a key counts as held after it went down, where its going up is not reported: until the keyboard's own
/// repetition sets in.
const UNTIL_REPETITION: Duration = Duration::from_millis(500);
/// The same after each repetition.
const BETWEEN_REPETITIONS: Duration = Duration::from_millis(150);

/// The keys that are down, as far as the terminal tells.
#[derive(Debug)]
pub(super) struct Hand {
    controls: Controls,
    /// Most terminals only report that a key goes down, and again while it is held.
    reports_releases: bool,
    /// The actions whose keys are down, the newest last.
    held: Vec<Held>,
    /// An action whose key went down since the last step: it counts once, however short that was.
    pressed: Option<usize>,
}

#[derive(Clone, Copy, Debug)]
struct Held {
    action: usize,
    /// When the key is taken to be up again.
    until: Option<Instant>,
}

impl Hand {
    pub(super) fn new(controls: Controls, reports_releases: bool) -> Hand {
        Hand { controls, reports_releases, held: Vec::new(), pressed: None }
    }

    /// A key went down, or is reported again because it is held.
    pub(super) fn press(&mut self, action: usize, now: Instant) {
        self.pressed = Some(action);
        if self.controls.pace != Pace::Held {
            return;
        }
        let until = (!self.reports_releases).then(|| match self.held.last() {
            Some(Held { action: same, until: Some(until) }) if *same == action && *until > now => {
                (*until).max(now + BETWEEN_REPETITIONS)
            }
            _ => now + UNTIL_REPETITION,
        });
        if self.reports_releases {
            self.held.retain(|held| held.action != action);
        } else {
            // Nobody says when the others go up, so the newest key is the only one that counts.
            self.held.clear();
        }
        self.held.push(Held { action, until });
    }

    /// A key went up.
    pub(super) fn release(&mut self, action: usize) {
        self.held.retain(|held| held.action != action);
    }

    /// All keys are taken to be up.
    pub(super) fn let_go(&mut self) {
        self.held.clear();
        self.pressed = None;
    }

    /// The action of the step that is due.
    pub(super) fn action(&mut self, now: Instant) -> usize {
        self.held.retain(|held| held.until.is_none_or(|until| until > now));
        let held = self.held.last().map(|held| held.action);
        self.pressed.take().or(held).unwrap_or(self.controls.idle_action)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STAY: usize = 0;
    const LEFT: usize = 1;
    const RIGHT: usize = 2;

    fn hand(pace: Pace, reports_releases: bool) -> (Hand, impl Fn(u64) -> Instant) {
        let start = Instant::now();
        (Hand::new(Controls { pace, idle_action: STAY }, reports_releases), move |ms| start + Duration::from_millis(ms))
    }

    #[test]
    fn an_impulse_counts_once() {
        let (mut hand, at) = hand(Pace::Impulses, false);
        assert_eq!(hand.action(at(0)), STAY);
        hand.press(LEFT, at(10));
        assert_eq!([hand.action(at(60)), hand.action(at(120))], [LEFT, STAY]);
    }

    #[test]
    fn a_held_key_lasts_until_it_is_released() {
        let (mut hand, at) = hand(Pace::Held, true);
        hand.press(LEFT, at(0));
        assert_eq!([hand.action(at(60)), hand.action(at(9_000))], [LEFT, LEFT]);
        hand.press(RIGHT, at(9_010));
        assert_eq!(hand.action(at(9_060)), RIGHT);
        hand.release(RIGHT);
        assert_eq!(hand.action(at(9_120)), LEFT, "whose key is still down");
        hand.release(LEFT);
        assert_eq!(hand.action(at(9_180)), STAY);
    }

    #[test]
    fn a_key_that_is_down_only_between_two_steps_counts_once() {
        let (mut hand, at) = hand(Pace::Held, true);
        hand.press(LEFT, at(0));
        hand.release(LEFT);
        assert_eq!([hand.action(at(60)), hand.action(at(120))], [LEFT, STAY]);
    }

    #[test]
    fn without_reports_a_key_is_held_until_its_repetition_stops() {
        let (mut hand, at) = hand(Pace::Held, false);
        hand.press(LEFT, at(0));
        assert_eq!([hand.action(at(60)), hand.action(at(450))], [LEFT, LEFT], "before the repetition sets in");
        for ms in (480..900).step_by(30) {
            hand.press(LEFT, at(ms));
            assert_eq!(hand.action(at(ms + 1)), LEFT);
        }
        assert_eq!(hand.action(at(1_000)), LEFT);
        assert_eq!(hand.action(at(1_100)), STAY);
    }

    #[test]
    fn without_reports_another_key_stops_the_first_at_once() {
        let (mut hand, at) = hand(Pace::Held, false);
        hand.press(LEFT, at(0));
        hand.press(STAY, at(100));
        assert_eq!([hand.action(at(120)), hand.action(at(180))], [STAY, STAY]);
        hand.press(RIGHT, at(200));
        assert_eq!(hand.action(at(240)), RIGHT);
        hand.let_go();
        assert_eq!(hand.action(at(300)), STAY);
    }
}

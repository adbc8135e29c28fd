//! Which key does what.

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use prf_envs::Controls;

/// What a key asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Request {
    /// An action, by its index.
    Act(usize),
    /// The same episode from its start.
    Again,
    /// The episode of the next seed.
    Next,
    Pause,
    Quit,
    /// Ctrl-C.
    Interrupt,
}

/// Keys that are not an action's, and what they do.
pub(super) const OTHER_KEYS: [(&str, &str); 4] = [("p", "pause"), ("r", "again"), ("n", "next episode"), ("q", "quit")];

/// The keys of the actions by their index, without those of [`OTHER_KEYS`]: more than any world has actions.
const BY_INDEX: &str = "123456789abcdefghijklmostuvwxyz";

/// The keys of a world's actions.
#[derive(Debug)]
pub(super) struct Keys {
    /// For each action its keys, those it is listed with first.
    actions: Vec<Vec<KeyCode>>,
}

impl Keys {
    /// Every action has a key by its index, and some have one that says what they do.
    pub(super) fn new(actions: &[&str], controls: Controls) -> Keys {
        let mut keys: Vec<Vec<KeyCode>> = actions.iter().map(|name| speaking(name).to_vec()).collect();
        // The key that does nothing is one that nothing else wants.
        for idle in [KeyCode::Down, KeyCode::Char(' ')] {
            if !keys.iter().flatten().any(|&key| key == idle) {
                keys[controls.idle_action].push(idle);
            }
        }
        for (own, index) in keys.iter_mut().zip(BY_INDEX.chars()) {
            own.push(KeyCode::Char(index));
        }
        Keys { actions: keys }
    }

    /// What `key` asks for, if anything.
    pub(super) fn request(&self, key: KeyEvent) -> Option<Request> {
        let code = match key.code {
            KeyCode::Char(letter) => KeyCode::Char(letter.to_ascii_lowercase()),
            code => code,
        };
        if key.modifiers.intersects(KeyModifiers::CONTROL | KeyModifiers::ALT | KeyModifiers::SUPER) {
            let is_interrupt = code == KeyCode::Char('c') && key.modifiers.contains(KeyModifiers::CONTROL);
            return is_interrupt.then_some(Request::Interrupt);
        }
        match code {
            KeyCode::Char('q') | KeyCode::Esc => Some(Request::Quit),
            KeyCode::Char('r') => Some(Request::Again),
            KeyCode::Char('n') => Some(Request::Next),
            KeyCode::Char('p') => Some(Request::Pause),
            _ => self.actions.iter().position(|keys| keys.contains(&code)).map(Request::Act),
        }
    }

    /// The keys of the action with this index, as they are shown.
    pub(super) fn shown(&self, action: usize) -> String {
        let names: Vec<String> = self.actions[action].iter().map(shown).collect();
        names.join(" ")
    }
}

/// Keys that say what an action of this name does.
fn speaking(name: &str) -> &'static [KeyCode] {
    match name {
        "left" => &[KeyCode::Left],
        "right" => &[KeyCode::Right],
        "up" => &[KeyCode::Up],
        "down" => &[KeyCode::Down],
        "flap" | "jump" => &[KeyCode::Char(' '), KeyCode::Up],
        _ => &[],
    }
}

fn shown(key: &KeyCode) -> String {
    match key {
        KeyCode::Left => "←".to_owned(),
        KeyCode::Right => "→".to_owned(),
        KeyCode::Up => "↑".to_owned(),
        KeyCode::Down => "↓".to_owned(),
        KeyCode::Char(' ') => "space".to_owned(),
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use prf_envs::{EnvConfig, Pace, registry};

    use super::*;

    fn keys_of(name: &str) -> Keys {
        let world = registry::make(&EnvConfig::new(name)).expect("it is registered");
        Keys::new(world.spec().actions, registry::controls(name).expect("it is registered"))
    }

    fn plain(keys: &Keys, code: KeyCode) -> Option<Request> {
        keys.request(KeyEvent::new(code, KeyModifiers::NONE))
    }

    #[test]
    fn the_arrows_move_the_paddle() {
        let keys = keys_of("breakout");
        for (code, action) in [
            (KeyCode::Left, 1),
            (KeyCode::Right, 2),
            (KeyCode::Down, 0),
            (KeyCode::Char(' '), 0),
            (KeyCode::Char('1'), 0),
            (KeyCode::Char('2'), 1),
            (KeyCode::Char('3'), 2),
        ] {
            assert_eq!(plain(&keys, code), Some(Request::Act(action)), "{code}");
        }
        assert_eq!(plain(&keys, KeyCode::Char('4')), None);
        assert_eq!(keys.shown(1), "← 2");
        assert_eq!(keys.shown(0), "↓ space 1");
    }

    #[test]
    fn space_flaps() {
        let keys = keys_of("flappy");
        for code in [KeyCode::Char(' '), KeyCode::Up, KeyCode::Char('2')] {
            assert_eq!(plain(&keys, code), Some(Request::Act(1)), "{code}");
        }
        assert_eq!(plain(&keys, KeyCode::Down), Some(Request::Act(0)));
    }

    #[test]
    fn any_number_of_actions_has_keys_and_none_has_two_meanings() {
        let names = ["a"; 31];
        let keys = Keys::new(&names, Controls { pace: Pace::TurnBased, idle_action: 0 });
        let reached: Vec<_> = BY_INDEX.chars().map(|letter| plain(&keys, KeyCode::Char(letter))).collect();
        assert_eq!(reached, (0..31).map(|action| Some(Request::Act(action))).collect::<Vec<_>>());
        for (code, request) in
            [('q', Request::Quit), ('r', Request::Again), ('n', Request::Next), ('p', Request::Pause)]
        {
            assert_eq!(plain(&keys, KeyCode::Char(code)), Some(request));
        }
    }

    #[test]
    fn every_world_is_played_by_keys_that_are_told_apart() {
        for name in registry::names() {
            let keys = keys_of(name);
            for (action, own) in keys.actions.iter().enumerate() {
                assert!(own.iter().all(|&code| plain(&keys, code) == Some(Request::Act(action))), "{name} {action}");
                assert!(!own.is_empty(), "{name} {action}");
            }
        }
    }

    #[test]
    fn ctrl_c_interrupts_and_other_chords_do_nothing() {
        let keys = keys_of("breakout");
        let chord = |letter, modifier| keys.request(KeyEvent::new(KeyCode::Char(letter), modifier));
        assert_eq!(chord('c', KeyModifiers::CONTROL), Some(Request::Interrupt));
        assert_eq!(chord('q', KeyModifiers::CONTROL), None);
        assert_eq!(chord('1', KeyModifiers::ALT), None);
        assert_eq!(chord('Q', KeyModifiers::SHIFT), Some(Request::Quit));
        assert_eq!(plain(&keys, KeyCode::Esc), Some(Request::Quit));
    }
}

//! The words beside or below the picture.

use prf_envs::Spec;

use super::keys::{Keys, OTHER_KEYS};
use super::session::Episode;

/// All that is said while a world is played.
#[derive(Debug)]
pub(super) struct Panel<'a> {
    pub(super) spec: &'a Spec,
    pub(super) episode: Episode,
    /// What the person should know or do now.
    pub(super) message: &'a str,
    /// Where the keys of actions do something.
    pub(super) keys: Option<&'a Keys>,
}

impl Panel<'_> {
    /// Lines for a narrow column.
    pub(super) fn tall(&self) -> Vec<String> {
        let Episode { seed, .. } = self.episode;
        let mut lines = vec![format!("{}, seed {seed}", self.spec.name)];
        lines.extend(self.figures());
        lines.extend([String::new(), self.message.to_owned(), String::new()]);
        let keys = self.keys();
        let widest = keys.iter().map(|(key, _)| key.chars().count()).max().unwrap_or(0);
        lines.extend(keys.iter().map(|(key, meaning)| format!("{key:widest$}  {meaning}")));
        lines
    }

    /// Two lines: the figures, and what can be done.
    pub(super) fn wide(&self) -> Vec<String> {
        let keys = || {
            let keys = self.keys().into_iter().map(|(key, meaning)| format!("{key} {meaning}"));
            keys.collect::<Vec<_>>().join(" · ")
        };
        let below = if self.message.is_empty() { keys() } else { self.message.to_owned() };
        vec![self.figures().join("  "), below]
    }

    fn figures(&self) -> [String; 3] {
        let Episode { score, last_reward, steps, .. } = self.episode;
        [
            format!("score {}", figure(score)),
            format!("step {steps}/{}", self.spec.limit_steps),
            format!("reward {}", figure(last_reward)),
        ]
    }

    fn keys(&self) -> Vec<(String, &str)> {
        let actions = self
            .keys
            .into_iter()
            .flat_map(|keys| self.spec.actions.iter().enumerate().map(|(action, &name)| (keys.shown(action), name)));
        actions.chain(OTHER_KEYS.map(|(key, meaning)| (key.to_owned(), meaning))).collect()
    }
}

/// A score or a reward without needless digits.
fn figure(value: f32) -> String {
    let rounded = (f64::from(value) * 1000.0).round() / 1000.0;
    // No minus before a 0.
    format!("{}", rounded + 0.0)
}

#[cfg(test)]
mod tests {
    use prf_envs::{Controls, Pace, Status};

    use super::*;

    const SPEC: Spec =
        Spec { name: "garden", width: 8, height: 8, actions: &["wait", "left"], limit_steps: 50, chance: true };

    fn panel<'a>(message: &'a str, keys: Option<&'a Keys>) -> Panel<'a> {
        let episode =
            Episode { seed: 7, steps: 12, score: 3.0, last_reward: 0.1, reward: 1.2, status: Status::Running };
        Panel { spec: &SPEC, episode, message, keys }
    }

    fn keys() -> Keys {
        Keys::new(SPEC.actions, Controls { pace: Pace::Held, idle_action: 0 })
    }

    #[test]
    fn a_column_has_figures_the_message_and_every_key() {
        let keys = keys();
        assert_eq!(
            panel("paused", Some(&keys)).tall(),
            [
                "garden, seed 7",
                "score 3",
                "step 12/50",
                "reward 0.1",
                "",
                "paused",
                "",
                "↓ space 1  wait",
                "← 2        left",
                "p          pause",
                "r          again",
                "n          next episode",
                "q          quit"
            ]
        );
    }

    #[test]
    fn two_lines_have_the_figures_and_either_message_or_keys() {
        let keys = keys();
        let figures = "score 3  step 12/50  reward 0.1";
        assert_eq!(panel("paused", Some(&keys)).wide(), [figures, "paused"]);
        let all = "↓ space 1 wait · ← 2 left · p pause · r again · n next episode · q quit";
        assert_eq!(panel("", Some(&keys)).wide(), [figures, all]);
        assert_eq!(panel("", None).wide()[1], "p pause · r again · n next episode · q quit");
    }

    #[test]
    fn figures_are_short() {
        assert_eq!([3.0, 0.1, -1.0, 0.12345, -0.0].map(figure), ["3", "0.1", "-1", "0.123", "0"]);
    }
}

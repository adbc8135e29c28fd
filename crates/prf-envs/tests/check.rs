//! The conformance suite finds worlds that break their promises.

use prf_core::FrameMut;
use prf_envs::breakout::Breakout;
use prf_envs::{Environment, Error, Spec, Status, Step, check};

/// What is wrong with a world.
#[derive(Clone, Copy, PartialEq)]
enum Flaw {
    IgnoresSeed,
    KeepsOldPicture,
    ForgetsPaddle,
    StepsAfterEnd,
    TerminatesAtLimit,
    TakesAnyAction,
    TakesAnyState,
    DrawsFromElsewhere,
}

/// Breakout with a flaw.
struct Flawed {
    inner: Breakout,
    flaw: Flaw,
    resets: u64,
}

impl Environment for Flawed {
    fn spec(&self) -> &Spec {
        self.inner.spec()
    }

    fn reset(&mut self, seed: u64) {
        self.resets += 1;
        match self.flaw {
            Flaw::IgnoresSeed => self.inner.reset(0),
            Flaw::DrawsFromElsewhere => self.inner.reset(seed + self.resets),
            _ => self.inner.reset(seed),
        }
    }

    fn step(&mut self, action: usize) -> Result<Step, Error> {
        let action = if self.flaw == Flaw::TakesAnyAction { action % 3 } else { action };
        match self.inner.step(action) {
            Ok(step) if self.flaw == Flaw::TerminatesAtLimit && step.status == Status::Truncated => {
                Ok(Step { status: Status::Terminated, ..step })
            }
            Err(Error::EpisodeOver { .. }) if self.flaw == Flaw::StepsAfterEnd => {
                Ok(Step { reward: 0.0, score: 0.0, status: Status::Terminated })
            }
            other => other,
        }
    }

    fn draw(&self, frame: &mut FrameMut<'_>) {
        let old = frame.as_mut_slice()[0];
        self.inner.draw(frame);
        if self.flaw == Flaw::KeepsOldPicture {
            frame.as_mut_slice()[0] = old;
        }
    }

    fn save_state(&self) -> Vec<u8> {
        self.inner.save_state()
    }

    fn load_state(&mut self, bytes: &[u8]) -> Result<(), Error> {
        match self.inner.load_state(bytes) {
            Err(_) if self.flaw == Flaw::TakesAnyState => Ok(()),
            Ok(()) if self.flaw == Flaw::ForgetsPaddle && bytes.len() > 33 => {
                let mut state = bytes.to_vec();
                state[33] /= 2;
                self.inner.load_state(&state)
            }
            other => other,
        }
    }

    fn oracle_action(&self) -> usize {
        self.inner.oracle_action()
    }
}

#[test]
fn each_flaw_is_found() {
    for (flaw, rule) in [
        (Flaw::IgnoresSeed, "seeds start differently where chance plays a part, else alike"),
        (Flaw::KeepsOldPicture, "a drawing covers the whole frame, at any size"),
        (Flaw::ForgetsPaddle, "a restored state goes on in the same way"),
        (Flaw::StepsAfterEnd, "after the end only a reset helps"),
        (Flaw::TerminatesAtLimit, "the step limit truncates"),
        (Flaw::TakesAnyAction, "an unknown action is refused and changes nothing"),
        (Flaw::TakesAnyState, "damaged states are refused and change nothing"),
        (Flaw::DrawsFromElsewhere, "the same seed and actions give the same episode"),
    ] {
        let result = check::conformance(&|limit_steps| {
            Ok(Box::new(Flawed { inner: Breakout::new(limit_steps)?, flaw, resets: 0 }))
        });
        match result {
            Err(Error::BrokenRule { rule: found, world, .. }) => {
                assert_eq!((found, world.as_str()), (rule, "breakout"));
            }
            other => panic!("expected \"{rule}\", got {other:?}"),
        }
    }
}

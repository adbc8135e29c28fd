//! Many settings at once, on several threads.

use std::num::NonZero;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use super::{Evidence, Judgement};
use crate::{Error, RewardParams};

impl Evidence<'_> {
    /// Judges each of these settings. The result is the same to the bit for any number of threads.
    ///
    /// # Errors
    ///
    /// As [`Evidence::judge`], of the first setting that has one.
    pub fn sweep(&self, settings: &[RewardParams], threads: NonZero<usize>) -> Result<Vec<Judgement>, Error> {
        let next = AtomicUsize::new(0);
        let work = || {
            let take = || Some(next.fetch_add(1, Ordering::Relaxed)).filter(|&index| index < settings.len());
            std::iter::from_fn(take).map(|index| (index, self.judge(settings[index]))).collect::<Vec<_>>()
        };
        let mut judged = thread::scope(|scope| {
            let others: Vec<_> = (1..threads.get().min(settings.len())).map(|_| scope.spawn(work)).collect();
            let mut judged = work();
            for other in others {
                match other.join() {
                    Ok(part) => judged.extend(part),
                    Err(panic) => std::panic::resume_unwind(panic),
                }
            }
            judged
        });
        judged.sort_by_key(|&(index, _)| index);
        judged.into_iter().map(|(_, judgement)| judgement).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{DescriptorParams, Frame, Goal, settings};

    #[test]
    fn any_number_of_threads_gives_the_same() {
        let mut goal = Frame::new(30, 30);
        (8..18).for_each(|y| goal.row_mut(y)[10..20].fill(255));
        goal.row_mut(25).fill(90);
        let goal = Goal::from(goal);
        let evidence = Evidence::of_goal(&DescriptorParams::Direct, &goal).expect("a thing");
        let settings = settings(&goal, RewardParams::default());
        let sweep = |threads| evidence.sweep(&settings, NonZero::new(threads).expect("above 0")).expect("they fit");
        let one = sweep(1);
        assert_eq!(one.len(), settings.len());
        assert!(one.iter().zip(&settings).all(|(judgement, params)| judgement.params == *params));
        assert_eq!(one, sweep(3));
        assert_eq!(one, sweep(1000));
    }
}

//! What a world looks like to players of every skill: frames to judge a reward by.

use prf_core::{Error as CoreError, Footage, Frame, Label};

use crate::players::{Oracle, Player, Random};
use crate::rng::{ChaCha8Rng, below, stream, unit_f32};
use crate::{EnvConfig, Environment, Error, registry};

/// How often the clumsy player does something at random.
const CLUMSY: f32 = 0.2;
/// Episodes of the random and of the clumsy player.
const EPISODES: usize = 40;
/// Episodes of the oracle, and the steps after which they are cut off: enough to see a finished task.
const LONG_EPISODES: usize = 4;
const LONG: u32 = 20_000;

/// Takes about `frames` frames of the world that `config` describes, a third each of a random player, of a clumsy one (the oracle with
/// every fifth action at random) and of the oracle, which plays beyond the config's limit until the task is finished. Each has what `label` makes
/// of the world's own [label](Environment::label).
///
/// The same seed gives the same frames.
///
/// # Errors
/// An unknown world; as [`Footage::observe`].
pub fn survey(
    config: &EnvConfig,
    seed: u64,
    frames: usize,
    label: impl Fn(Label) -> Label,
    footage: &mut Footage,
) -> Result<(), Error> {
    // Without chance all episodes of an oracle are one, which ends with the task.
    let has_chance = registry::make(config)?.spec().chance;
    let long_steps = if has_chance { config.limit_steps.max(LONG) } else { config.limit_steps };
    let long = EnvConfig { limit_steps: long_steps, ..config.clone() };
    let shares: [(&EnvConfig, &mut dyn Player, usize); 3] = [
        (config, &mut Random::new(), EPISODES),
        (config, &mut Clumsy::new(), EPISODES),
        (&long, &mut Oracle, LONG_EPISODES),
    ];
    for (config, player, episodes) in shares {
        let seeds: Vec<u64> = (0..episodes as u64).map(|index| episode_seed(seed, index)).collect();
        take(config, player, &seeds, frames.div_ceil(3), &label, footage)?;
    }
    Ok(())
}

/// `share` frames, evenly spread over a player's episodes, and the last of each. A frame that looks like the one before it is none of them:
/// an oracle may rest once the task is done.
fn take(
    config: &EnvConfig,
    player: &mut dyn Player,
    seeds: &[u64],
    share: usize,
    label: &impl Fn(Label) -> Label,
    footage: &mut Footage,
) -> Result<(), Error> {
    let mut world = registry::make(config)?;
    let mut counts = Vec::with_capacity(seeds.len());
    for &seed in seeds {
        let mut news = 0;
        play(world.as_mut(), player, seed, |_, label| {
            news += usize::from(label.is_some());
            Ok(())
        })?;
        counts.push(news);
    }
    let stride = (counts.iter().sum::<usize>() / share.max(1)).max(1);
    let mut index = 0;
    for (&seed, &count) in seeds.iter().zip(&counts) {
        footage.begin();
        let end = index + count;
        play(world.as_mut(), player, seed, |frame, found| {
            let Some(found) = found else { return footage.pass(frame.view()) };
            // The last frame may be the only one that shows the finished task.
            let is_taken = index % stride == 0 || index + 1 == end;
            index += 1;
            if is_taken { footage.observe(frame.view(), label(found)) } else { footage.pass(frame.view()) }
        })?;
    }
    Ok(())
}

fn episode_seed(seed: u64, index: u64) -> u64 {
    let mut rng = stream(seed, "survey", index);
    below(&mut rng, 1 << 53) as u64
}

/// Plays an episode and shows all its frames, with a label those that show something new: not the first one, before any step, and none that
/// looks like the one before it.
fn play(
    world: &mut dyn Environment,
    player: &mut dyn Player,
    seed: u64,
    mut look: impl FnMut(&Frame, Option<Label>) -> Result<(), CoreError>,
) -> Result<(), Error> {
    let mut frame = Frame::new(world.spec().width, world.spec().height);
    world.reset(seed);
    player.begin(seed);
    world.draw_into(&mut frame);
    look(&frame, None)?;
    let mut before = frame.clone();
    loop {
        let step = world.step(player.action(world))?;
        world.draw_into(&mut frame);
        look(&frame, (frame != before).then(|| world.label(step.score)))?;
        if step.status.is_over() {
            return Ok(());
        }
        before.as_mut_slice().copy_from_slice(frame.as_slice());
    }
}

/// The oracle, when it pays attention.
struct Clumsy(ChaCha8Rng);

impl Clumsy {
    fn new() -> Clumsy {
        Clumsy(stream(0, "clumsy-player", 0))
    }
}

impl Player for Clumsy {
    fn begin(&mut self, seed: u64) {
        self.0 = stream(seed, "clumsy-player", 0);
    }

    fn action(&mut self, world: &dyn Environment) -> usize {
        if unit_f32(&mut self.0) < CLUMSY {
            below(&mut self.0, world.spec().actions.len())
        } else {
            world.oracle_action()
        }
    }
}

#[cfg(test)]
mod tests {
    use std::num::NonZero;

    use prf_core::{
        CellSize, DescriptorParams, FigureKind, Goal, HogParams, Norm, RewardParams, Verdict, recommend, settings,
    };

    use super::*;

    fn surveyed(seed: u64, frames: usize) -> Footage {
        let mut footage = Footage::new(None, 2 * frames).expect("above 0");
        survey(&EnvConfig::new("breakout"), seed, frames, |label| label, &mut footage).expect("the world is there");
        footage
    }

    #[test]
    fn frames_show_the_way_from_the_start_to_the_finished_task() {
        let footage = surveyed(1, 300);
        assert!((300..=500).contains(&footage.frames().len()), "{}", footage.frames().len());
        let scores: Vec<f64> = footage.labels().iter().filter_map(|label| label.score).collect();
        assert_eq!(scores.len(), footage.frames().len());
        assert!(scores.contains(&0.0));
        assert!(scores.contains(&60.0), "the wall is cleared: {:?}", scores.last());
    }

    #[test]
    fn a_seed_gives_its_own_frames() {
        let (a, b, other) = (surveyed(1, 60), surveyed(1, 60), surveyed(2, 60));
        assert!(a.frames() == b.frames() && a.labels() == b.labels());
        assert!(a.frames() != other.frames());
    }

    /// The marked row of the table in docs/reward.md.
    #[test]
    fn breakouts_settings_are_found_from_the_usual_ones_of_the_papers_year() {
        let footage = surveyed(1, 1000);
        let goal = Goal::from(Frame::new(84, 84));
        let hog = HogParams { norm: Norm::L1, block_cells: 3, cell: CellSize::Px(8), ..HogParams::default() };
        let params = RewardParams { hog, ..RewardParams::default() };
        let evidence = footage.scored(&DescriptorParams::Direct, &goal).expect("scores differ");
        let judged = evidence.sweep(&settings(&goal, params), NonZero::<usize>::MIN).expect("settings fit");
        assert_ne!(judged[0].verdict, Verdict::Good, "{:?}", judged[0]);
        let best = &judged[recommend(&judged).expect("there is a good one")];
        assert_eq!((best.params.hog.norm, best.params.hog.block_cells, best.cell_px), (Norm::L2, 1, 2));
        assert!(
            best.figure(FigureKind::Rank) > Some(0.95) && best.figure(FigureKind::EarlyRank) > Some(0.85),
            "{best:?}"
        );
        assert_eq!(best.verdict, Verdict::Good);
    }

    #[test]
    fn an_unknown_world_is_named() {
        let mut footage = Footage::new(None, 10).expect("above 0");
        let error = survey(&EnvConfig::new("breakin"), 1, 10, |label| label, &mut footage)
            .expect_err("there is none")
            .to_string();
        assert!(error.contains("breakin"), "{error}");
    }
}

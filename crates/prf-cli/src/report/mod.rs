//! What runs came to, gathered for one page.

use std::path::Path;

use prf_core::Goal;
use prf_dqn::checkpoint::{CheckpointStore, MODEL_FILE};
use prf_dqn::evaluate::episode_seeds;
use prf_dqn::run_dir::Manifest;
use prf_envs::registry;

use self::claims::{Claim, Outcome};
use self::episode::Episode;
use crate::args::{Aggregate, Place, Quantity};
use crate::commands::learning::load_network;
use crate::error::Result;
use crate::printer::Printer;
use crate::runs::curves::{LearningCurve, Question};
use crate::runs::diagram::players;
use crate::runs::group::Group;
use crate::runs::players::Players;
use crate::runs::standing::Standing;
use crate::settings::load_run;

mod claims;
mod episode;
pub(crate) mod page;

/// Everything on the page.
pub(crate) struct Report<'a> {
    pub(crate) world: &'a str,
    pub(crate) summary: &'static str,
    pub(crate) question: Question,
    pub(crate) curves: Vec<LearningCurve>,
    /// To compare all curves with.
    pub(crate) players: Option<Players>,
    pub(crate) chapters: Vec<Chapter<'a>>,
}

/// What there is to say of a group.
pub(crate) struct Chapter<'a> {
    pub(crate) group: &'a Group,
    /// In the order of the group's runs.
    pub(crate) standings: Vec<Standing>,
    pub(crate) headline: String,
    pub(crate) claims: Vec<Claim>,
    pub(crate) goal: Option<Goal>,
    /// The config of the first run, as its file has it.
    pub(crate) config: String,
    pub(crate) played: Played,
}

/// The agent playing.
pub(crate) enum Played {
    /// Nothing is saved that could play.
    NoModel,
    /// Why what is saved can't play.
    Broken(String),
    Episode {
        episode: Box<Episode>,
        /// Which run's, and after how many steps it was saved.
        agent: String,
    },
}

impl<'a> Report<'a> {
    /// Reads what is left to be read and plays an episode of each group.
    ///
    /// # Errors
    ///
    /// The world's players fail, or a run's config can't be read any more.
    pub(crate) fn of(groups: &'a [Group], printer: &mut Printer) -> Result<Report<'a>> {
        let question = Question { y: Quantity::Score, x: Place::Steps, aggregate: Aggregate::Iqm };
        let world = &groups[0].runs[0].config.env.name;
        let chapters = groups.iter().map(|group| Chapter::of(group, printer)).collect::<Result<_>>()?;
        Ok(Report {
            world,
            summary: registry::summary(world).unwrap_or_default(),
            question,
            curves: question.curves(groups, printer),
            players: players(groups, question.y)?,
            chapters,
        })
    }

    /// Whether something that should be on the page could not be read.
    pub(crate) fn is_incomplete(&self) -> bool {
        self.chapters.iter().any(|chapter| matches!(chapter.played, Played::Broken(_)))
    }
}

impl<'a> Chapter<'a> {
    fn of(group: &'a Group, printer: &mut Printer) -> Result<Chapter<'a>> {
        let first = &group.runs[0];
        let standings: Vec<Standing> = group.runs.iter().map(|run| Standing::of(run.dir.path())).collect();
        let outcome = Outcome::of(group, &standings, Players::of(&first.config.env, first.config.evaluation.episodes)?);
        let loaded = load_run(&first.dir.config_path(), &[], None);
        let (goal, played) = match loaded {
            Ok(loaded) => (loaded.goal, play(group, printer)),
            // Its records are as good without the goal's picture.
            Err(error) => {
                printer.warning(format_args!("the agent is not shown playing: {error}"), None);
                (None, Played::Broken(error.to_string()))
            }
        };
        Ok(Chapter {
            group,
            headline: outcome.headline(&group.name),
            claims: outcome.claims(),
            standings,
            goal,
            config: std::fs::read_to_string(first.dir.config_path())?,
            played,
        })
    }

    pub(crate) fn manifests(&self) -> impl Iterator<Item = &Manifest> {
        self.standings.iter().filter_map(|standing| standing.manifest.as_ref())
    }
}

/// Lets the newest model of the first run that has one play.
fn play(group: &Group, printer: &mut Printer) -> Played {
    for run in &group.runs {
        let Some(newest) = CheckpointStore::list(run.dir.path()).ok().and_then(|mut found| found.pop()) else {
            continue;
        };
        let steps = newest.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let steps = steps.trim_start_matches("step-").trim_start_matches('0').to_owned();
        return match play_model(run.dir.path(), &newest.join(MODEL_FILE)) {
            Ok(episode) => {
                let agent = format!("seed {} after {steps} steps", run.config.seed);
                Played::Episode { episode: Box::new(episode), agent }
            }
            Err(error) => {
                printer.warning(format_args!("the agent is not shown playing: {error}"), None);
                Played::Broken(error.to_string())
            }
        };
    }
    Played::NoModel
}

fn play_model(run: &Path, model: &Path) -> Result<Episode> {
    let loaded = load_run(&run.join("config.toml"), &[], None)?;
    let network = load_network(&loaded, model, tch::Device::Cpu)?;
    Episode::play(&network, &loaded, episode_seeds(0, "eval", 1)[0])
}

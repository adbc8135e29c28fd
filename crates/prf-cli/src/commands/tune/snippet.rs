//! The recommendation: a `[reward]` with its reason, and the files that it needs.

use std::path::{Path, PathBuf};

use prf_core::{Judgement, Rect, io};
use prf_envs::RewardConfig;

use super::{Judged, tables};
use crate::error::Result;
use crate::evidence::{Known, Subject, words};
use crate::files::{refuse_existing, write_whole};
use crate::plot::heat::HeatTable;
use crate::printer::Printer;

/// The best of all that was judged.
pub(super) struct Recommendation<'a> {
    pub(super) subject: &'a Subject,
    pub(super) known: &'a Known,
    pub(super) judged: &'a [Judged],
    pub(super) window: &'a Judged,
    pub(super) best: &'a Judgement,
    /// What the given settings are worth, if they fit the goal.
    pub(super) given: Option<&'a Judgement>,
    /// What windows are cut out of.
    pub(super) picture: &'a Path,
    /// The file that it is written to.
    pub(super) out: Option<&'a Path>,
}

/// The files of a goal that was cut anew.
struct Files {
    goal: PathBuf,
    mask: PathBuf,
}

impl Recommendation<'_> {
    pub(super) fn headline(&self) -> String {
        let settings = words::settings(&self.best.params, self.best.cell_px);
        format!("recommended: {settings}{}", self.window_words())
    }

    fn window_words(&self) -> String {
        match self.window.candidate.rect {
            Some(Rect { width, height, .. }) => format!(", window of {width}x{height} px"),
            None => String::new(),
        }
    }

    /// Tables of the settings for the recommended window, and of the windows if there are several.
    pub(super) fn tables(&self) -> Vec<HeatTable> {
        let title = format!("quality of cell sizes, norms and blocks{}", self.window_words());
        let mut all = vec![tables::settings(title, &self.window.judgements, self.best)];
        if self.judged.len() > 1 {
            let title = "quality of the best settings for windows of other widths and heights".to_owned();
            all.push(tables::windows(title, self.judged, self.window));
        }
        all
    }

    /// The `[reward]`, with the reason as comments, as it stands in the file or is to be put into the config.
    pub(super) fn toml(&self) -> Result<String> {
        let reward = RewardConfig { hog: self.best.params.hog, ..self.subject.reward.clone() };
        let reward = self.with_goal(reward);
        let comments: Vec<String> =
            self.reason().iter().map(|line| format!("# {line}").trim_end().to_owned()).collect();
        Ok(format!("{}\n\n{}", comments.join("\n"), words::snippet(&reward)?))
    }

    /// With paths that lead from the snippet, or from where the given ones do, to the goal.
    fn with_goal(&self, mut reward: RewardConfig) -> RewardConfig {
        let folder = self.out.map(|out| out.parent().unwrap_or(Path::new("")));
        let (goal, mask) = match (self.window.candidate.is_given, folder) {
            (true, None) => return reward,
            (true, Some(_)) => (self.subject.goal_path.clone(), self.subject.mask_path.clone()),
            (false, _) => {
                let files = self.files(self.out.or(reward.goal.as_deref()).unwrap_or(&self.subject.goal_path));
                (files.goal, self.window.candidate.goal.mask.as_ref().map(|_| files.mask))
            }
        };
        let seen = |path: PathBuf| folder.map_or_else(|| path.clone(), |folder| relative(&path, folder));
        reward.goal = Some(seen(goal));
        if let Some(window) = &mut reward.window {
            window.mask = mask.map(seen);
        }
        reward
    }

    /// What a goal that is cut anew is called, beside another file.
    fn files(&self, beside: &Path) -> Files {
        let stem = beside.file_stem().unwrap_or_default().to_string_lossy();
        let size =
            self.window.candidate.rect.map_or_else(String::new, |rect| format!("{}x{}", rect.width, rect.height));
        let named = |what: &str| beside.with_file_name(format!("{stem}-{what}{size}.png"));
        Files { goal: named(""), mask: named("mask-") }
    }

    fn reason(&self) -> Vec<String> {
        let judged = words::evidence(self.known, self.window.frames);
        let mut lines = vec![self.headline(), format!("judged by {judged}")];
        lines.extend(words::figures(self.best).into_iter().map(|line| format!("  {line}")));
        lines.push(format!("  rewards: {}", words::rewards(self.best.rewards)));
        lines.push(words::verdict(self.best));
        if let Some(given) = self.given {
            let settings = words::settings(&given.params, given.cell_px);
            lines.push(format!("as given: {settings}: {}", words::verdict(given)));
        }
        lines.push(String::new());
        lines.push("Qualities run from -1, always wrong, over 0, which tells nothing, to 1, always right.".to_owned());
        for table in self.tables() {
            lines.push(String::new());
            lines.extend(tables::text(&table));
        }
        lines.extend(self.commands());
        lines
    }

    /// What cuts the goal, and its mask, where it is not the given one.
    fn commands(&self) -> Vec<String> {
        let (false, Some(rect)) = (self.window.candidate.is_given, self.window.candidate.rect) else {
            return Vec::new();
        };
        let Rect { x, y, width, height } = rect;
        let files = self.files(self.out.unwrap_or(&self.subject.goal_path));
        let crop = |from: &Path, to: &Path| {
            format!("prf goal crop {} --rect {x},{y},{width},{height} --out {}", quoted(from), quoted(to))
        };
        let mut lines = vec![String::new(), "The goal is cut by".to_owned(), crop(self.picture, &files.goal)];
        lines.extend(self.subject.mask_path.as_ref().map(|mask| crop(mask, &files.mask)));
        lines
    }
}

/// As a shell takes it.
fn quoted(path: &Path) -> String {
    let path = path.to_string_lossy();
    let is_plain = |c: char| c.is_alphanumeric() || "/._-+".contains(c);
    if path.chars().all(is_plain) { path.into_owned() } else { format!("'{}'", path.replace('\'', "'\\''")) }
}

/// Writes the snippet, and the goal if it was cut anew; nothing if anything is in the way.
pub(super) fn write_files(
    recommendation: &Recommendation<'_>,
    out: &Path,
    force: bool,
    printer: &mut Printer,
) -> Result<()> {
    let candidate = &recommendation.window.candidate;
    let mut files = Vec::new();
    if !candidate.is_given {
        let named = recommendation.files(out);
        files.push((named.goal, io::png(candidate.goal.picture.view())));
        files.extend(candidate.goal.mask.as_ref().map(|mask| (named.mask, io::png(mask.view()))));
    }
    // The snippet last: once it is there, everything it names is there too.
    files.push((out.to_owned(), recommendation.toml()?.into_bytes()));
    if !force {
        files.iter().try_for_each(|(path, _)| refuse_existing(path))?;
    }
    for (path, content) in &files {
        write_whole(path, content, force)?;
        printer.note(format_args!("wrote {}", path.display()));
    }
    Ok(())
}

/// The path as seen from a folder: what lies in it by its path there, all else by its full path.
fn relative(path: &Path, folder: &Path) -> PathBuf {
    let whole = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let (path, folder) = (whole(path), whole(if folder.as_os_str().is_empty() { Path::new(".") } else { folder }));
    path.strip_prefix(&folder).map_or_else(|_| path.clone(), Path::to_owned)
}

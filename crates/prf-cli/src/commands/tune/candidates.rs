//! Which goals there are to choose from: windows of other sizes around the given one.

use std::path::Path;

use prf_core::io;
use prf_core::{DescriptorParams, Frame, Goal, MatchMethod, Rect, TemplateMatcher, windows_around};

use crate::error::{CliError, Result};
use crate::evidence::Subject;

/// A goal to try.
pub(super) struct Candidate {
    pub(super) goal: Goal,
    /// Where a window lies in the screen, or in the given goal if there is no screen.
    pub(super) rect: Option<Rect>,
    /// Whether it is the given goal itself.
    pub(super) is_given: bool,
}

/// The given goal, then others: for a window descriptor, windows around it.
///
/// # Errors
///
/// Misuse when the screen doesn't hold the goal or the descriptor has no use for one; failure when it can't be read.
pub(super) fn candidates(subject: &Subject, screen: Option<&Path>) -> Result<Vec<Candidate>> {
    let given = subject.goal.clone();
    if !matches!(subject.descriptor(), DescriptorParams::Window(_)) {
        if screen.is_some() {
            let error = CliError::misuse("--screen is for --descriptor window, which was not asked for");
            return Err(error.hint("add --descriptor window, or leave --screen out").into());
        }
        return Ok(vec![Candidate { goal: given, rect: None, is_given: true }]);
    }
    let around = match screen {
        None => given.clone(),
        Some(_) if given.mask.is_some() => {
            let error = CliError::misuse("--screen: windows larger than a goal with a mask have no mask");
            return Err(error.hint("leave the mask out, or --screen").into());
        }
        Some(path) => Goal::from(io::read_frame(path)?),
    };
    let whole = Rect { x: 0, y: 0, width: given.picture.width(), height: given.picture.height() };
    let rect = match screen {
        None => whole,
        Some(path) => find(&given.picture, &around.picture, path)?,
    };
    let windows = windows_around(rect, [around.picture.height(), around.picture.width()]);
    let candidate = |window: Rect| Candidate {
        goal: Goal { picture: cut(&around.picture, window), mask: around.mask.as_ref().map(|mask| cut(mask, window)) },
        rect: Some(window),
        is_given: window == rect,
    };
    // A mask that leaves nothing is no goal.
    let counts = |candidate: &Candidate| {
        candidate.goal.mask.as_ref().is_none_or(|mask| mask.as_slice().iter().any(|&pixel| pixel != 0))
    };
    Ok(windows.into_iter().map(candidate).filter(counts).collect())
}

/// Where the goal lies in the screen it was cut out of.
fn find(goal: &Frame, screen: &Frame, path: &Path) -> Result<Rect> {
    let misfit = |error: prf_core::Error| CliError::misuse(format!("--screen {}: {error}", path.display()));
    let mut matcher = TemplateMatcher::new(goal, None, MatchMethod::CcorrNormed).map_err(misfit)?;
    let similar = matcher.best(screen.view()).map_err(misfit)?;
    // The best match may be the same but for its brightness.
    let (rows, columns) = (screen.height() - goal.height() + 1, screen.width() - goal.width() + 1);
    let is_equal =
        |x: usize, y: usize| (0..goal.height()).all(|row| screen.row(y + row)[x..].starts_with(goal.row(row)));
    if let Some((x, y)) = (0..rows).flat_map(|y| (0..columns).map(move |x| (x, y))).find(|&(x, y)| is_equal(x, y)) {
        return Ok(Rect { x, y, width: goal.width(), height: goal.height() });
    }
    let Rect { x, y, .. } = similar.rect;
    let message = format!(
        "--screen {}: the goal is no part of it; the most similar part, at ({x}, {y}), matches by {:.3}",
        path.display(),
        similar.score
    );
    Err(CliError::misuse(message).hint("name the picture that the goal was cut out of").into())
}

fn cut(picture: &Frame, rect: Rect) -> Frame {
    let mut part = Frame::new(rect.width, rect.height);
    for y in 0..rect.height {
        part.row_mut(y).copy_from_slice(&picture.row(rect.y + y)[rect.x..rect.x + rect.width]);
    }
    part
}

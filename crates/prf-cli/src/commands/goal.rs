//! `prf goal`: makes the picture of a goal.

use std::path::Path;

use prf_core::io;
use prf_core::{DescriptorKind, Frame, Goal, Rect, RewardParams, check_goal};

use crate::ExitStatus;
use crate::args::{GoalArgs, GoalCommand, GoalOut, PasteArgs};
use crate::error::{CliError, Result};
use crate::files::{refuse_existing, write_whole};
use crate::printer::Printer;

mod ck_plus;
mod sequence;

pub(crate) fn run(args: &GoalArgs, printer: &mut Printer) -> Result<ExitStatus> {
    match &args.command {
        GoalCommand::Crop(args) => {
            let picture = io::read_frame(&args.picture)?;
            finish(crop(&picture, args.rect, "--rect", &args.picture)?, DescriptorKind::Window, &args.out, printer)
        }
        GoalCommand::Paste(args) => paste(args, printer),
        GoalCommand::Motion(args) => sequence::run(args, printer),
        GoalCommand::CkPlus(args) => ck_plus::run(args, printer),
    }
}

fn paste(args: &PasteArgs, printer: &mut Printer) -> Result<ExitStatus> {
    let mut picture = io::read_frame(&args.picture)?;
    let cut_out = io::read_cut_out(&args.cut_out)?;
    let (width, height) = (cut_out.picture.width(), cut_out.picture.height());
    let [x, y] = args.at;
    inside(&picture, Rect { x, y, width, height }, "--at", &args.picture)?;
    for row in 0..height {
        let opaque = cut_out.mask.as_ref().map(|mask| mask.view().row(row));
        for (column, &pixel) in cut_out.picture.view().row(row).iter().enumerate() {
            if opaque.is_none_or(|opaque| opaque[column] != 0) {
                picture.row_mut(y + row)[x + column] = pixel;
            }
        }
    }
    let Some(rect) = args.crop else { return finish(picture, DescriptorKind::Direct, &args.out, printer) };
    finish(crop(&picture, rect, "--crop", &args.picture)?, DescriptorKind::Window, &args.out, printer)
}

fn crop(picture: &Frame, rect: Rect, option: &str, path: &Path) -> Result<Frame> {
    inside(picture, rect, option, path)?;
    let rows = (rect.y..rect.y + rect.height).flat_map(|y| &picture.view().row(y)[rect.x..rect.x + rect.width]);
    Ok(Frame::from_vec(rect.width, rect.height, rows.copied().collect())?)
}

/// Refuses what reaches over the picture's border.
fn inside(picture: &Frame, rect: Rect, option: &str, path: &Path) -> Result<()> {
    let reaches = |start: usize, len: usize, side: usize| start.checked_add(len).is_none_or(|end| end > side);
    if !reaches(rect.x, rect.width, picture.width()) && !reaches(rect.y, rect.height, picture.height()) {
        return Ok(());
    }
    let Rect { x, y, width, height } = rect;
    Err(CliError::misuse(format!(
        "{option}: {width}x{height} px at ({x}, {y}) reach over the border of {}, which is {}x{} px",
        path.display(),
        picture.width(),
        picture.height()
    ))
    .into())
}

/// Writes the goal, names it on stdout, and says what is suspicious about it.
fn finish(picture: Frame, kind: DescriptorKind, out: &GoalOut, printer: &mut Printer) -> Result<ExitStatus> {
    write(&picture, out)?;
    printer.line(out.out.display())?;
    warn_of(picture, kind, printer);
    Ok(ExitStatus::Done)
}

fn write(picture: &Frame, out: &GoalOut) -> Result<()> {
    if !out.force {
        refuse_existing(&out.out)?;
    }
    write_whole(&out.out, &io::png(picture.view()), out.force)
}

/// Says what is suspicious about a goal.
pub(super) fn warn_of(picture: Frame, kind: DescriptorKind, printer: &mut Printer) {
    let mut params = RewardParams::default();
    params.hog.cell = kind.paper_cell();
    match check_goal(&Goal::from(picture), kind, params) {
        Ok(warnings) => warnings.iter().for_each(|warning| printer.warning(warning, Some(warning.hint()))),
        Err(error) => printer.warning(error, Some("cut out a larger part")),
    }
}

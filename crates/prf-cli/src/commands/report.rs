//! `prf report`: one page about runs.

use crate::ExitStatus;
use crate::args::ReportArgs;
use crate::error::Result;
use crate::files::write_whole;
use crate::printer::Printer;
use crate::report::{Report, page};
use crate::runs::group::groups;
use crate::runs::read_all;

pub(crate) fn run(args: &ReportArgs, printer: &mut Printer) -> Result<ExitStatus> {
    let (runs, is_damaged) = read_all(&args.runs, printer)?;
    let groups = groups(runs, printer);
    let report = Report::of(&groups, printer)?;
    write_whole(&args.out, page::html(&report)?.as_bytes(), true)?;
    for chapter in &report.chapters {
        printer.line(&chapter.headline)?;
    }
    printer.note(format_args!("wrote {}", args.out.display()));
    Ok(if is_damaged || report.is_incomplete() { ExitStatus::FinishedWithLoss } else { ExitStatus::Done })
}

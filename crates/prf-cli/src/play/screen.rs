//! The terminal while a world is shown in it.

use std::io::{self, IsTerminal as _, Write as _};
use std::panic;
use std::sync::Once;
use std::sync::atomic::{AtomicBool, Ordering};

use crossterm::cursor::{Hide, Show};
use crossterm::event::{KeyboardEnhancementFlags, PopKeyboardEnhancementFlags, PushKeyboardEnhancementFlags};
use crossterm::terminal::{
    BeginSynchronizedUpdate, Clear, ClearType, DisableLineWrap, EnableLineWrap, EndSynchronizedUpdate,
    EnterAlternateScreen, LeaveAlternateScreen, disable_raw_mode, enable_raw_mode, size, supports_keyboard_enhancement,
};
use crossterm::{cursor, execute, queue, style, terminal};
use prf_core::Frame;
use prf_envs::Environment;

use super::blocks::{Greys, lines};
use super::layout::{Layout, Words};
use super::panel::Panel;

/// Whether there is something to take back: at most one screen is open at a time, and a panic must find it.
static OPEN: AtomicBool = AtomicBool::new(false);
/// Whether the terminal was asked to report keys that go up.
static REPORTS_RELEASES: AtomicBool = AtomicBool::new(false);

/// Whether a person can be shown something and answer by keys.
pub(crate) fn is_there() -> bool {
    io::stdin().is_terminal() && io::stdout().is_terminal()
}

/// The terminal's other screen, without a cursor and with every key passed on. Dropping it gives the terminal back as
/// it was.
pub(super) struct Screen {
    greys: Greys,
    /// Columns and rows when it was last drawn on.
    drawn_size: Option<[usize; 2]>,
    picture: Frame,
}

impl Screen {
    /// Takes the terminal. With `wants_releases` it is asked to report keys that go up, which not every one can.
    ///
    /// # Errors
    ///
    /// The terminal cannot be talked to; it is then as it was.
    pub(super) fn open(wants_releases: bool) -> io::Result<Screen> {
        restore_on_panic();
        enable_raw_mode()?;
        OPEN.store(true, Ordering::SeqCst);
        let greys = Greys::promised(std::env::var("COLORTERM").ok().as_deref());
        // From here on dropping it restores the terminal.
        let screen = Screen { greys, drawn_size: None, picture: Frame::new(1, 1) };
        execute!(io::stdout(), EnterAlternateScreen, Hide, DisableLineWrap)?;
        if wants_releases && supports_keyboard_enhancement().unwrap_or(false) {
            let flags =
                KeyboardEnhancementFlags::DISAMBIGUATE_ESCAPE_CODES | KeyboardEnhancementFlags::REPORT_EVENT_TYPES;
            execute!(io::stdout(), PushKeyboardEnhancementFlags(flags))?;
            REPORTS_RELEASES.store(true, Ordering::SeqCst);
        }
        Ok(screen)
    }

    /// Whether the terminal reports keys that go up; Windows always does.
    pub(super) fn reports_releases(&self) -> bool {
        cfg!(windows) || REPORTS_RELEASES.load(Ordering::SeqCst)
    }

    /// Draws the world as large as there is room for, and the words.
    ///
    /// # Errors
    ///
    /// The terminal cannot be written to.
    pub(super) fn draw(&mut self, world: &dyn Environment, panel: &Panel<'_>) -> io::Result<()> {
        let (columns, rows) = size()?;
        let room = [columns, rows].map(usize::from);
        let layout = Layout::new(room, [world.spec().width, world.spec().height]);
        let mut bytes = Vec::new();
        queue!(bytes, BeginSynchronizedUpdate)?;
        if self.drawn_size != Some(room) {
            queue!(bytes, Clear(ClearType::All))?;
            self.drawn_size = Some(room);
        }
        for (row, line) in self.picture_lines(world, layout.picture).iter().enumerate() {
            write_at(&mut bytes, 0, row, line)?;
        }
        write_words(&mut bytes, room, layout, panel)?;
        queue!(bytes, EndSynchronizedUpdate)?;
        let mut stdout = io::stdout().lock();
        stdout.write_all(&bytes)?;
        stdout.flush()
    }

    fn picture_lines(&mut self, world: &dyn Environment, [width, height]: [usize; 2]) -> Vec<String> {
        if width == 0 || height == 0 {
            return Vec::new();
        }
        if (self.picture.width(), self.picture.height()) != (width, height) {
            self.picture = Frame::new(width, height);
        }
        world.draw_into(&mut self.picture);
        lines(self.picture.view(), self.greys)
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        restore();
    }
}

fn write_words(bytes: &mut Vec<u8>, [columns, rows]: [usize; 2], layout: Layout, panel: &Panel<'_>) -> io::Result<()> {
    let (column, first_row, lines) = match layout.words {
        Words::Beside { column } => (column, 0, panel.tall()),
        Words::Below { row } => (0, row, panel.wide()),
    };
    // Every row, so that nothing stays of a longer text.
    for row in first_row..rows {
        let line = lines.get(row - first_row).map_or("", String::as_str);
        write_at(bytes, column, row, &shortened(line, columns - column))?;
        queue!(bytes, Clear(ClearType::UntilNewLine))?;
    }
    Ok(())
}

fn write_at(bytes: &mut Vec<u8>, column: usize, row: usize, text: &str) -> io::Result<()> {
    queue!(bytes, cursor::MoveTo(column as u16, row as u16), style::Print(text))
}

/// `text`, or its beginning and `…`.
fn shortened(text: &str, columns: usize) -> String {
    if text.chars().count() <= columns {
        return text.to_owned();
    }
    let mut short: String = text.chars().take(columns.saturating_sub(1)).collect();
    short.push('…');
    short
}

/// Gives the terminal back. What cannot be written then cannot be mended either.
fn restore() {
    if !OPEN.swap(false, Ordering::SeqCst) {
        return;
    }
    let mut stdout = io::stdout();
    if REPORTS_RELEASES.swap(false, Ordering::SeqCst) {
        let _ = execute!(stdout, PopKeyboardEnhancementFlags);
    }
    let _ = execute!(stdout, terminal::EndSynchronizedUpdate, EnableLineWrap, Show, LeaveAlternateScreen);
    let _ = disable_raw_mode();
}

/// A panic's words would be lost with the other screen, so the terminal is given back before they are written.
fn restore_on_panic() {
    static HOOKED: Once = Once::new();
    HOOKED.call_once(|| {
        let usual = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            restore();
            usual(info);
        }));
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_words_are_cut_off_visibly() {
        assert_eq!(shortened("← 2 left", 8), "← 2 left");
        assert_eq!(shortened("← 2 left", 7), "← 2 le…");
        assert_eq!(shortened("← 2 left", 1), "…");
    }
}

//! `prf play` in a terminal: keys go in, and what a terminal would show comes out.
#![cfg(unix)]

use std::fs;
use std::io::{Read as _, Write};
use std::path::Path;
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::{Duration, Instant};

use portable_pty::{Child, CommandBuilder, MasterPty, PtySize, native_pty_system};
use prf_core::Frame;
use prf_envs::{EnvConfig, registry};
use tempfile::TempDir;

/// Longer than anything takes on a busy machine.
const PATIENCE: Duration = Duration::from_secs(60);

/// What crossterm asks a terminal, to learn whether it reports keys that go up.
const QUESTION: &[u8] = b"\x1b[c";
/// The answer of one that does not.
const ANSWER: &[u8] = b"\x1b[?1;2c";

/// A terminal in which `prf play` runs.
struct Terminal {
    master: Box<dyn MasterPty + Send>,
    keyboard: Box<dyn Write + Send>,
    output: Receiver<Vec<u8>>,
    /// All that prf has written.
    said: Vec<u8>,
    /// What is answered to [`QUESTION`].
    answer: &'static [u8],
    screen: vt100::Parser,
    child: Box<dyn Child + Send + Sync>,
    folder: TempDir,
}

fn size(columns: u16, rows: u16) -> PtySize {
    PtySize { rows, cols: columns, pixel_width: 0, pixel_height: 0 }
}

impl Terminal {
    fn play(args: &[&str], columns: u16, rows: u16) -> Terminal {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let pty = native_pty_system().openpty(size(columns, rows)).expect("there are pseudo-terminals");
        let mut command = CommandBuilder::new(assert_cmd::cargo::cargo_bin!("prf"));
        command.arg("play");
        command.args(args);
        command.cwd(folder.path());
        command.env("COLORTERM", "truecolor");
        command.env("TERM", "xterm-256color");
        let child = pty.slave.spawn_command(command).expect("prf starts");
        let mut reader = pty.master.try_clone_reader().expect("it can be read");
        let (sender, output) = channel();
        thread::spawn(move || {
            let mut bytes = [0; 4096];
            // The end is an error, 0 bytes, or a test that does not listen any more.
            while let Ok(count @ 1..) = reader.read(&mut bytes) {
                if sender.send(bytes[..count].to_vec()).is_err() {
                    break;
                }
            }
        });
        let keyboard = pty.master.take_writer().expect("it can be written");
        let screen = vt100::Parser::new(rows, columns, 0);
        Terminal { master: pty.master, keyboard, output, said: Vec::new(), answer: ANSWER, screen, child, folder }
    }

    fn press(&mut self, keys: &str) {
        self.keyboard.write_all(keys.as_bytes()).and_then(|()| self.keyboard.flush()).expect("prf reads its keys");
    }

    /// Takes in what prf writes for a moment; false once it writes no more.
    fn listen(&mut self) -> bool {
        match self.output.recv_timeout(Duration::from_millis(20)) {
            Ok(bytes) => {
                if bytes.windows(QUESTION.len()).any(|part| part == QUESTION) {
                    self.keyboard.write_all(self.answer).expect("prf reads the answer");
                }
                self.screen.process(&bytes);
                self.said.extend(bytes);
                true
            }
            Err(error) => error == std::sync::mpsc::RecvTimeoutError::Timeout,
        }
    }

    fn text(&self) -> String {
        self.screen.screen().contents()
    }

    fn wait_for(&mut self, what: &str, is_there: impl Fn(&Terminal) -> bool) {
        let start = Instant::now();
        while !is_there(self) {
            assert!(self.listen() && start.elapsed() < PATIENCE, "{what} never came:\n{}", self.text());
        }
    }

    fn wait_for_words(&mut self, words: &str) {
        self.wait_for(words, |terminal| terminal.text().contains(words));
    }

    /// The number of steps that the screen shows.
    fn steps(&self) -> Option<usize> {
        let text = self.text();
        let (_, behind) = text.split_once("step ")?;
        behind.split_once('/')?.0.parse().ok()
    }

    /// Single steps may come too fast to be seen one by one.
    fn wait_for_step(&mut self, least: usize) {
        self.wait_for(&format!("step {least}"), |terminal| terminal.steps().is_some_and(|steps| steps >= least));
    }

    /// Waits for the end: the exit code.
    fn end(&mut self) -> u32 {
        let start = Instant::now();
        while self.listen() {
            assert!(start.elapsed() < PATIENCE, "prf goes on:\n{}", self.text());
        }
        self.child.wait().expect("prf ends").exit_code()
    }

    fn assert_given_back(&self) {
        let screen = self.screen.screen();
        assert!(!screen.alternate_screen() && !screen.hide_cursor());
        let modes = self.master.get_termios().expect("it has modes");
        let shown = format!("{:?}", modes.local_flags);
        assert!(["ICANON", "ECHO", "ISIG"].iter().all(|flag| shown.contains(flag)), "{shown}");
    }

    /// The greys of the picture in the top left corner, two rows of pixels for each row of characters; nothing while it
    /// is not, or not all, there.
    fn picture(&self, width: u16, height: u16) -> Option<Frame> {
        let grey = |colour: vt100::Color| match colour {
            vt100::Color::Rgb(red, green, blue) if red == green && green == blue => Some(red),
            _ => None,
        };
        let pixel = |x: u16, y: u16| {
            let cell = self.screen.screen().cell(y / 2, x)?;
            match (cell.contents(), y % 2) {
                ("▀", 0) => grey(cell.fgcolor()),
                ("▀" | " ", _) => grey(cell.bgcolor()),
                _ => None,
            }
        };
        let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let pixels = places.map(|(x, y)| pixel(x, y)).collect::<Option<_>>()?;
        Frame::from_vec(width.into(), height.into(), pixels).ok()
    }

    fn path(&self) -> &Path {
        self.folder.path()
    }
}

/// What the world called `name` looks like at the start of the episode of `seed`.
fn start_of(name: &str, seed: u64, side: usize) -> Frame {
    let mut world = registry::make(&EnvConfig::new(name)).expect("it is registered");
    world.reset(seed);
    let mut frame = Frame::new(side, side);
    world.draw_into(&mut frame);
    frame
}

#[test]
fn the_picture_is_the_worlds_and_follows_the_terminals_size() {
    let mut terminal = Terminal::play(&["breakout", "--seed", "3"], 80, 24);
    terminal.wait_for_words("any key begins");
    assert_eq!(terminal.picture(48, 48), Some(start_of("breakout", 3, 48)));
    for words in ["breakout, seed 3", "score 0", "step 0/100", "← 2        left", "q          quit"] {
        terminal.wait_for_words(words);
    }
    for (columns, rows, side) in [(20, 10, 16), (200, 60, 120), (7, 4, 4)] {
        terminal.screen.screen_mut().set_size(rows, columns);
        terminal.master.resize(size(columns, rows)).expect("it has a size");
        let expected = start_of("breakout", 3, side);
        let shows_it = |terminal: &Terminal| terminal.picture(side as u16, side as u16).as_ref() == Some(&expected);
        terminal.wait_for("the picture in another size", shows_it);
    }
    terminal.press("q");
    assert_eq!(terminal.end(), 0);
    terminal.assert_given_back();
}

#[test]
fn what_is_played_is_recorded_also_when_it_is_broken_off() {
    let args = ["flappy", "--fps", "50", "--gif", "a.gif", "--frames", "frames", "--motion-goal", "goal.png"];
    let mut terminal = Terminal::play(&args, 80, 24);
    terminal.wait_for_words("any key begins");
    terminal.press(" ");
    terminal.wait_for_step(3);
    terminal.press("q");
    assert_eq!(terminal.end(), 0);
    terminal.assert_given_back();
    for words in ["flappy, seed 0, played by you", "frames into a.gif", "frames into frames", "motion template"] {
        assert!(terminal.text().contains(words), "{words}:\n{}", terminal.text());
    }
    assert!(["a.gif", "goal.png"].iter().all(|name| terminal.path().join(name).is_file()));
    assert!(fs::read_dir(terminal.path().join("frames")).expect("it is there").count() >= 4);
}

#[test]
fn the_world_stands_until_the_first_key_and_then_goes_on_to_its_end() {
    let mut terminal = Terminal::play(&["flappy", "--fps", "50"], 80, 24);
    terminal.wait_for_words("any key begins");
    let start = Instant::now();
    while start.elapsed() < Duration::from_millis(300) {
        assert!(terminal.listen());
    }
    assert_eq!(terminal.steps(), Some(0));
    terminal.press("x");
    terminal.wait_for_words("over: r, n or q");
    assert!(terminal.text().contains("reward -1"), "a bird that only glides falls down:\n{}", terminal.text());
    terminal.press("n");
    terminal.wait_for("the next episode", |terminal| {
        terminal.text().contains("flappy, seed 1") && terminal.text().contains("any key begins")
    });
    terminal.press("\x1b[A");
    terminal.wait_for_step(1);
    terminal.press("p");
    terminal.wait_for_words("paused: p goes on");
    terminal.press("r");
    terminal.wait_for_words("any key begins");
    terminal.press("\x1b");
    assert_eq!(terminal.end(), 0);
    assert!(terminal.text().contains("flappy, seed 1, played by you"), "{}", terminal.text());
}

/// Wide, brows, wide, corners, brows, wide, corners, open: the smile, one key at a time.
#[test]
fn a_face_waits_for_each_action() {
    let args = ["kobian-happy", "--gif", "smile.gif", "--motion-goal", "goal.png", "--skip-still"];
    let mut terminal = Terminal::play(&args, 90, 30);
    terminal.wait_for_words("kobian-happy, seed 0");
    for (count, key) in ["8", "2", "8", "a", "2", "8", "a", "c"].into_iter().enumerate() {
        assert_eq!(terminal.steps(), Some(count));
        terminal.press(key);
        terminal.wait_for_step(count + 1);
    }
    terminal.wait_for_words("reward 1");
    terminal.press("q");
    assert_eq!(terminal.end(), 0);
    assert!(terminal.text().contains("score   0") && terminal.text().contains("8, stopped"), "{}", terminal.text());
    assert!(["smile.gif", "goal.png"].iter().all(|name| terminal.path().join(name).is_file()));
}

#[test]
fn keys_move_the_paddle() {
    let mut terminal = Terminal::play(&["breakout", "--fps", "1", "--frames", "frames", "--steps", "1"], 80, 24);
    terminal.wait_for_words("any key begins");
    terminal.press("\x1b[D");
    terminal.wait_for_words("over: ");
    terminal.press("q");
    assert_eq!(terminal.end(), 0);
    let mut world = registry::make(&EnvConfig::new("breakout")).expect("it is registered");
    world.reset(0);
    world.step(1).expect("left is an action");
    let mut expected = Frame::new(84, 84);
    world.draw_into(&mut expected);
    let recorded = prf_core::io::read_frame(terminal.path().join("frames/0001.png")).expect("it was written");
    assert_eq!(recorded, expected);
}

#[test]
fn ctrl_c_gives_the_terminal_back_and_ends_with_130() {
    let mut terminal = Terminal::play(&["breakout", "--gif", "a.gif"], 80, 24);
    terminal.wait_for_words("any key begins");
    terminal.press("\x03");
    assert_eq!(terminal.end(), 130);
    terminal.assert_given_back();
    assert!(terminal.text().contains("no step was taken, so nothing was recorded"), "{}", terminal.text());
    assert!(!terminal.path().join("a.gif").exists());
}

#[test]
fn a_terminal_that_is_closed_ends_it_and_loses_nothing() {
    let mut terminal = Terminal::play(&["flappy", "--gif", "a.gif"], 80, 24);
    terminal.wait_for_words("any key begins");
    terminal.press(" ");
    terminal.wait_for_step(2);
    let process = terminal.child.process_id().expect("it runs").to_string();
    let kill = std::process::Command::new("kill").args(["-HUP", &process]).status();
    assert!(kill.expect("the tests need kill").success());
    assert_eq!(terminal.end(), 130);
    terminal.assert_given_back();
    assert!(terminal.path().join("a.gif").is_file());
}

#[test]
fn another_player_is_shown_unless_it_is_recorded() {
    let mut terminal = Terminal::play(&["breakout", "--player", "oracle", "--fps", "50", "--steps", "20"], 80, 24);
    terminal.wait_for_words("over: r, n or q");
    assert!(terminal.text().contains("step 20/20") && !terminal.text().contains("left"), "{}", terminal.text());
    terminal.press("q");
    assert_eq!(terminal.end(), 0);
    terminal.assert_given_back();

    let mut terminal = Terminal::play(&["breakout", "--player", "oracle", "--gif", "a.gif"], 80, 24);
    assert_eq!(terminal.end(), 0);
    assert!(terminal.text().contains("breakout, seed 0, played by oracle"), "{}", terminal.text());
}

/// A terminal with the kitty keyboard protocol is asked to report keys that go up, and asked to stop at the end.
#[test]
fn a_terminal_that_reports_releases_is_used() {
    let mut terminal = Terminal::play(&["breakout", "--fps", "5", "--seed", "3", "--frames", "frames"], 80, 24);
    terminal.answer = b"\x1b[?1u\x1b[?1;2c";
    terminal.wait_for_words("any key begins");
    terminal.press("\x1b[1;1:1C");
    terminal.wait_for_step(5);
    terminal.press("\x1b[1;1:3C");
    let seen = terminal.steps().expect("it is shown");
    terminal.wait_for_step(seen + 3);
    terminal.press("q");
    assert_eq!(terminal.end(), 0);
    terminal.assert_given_back();
    let said = |sequence: &[u8]| terminal.said.windows(sequence.len()).any(|part| part == sequence);
    assert!(said(b"\x1b[>3u") && said(b"\x1b[<1u"));
    // Five steps at 5 a second are longer than a key counts as held that nobody says is up again.
    let paddle = |step: usize| {
        let path = terminal.path().join(format!("frames/{step:04}.png"));
        let frame = prf_core::io::read_frame(path).expect("it was written");
        frame.row(83).iter().position(|&grey| grey > 0).expect("the paddle is always there")
    };
    assert_eq!(paddle(5) - paddle(0), 15);
    assert_eq!(paddle(seen + 3), paddle(seen + 2));
}

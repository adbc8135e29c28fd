//! What the terminal reports.

use std::io;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use crossterm::event::{self, Event};

/// Waits for events in a thread of its own. That one may never come back from a terminal that was closed, where reading
/// finds neither an event nor an end; the rest of the program then still gets to save what there is.
pub(super) struct Events(Receiver<io::Result<Event>>);

impl Events {
    /// Begins to listen, for as long as the program runs: nobody else may read from the terminal from here on.
    ///
    /// # Errors
    ///
    /// There can be no further thread.
    pub(super) fn listen() -> io::Result<Events> {
        let (sender, receiver) = channel();
        let listen = move || loop {
            let event = event::read();
            let is_last = event.is_err();
            if sender.send(event).is_err() || is_last {
                return;
            }
        };
        thread::Builder::new().name("terminal".to_owned()).spawn(listen)?;
        Ok(Events(receiver))
    }

    /// The next event, if one comes within `patience`.
    ///
    /// # Errors
    ///
    /// The terminal cannot be read.
    pub(super) fn next(&self, patience: Duration) -> io::Result<Option<Event>> {
        match self.0.recv_timeout(patience) {
            Ok(event) => event.map(Some),
            Err(RecvTimeoutError::Timeout) => Ok(None),
            Err(RecvTimeoutError::Disconnected) => Err(io::Error::other("the terminal can no longer be read")),
        }
    }
}

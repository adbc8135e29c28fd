//! Ctrl-C and the signals that ask a program to end.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::error::Result;

/// Notes that the user wants to stop, so that what was done can be saved first.
#[derive(Clone, Debug)]
pub(crate) struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// From now on the signals no longer end the program, and a file that reaches the limit of its size (`ulimit -f`) is an error
    /// of the write and no end of the program either. To be called once.
    pub(crate) fn listen() -> Result<Interrupt> {
        #[cfg(unix)]
        signal_hook::flag::register(signal_hook::consts::SIGXFSZ, Arc::default())?;
        let came = Arc::new(AtomicBool::new(false));
        let handle = Arc::clone(&came);
        ctrlc::set_handler(move || handle.store(true, Ordering::Relaxed))?;
        Ok(Interrupt(came))
    }

    /// Whether it is time to stop.
    pub(crate) fn came(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

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
        let came = Arc::new(AtomicBool::new(false));
        #[cfg(unix)]
        {
            use signal_hook::consts::{SIGHUP, SIGTERM, SIGXFSZ};
            signal_hook::flag::register(SIGXFSZ, Arc::default())?;
            signal_hook::flag::register(SIGTERM, Arc::clone(&came))?;
            // `nohup` has it ignored, so that the run outlives its terminal.
            if !is_ignored(SIGHUP) {
                signal_hook::flag::register(SIGHUP, Arc::clone(&came))?;
            }
        }
        let handle = Arc::clone(&came);
        ctrlc::set_handler(move || handle.store(true, Ordering::Relaxed))?;
        Ok(Interrupt(came))
    }

    /// Whether it is time to stop.
    pub(crate) fn came(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// Whether whoever started the program wants it to ignore a signal, as Linux tells; elsewhere nobody is taken to.
#[cfg(unix)]
fn is_ignored(signal: std::ffi::c_int) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|digits| u64::from_str_radix(digits.trim(), 16).ok());
    mask.is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
}

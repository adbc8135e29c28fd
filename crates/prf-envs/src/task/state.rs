//! How mirror frames become what the agent sees.

use prf_core::{EmaState, Error as CoreError, FrameView};

use super::{StateConfig, StateKind};
use crate::Error;
use crate::bytes::Reader;

/// A state representation in the middle of an episode.
#[derive(Clone)]
pub(super) enum Representation {
    /// The mirror frame itself, of which no copy is kept.
    Mirror,
    Ema(EmaState),
}

impl Representation {
    pub(super) fn new(config: &StateConfig, width: usize, height: usize) -> Result<Representation, Error> {
        match config.kind {
            StateKind::Mirror => Ok(Representation::Mirror),
            StateKind::Ema => {
                let ema = EmaState::new(width, height, config.lambda).map_err(|error| error.within("state"))?;
                Ok(Representation::Ema(ema))
            }
        }
    }

    pub(super) fn reset(&mut self) {
        if let Representation::Ema(ema) = self {
            ema.reset();
        }
    }

    pub(super) fn update(&mut self, mirror: FrameView<'_>) {
        if let Representation::Ema(ema) = self {
            ema.update(mirror);
        }
    }

    /// What the agent sees, unless it is the mirror frame itself.
    pub(super) fn observation(&self) -> Option<&[u8]> {
        match self {
            Representation::Mirror => None,
            Representation::Ema(ema) => Some(ema.as_slice()),
        }
    }

    /// How many values are remembered, and the values.
    pub(super) fn save_into(&self, bytes: &mut Vec<u8>) {
        let values = match self {
            Representation::Mirror => &[],
            Representation::Ema(ema) => ema.values(),
        };
        bytes.extend((values.len() as u32).to_le_bytes());
        bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
    }

    /// This representation with the memory that [`save_into`](Representation::save_into) wrote.
    pub(super) fn restored(&self, reader: &mut Reader<'_>) -> Result<Representation, Error> {
        let count = reader.u32()? as usize;
        let (values, _) = reader.take(count.saturating_mul(4))?.as_chunks();
        let values: Vec<f32> = values.iter().map(|&value| f32::from_le_bytes(value)).collect();
        let mut restored = self.clone();
        match &mut restored {
            Representation::Mirror if values.is_empty() => Ok(restored),
            Representation::Mirror => Err(reader.bad(format!("{count} averages"), "none for the state \"mirror\"")),
            Representation::Ema(ema) => match ema.restore(&values) {
                Ok(()) => Ok(restored),
                Err(CoreError::Restore { got, expected }) => Err(reader.bad(got, expected)),
                Err(other) => Err(other.into()),
            },
        }
    }
}

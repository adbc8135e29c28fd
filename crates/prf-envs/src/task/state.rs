//! How mirror frames become what the agent sees.

use prf_core::{EmaState, Error as CoreError, Frame, FrameView, MotionTemplate};

use super::{StateKind, TaskConfig};
use crate::Error;
use crate::bytes::Reader;

/// A state representation in the middle of an episode.
#[derive(Clone)]
pub(super) enum Representation {
    /// The mirror frame itself, of which no copy is kept.
    Mirror,
    Ema(EmaState),
    Motion(Motion),
}

/// A motion template and its picture.
#[derive(Clone)]
pub(super) struct Motion {
    template: MotionTemplate,
    picture: Frame,
}

impl Motion {
    fn draw(&mut self) {
        self.template.history_into(&mut self.picture);
    }
}

impl Representation {
    pub(super) fn new(config: &TaskConfig, width: usize, height: usize) -> Result<Representation, Error> {
        match config.state.kind {
            StateKind::Mirror => Ok(Representation::Mirror),
            StateKind::Ema => {
                let ema = EmaState::new(width, height, config.state.lambda).map_err(|error| error.within("state"))?;
                Ok(Representation::Ema(ema))
            }
            StateKind::Motion => {
                let params = config.reward.motion.unwrap_or_default();
                let template = MotionTemplate::new(params).map_err(|error| error.within("reward.motion"))?;
                Ok(Representation::Motion(Motion { template, picture: Frame::new(width, height) }))
            }
        }
    }

    pub(super) fn reset(&mut self) {
        match self {
            Representation::Mirror => {}
            Representation::Ema(ema) => ema.reset(),
            Representation::Motion(motion) => motion.template.reset(),
        }
    }

    /// Whether frames have to be taken in by [`update`](Representation::update).
    pub(super) fn remembers(&self) -> bool {
        !matches!(self, Representation::Mirror)
    }

    pub(super) fn update(&mut self, mirror: FrameView<'_>) {
        match self {
            Representation::Mirror => {}
            Representation::Ema(ema) => {
                ema.update(mirror);
            }
            Representation::Motion(motion) => {
                motion.template.observe(mirror).expect("frames of a world have one size");
                motion.draw();
            }
        }
    }

    /// What the agent sees, unless it is the mirror frame itself.
    pub(super) fn observation(&self) -> Option<&[u8]> {
        match self {
            Representation::Mirror => None,
            Representation::Ema(ema) => Some(ema.as_slice()),
            Representation::Motion(motion) => Some(motion.picture.as_slice()),
        }
    }

    /// How many bytes follow, and what is remembered.
    pub(super) fn save_into(&self, bytes: &mut Vec<u8>) {
        let memory = match self {
            Representation::Mirror => Vec::new(),
            Representation::Ema(ema) => ema.values().iter().flat_map(|value| value.to_le_bytes()).collect(),
            Representation::Motion(motion) => motion.template.save_state(),
        };
        bytes.extend((memory.len() as u32).to_le_bytes());
        bytes.extend(memory);
    }

    /// This representation with the memory that [`save_into`](Representation::save_into) wrote.
    pub(super) fn restored(&self, reader: &mut Reader<'_>) -> Result<Representation, Error> {
        let len = reader.u32()? as usize;
        let memory = reader.take(len)?;
        let mut restored = self.clone();
        let loaded = match &mut restored {
            Representation::Mirror if memory.is_empty() => Ok(()),
            Representation::Mirror => return Err(reader.bad(format!("{len} bytes"), "none for the state \"mirror\"")),
            Representation::Ema(ema) => {
                let (values, rest) = memory.as_chunks();
                if !rest.is_empty() {
                    return Err(reader.bad(format!("{len} bytes"), "averages of 4 bytes each"));
                }
                ema.restore(&values.iter().map(|&value| f32::from_le_bytes(value)).collect::<Vec<f32>>())
            }
            Representation::Motion(motion) => {
                let shape = [motion.picture.height(), motion.picture.width()];
                let loaded = motion.template.load_state(memory);
                let got = motion.template.shape();
                if got != shape && got != [0, 0] {
                    return Err(reader.bad(format!("a motion template of {got:?}"), format!("one of {shape:?}")));
                }
                motion.draw();
                loaded
            }
        };
        match loaded {
            Ok(()) => Ok(restored),
            Err(CoreError::Restore { got, expected }) => Err(reader.bad(got, expected)),
            Err(other) => Err(other.into()),
        }
    }
}

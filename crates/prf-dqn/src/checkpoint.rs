//! Everything a run needs to go on, in a directory that is there whole or not at all.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{ErrorKind, Read};
use std::path::Path;

use safetensors::tensor::{Metadata, TensorView};
use safetensors::{Dtype, SafeTensors};

use crate::error::{Error, Result};
use crate::files::write_synced;
use crate::network::Architecture;

mod model;
mod origin;
mod retention;
mod store;

pub use model::Model;
use origin::Origin;
pub use origin::{FORMAT, Writer};
pub(crate) use retention::Retention;
pub use store::CheckpointStore;

const STATE_FILE: &str = "state.safetensors";
/// The network's parameters, by name: the file of a checkpoint that is enough to play.
pub const MODEL_FILE: &str = "model.safetensors";
/// The byte string of [`STATE_FILE`] that is the state's JSON text.
const STATE_NAME: &str = "state";

/// What a checkpoint holds besides the replay.
#[derive(Debug)]
pub struct Checkpoint {
    /// Counters and the like, as JSON.
    pub state: String,
    /// Named byte strings: random streams and tasks.
    pub blobs: BTreeMap<String, Vec<u8>>,
    /// Named vectors: target network, Adam's moments, and the priorities of the replay if it has any.
    pub vectors: BTreeMap<String, Vec<f32>>,
    /// The online network.
    pub model: Model,
}

impl Checkpoint {
    /// Writes the checkpoint's files into the existing directory `dir`.
    pub(crate) fn write(&self, dir: &Path) -> Result<()> {
        self.model.write(&dir.join(MODEL_FILE))?;
        let path = dir.join(STATE_FILE);
        let vectors: BTreeMap<&String, Vec<u8>> = self.vectors.iter().map(|(k, v)| (k, bytes_of(v))).collect();
        let mut tensors = vec![(STATE_NAME, view(Dtype::U8, vec![self.state.len()], self.state.as_bytes()))];
        for (name, bytes) in &self.blobs {
            tensors.push((name.as_str(), view(Dtype::U8, vec![bytes.len()], bytes)));
        }
        for (name, bytes) in &vectors {
            tensors.push((name.as_str(), view(Dtype::F32, vec![bytes.len() / 4], bytes)));
        }
        let metadata = Origin::ours(&self.model.architecture).metadata();
        let bytes = safetensors::serialize(tensors, Some(metadata)).expect("names are distinct and sizes consistent");
        write_synced(&path, &bytes).map_err(Error::io("write", &path))
    }

    /// Reads a checkpoint's directory.
    ///
    /// # Errors
    /// [`Error::Format`] for a file of another format; [`Error::Mismatch`] for one made for another network;
    /// [`Error::Checkpoint`] for one that is cut short or damaged; [`Error::Io`] when it cannot be read.
    pub fn read(dir: &Path, architecture: &Architecture) -> Result<Self> {
        let model = Model::read(&dir.join(MODEL_FILE))?;
        model.check(architecture, &dir.join(MODEL_FILE))?;
        let path = dir.join(STATE_FILE);
        let bytes = fs::read(&path).map_err(Error::unreadable(&path))?;
        let whole = "a whole checkpoint of this version";
        let damaged = |error: safetensors::SafeTensorError| Error::checkpoint(&path, error, whole);
        let (_, metadata) = SafeTensors::read_metadata(&bytes).map_err(damaged)?;
        let network = Origin::read(&metadata, &path)?;
        if network != *architecture {
            return Err(Error::mismatch(&path, &network, architecture));
        }
        let (mut blobs, mut vectors) = (BTreeMap::new(), BTreeMap::new());
        for (name, tensor) in SafeTensors::deserialize(&bytes).map_err(damaged)?.iter() {
            match tensor.dtype() {
                Dtype::F32 => drop(vectors.insert(name.to_owned(), floats_of(tensor.data()))),
                Dtype::U8 => drop(blobs.insert(name.to_owned(), tensor.data().to_vec())),
                other => return Err(Error::checkpoint(&path, format!("`{name}` of type {other}"), whole)),
            }
        }
        let state = blobs.remove(STATE_NAME).and_then(|bytes| String::from_utf8(bytes).ok());
        let state = state.ok_or_else(|| Error::checkpoint(&path, "no run state", whole))?;
        Ok(Self { state, blobs, vectors, model })
    }

    /// Checks that the files of the checkpoint in `dir` are there at their full lengths, without reading what they hold.
    ///
    /// # Errors
    /// As [`Checkpoint::read`].
    pub fn check_lengths(dir: &Path) -> Result<()> {
        [MODEL_FILE, STATE_FILE].iter().try_for_each(|name| check_length(&dir.join(name)))
    }

    /// Takes the byte string `name` out.
    pub(crate) fn blob(&mut self, name: &str, dir: &Path) -> Result<Vec<u8>> {
        self.blobs.remove(name).ok_or_else(|| missing(name, dir))
    }

    /// Takes the vector `name`, of `count` numbers, out.
    pub(crate) fn vector(&mut self, name: &str, count: usize, dir: &Path) -> Result<Vec<f32>> {
        let vector = self.vectors.remove(name).ok_or_else(|| missing(name, dir))?;
        if vector.len() == count {
            return Ok(vector);
        }
        let got = format!("{} numbers in `{name}`", vector.len());
        Err(Error::checkpoint(dir.join(STATE_FILE), got, format!("{count} of them")))
    }
}

/// Checks that a safetensors file is as long as its header says.
fn check_length(path: &Path) -> Result<()> {
    /// As the safetensors crate has it.
    const LONGEST_HEADER: u64 = 100_000_000;
    let mut file = File::open(path).map_err(Error::unreadable(path))?;
    let found = file.metadata().map_err(Error::io("read", path))?.len();
    let mut read = || -> std::io::Result<(u64, Vec<u8>)> {
        let mut length = [0; 8];
        file.read_exact(&mut length)?;
        let length = u64::from_le_bytes(length);
        let mut header = Vec::new();
        (&mut file).take(length.min(LONGEST_HEADER)).read_to_end(&mut header)?;
        Ok((length, header))
    };
    let (length, header) = match read() {
        Err(error) if error.kind() == ErrorKind::UnexpectedEof => (0, Vec::new()),
        read => read.map_err(Error::io("read", path))?,
    };
    let metadata: Option<Metadata> = serde_json::from_slice(&header).ok();
    let expected = metadata.and_then(|metadata| length.checked_add(8 + metadata.data_len() as u64));
    if expected == Some(found) {
        return Ok(());
    }
    let expected = expected.map_or("a whole safetensors file".to_owned(), |bytes| format!("{bytes} bytes"));
    Err(Error::checkpoint(path, format!("{found} bytes"), expected))
}

fn missing(name: &str, dir: &Path) -> Error {
    Error::checkpoint(dir.join(STATE_FILE), format!("no `{name}`"), "a checkpoint of this version and configuration")
}

pub(crate) fn view(dtype: Dtype, shape: Vec<usize>, bytes: &[u8]) -> TensorView<'_> {
    TensorView::new(dtype, shape, bytes).expect("the shape was computed from the bytes")
}

pub(crate) fn bytes_of(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

fn floats_of(bytes: &[u8]) -> Vec<f32> {
    bytes.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect()
}

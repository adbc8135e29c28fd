//! What wrote a checkpoint's file, and for which network: the text that each carries in its metadata.

use std::collections::HashMap;
use std::path::Path;

use safetensors::tensor::Metadata;
use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};
use crate::network::Architecture;

/// Version of the layout of a checkpoint. It goes up with every change by which a run would no longer be continued to the
/// same bits, in this version or an older one.
pub const FORMAT: u32 = 3;

/// Key of the text in the metadata. It is the only key: several would be written in any order.
const KEY: &str = "prf";
/// What the files of format 1, which did not name it, have in their metadata: a model and a state.
const UNNAMED_FORMAT_KEYS: [&str; 2] = ["input", KEY];

/// Who wrote a file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Writer {
    /// Version of its layout; this version of PRF reads [`FORMAT`].
    pub format: u32,
    /// Version of PRF.
    pub prf_version: String,
}

/// Who wrote a file, and the network that it belongs to.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Origin {
    #[serde(flatten)]
    writer: Writer,
    network: Architecture,
}

impl Origin {
    /// Of a file written now.
    pub(super) fn ours(network: &Architecture) -> Self {
        let writer = Writer { format: FORMAT, prf_version: env!("CARGO_PKG_VERSION").to_owned() };
        Self { writer, network: network.clone() }
    }

    /// As metadata of a safetensors file.
    pub(super) fn metadata(&self) -> HashMap<String, String> {
        let text = serde_json::to_string(self).expect("an origin holds only numbers and strings");
        HashMap::from([(KEY.to_owned(), text)])
    }

    /// The network of the file at `path` that has this metadata.
    ///
    /// # Errors
    /// [`Error::Format`] when the file is of another format; [`Error::Checkpoint`] when it is of this one and its network is
    /// none.
    pub(super) fn read(metadata: &Metadata, path: &Path) -> Result<Architecture> {
        let map = metadata.metadata().as_ref();
        let text = map.and_then(|map| map.get(KEY)).map_or("", String::as_str);
        let writer = serde_json::from_str::<Writer>(text).ok();
        match writer {
            Some(writer) if writer.format == FORMAT => {}
            None if map.is_some_and(|map| UNNAMED_FORMAT_KEYS.iter().any(|key| map.contains_key(*key))) => {
                return Err(Error::Format { path: path.to_owned(), writer: Some(Writer::unnamed()) });
            }
            writer => return Err(Error::Format { path: path.to_owned(), writer }),
        }
        let network = serde_json::from_str::<Self>(text).map(|origin| origin.network);
        let network = network.map_err(|error| Error::checkpoint(path, error, "the network it is made for"))?;
        let sides = Architecture::smallest_input()..=1 << 14;
        if !network.input.iter().all(|side| sides.contains(side)) || !(1..=1 << 14).contains(&network.actions) {
            let expected = format!("{} to {} px and 1 to {} actions", sides.start(), sides.end(), sides.end());
            return Err(Error::checkpoint(path, network, expected));
        }
        Ok(network)
    }
}

impl Writer {
    /// Of files that do not say so.
    fn unnamed() -> Self {
        Self { format: 1, prf_version: "0.1.0".to_owned() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NETWORK: Architecture = Architecture { input: [84, 84], actions: 3, dueling: true };

    fn read(metadata: HashMap<String, String>) -> Result<Architecture> {
        let bytes = safetensors::serialize(Vec::<(&str, safetensors::tensor::TensorView<'_>)>::new(), Some(metadata));
        let bytes = bytes.expect("nothing to write");
        let (_, metadata) = safetensors::SafeTensors::read_metadata(&bytes).expect("it was just written");
        Origin::read(&metadata, Path::new("m.safetensors"))
    }

    fn writer_of(metadata: HashMap<String, String>) -> Option<Writer> {
        match read(metadata).expect_err("it is of another format") {
            Error::Format { writer, .. } => writer,
            other => panic!("{other}"),
        }
    }

    fn text(text: &str) -> HashMap<String, String> {
        HashMap::from([(KEY.to_owned(), text.to_owned())])
    }

    #[test]
    fn what_is_written_is_read() {
        assert_eq!(read(Origin::ours(&NETWORK).metadata()).expect("ours"), NETWORK);
    }

    #[test]
    fn a_newer_file_is_told_by_its_format_whatever_else_it_holds() {
        let newer = writer_of(text(r#"{"format": 4, "prf_version": "0.9.1", "network": "of a kind to come"}"#));
        assert_eq!(newer, Some(Writer { format: 4, prf_version: "0.9.1".to_owned() }));
    }

    #[test]
    fn files_of_before_formats_were_named_are_old() {
        let model = HashMap::from([("input".to_owned(), "84x84".to_owned())]);
        let state = text(r#"{"config": "", "updates": 3}"#);
        for old in [model, state] {
            assert_eq!(writer_of(old), Some(Writer::unnamed()));
        }
    }

    #[test]
    fn files_of_others_are_foreign() {
        assert_eq!(writer_of(HashMap::from([("format".to_owned(), "pt".to_owned())])), None);
    }

    #[test]
    fn a_network_that_cannot_be_is_damage() {
        for network in [r#"{"input":[84,84]}"#, r#"{"input":[0,84],"actions":3,"dueling":false}"#] {
            let ours = format!(r#"{{"format":{FORMAT},"prf_version":"0.1.0","network":{network}}}"#);
            let error = read(text(&ours)).expect_err("no network");
            assert!(matches!(error, Error::Checkpoint { .. }), "{error}");
        }
    }
}

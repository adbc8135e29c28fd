//! Reads an MCAP file as far as it is whole, also one whose end was never written.

use std::io::Read;
use std::ops::ControlFlow;

use mcap::McapError;
use mcap::records::{MessageHeader, Record};
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};

use crate::error::Result;

/// Longest record that is believed to be one, in bytes: far above any world's picture.
const LONGEST_RECORD: usize = 1 << 28;
/// Bytes read at a time.
const READ: usize = 1 << 16;

/// A message of a file.
pub(super) struct Stored {
    pub(super) header: MessageHeader,
    pub(super) data: Vec<u8>,
}

/// Gives the messages of each whole chunk in turn to `take`, until it has enough or nothing whole is left, and says what came then.
pub(super) fn salvage(
    mut file: impl Read,
    take: &mut dyn FnMut(Vec<Stored>) -> Result<ControlFlow<()>>,
) -> Result<String> {
    let options = LinearReaderOptions::default()
        .with_skip_end_magic(true)
        .with_prevalidate_chunk_crcs(true)
        .with_record_length_limit(LONGEST_RECORD);
    let mut reader = LinearReader::new_with_options(options);
    let mut chunk = Vec::new();
    while let Some(event) = reader.next_event() {
        let record = match event {
            Ok(LinearReadEvent::ReadRequest(wanted)) => {
                let read = file.read(reader.insert(wanted.clamp(1, READ)));
                match read {
                    Ok(read) => reader.notify_read(read),
                    Err(error) => return Ok(format!("cannot be read any further ({error})")),
                }
                continue;
            }
            Ok(LinearReadEvent::Record { opcode, data }) => mcap::parse_record(opcode, data).map(Record::into_owned),
            Err(error) => Err(error),
        };
        match record {
            Ok(Record::Message { header, data }) => chunk.push(Stored { header, data: data.into_owned() }),
            // The index of a chunk's messages stands behind it.
            Ok(Record::MessageIndex(_)) if !chunk.is_empty() => {
                if take(std::mem::take(&mut chunk))?.is_break() {
                    return Ok(String::new());
                }
            }
            Ok(_) => {}
            Err(McapError::UnexpectedEof) => break,
            Err(error) => return Ok(format!("is damaged ({error})")),
        }
    }
    Ok("ends too early".to_owned())
}

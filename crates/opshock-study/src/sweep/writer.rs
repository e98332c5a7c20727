//! The one thread that writes the store and sends progress events.
//!
//! Messages are taken in order. Records that wait together are appended with one sync; only then are their events sent
//! and a checkpoint that includes them written. So everything reported as done is on the disk, and `results.h5` never
//! has a run that the journal lacks.

use crossbeam_channel::Receiver;

use super::progress::{Event, Progress};
use crate::store::{Record, Results, Store, StoreError};

/// Message to the writer.
#[derive(Debug)]
pub(super) enum Message {
    /// Keep this.
    Keep(Record),
    /// Send this event once everything before it is on the disk.
    Report(Event),
    /// Replace `results.h5`.
    Checkpoint(Box<Results>),
}

/// Messages appended with one sync at most.
const BATCH: usize = 256;

/// Writes until the channel is closed, or the disk refuses.
///
/// # Errors
///
/// The disk refused: nothing of the current batch is stored and nothing more is written.
pub(super) fn write(
    store: &mut Store,
    messages: &Receiver<Message>,
    progress: &dyn Progress,
) -> Result<(), StoreError> {
    while let Ok(first) = messages.recv() {
        let mut batch = vec![first];
        batch.extend(messages.try_iter().take(BATCH));
        let records: Vec<Record> = batch
            .iter()
            .filter_map(|message| match message {
                Message::Keep(record) => Some(record.clone()),
                Message::Report(_) | Message::Checkpoint(_) => None,
            })
            .collect();
        if !records.is_empty() {
            store.append(&records)?;
        }
        for message in batch {
            match message {
                Message::Keep(_) => {}
                Message::Report(event) => progress.event(&event),
                Message::Checkpoint(results) => {
                    let path = store.checkpoint(&results)?;
                    progress.event(&Event::Checkpoint {
                        path,
                        runs: results.summary.totals.runs,
                    });
                }
            }
        }
    }
    Ok(())
}

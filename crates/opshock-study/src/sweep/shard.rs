//! A sweep divided among processes that share a folder, each with a store of its own.
//!
//! Shard `k/n` owns every n-th point of the canonical order, from the k-th on. It simulates the requests of its points'
//! searches, keeps them in `STORE/shards/k-of-n`, and reads the finished simulations of the stores beside it. A point
//! whose answer it needs and whose owner is not at work (not started, killed) it searches itself, so that a single
//! shard, or shards one after another, finish, too. The division changes no answer: `opshock merge` unites the stores.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use crate::search::Order;
use crate::store::StoreError;
use crate::store::files::list;
use crate::store::lock;
use crate::store::{Record, journal};

/// Folder of the shards in a store.
const SHARDS: &str = "shards";
/// Largest number of shards; more are a mistake.
const MOST: usize = 100_000;

/// One part of a divided sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    number: usize,
    count: usize,
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Shard, String> {
        let parts = text.split_once('/');
        let number = |text: &str| text.parse::<usize>().ok();
        let shard = parts.and_then(|(k, n)| Some((number(k)?, number(n)?)));
        shard
            .filter(|&(number, count)| 1 <= number && number <= count && count <= MOST)
            .map(|(number, count)| Shard { number, count })
            .ok_or_else(|| "must be k/n with k from 1 to n, as 2/4".to_owned())
    }
}

impl std::fmt::Display for Shard {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.number, self.count)
    }
}

impl Shard {
    /// Its own store within the store of the whole sweep.
    pub fn folder(&self, whole: &Path) -> PathBuf {
        folder(whole, self.number, self.count)
    }

    /// Number of the shard that owns each point, by place in the study, from 1.
    pub(super) fn owners(&self, order: &Order) -> Vec<usize> {
        let mut owners = vec![0; order.sequence.len()];
        for (place, &point) in order.sequence.iter().enumerate() {
            owners[point] = place % self.count + 1;
        }
        owners
    }

    /// Which points it owns, by place in the study.
    pub fn owned(&self, order: &Order) -> Vec<bool> {
        let owners = self.owners(order);
        owners.iter().map(|&owner| owner == self.number).collect()
    }
}

fn folder(whole: &Path, number: usize, count: usize) -> PathBuf {
    whole.join(SHARDS).join(format!("{number}-of-{count}"))
}

/// Stores of the shards in the store of a whole sweep, by name.
///
/// # Errors
///
/// The folder cannot be read.
pub fn stores(whole: &Path) -> Result<Vec<PathBuf>, StoreError> {
    let path = whole.join(SHARDS);
    let mut found = match list(&path) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(Vec::new()),
        found => found.map_err(|source| StoreError::Unreadable { path, source })?,
    };
    found.retain(|path| path.join("journal").exists() || path.join("results.h5").exists());
    Ok(found)
}

/// Points whose searches a shard needs to be final, by place in the study: those it wants, the widths that give each
/// other their lower failures, and whatever these start from.
pub(super) fn needed(order: &Order, wanted: &[bool]) -> Vec<bool> {
    let mut needed = vec![false; wanted.len()];
    let mut open: Vec<usize> = (0..wanted.len()).filter(|&point| wanted[point]).collect();
    while let Some(point) = open.pop() {
        if std::mem::replace(&mut needed[point], true) {
            continue;
        }
        let relations = &order.relations[point];
        open.extend(&order.chains[relations.chain]);
        open.extend(relations.predecessors());
    }
    needed
}

/// The stores beside a shard's own.
#[derive(Debug)]
pub(super) struct Others {
    folders: Vec<PathBuf>,
    /// Length of each journal when it was read last.
    read: Vec<u64>,
    own: usize,
}

impl Others {
    pub(super) fn of(shard: &Shard, whole: &Path) -> Others {
        // The store of the whole sweep first: what it has from before is used too.
        let shards = (1..=shard.count).map(|number| folder(whole, number, shard.count));
        let folders: Vec<PathBuf> = std::iter::once(whole.to_owned()).chain(shards).collect();
        Others {
            read: vec![0; folders.len()],
            folders,
            own: shard.number,
        }
    }

    /// Which shards are at work, 0 standing for the whole sweep.
    pub(super) fn at_work(&self) -> Vec<bool> {
        self.folders
            .iter()
            .map(|folder| lock::is_held(folder))
            .collect()
    }

    /// Another shard, or a sweep of the whole, is at work.
    pub(super) fn any_at_work(&self) -> bool {
        let others = self.at_work().into_iter().enumerate();
        others
            .filter(|&(number, _)| number != self.own)
            .any(|(_, is_at_work)| is_at_work)
    }

    /// New records of journals that have grown. What cannot be read now is read later, or simulated.
    pub(super) fn news(&mut self) -> Vec<Record> {
        let mut news = Vec::new();
        for (number, folder) in self.folders.iter().enumerate() {
            let path = folder.join("journal");
            let length = std::fs::metadata(&path).map_or(0, |data| data.len());
            if number == self.own || length == self.read[number] {
                continue;
            }
            if let Ok(Some(content)) = journal::read(&path) {
                self.read[number] = length;
                news.extend(content.records);
            }
        }
        news
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shard_is_k_of_n() {
        assert_eq!(
            "2/4".parse::<Shard>().map(|s| s.to_string()),
            Ok("2/4".into())
        );
        for text in ["0/4", "5/4", "1/0", "1", "1/2/3", "-1/2", "a/b", ""] {
            assert!(text.parse::<Shard>().is_err(), "{text}");
        }
    }
}

//! A file system in memory that fails, dies and loses power at a chosen system call.
//!
//! What a process sees (page cache) and what is on the disk are kept apart. Writes and new names
//! wait until a sync. At a power loss any of those waiting may have reached the disk, in any order,
//! each torn at sectors; bytes that did not are zeros or old rubbish. After a failed sync, what
//! waited stays readable and, unless it happened to arrive, is on no disk whatever is synced
//! later, as on Linux.

use std::collections::BTreeMap;
use std::io::{Error, ErrorKind, Result};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard};

use opshock_study::store::files::{Files, OpenFile};
use opshock_tests::seeded::Seeded;

const SECTOR: usize = 64;

/// What goes wrong at a system call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Nothing happens, and an error is reported.
    Refused,
    /// It is done, and yet an error is reported.
    DoneButRefused,
    /// A part is done and reported (of a write), else refused.
    Short,
    /// A part of a write is done, the next call has no room.
    Full,
    /// Interrupted; the same call goes through when repeated.
    Interrupted,
    /// The process is killed before.
    KilledBefore,
    /// The process is killed after.
    KilledAfter,
}

impl Fault {
    pub const ALL: [Fault; 7] = [
        Fault::Refused,
        Fault::DoneButRefused,
        Fault::Short,
        Fault::Full,
        Fault::Interrupted,
        Fault::KilledBefore,
        Fault::KilledAfter,
    ];

    /// It can happen to a call that is a write, or is not.
    pub fn can_strike(self, is_write: bool) -> bool {
        is_write || !matches!(self, Fault::Short | Fault::Full | Fault::Interrupted)
    }
}

#[derive(Debug, Default)]
struct Inode {
    visible: Vec<u8>,
    on_disk: Vec<u8>,
    /// Places and lengths of writes that wait for a sync.
    waiting: Vec<(usize, usize)>,
}

#[derive(Debug)]
struct State {
    names: BTreeMap<PathBuf, usize>,
    names_on_disk: BTreeMap<PathBuf, usize>,
    /// Changes of names that wait: those taken away, then those given.
    waiting: Vec<(Option<PathBuf>, PathBuf, usize)>,
    inodes: Vec<Inode>,
    /// Whether each call so far was a write.
    calls: Vec<bool>,
    fault: Option<(usize, Fault)>,
    no_room: bool,
    is_dead: bool,
    seeded: Seeded,
}

/// The file system; clones are the same one.
#[derive(Clone, Debug)]
pub struct SimFiles(Arc<Mutex<State>>);

/// A file in it.
#[derive(Debug)]
pub struct SimOpen {
    files: SimFiles,
    inode: usize,
}

fn refused() -> Error {
    Error::other("input/output error")
}

impl SimFiles {
    /// An empty disk.
    pub fn new(seed: u64) -> SimFiles {
        SimFiles(Arc::new(Mutex::new(State {
            names: BTreeMap::new(),
            names_on_disk: BTreeMap::new(),
            waiting: Vec::new(),
            inodes: Vec::new(),
            calls: Vec::new(),
            fault: None,
            no_room: false,
            is_dead: false,
            seeded: Seeded::new(seed),
        })))
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.0.lock().expect("no test panics inside")
    }

    /// System calls so far; whether each was a write.
    pub fn calls(&self) -> Vec<bool> {
        self.state().calls.clone()
    }

    /// Lets the call of this number fail.
    pub fn fail_at(&self, call: usize, fault: Fault) {
        self.state().fault = Some((call, fault));
    }

    /// What a process would read, without a call.
    pub fn peek(&self, path: &Path) -> Option<Vec<u8>> {
        let state = self.state();
        let inode = state.names.get(path)?;
        Some(state.inodes[*inode].visible.clone())
    }

    /// A new process: what the last one wrote is still there.
    pub fn restart(&self) {
        let mut state = self.state();
        state.is_dead = false;
        state.no_room = false;
        if state
            .names
            .remove(Path::new("store/.aside-journal"))
            .is_some()
        {
            state
                .names_on_disk
                .remove(Path::new("store/.aside-journal"));
        }
    }

    /// The machine loses power and starts again.
    pub fn lose_power(&self, seed: u64) {
        let mut state = self.state();
        let state = &mut *state;
        state.seeded = Seeded::new(seed);
        for (from, to, inode) in std::mem::take(&mut state.waiting) {
            // Names change in order, but the last of them may be lost.
            if state.seeded.once_in(3) {
                break;
            }
            if let Some(from) = from {
                state.names_on_disk.remove(&from);
            }
            state.names_on_disk.insert(to, inode);
        }
        state.names = state.names_on_disk.clone();
        for inode in &mut state.inodes {
            inode.lose_power(&mut state.seeded);
        }
    }
}

impl Inode {
    fn lose_power(&mut self, seeded: &mut Seeded) {
        for (at, length) in std::mem::take(&mut self.waiting) {
            self.arrive(at, length, seeded);
        }
        self.visible = self.on_disk.clone();
    }

    /// Some sectors of a write reach the disk.
    fn arrive(&mut self, at: usize, length: usize, seeded: &mut Seeded) {
        let rubbish = seeded.once_in(2);
        let mode = seeded.below(4);
        let mut start = at;
        while start < at + length {
            let end = (start / SECTOR * SECTOR + SECTOR).min(at + length);
            let arrives = match mode {
                0 => false,
                1 => true,
                _ => seeded.once_in(2),
            };
            if arrives {
                if self.on_disk.len() < end {
                    let fill = if rubbish { seeded.bits() as u8 } else { 0 };
                    self.on_disk.resize(end, fill);
                }
                self.on_disk[start..end].copy_from_slice(&self.visible[start..end]);
            }
            start = end;
        }
    }
}

impl State {
    /// Registers a call; what is wrong with it.
    fn call(&mut self, is_write: bool) -> Result<Option<Fault>> {
        if self.is_dead {
            return Err(refused());
        }
        let number = self.calls.len();
        self.calls.push(is_write);
        let fault = self
            .fault
            .filter(|(call, _)| *call == number)
            .map(|(_, fault)| fault);
        match fault {
            Some(Fault::Refused) => Err(refused()),
            Some(Fault::KilledBefore) => {
                self.is_dead = true;
                Err(refused())
            }
            fault => Ok(fault),
        }
    }

    /// Ends a call that was done.
    fn done(&mut self, fault: Option<Fault>) -> Result<()> {
        match fault {
            Some(Fault::KilledAfter) => {
                self.is_dead = true;
                Err(refused())
            }
            Some(Fault::DoneButRefused) => Err(refused()),
            _ => Ok(()),
        }
    }
}

impl Files for SimFiles {
    type Open = SimOpen;

    fn read(&self, path: &Path) -> Result<Vec<u8>> {
        let mut state = self.state();
        let fault = state.call(false)?;
        let Some(&inode) = state.names.get(path) else {
            return Err(ErrorKind::NotFound.into());
        };
        state.done(fault)?;
        Ok(state.inodes[inode].visible.clone())
    }

    fn create(&self, path: &Path) -> Result<SimOpen> {
        let mut state = self.state();
        let fault = state.call(false)?;
        let inode = state.inodes.len();
        state.inodes.push(Inode::default());
        state.names.insert(path.to_owned(), inode);
        state.waiting.push((None, path.to_owned(), inode));
        state.done(fault)?;
        Ok(SimOpen {
            files: self.clone(),
            inode,
        })
    }

    fn rename(&self, from: &Path, to: &Path) -> Result<()> {
        let mut state = self.state();
        let fault = state.call(false)?;
        let inode = state.names.remove(from).ok_or(ErrorKind::NotFound)?;
        state.names.insert(to.to_owned(), inode);
        state
            .waiting
            .push((Some(from.to_owned()), to.to_owned(), inode));
        state.done(fault)
    }

    fn sync_folder(&self, _folder: &Path) -> Result<()> {
        let mut state = self.state();
        let fault = state.call(false)?;
        state.waiting.clear();
        state.names_on_disk = state.names.clone();
        state.done(fault)
    }
}

impl OpenFile for SimOpen {
    fn write(&mut self, bytes: &[u8]) -> Result<usize> {
        let mut state = self.files.state();
        let fault = state.call(true)?;
        if fault == Some(Fault::Interrupted) {
            return Err(ErrorKind::Interrupted.into());
        }
        if state.no_room {
            return Err(ErrorKind::StorageFull.into());
        }
        let mut length = bytes.len();
        // Long writes may be short without any fault.
        if matches!(
            fault,
            Some(Fault::Short | Fault::Full | Fault::DoneButRefused)
        ) || state.seeded.once_in(8)
        {
            length = 1 + state.seeded.below(length);
        }
        state.no_room = fault == Some(Fault::Full);
        let inode = &mut state.inodes[self.inode];
        let at = inode.visible.len();
        inode.visible.extend_from_slice(&bytes[..length]);
        inode.waiting.push((at, length));
        state.done(fault)?;
        Ok(length)
    }

    fn sync(&mut self) -> Result<()> {
        let mut state = self.files.state();
        let number = state.calls.len();
        let refuses = matches!(state.fault, Some((call, Fault::Refused)) if call == number);
        if refuses && !state.is_dead {
            // What waited is clean now: on the disk by chance, or never.
            let state = &mut *state;
            let inode = &mut state.inodes[self.inode];
            for (at, length) in std::mem::take(&mut inode.waiting) {
                inode.arrive(at, length, &mut state.seeded);
            }
        }
        let fault = state.call(false)?;
        let inode = &mut state.inodes[self.inode];
        for (at, length) in std::mem::take(&mut inode.waiting) {
            let end = at + length;
            if inode.on_disk.len() < end {
                inode.on_disk.resize(end, 0);
            }
            inode.on_disk[at..end].copy_from_slice(&inode.visible[at..end]);
        }
        state.done(fault)
    }
}

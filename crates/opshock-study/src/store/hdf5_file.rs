//! HDF5 files as bytes, made in memory and read from memory, so that the HDF5 library never accesses the disk.
//!
//! The library writes what is left when the last of a file's groups is dropped, where an error cannot be returned, and
//! it may crash on a file with flipped bytes. Bytes are written by [`aside`](super::aside), whose errors are those of
//! the operating system, and their seal (`store/seal.rs`) is checked before they are opened.
#![expect(
    unsafe_code,
    reason = "the HDF5 crate has no images of files: one C call makes them, two open them"
)]

use std::ffi::CString;
use std::sync::atomic::{AtomicU64, Ordering};

use hdf5::file::FileAccess;
use hdf5::{File, FileBuilder, Group, Result};
use hdf5_sys::h5f::{H5F_ACC_RDONLY, H5Fget_file_image, H5Fopen};
use hdf5_sys::h5p::H5Pset_file_image;

/// Bytes of a file whose root `fill` has filled.
///
/// # Errors
///
/// What `fill` says, or HDF5 is out of memory.
pub fn bytes(fill: impl FnOnce(&Group) -> Result<()>) -> Result<Vec<u8>> {
    let mut builder = FileBuilder::new();
    builder.with_fapl(|access| access.core_filebacked(false));
    let file = builder.create(name())?;
    fill(&file)?;
    file.flush()?;
    let image = |bytes: *mut u8, length: usize| {
        // SAFETY: the file is open, and `bytes` is null or the start of `length` writable bytes.
        let found =
            hdf5::sync::sync(|| unsafe { H5Fget_file_image(file.id(), bytes.cast(), length) });
        usize::try_from(found).map_err(|_| hdf5::Error::from("HDF5 gives no image of a file"))
    };
    let mut bytes = vec![0; image(std::ptr::null_mut(), 0)?];
    let written = image(bytes.as_mut_ptr(), bytes.len())?;
    assert_eq!(written, bytes.len());
    Ok(bytes)
}

/// Opens the bytes of a file for reading.
///
/// # Errors
///
/// They are not HDF5, or cut short.
pub fn open(bytes: &[u8]) -> Result<File> {
    let access = FileAccess::build().core_filebacked(false).finish()?;
    let name = CString::new(name()).expect("no NUL in it");
    hdf5::sync::sync(|| {
        // SAFETY: the list is open, and HDF5 copies the bytes, which it does not change.
        let set = unsafe {
            H5Pset_file_image(access.id(), bytes.as_ptr().cast_mut().cast(), bytes.len())
        };
        if set < 0 {
            return Err("HDF5 takes no image of a file".into());
        }
        // SAFETY: the name ends in NUL, and the list is open.
        let file = unsafe { H5Fopen(name.as_ptr(), H5F_ACC_RDONLY, access.id()) };
        if file < 0 {
            return Err(hdf5::Error::query().unwrap_or_else(|error| error));
        }
        // SAFETY: the file was opened just now and has no other owner.
        unsafe { hdf5::from_id(file) }
    })
}

/// A name for a file in memory: HDF5 distinguishes files by it, and looks whether one is on the disk, where none can be
/// below a device.
fn name() -> String {
    static NUMBER: AtomicU64 = AtomicU64::new(0);
    format!("/dev/null/{}", NUMBER.fetch_add(1, Ordering::Relaxed))
}

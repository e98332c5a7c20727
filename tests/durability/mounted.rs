//! A small file system of its own.

use std::path::{Path, PathBuf};
use std::process::Command;

/// Mounted; taken away in the end.
pub struct Mounted(PathBuf);

impl Mounted {
    /// A file system in memory.
    ///
    /// # Panics
    /// Where this user may not mount one.
    pub fn tmpfs(at: &Path, options: &str) -> Mounted {
        let mounted = Mounted::try_tmpfs(at, options);
        mounted.unwrap_or_else(|why| panic!("a file system of {options} needs root: {why}"))
    }

    /// As [`Mounted::tmpfs`], or why not.
    pub fn try_tmpfs(at: &Path, options: &str) -> Result<Mounted, String> {
        std::fs::create_dir_all(at).expect("folder");
        let mount = Command::new("mount")
            .args(["-t", "tmpfs", "-o", options, "tmpfs"])
            .arg(at)
            .output();
        match mount {
            Ok(output) if output.status.success() => Ok(Mounted(at.to_owned())),
            Ok(output) => Err(String::from_utf8_lossy(&output.stderr).into_owned()),
            Err(error) => Err(error.to_string()),
        }
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.0
    }

    /// Changes its options.
    pub fn remount(&self, options: &str) {
        let status = Command::new("mount")
            .args(["-o", &format!("remount,{options}")])
            .arg(&self.0)
            .status()
            .expect("mount");
        assert!(status.success(), "remount {options}");
    }
}

impl Drop for Mounted {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg(&self.0).status();
    }
}

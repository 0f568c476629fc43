//! Writing results: files appear whole or not at all.

use std::io::Write as _;
use std::path::Path;

use anyhow::{Context as _, Result};

/// A file to be written and what it will hold.
pub(super) type Content<'a> = (&'a Path, &'a [u8]);

/// Writes `bytes` to a file, or to standard output where the name is `-`.
///
/// # Errors
/// Names the file.
pub(super) fn write(path: &Path, bytes: &[u8]) -> Result<()> {
    write_together(&[(path, bytes)])
}

/// Writes several files, each to a file or to standard output where the name is `-`.
///
/// All bytes go to temporary files beside the targets first, which then take their places: where one of them cannot be
/// written, none appears.
///
/// # Errors
/// Names the file.
pub(super) fn write_together(contents: &[Content]) -> Result<()> {
    let cannot =
        |path: &Path| format!("{}: cannot be written; is the folder there, and may you write to it?", path.display());
    let mut staged = Vec::new();
    for &(path, bytes) in contents.iter().filter(|(path, _)| *path != Path::new("-")) {
        let file = stage(path, bytes).with_context(|| cannot(path))?;
        staged.push((path, file));
    }
    for (path, file) in staged {
        file.persist(path).map_err(|e| e.error).with_context(|| cannot(path))?;
    }
    for (_, bytes) in contents.iter().filter(|(path, _)| *path == Path::new("-")) {
        let mut out = std::io::stdout().lock();
        out.write_all(bytes).and_then(|()| out.flush()).context("standard output")?;
    }
    Ok(())
}

/// A temporary file beside `path` that holds `bytes`.
fn stage(path: &Path, bytes: &[u8]) -> std::io::Result<tempfile::NamedTempFile> {
    let folder = match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    // A folder in the target's place would be noticed only once other files have appeared.
    if path.is_dir() {
        return Err(std::io::ErrorKind::IsADirectory.into());
    }
    let mut file = tempfile::Builder::new().prefix(".clopen-").tempfile_in(folder)?;
    file.write_all(bytes)?;
    allow_reading(file.as_file())?;
    Ok(file)
}

/// Temporary files are private; a result is not.
#[cfg(unix)]
fn allow_reading(file: &std::fs::File) -> std::io::Result<()> {
    use std::os::unix::fs::PermissionsExt as _;
    file.set_permissions(std::fs::Permissions::from_mode(0o644))
}

#[cfg(not(unix))]
fn allow_reading(_: &std::fs::File) -> std::io::Result<()> {
    Ok(())
}

/// Prints to standard output; a reader that went away is no error.
pub(super) fn print(text: &str) {
    let _ = std::io::stdout().lock().write_all(text.as_bytes());
}

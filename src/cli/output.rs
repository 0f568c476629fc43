//! Writing results: files appear whole or not at all.

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use anyhow::{Context as _, Result, bail};

/// A file to be written and what it will hold.
pub(super) type Content<'a> = (&'a Path, &'a [u8]);

/// The temporary files that there are now. A user who breaks off finds none of them, so the one who removes them must know.
static STAGED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// The exit status of a command that was broken off, as shells have it.
const BROKEN_OFF: i32 = 130;

fn staged() -> MutexGuard<'static, Vec<PathBuf>> {
    STAGED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Has temporary files removed where the user breaks off (Ctrl-C) or the system does. Results that are just taking their places
/// take them first, all of them.
pub(super) fn tidy_when_broken_off() {
    // Where no handler can be had, a temporary file may be left behind: no reason not to work.
    let _ = ctrlc::set_handler(|| {
        for path in staged().drain(..) {
            let _ = std::fs::remove_file(path);
        }
        std::process::exit(BROKEN_OFF);
    });
}

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
/// written, none appears. A symbolic link stays one, and what it leads to is written. Pipes and devices have no place to
/// take: they are written to last, as standard output is.
///
/// # Errors
/// Names the file.
pub(super) fn write_together(contents: &[Content]) -> Result<()> {
    let written = write_all(contents);
    staged().clear();
    written
}

fn write_all(contents: &[Content]) -> Result<()> {
    let cannot =
        |path: &Path| format!("{}: cannot be written; is the folder there, and may you write to it?", path.display());
    let mut files = Vec::new();
    let mut streams = Vec::new();
    for &(path, bytes) in contents {
        // A temporary file that cannot be made is named in the error, and is nothing to anyone.
        let plain = |e: std::io::Error| match e.kind() {
            std::io::ErrorKind::NotFound => std::io::Error::new(e.kind(), "there is no such folder"),
            kind if e.get_ref().is_some() => kind.into(),
            _ => e,
        };
        match stage(path, bytes).map_err(plain).with_context(|| cannot(path))? {
            Staged::Stream => streams.push((path, bytes)),
            Staged::File { file, target } => files.push((path, file, target)),
        }
    }
    {
        let _no_breaking_off = staged();
        for (path, file, target) in files {
            file.persist(target).map_err(|e| e.error).with_context(|| cannot(path))?;
        }
    }
    for (path, bytes) in streams {
        if path == Path::new("-") {
            print_bytes(bytes)?;
        } else {
            std::fs::OpenOptions::new()
                .write(true)
                .open(path)
                .and_then(|mut stream| stream.write_all(bytes))
                .with_context(|| cannot(path))?;
        }
    }
    Ok(())
}

/// Content on its way.
enum Staged {
    /// A temporary file, and the place that it is to take.
    File { file: tempfile::NamedTempFile, target: PathBuf },
    /// The target is standard output, a pipe or a device.
    Stream,
}

/// A temporary file beside the file that `path` leads to, holding `bytes`, with the permissions of what it replaces.
fn stage(path: &Path, bytes: &[u8]) -> std::io::Result<Staged> {
    if path == Path::new("-") {
        return Ok(Staged::Stream);
    }
    let replaced = match std::fs::symlink_metadata(path) {
        Ok(found) if found.is_symlink() => Some(std::fs::metadata(path)?),
        Ok(found) => Some(found),
        Err(_) => None,
    };
    // A folder in the target's place would be noticed only once other files have appeared.
    if replaced.as_ref().is_some_and(|found| found.is_dir()) {
        return Err(std::io::ErrorKind::IsADirectory.into());
    }
    if replaced.as_ref().is_some_and(|found| !found.is_file()) {
        return Ok(Staged::Stream);
    }
    let target = if replaced.is_some() { path.canonicalize()? } else { path.to_owned() };
    let folder = match target.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".clopen-");
    // Temporary files are private; a result is what the user's mask makes of any new file.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let mut file = {
        // Not to be broken off between making it and noting it.
        let mut staged = staged();
        let file = builder.tempfile_in(folder)?;
        staged.push(file.path().to_owned());
        file
    };
    file.write_all(bytes)?;
    if let Some(found) = replaced {
        if found.permissions().readonly() {
            return Err(std::io::ErrorKind::PermissionDenied.into());
        }
        file.as_file().set_permissions(found.permissions())?;
    }
    Ok(Staged::File { file, target })
}

/// Prints to standard output; a reader that went away is no error.
///
/// # Errors
/// Where standard output takes no more, as on a full disk.
pub(super) fn print(text: &str) -> Result<()> {
    print_bytes(text.as_bytes())
}

fn print_bytes(bytes: &[u8]) -> Result<()> {
    let mut out = std::io::stdout().lock();
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => Err(error).context("standard output"),
        _ => Ok(()),
    }
}

/// Says something on standard error, which may be closed: then there is nobody to tell.
pub(super) fn say(text: &str) {
    let _ = std::io::stderr().lock().write_all(text.as_bytes());
}

/// Refuses a target in a folder that is not there: before hours of work, not after.
///
/// # Errors
/// Names the folder.
pub(super) fn keep_folder(target: &Path) -> Result<()> {
    match target.parent().filter(|folder| *folder != Path::new("") && !folder.is_dir()) {
        Some(folder) => bail!("{}: there is no folder {}: make it first", target.display(), folder.display()),
        None => Ok(()),
    }
}

/// Refuses to write over what is being read.
///
/// # Errors
/// Names the file and says what to do.
pub(super) fn keep_input(input: &Path, target: &Path) -> Result<()> {
    let is_same = match (input.canonicalize(), target.canonicalize()) {
        (Ok(input), Ok(target)) => input == target,
        _ => false,
    };
    if is_same {
        bail!(
            "{}: this is the file that is read, and it would be written over: name another with -o",
            target.display()
        );
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_read_is_not_written_over() {
        let folder = tempfile::tempdir().unwrap();
        let input = folder.path().join("part.svg");
        std::fs::write(&input, "drawing").unwrap();
        assert!(keep_input(&input, &folder.path().join("./part.svg")).is_err());
        assert!(keep_input(&input, &folder.path().join("part.nc")).is_ok());
    }

    #[cfg(unix)]
    #[test]
    fn links_stay_links_and_permissions_stay() {
        use std::os::unix::fs::PermissionsExt as _;
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("file"), folder.path().join("link"));
        std::fs::write(&file, "old").unwrap();
        std::fs::set_permissions(&file, std::fs::Permissions::from_mode(0o640)).unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        write(&link, b"new").unwrap();
        assert!(link.symlink_metadata().unwrap().is_symlink());
        assert_eq!(std::fs::read(&file).unwrap(), b"new");
        assert_eq!(file.metadata().unwrap().permissions().mode() & 0o777, 0o640);
    }

    /// A socket stands for pipes and devices: making one needs neither another program nor rights.
    #[cfg(unix)]
    #[test]
    fn what_is_no_file_is_not_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("socket");
        let _socket = std::os::unix::net::UnixListener::bind(&path).unwrap();
        assert!(write(&path, b"drawing").is_err(), "a socket cannot be opened");
        assert!(!path.symlink_metadata().unwrap().is_file());
    }
}

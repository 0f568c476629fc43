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
    keep_apart(&contents.iter().map(|(path, _)| *path).collect::<Vec<_>>())?;
    let written = write_all(contents);
    staged().clear();
    written
}

fn write_all(contents: &[Content]) -> Result<()> {
    let cannot = |path: &Path| format!("{}: cannot be written", path.display());
    let mut files = Vec::new();
    let mut streams = Vec::new();
    for &(path, bytes) in contents {
        let plain = |e: std::io::Error| plain(&e, path).map_or(e, std::io::Error::other);
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

/// Why a file could not be made, in words, where the system's say little: a temporary file that cannot be made is named in them, and
/// is nothing to anyone.
fn plain(error: &std::io::Error, path: &Path) -> Option<String> {
    let folder = path.parent().filter(|folder| *folder != Path::new(""));
    match error.kind() {
        std::io::ErrorKind::NotFound if folder.is_none_or(Path::is_dir) => {
            Some("no file can be made in this folder: name another".to_owned())
        }
        std::io::ErrorKind::NotFound => Some("there is no such folder: make it first".to_owned()),
        std::io::ErrorKind::PermissionDenied => Some("you may not write there: name another place".to_owned()),
        kind => error.get_ref().is_some().then(|| kind.to_string()),
    }
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

/// Refuses a folder in place of a file: programs would be written beside it.
///
/// # Errors
/// Names the folder.
pub(super) fn keep_file(target: &Path) -> Result<()> {
    match target.is_dir() {
        true => bail!("{}: this is a folder: name a file in it", target.display()),
        false => Ok(()),
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

/// Refuses two outputs at one place: one of them would be lost.
///
/// # Errors
/// Names the place.
pub(super) fn keep_apart(targets: &[&Path]) -> Result<()> {
    let places: Vec<PathBuf> = targets.iter().map(|target| place(target)).collect();
    for (k, target) in targets.iter().enumerate() {
        if places[..k].contains(&places[k]) {
            let name = if *target == Path::new("-") { "standard output".into() } else { target.display().to_string() };
            bail!("{name}: two results would go there, one over the other: give each a name of its own");
        }
    }
    Ok(())
}

/// Where a path leads to, also one to a file that is still to be made.
fn place(path: &Path) -> PathBuf {
    if let Ok(found) = path.canonicalize() {
        return found;
    }
    let folder = path.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."));
    match (folder.canonicalize(), path.file_name()) {
        (Ok(folder), Some(name)) if path != Path::new("-") => folder.join(name),
        _ => path.to_owned(),
    }
}

/// Refuses a name for a picture that says another format than the one that is written.
///
/// # Errors
/// Names the file and what to call it.
pub(super) fn keep_png(target: &Path) -> Result<()> {
    let is_png = |extension: &std::ffi::OsStr| extension.eq_ignore_ascii_case("png");
    match target.extension().filter(|extension| !is_png(extension)) {
        Some(_) => bail!(
            "{}: pictures are written as PNG, and the name says something else: call it {}",
            target.display(),
            target.with_extension("png").display()
        ),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_results_do_not_go_to_one_place() {
        let folder = tempfile::tempdir().unwrap();
        let [a, b] = ["a.obj", "./a.obj"].map(|name| folder.path().join(name));
        assert!(keep_apart(&[&a, &b]).is_err() && keep_apart(&[&a, &folder.path().join("b.obj")]).is_ok());
        assert!(keep_apart(&[Path::new("-"), Path::new("-")]).is_err());
        std::fs::write(&a, "mesh").unwrap();
        assert!(write_together(&[(&a, b"mesh"), (&b, b"picture")]).is_err());
        assert_eq!(std::fs::read(&a).unwrap(), b"mesh");
        for (name, is_png) in [("x.png", true), ("x.PNG", true), ("-", true), ("x", true), ("x.jpg", false)] {
            assert_eq!(keep_png(Path::new(name)).is_ok(), is_png, "{name}");
        }
    }

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

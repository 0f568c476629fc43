//! Writes the solid samples: `cargo run --release --example solids -- samples`.

use clopen::io::mesh::{MeshFormat, write};
use std::path::PathBuf;
use std::process::ExitCode;

#[path = "../tests/solids/mod.rs"]
mod solids;

fn main() -> ExitCode {
    let Some(folder) = std::env::args_os().nth(1).map(PathBuf::from) else {
        eprintln!("which folder? cargo run --release --example solids -- samples");
        return ExitCode::from(2);
    };
    for (name, mesh) in solids::all() {
        let path = folder.join(format!("{name}.obj"));
        if let Err(error) = std::fs::write(&path, write(&mesh, MeshFormat::Obj)) {
            eprintln!("{}: {error}", path.display());
            return ExitCode::from(2);
        }
        eprintln!("{}: {} vertices, {} faces", path.display(), mesh.points.len(), mesh.polygon_count());
    }
    ExitCode::SUCCESS
}

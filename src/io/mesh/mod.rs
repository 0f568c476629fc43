//! Surfaces in and out: OBJ, STL and PLY.
//!
//! What is guaranteed: coordinates are read as f64 to the last bit that the file has; polygons stay polygons, in the order of
//! the file with the order of their corners; every corner names a vertex, every polygon has three corners or more, every
//! number is finite, and there is at least one polygon. What the file says of normals, textures, materials and groups is
//! left out.
//!
//! What is refused, with the line, the byte or the element: files that are cut short, mixed or of another format, numbers
//! that are none or not finite, corners without a vertex, headers that announce more than the file has. Memory and time are
//! proportional to the file, whatever its header says.
//!
//! The PLY reader is our own: ply-rs-bw, the crate that was looked at, does not name the place of what is wrong, and brings a
//! parser generator for a header of ten lines.

mod error;
mod obj;
mod ply;
mod stl;
mod text;

use std::fmt;
use std::path::Path;

pub use error::{MeshError, Place};

use crate::mesh::PolygonMesh;

/// A format of files with surfaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MeshFormat {
    /// Wavefront OBJ: text, polygons, colours of vertices as most programs write them after the coordinates.
    Obj,
    /// STL: loose triangles, binary or text. Vertices with bit-identical coordinates become one vertex (0 and -0 are the
    /// same): the format has no other way to say that triangles are neighbours.
    Stl,
    /// PLY, text or binary: polygons, colours, and a number for each vertex.
    Ply,
}

impl MeshFormat {
    /// The format that a file has by its name.
    pub fn of_path(path: &Path) -> Option<MeshFormat> {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        match extension.as_str() {
            "obj" => Some(MeshFormat::Obj),
            "stl" => Some(MeshFormat::Stl),
            "ply" => Some(MeshFormat::Ply),
            _ => None,
        }
    }

    /// The format that these bytes look like, for what comes without a name: PLY and STL are known by how they begin (a binary
    /// STL by its size), anything else is taken for OBJ.
    pub fn of_bytes(bytes: &[u8]) -> MeshFormat {
        if ply::is_ply(bytes) {
            MeshFormat::Ply
        } else if stl::is_stl(bytes) {
            MeshFormat::Stl
        } else {
            MeshFormat::Obj
        }
    }

    /// The format that these bytes have without doubt, among all other files: an OBJ has a statement of one among its first lines.
    pub fn known_by(bytes: &[u8]) -> Option<MeshFormat> {
        let format = MeshFormat::of_bytes(bytes);
        (format != MeshFormat::Obj || obj::has_vertices(bytes)).then_some(format)
    }
}

impl fmt::Display for MeshFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            MeshFormat::Obj => "OBJ",
            MeshFormat::Stl => "STL",
            MeshFormat::Ply => "PLY",
        })
    }
}

/// The surface in a file.
///
/// Colours are kept where all or some vertices have one (the others are white, as if they had none); of the numbers at the
/// vertices of a PLY the first that is called `displacement`, `quality`, `scalar`, `value` or `radius`.
///
/// # Errors
/// Names the first thing that is wrong, by line or byte and element.
pub fn read(bytes: &[u8], format: MeshFormat) -> Result<PolygonMesh, MeshError> {
    if bytes.iter().all(u8::is_ascii_whitespace) {
        return Err(MeshError::Empty);
    }
    if u32::try_from(bytes.len()).is_err() {
        return Err(MeshError::TooLarge);
    }
    // A binary STL may begin with any word: its size alone tells.
    let looks = MeshFormat::of_bytes(bytes);
    if looks != format && (looks != MeshFormat::Obj || obj::is_obj(bytes)) {
        return Err(MeshError::OtherFormat { expected: format, found: looks });
    }
    let mesh = match format {
        MeshFormat::Obj => obj::read(bytes),
        MeshFormat::Stl => stl::read(bytes),
        MeshFormat::Ply => ply::read(bytes),
    }?;
    if mesh.polygon_count() == 0 {
        return Err(MeshError::NoFaces { vertices: mesh.points.len() });
    }
    if let Some((face, vertices)) = mesh.first_tangled() {
        return Err(MeshError::Tangled { face, corners: mesh.polygon(face).len(), vertices });
    }
    Ok(mesh)
}

/// The file of a surface.
///
/// - OBJ: coordinates with the shortest digits that read back bit for bit, polygons as they are, colours after the
///   coordinates; the numbers at the vertices have no place there.
/// - STL: binary, triangles, coordinates rounded to f32 (the format has nothing better, and what lies beyond f32 is put at its
///   end); no colours, no numbers.
/// - PLY: binary little endian, f64, polygons as they are, colours, and the numbers at the vertices as `displacement`.
pub fn write(mesh: &PolygonMesh, format: MeshFormat) -> Vec<u8> {
    write_named(mesh, format, None)
}

/// As [`write()`], with another name than `displacement` for the numbers at the vertices: one that [`scalar_name`] has found.
pub fn write_named(mesh: &PolygonMesh, format: MeshFormat, scalar_name: Option<&str>) -> Vec<u8> {
    let known = scalar_name.filter(|name| ply::SCALARS.contains(name));
    match format {
        MeshFormat::Obj => obj::write(mesh),
        MeshFormat::Stl => stl::write(mesh),
        MeshFormat::Ply => ply::write(mesh, known.unwrap_or(ply::SCALARS[0])),
    }
}

/// What a file calls the numbers at its vertices that [`read`] gives; nothing where there are none.
pub fn scalar_name(bytes: &[u8], format: MeshFormat) -> Option<String> {
    if format == MeshFormat::Ply { ply::scalar_name(bytes) } else { None }
}

/// What a file says of a surface that [`read`] leaves out, in words: `normals`, `materials`. Only of OBJ: what a PLY may say has
/// no end.
pub fn left_out(bytes: &[u8], format: MeshFormat) -> Vec<&'static str> {
    if format == MeshFormat::Obj { obj::left_out(bytes) } else { vec![] }
}

/// The colour of vertices that have none among others that have one.
const UNCOLOURED: [u8; 3] = [255; 3];

#[cfg(test)]
mod tests;

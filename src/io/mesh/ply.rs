//! PLY, text or binary.
//!
//! Of the vertices x, y, z, colours (`red`, `green`, `blue`, or with `diffuse_` before) and one number are read, of the faces
//! their corners. All other elements and properties are passed over.

mod header;
mod source;

use super::{MeshError, UNCOLOURED};
use crate::mesh::{Point, PolygonMesh};
use header::{Element, Encoding, Header, Kind, Property, Type};
use source::Source;

/// The names of the number that is read with the vertices; the first is the one that is written unless another is asked for.
pub(super) const SCALARS: [&str; 5] = ["displacement", "quality", "scalar", "value", "radius"];

/// Whether this is PLY without doubt.
pub(super) fn is_ply(bytes: &[u8]) -> bool {
    bytes.strip_prefix(b"ply").is_some_and(|rest| rest.first().is_none_or(u8::is_ascii_whitespace))
}

pub(super) fn read(bytes: &[u8]) -> Result<PolygonMesh, MeshError> {
    let header = Header::read(bytes)?;
    let mut source = Source::new(bytes, &header);
    let mut mesh = PolygonMesh::default();
    let vertices = header.elements.iter().find(|e| e.name == "vertex");
    let Some(vertices) = vertices else { return Err(MeshError::Header { missing: "element \"vertex\"" }) };
    let vertex_count = usize::try_from(vertices.count).unwrap_or(usize::MAX);
    for element in &header.elements {
        source.has_room(element)?;
        match element.name.as_str() {
            "vertex" => read_vertices(&mut source, element, &mut mesh)?,
            "face" => read_faces(&mut source, element, vertex_count, &mut mesh)?,
            // Elements without properties take no bytes, however many they are.
            _ if element.properties.is_empty() => {}
            _ => read_rows(&mut source, element, |_, _, _| Ok(()))?,
        }
    }
    source.finish()?;
    Ok(mesh)
}

/// Calls `visit` with each number of an element, the number of its property and its place in the list (0 where there is none).
fn read_rows<'a>(
    source: &mut Source<'a>,
    element: &'a Element,
    mut visit: impl FnMut(&Source<'a>, usize, f64) -> Result<(), MeshError>,
) -> Result<(), MeshError> {
    for number in 0..element.count as usize {
        source.begin(element, number)?;
        for (k, property) in element.properties.iter().enumerate() {
            match property.kind {
                Kind::Scalar(kind) => {
                    let value = source.value(kind)?;
                    visit(source, k, value)?;
                }
                Kind::List { count, item } => {
                    for _ in 0..source.count(count, item)? {
                        let value = source.value(item)?;
                        visit(source, k, value)?;
                    }
                }
            }
        }
        source.end()?;
    }
    Ok(())
}

/// What a number of a vertex means.
#[derive(Clone, Copy)]
enum Role {
    Coordinate(usize),
    Colour(usize, Type),
    Scalar,
    None,
}

fn read_vertices<'a>(source: &mut Source<'a>, element: &'a Element, mesh: &mut PolygonMesh) -> Result<(), MeshError> {
    let find = |names: &[&str]| {
        let is_named = |p: &Property| matches!(p.kind, Kind::Scalar(_)) && names.contains(&p.name.as_str());
        element.properties.iter().position(is_named)
    };
    let mut roles = vec![Role::None; element.properties.len()];
    for (k, name) in ["x", "y", "z"].into_iter().enumerate() {
        let Some(at) = find(&[name]) else {
            return Err(MeshError::Header { missing: "properties x, y and z of \"vertex\"" });
        };
        roles[at] = Role::Coordinate(k);
    }
    let colours = [["red", "diffuse_red"], ["green", "diffuse_green"], ["blue", "diffuse_blue"]].map(|n| find(&n));
    let has_colours = colours.iter().all(Option::is_some);
    for (k, at) in colours.into_iter().flatten().enumerate().filter(|_| has_colours) {
        let Kind::Scalar(kind) = element.properties[at].kind else { continue };
        roles[at] = Role::Colour(k, kind);
    }
    let scalar = scalar(element);
    if let Some(at) = scalar {
        roles[at] = Role::Scalar;
    }
    // The file has room for so many: the header was held against it.
    mesh.points = vec![Point::origin(); element.count as usize];
    mesh.colours = vec![UNCOLOURED; if has_colours { mesh.points.len() } else { 0 }];
    mesh.scalars = vec![0.0; if scalar.is_some() { mesh.points.len() } else { 0 }];
    read_rows(source, element, |source, k, value| {
        let row = source.row();
        match roles[k] {
            Role::Coordinate(axis) => mesh.points[row][axis] = source.finite(value, "a coordinate")?,
            Role::Colour(channel, kind) => {
                mesh.colours[row][channel] = kind.byte(source.finite(value, "a colour")?);
            }
            Role::Scalar => mesh.scalars[row] = source.finite(value, "the number of a vertex")?,
            Role::None => {}
        }
        Ok(())
    })
}

fn read_faces<'a>(
    source: &mut Source<'a>,
    element: &'a Element,
    vertex_count: usize,
    mesh: &mut PolygonMesh,
) -> Result<(), MeshError> {
    let is_corners = |p: &Property| {
        matches!(p.kind, Kind::List { .. }) && matches!(p.name.as_str(), "vertex_indices" | "vertex_index")
    };
    let Some(at) = element.properties.iter().position(is_corners) else {
        return Err(MeshError::Header { missing: "list \"vertex_indices\" of \"face\"" });
    };
    let mut corners: Vec<u32> = vec![];
    for number in 0..element.count as usize {
        source.begin(element, number)?;
        corners.clear();
        for (k, property) in element.properties.iter().enumerate() {
            match property.kind {
                Kind::Scalar(kind) => {
                    source.value(kind)?;
                }
                Kind::List { count, item } => {
                    for _ in 0..source.count(count, item)? {
                        let value = source.value(item)?;
                        if k == at {
                            corners.push(source.corner(value, vertex_count)?);
                        }
                    }
                }
            }
        }
        if corners.len() < 3 {
            return Err(MeshError::FewCorners { place: source.place(), corners: corners.len() });
        }
        mesh.push(&corners);
        source.end()?;
    }
    Ok(())
}

/// The name of the number that is read with the vertices, if there is one.
pub(super) fn scalar_name(bytes: &[u8]) -> Option<String> {
    let header = Header::read(bytes).ok()?;
    let vertices = header.elements.iter().find(|e| e.name == "vertex")?;
    scalar(vertices).map(|at| vertices.properties[at].name.clone())
}

/// Which property of the vertices the number is.
fn scalar(vertices: &Element) -> Option<usize> {
    let is_named = |p: &Property| matches!(p.kind, Kind::Scalar(_)) && SCALARS.contains(&p.name.as_str());
    vertices.properties.iter().position(is_named)
}

/// The file, with this name for the numbers at the vertices.
pub(super) fn write(mesh: &PolygonMesh, scalar_name: &str) -> Vec<u8> {
    let has_colours = !mesh.points.is_empty() && mesh.colours.len() == mesh.points.len();
    let has_scalars = !mesh.points.is_empty() && mesh.scalars.len() == mesh.points.len();
    // Some programs know signed numbers of corners alone, and no counts above a byte.
    let most = mesh.polygons().map(<[u32]>::len).max().unwrap_or(0);
    let count = if most <= usize::from(u8::MAX) { "uchar" } else { "uint" };
    let item = if mesh.points.len() <= i32::MAX as usize { "int" } else { "uint" };
    let mut header = format!(
        "ply\nformat {} 1.0\ncomment clopen\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\n",
        Encoding::Little,
        mesh.points.len()
    );
    if has_colours {
        header += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    }
    if has_scalars {
        header += &format!("property double {scalar_name}\n");
    }
    header +=
        &format!("element face {}\nproperty list {count} {item} vertex_indices\nend_header\n", mesh.polygon_count());
    let mut out = header.into_bytes();
    for (k, p) in mesh.points.iter().enumerate() {
        for x in p.iter() {
            out.extend_from_slice(&x.to_le_bytes());
        }
        if has_colours {
            out.extend_from_slice(&mesh.colours[k]);
        }
        if has_scalars {
            out.extend_from_slice(&mesh.scalars[k].to_le_bytes());
        }
    }
    for polygon in mesh.polygons() {
        match count {
            "uchar" => out.push(polygon.len() as u8),
            _ => out.extend_from_slice(&(polygon.len() as u32).to_le_bytes()),
        }
        for v in polygon {
            out.extend_from_slice(&v.to_le_bytes());
        }
    }
    out
}

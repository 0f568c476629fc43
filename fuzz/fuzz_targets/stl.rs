//! Any bytes are a surface in STL or an error; and any surface can be cut into triangles, judged, mended and written.
#![no_main]

use clopen::io::mesh::{MeshFormat, read, write};
use clopen::mesh::{HalfEdgeMesh, Problem, Severity, problems, repair};
use libfuzzer_sys::fuzz_target;

/// Larger surfaces say nothing new and take long.
const MOST_POLYGONS: usize = 2000;

fuzz_target!(|bytes: &[u8]| {
    let Ok(mesh) = read(bytes, MeshFormat::Stl) else { return };
    assert!(mesh.points.iter().all(|p| p.iter().all(|x| x.is_finite())));
    assert!(mesh.polygons().all(|p| p.len() > 2 && p.iter().all(|v| (*v as usize) < mesh.points.len())));
    if mesh.polygon_count() > MOST_POLYGONS {
        return;
    }
    for format in [MeshFormat::Obj, MeshFormat::Ply] {
        let back = read(&write(&mesh, format), format).expect("what was written can be read");
        assert_eq!((back.points.len(), back.polygon_count()), (mesh.points.len(), mesh.polygon_count()));
    }
    let _ = write(&mesh, MeshFormat::Stl);
    let found = problems(&mesh);
    if found.iter().all(|p| p.severity() == Severity::Allowed) {
        let triangles = mesh.triangulated();
        assert!(HalfEdgeMesh::new(triangles.points, &triangles.faces).is_ok());
    }
    let (mended, _) = repair(mesh);
    let left = problems(&mended);
    let is_mended =
        |p: &Problem| matches!(p, Problem::RepeatedCorner { .. } | Problem::Duplicate { .. } | Problem::Unused { .. });
    assert!(!left.iter().any(is_mended), "{left:?}");
});

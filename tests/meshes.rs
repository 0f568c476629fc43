//! Meshes as people have them: the samples and the shared ones, in and out.

use clopen::io::mesh::{MeshFormat, read, write};
use clopen::mesh::{HalfEdgeMesh, Severity, problems, self_intersections};
use std::path::Path;

mod solids;

#[test]
fn the_samples_are_closed_surfaces_without_a_problem() {
    for (name, mesh) in solids::all() {
        assert_eq!(problems(&mesh), [], "{name}");
        assert!((1000..10_000).contains(&mesh.points.len()), "{name}: {}", mesh.points.len());
        let triangles = mesh.triangulated();
        assert!(triangles.volume() > 0.0, "{name}");
        assert!(HalfEdgeMesh::new(triangles.points, &triangles.faces).is_ok(), "{name}");
        for format in [MeshFormat::Obj, MeshFormat::Ply] {
            assert_eq!(read(&write(&mesh, format), format).as_ref(), Ok(&mesh), "{name}");
        }
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("samples/{name}.obj"));
        let stored = read(&std::fs::read(&file).unwrap(), MeshFormat::Obj).unwrap();
        assert_eq!(stored.polygons().collect::<Vec<_>>(), mesh.polygons().collect::<Vec<_>>(), "{name}");
        // Sines may differ in their last digit from one machine to another.
        assert!(stored.points.iter().zip(&mesh.points).all(|(p, q)| (p - q).norm() < 1e-12), "{name}");
    }
}

#[test]
fn the_samples_have_the_volumes_of_their_shapes() {
    let volume = |mesh: clopen::mesh::PolygonMesh| mesh.triangulated().volume();
    assert!((volume(solids::bracket()) - 2.56).abs() < 1e-12);
    assert!((volume(solids::plus()) - 5.0).abs() < 1e-12);
    // Inscribed, so a little less than the round ones.
    let pi = std::f64::consts::PI;
    let capsule = pi * 0.25 * (2.0 + 4.0 / 3.0 * 0.5);
    assert!((0.98..1.0).contains(&(volume(solids::capsule()) / capsule)));
    let cap = 1.7f64;
    let spheres = 2.0 * pi * cap * cap * (3.0 - cap) / 3.0;
    assert!((0.98..1.0).contains(&(volume(solids::two_spheres()) / spheres)));
}

#[test]
fn shared_meshes_come_back_bit_for_bit() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/3d");
    let Ok(files) = std::fs::read_dir(&folder) else {
        println!("skipped: ../shared is absent");
        return;
    };
    let mut seen = 0;
    for path in files.map(|f| f.unwrap().path()).filter(|p| MeshFormat::of_path(p).is_some()) {
        let mesh = read(&std::fs::read(&path).unwrap(), MeshFormat::Obj).unwrap();
        for format in [MeshFormat::Obj, MeshFormat::Ply] {
            assert_eq!(read(&write(&mesh, format), format).as_ref(), Ok(&mesh), "{}", path.display());
        }
        let found = problems(&mesh);
        if path.to_string_lossy().contains("_input") {
            assert!(found.iter().all(|p| p.severity() != Severity::Refused), "{}: {found:?}", path.display());
            assert_eq!(self_intersections(&mesh.triangulated()), [], "{}", path.display());
        }
        println!("{}: {} problems, first {:?}", path.display(), found.len(), found.first());
        seen += 1;
    }
    assert!(seen > 0);
}

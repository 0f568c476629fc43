//! Judges a closed surface without the command: `surface_judge check IN.obj OUT.obj R H [PICTURE.png]` prints the report as JSON,
//! `surface_judge volume IN.obj R VOXEL OUT.obj` writes the closing on a grid. Times are on standard error.

use std::fmt::Write;
use std::time::Instant;

use clopen::mesh::{Hierarchy, Point, TriangleMesh};
use clopen::preview::{MeshStyle, mesh, meshes};
use clopen::reference::{Operation, volumetric_close};

fn read(path: &str) -> Result<TriangleMesh, Box<dyn std::error::Error>> {
    let mut mesh = TriangleMesh::default();
    for line in std::fs::read_to_string(path)?.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let x = words.take(3).map(str::parse).collect::<Result<Vec<f64>, _>>()?;
                mesh.points.push(Point::from_slice(&x));
            }
            Some("f") => {
                let corner = |w: &str| w.split('/').next().unwrap_or("").parse::<u32>().map(|k| k - 1);
                let v = words.map(corner).collect::<Result<Vec<u32>, _>>()?;
                mesh.faces.extend((2..v.len()).map(|k| [v[0], v[k - 1], v[k]]));
            }
            _ => {}
        }
    }
    Ok(mesh)
}

fn timed<T>(what: &str, work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = work();
    eprintln!("{what}: {:.0} ms", start.elapsed().as_secs_f64() * 1e3);
    result
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = args.iter().map(String::as_str).collect();
    match words[..] {
        ["check", before, after, r, h, ref picture @ ..] => {
            let (before, after) = (read(before)?, read(after)?);
            let (r, h) = (r.parse()?, h.parse()?);
            let report = timed("check", || clopen::check::surface(&before, &after, r, Operation::Close, h))?;
            println!("{}", serde_json::to_string_pretty(&report)?);
            if let [picture] = picture {
                let hierarchy = Hierarchy::new(&before.points, &before.faces);
                let limit = clopen::check::MOVED * before.diagonal();
                let moved: Vec<bool> = after.points.iter().map(|p| !hierarchy.is_nearer(*p, limit)).collect();
                let moved: Vec<bool> = after.faces.iter().map(|f| f.iter().any(|&v| moved[v as usize])).collect();
                let plain = MeshStyle::default();
                let style = MeshStyle { moved: Some(&moved), ..plain };
                timed(&format!("picture of {} faces", after.faces.len()), || mesh(&after, &plain))?;
                std::fs::write(picture, timed("both pictures", || meshes(&[(&before, plain), (&after, style)]))?)?;
            }
        }
        ["volume", input, r, voxel, output] => {
            let input = read(input)?;
            let closed =
                timed("volume", || volumetric_close(&input, r.parse().unwrap_or(0.0), voxel.parse().unwrap_or(0.0)))?;
            let mut text = String::new();
            closed.points.iter().try_for_each(|p| writeln!(text, "v {} {} {}", p.x, p.y, p.z))?;
            closed.faces.iter().try_for_each(|[a, b, c]| writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1))?;
            std::fs::write(output, text)?;
        }
        _ => return Err("see the first lines of this file for what to write".into()),
    }
    Ok(())
}

use clopen::{mesh::*, rolling::*};
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let s = std::fs::read_to_string(&a[1]).unwrap();
    let (mut p, mut f) = (vec![], vec![]);
    for l in s.lines() {
        if let Some(r) = l.strip_prefix("v ") {
            let q: Vec<f64> = r.split_ascii_whitespace().map(|x| x.parse().unwrap()).collect();
            p.push(Point::new(q[0], q[1], q[2]));
        } else if let Some(r) = l.strip_prefix("f ") {
            let q: Vec<u32> =
                r.split_ascii_whitespace().map(|x| x.split('/').next().unwrap().parse::<u32>().unwrap() - 1).collect();
            for k in 1..q.len() - 1 {
                f.push([q[0], q[k], q[k + 1]]);
            }
        }
    }
    let m = TriangleMesh::new(p, f);
    let t = std::time::Instant::now();
    let r: f64 = a[3].parse().unwrap();
    let o = SurfaceOptions {
        radius: &|_| r,
        pin_distance: &|_| f64::INFINITY,
        edge: a[4].parse().unwrap(),
        threads: a.get(5).map_or(2, |x| x.parse().unwrap()),
    };
    let c = close_surface(&m, &o).unwrap();
    eprintln!(
        "{:?} kept {} of {} conflicts {} error {}",
        t.elapsed(),
        c.origins.iter().filter(|x| **x != NONE).count(),
        m.points.len(),
        c.conflicts.len(),
        c.error / o.edge
    );
    let mut out = String::new();
    use std::fmt::Write;
    for p in &c.points {
        writeln!(out, "v {:?} {:?} {:?}", p.x, p.y, p.z).unwrap();
    }
    for f in &c.faces {
        writeln!(out, "f {} {} {}", f[0] + 1, f[1] + 1, f[2] + 1).unwrap();
    }
    std::fs::write(&a[2], out).unwrap();
}

//! What comes out: the input as far as it is left, then what is new.

use super::SurfaceFront;
use crate::mesh::{NONE, Point};

/// A surface after a flow.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FlownSurface {
    /// The vertices: those of the input that are left, in their order, then new ones.
    pub points: Vec<Point>,
    /// The vertex of the input that each of them is, at its place bit for bit; [`NONE`] where it moved or is new.
    pub origins: Vec<u32>,
    /// The faces: those of the input that did not change, in their order, then new ones.
    pub faces: Vec<[u32; 3]>,
    /// The face of the input that each of them is; [`NONE`] where it changed or is new.
    pub parents: Vec<u32>,
}

impl SurfaceFront<'_> {
    /// The surface as it is now; `mirrored` turns it inside out.
    pub(super) fn result(&self, mirrored: bool) -> FlownSurface {
        let mut surface = FlownSurface::default();
        let (inputs, count) = (self.input.points.len(), self.mesh.points.len());
        // What no face ever used stays, too.
        let mut is_used = vec![false; count];
        is_used[..inputs].fill(true);
        self.input.faces.iter().flatten().for_each(|&v| is_used[v as usize] = false);
        for f in self.mesh.faces() {
            let mut face = self.mesh.face(f);
            face.iter().for_each(|&v| is_used[v as usize] = true);
            if mirrored {
                face.swap(1, 2);
            }
            surface.faces.push(face);
            let is_input = (f as usize) < self.input.faces.len() && !self.touched[f as usize];
            surface.parents.push(if is_input { f } else { NONE });
        }
        let mut number = vec![NONE; count];
        for v in (0..count).filter(|&v| is_used[v]) {
            number[v] = surface.points.len() as u32;
            surface.points.push(self.mesh.points[v]);
            surface.origins.push(if self.is_kept(v as u32) { v as u32 } else { NONE });
        }
        surface.faces.iter_mut().flatten().for_each(|v| *v = number[*v as usize]);
        surface
    }
}

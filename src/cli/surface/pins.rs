//! Where the ball has which radius, and what stays, from arguments to functions of a place.

use std::str::FromStr;

use anyhow::{Result, bail};
use clap::Args;

use super::MeshLength;
use crate::mesh::{Hierarchy, Point, Vector};

use super::touch::Space;
use super::work::{Input, scaled};

/// Radii and pins.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Radius and pins (in units of the mesh)")]
pub(super) struct FieldArgs {
    /// The radius at a place, from which it varies linearly to that of --radius-to. --radius is then
    /// nothing but the unit of the times of a flow
    #[arg(long, value_name = "X,Y,Z=RADIUS", requires = "radius_to", allow_hyphen_values = true)]
    radius_from: Option<PlacedRadius>,
    /// The radius at the other place, and beyond
    #[arg(long, value_name = "X,Y,Z=RADIUS", requires = "radius_from", allow_hyphen_values = true)]
    radius_to: Option<PlacedRadius>,
    /// The number that a PLY has for each vertex (quality, scalar, value or radius) is the radius there, in parts of --radius
    #[arg(long, conflicts_with = "radius_from")]
    radius_by_vertex: bool,
    /// Where the surface faces this way, the radius is multiplied by FACTOR; the less, the more it faces another way, and not
    /// at all from a right angle on: 1 + (FACTOR - 1) cos² of the angle between. May be given more than once; needs --method
    /// flow
    #[arg(long, value_name = "X,Y,Z=FACTOR", allow_hyphen_values = true)]
    radius_facing: Vec<Facing>,
    /// A box in which nothing moves: a corner and the extents; near it the surface joins it smoothly. May be given more than once
    #[arg(long, value_name = "X,Y,Z,DX,DY,DZ", allow_hyphen_values = true)]
    pin_box: Vec<PinBox>,
    /// A ball in which nothing moves; may be given more than once
    #[arg(long, value_name = "X,Y,Z,R", allow_hyphen_values = true)]
    pin_ball: Vec<PinBall>,
    /// What is within R of the line between two points does not move; may be given more than once
    #[arg(long, value_name = "X,Y,Z,X,Y,Z,R", allow_hyphen_values = true)]
    pin_line: Vec<PinLine>,
    /// A box outside of which nothing moves: a corner and the extents; may be given more than once
    #[arg(long, value_name = "X,Y,Z,DX,DY,DZ", allow_hyphen_values = true)]
    only_box: Vec<PinBox>,
}

/// The radius at every place, and the distance from what is pinned.
pub(super) struct Field<'a> {
    pub radius: Box<dyn Fn(Point) -> f64 + Sync + 'a>,
    pub pin_distance: Box<dyn Fn(Point) -> f64 + Sync + 'a>,
    /// What the radius is multiplied by where the surface has a normal, if it hangs on that.
    pub facing: Option<Box<dyn Fn(Vector) -> f64 + Sync + 'a>>,
    pub smallest: f64,
    pub largest: f64,
}

impl<'a> Field<'a> {
    /// The field on a mesh that is squeezed by these numbers, so that the ellipsoid with such half axes is a ball.
    pub fn stretched(self, by: [f64; 3]) -> Field<'a> {
        let most = by.iter().copied().fold(0.0, f64::max);
        let Field { radius, pin_distance, facing, smallest, largest } = self;
        Field {
            radius: Box::new(move |p| radius(scaled(p, by))),
            // No farther than it is in any direction.
            pin_distance: Box::new(move |p| pin_distance(scaled(p, by)) / most),
            facing,
            smallest,
            largest,
        }
    }
}

/// Factors along the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stretch(pub [f64; 3]);

impl FromStr for Stretch {
    type Err = String;

    fn from_str(text: &str) -> Result<Stretch, String> {
        let found = numbers::<3>(text).filter(|n| n.iter().all(|x| (1e-3..=1e3).contains(x)));
        found.map(Stretch).ok_or_else(|| "write three numbers from 0.001 to 1000, for example 1,1,2".to_owned())
    }
}

impl FieldArgs {
    /// What the arguments mean for a mesh, the radius being `radius` where nothing else is said.
    pub fn resolve<'a>(&'a self, input: &'a Input, radius: f64) -> Result<Field<'a>> {
        let mut field = self.in_space(input, radius)?;
        if !self.radius_facing.is_empty() {
            let facing = move |n: Vector| self.radius_facing.iter().map(|f| f.factor(&n)).product();
            field.facing = Some(Box::new(facing));
            let factors = || self.radius_facing.iter().map(|f| f.factor);
            field.smallest *= factors().map(|f| f.min(1.0)).product::<f64>();
            field.largest *= factors().map(|f| f.max(1.0)).product::<f64>();
        }
        Ok(field)
    }

    /// The radius by place alone, and what is pinned.
    fn in_space<'a>(&'a self, input: &'a Input, radius: f64) -> Result<Field<'a>> {
        let pin_distance = Box::new(move |p: Point| self.pin_distance(p));
        let spaces = self.spaces();
        if !spaces.is_empty() {
            let hierarchy = Hierarchy::new(&input.triangles.points, &input.triangles.faces);
            if let Some((typed, _)) = spaces.iter().find(|(_, space)| !space.meets(&input.triangles, &hierarchy)) {
                bail!("{typed} holds nothing of the surface: {}", input.extent());
            }
            // Other vertices begin to move only where one does.
            if !self.only_box.is_empty() && input.triangles.points.iter().all(|&p| self.depth(p) == 0.0) {
                bail!(
                    "--only-box: part of the surface is in it, but no vertex, so that nothing would begin to move: make it reach a vertex, or \
                     divide the faces there first"
                );
            }
        }
        if let (Some(from), Some(to)) = (&self.radius_from, &self.radius_to) {
            let along = to.place - from.place;
            let length2 = along.norm_squared();
            if length2 == 0.0 {
                bail!("--radius-from and --radius-to are in the same place: give two places, or one --radius");
            }
            let (a, b) = (from.radius, to.radius);
            let at = move |p: Point| a + (b - a) * ((p - from.place).dot(&along) / length2).clamp(0.0, 1.0);
            let (smallest, largest) = (a.min(b), a.max(b));
            return Ok(Field { radius: Box::new(at), pin_distance, facing: None, smallest, largest });
        }
        if self.radius_by_vertex {
            let scalars = &input.polygons.scalars;
            if scalars.is_empty() {
                bail!(
                    "--radius-by-vertex: the mesh has no number at its vertices: give a PLY with a property \
                     quality, scalar, value or radius"
                );
            }
            if let Some(k) = scalars.iter().position(|s| !(*s > 0.0 && s.is_finite())) {
                bail!("--radius-by-vertex: the number of vertex {k} is {}: it must be above zero", scalars[k]);
            }
            let hierarchy = Hierarchy::new(&input.triangles.points, &input.triangles.faces);
            let at = move |p: Point| {
                let Some(hit) = hierarchy.nearest(p, f64::INFINITY) else { return radius };
                let face = input.triangles.faces[hit.face as usize];
                let [a, b, c] = face.map(|v| input.triangles.points[v as usize]);
                // Linear over the triangle, by the areas of its parts.
                let whole = (b - a).cross(&(c - a));
                let part = |u: Point, v: Point| (u - hit.point).cross(&(v - hit.point)).dot(&whole);
                let weights =
                    [part(b, c), part(c, a), part(a, b)].map(|w| w / whole.norm_squared().max(f64::MIN_POSITIVE));
                radius * (0..3).map(|k| weights[k] * scalars[face[k] as usize]).sum::<f64>()
            };
            let smallest = scalars.iter().copied().fold(f64::INFINITY, f64::min);
            let largest = scalars.iter().copied().fold(0.0, f64::max);
            return Ok(Field {
                radius: Box::new(at),
                pin_distance,
                facing: None,
                smallest: radius * smallest,
                largest: radius * largest,
            });
        }
        Ok(Field { radius: Box::new(move |_| radius), pin_distance, facing: None, smallest: radius, largest: radius })
    }

    fn pin_distance(&self, p: Point) -> f64 {
        let boxes = self.pin_box.iter().map(|pin| pin.distance(p));
        let balls = self.pin_ball.iter().map(|pin| pin.distance(p));
        let lines = self.pin_line.iter().map(|pin| pin.distance(p));
        let held = boxes.chain(balls).chain(lines).fold(f64::INFINITY, f64::min);
        if self.only_box.is_empty() { held } else { held.min(self.depth(p)) }
    }

    /// How deep a place is in the boxes outside of which nothing moves, 0 outside.
    fn depth(&self, p: Point) -> f64 {
        self.only_box.iter().map(|only| only.depth(p)).fold(0.0, f64::max)
    }

    /// The regions with what was typed.
    fn spaces(&self) -> Vec<(String, Space)> {
        let mut spaces = Vec::new();
        for (option, boxes) in [("--pin-box", &self.pin_box), ("--only-box", &self.only_box)] {
            spaces.extend(boxes.iter().map(|pin| (format!("{option} {}", typed(&pin.0)), Space::Box(pin.corners()))));
        }
        for pin in &self.pin_ball {
            let middle = Point::new(pin.0[0], pin.0[1], pin.0[2]);
            spaces.push((format!("--pin-ball {}", typed(&pin.0)), Space::Line([middle; 2], pin.0[3])));
        }
        for pin in &self.pin_line {
            spaces.push((format!("--pin-line {}", typed(&pin.0)), Space::Line(pin.ends(), pin.0[6])));
        }
        spaces
    }
}

fn typed(numbers: &[f64]) -> String {
    numbers.iter().map(f64::to_string).collect::<Vec<_>>().join(",")
}

/// So many finite numbers with commas between them.
pub(super) fn numbers<const N: usize>(text: &str) -> Option<[f64; N]> {
    let parse = |t: &str| t.trim().parse::<f64>().ok().filter(|x| x.is_finite());
    let found: Option<Vec<f64>> = text.split(',').map(parse).collect();
    found?.try_into().ok()
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct PlacedRadius {
    place: Point,
    radius: f64,
}

impl FromStr for PlacedRadius {
    type Err = String;

    fn from_str(text: &str) -> Result<PlacedRadius, String> {
        let read = || {
            let (place, radius) = text.split_once('=')?;
            let MeshLength::Units(radius) = radius.parse().ok()? else { return None };
            Some(PlacedRadius { place: Point::from(numbers::<3>(place)?), radius })
        };
        read().ok_or_else(|| "write a place and the radius there, for example 10,0,0=0.5".to_owned())
    }
}

/// A direction, and what the radius is multiplied by where the surface faces it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Facing {
    /// Of unit length.
    direction: Vector,
    factor: f64,
}

impl Facing {
    /// What the radius is multiplied by where the surface has this normal.
    fn factor(&self, normal: &Vector) -> f64 {
        let cosine = self.direction.dot(normal).clamp(0.0, 1.0);
        1.0 + (self.factor - 1.0) * cosine * cosine
    }
}

impl FromStr for Facing {
    type Err = String;

    fn from_str(text: &str) -> Result<Facing, String> {
        let read = || {
            let (direction, factor) = text.split_once('=')?;
            let [factor] = numbers::<1>(factor)?;
            let direction = Vector::from(numbers::<3>(direction)?).try_normalize(0.0)?;
            (1e-3..=1e3).contains(&factor).then_some(Facing { direction, factor })
        };
        read().ok_or_else(|| "write a direction and a factor from 0.001 to 1000, for example 0,0,1=0.5".to_owned())
    }
}

/// A box: a corner and the extents.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PinBox([f64; 6]);

impl PinBox {
    fn corners(&self) -> [Point; 2] {
        let [x, y, z, dx, dy, dz] = self.0;
        [Point::new(x, y, z), Point::new(x + dx, y + dy, z + dz)]
    }

    /// How far `p` is from the box, 0 in it.
    fn distance(&self, p: Point) -> f64 {
        let beyond = |k: usize| (self.0[k] - p[k]).max(p[k] - self.0[k] - self.0[k + 3]).max(0.0);
        beyond(0).hypot(beyond(1)).hypot(beyond(2))
    }

    /// How far `p` is from the outside of the box, 0 there.
    fn depth(&self, p: Point) -> f64 {
        (0..3).map(|k| (p[k] - self.0[k]).min(self.0[k] + self.0[k + 3] - p[k])).fold(f64::INFINITY, f64::min).max(0.0)
    }
}

impl FromStr for PinBox {
    type Err = String;

    fn from_str(text: &str) -> Result<PinBox, String> {
        let found = numbers::<6>(text).filter(|n| n[3..].iter().all(|d| *d > 0.0));
        found
            .map(PinBox)
            .ok_or_else(|| "write a corner and three extents above zero, for example 0,0,0,1,1,2".to_owned())
    }
}

/// A ball: its middle and its radius.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PinBall([f64; 4]);

impl PinBall {
    fn distance(&self, p: Point) -> f64 {
        ((p - Point::new(self.0[0], self.0[1], self.0[2])).norm() - self.0[3]).max(0.0)
    }
}

impl FromStr for PinBall {
    type Err = String;

    fn from_str(text: &str) -> Result<PinBall, String> {
        let found = numbers::<4>(text).filter(|n| n[3] > 0.0);
        found.map(PinBall).ok_or_else(|| "write the middle and a radius above zero, for example 0,0,0,0.5".to_owned())
    }
}

/// A line between two points, and how far around it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PinLine([f64; 7]);

impl PinLine {
    fn ends(&self) -> [Point; 2] {
        [0, 3].map(|k| Point::new(self.0[k], self.0[k + 1], self.0[k + 2]))
    }

    fn distance(&self, p: Point) -> f64 {
        let [a, b] = self.ends();
        let along = b - a;
        let t = ((p - a).dot(&along) / along.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        ((p - (a + along * t)).norm() - self.0[6]).max(0.0)
    }
}

impl FromStr for PinLine {
    type Err = String;

    fn from_str(text: &str) -> Result<PinLine, String> {
        let found = numbers::<7>(text).filter(|n| n[6] > 0.0);
        found
            .map(PinLine)
            .ok_or_else(|| "write two points and a distance above zero, for example 0,0,0,0,0,1,0.02".to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pins_are_as_far_as_they_look() {
        let p = Point::new(3.0, 0.5, 0.5);
        for (pin, expected) in [("0,0,0,1,1,1", 2.0), ("2,0,0,2,1,1", 0.0)] {
            assert_eq!(pin.parse::<PinBox>().unwrap().distance(p), expected);
        }
        assert_eq!("0,0,0,4,1,1".parse::<PinBox>().unwrap().depth(p), 0.5);
        assert_eq!("0,0.5,0.5,1".parse::<PinBall>().unwrap().distance(p), 2.0);
        assert_eq!("3,0,-9,3,0,9,0.25".parse::<PinLine>().unwrap().distance(p), 0.25);
        for text in ["", "1,2,3", "0,0,0,1,1,0", "0,0,0,1,1,nan"] {
            assert!(text.parse::<PinBox>().is_err(), "{text}");
        }
        assert!("0,0,0,0".parse::<PinBall>().is_err() && "0,0,0,0,0,0,0".parse::<PinLine>().is_err());
        for text in ["", "0,0,0=1", "0,0,1", "0,0,1=0", "0,0,1=nan", "0,1=2"] {
            assert!(text.parse::<Facing>().is_err(), "{text}");
        }
        let up: Facing = "0,0,9=0.5".parse().unwrap();
        assert_eq!([Vector::z(), Vector::x(), -Vector::z()].map(|n| up.factor(&n)), [0.5, 1.0, 1.0]);
        assert!("0,0=1".parse::<PlacedRadius>().is_err() && "0,0,0=1%".parse::<PlacedRadius>().is_err());
    }
}

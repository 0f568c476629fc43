//! The radius of the disk.

use super::Brief;

/// A finite radius above zero. Its unit is that of the geometry it is used on.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Radius(f64);

/// Why a number is not a radius.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("the radius is {}: it must be a finite number above zero", Brief(*.0))]
pub struct InvalidRadius(f64);

impl Radius {
    /// A radius of `value`.
    ///
    /// # Errors
    /// Where `value` is zero, negative, subnormal, infinite or not a number.
    pub fn new(value: f64) -> Result<Radius, InvalidRadius> {
        if value.is_normal() && value > 0.0 { Ok(Radius(value)) } else { Err(InvalidRadius(value)) }
    }

    /// The number.
    pub fn get(self) -> f64 {
        self.0
    }
}

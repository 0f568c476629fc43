//! Numbers as people read them: no more digits than mean something.

/// A number with six digits at most, and an exponent where there would be rows of zeros.
pub(super) fn number(x: f64) -> String {
    // Reading back what was just written cannot fail.
    let rounded = format!("{x:.5e}").parse().unwrap_or(x);
    let size = f64::abs(rounded);
    if size == 0.0 || (1e-4..1e7).contains(&size) { format!("{rounded}") } else { format!("{rounded:e}") }
}

/// A count with its noun: `1 face`, `2 faces`.
pub(super) fn count(n: usize, one: &str, several: &str) -> String {
    format!("{n} {}", if n == 1 { one } else { several })
}

/// How places on a mesh are written: to a few hundred thousandths of its size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Places {
    /// Digits after the point; none where only an exponent helps.
    decimals: Option<usize>,
}

/// Digits from the first of the diagonal on.
const DIGITS: i32 = 4;

/// More decimals than this, and larger meshes than with a diagonal of so many digits, are written with an exponent.
const MOST_DECIMALS: i32 = 10;

impl Places {
    /// On a mesh whose box has this diagonal.
    pub fn on(diagonal: f64) -> Places {
        let size = diagonal.log10().floor();
        let decimals = DIGITS - size.clamp(-1000.0, 1000.0) as i32;
        let is_plain = diagonal > 0.0 && (-MOST_DECIMALS..=MOST_DECIMALS).contains(&decimals);
        Places { decimals: is_plain.then_some(decimals.max(0) as usize) }
    }

    /// `(x, y, z)`.
    pub fn show(self, [x, y, z]: [f64; 3]) -> String {
        // Minus zero is zero, and what rounds to it.
        match self.decimals {
            Some(n) => {
                let [x, y, z] = [x, y, z].map(|x| {
                    let text = format!("{x:.n$}");
                    if text.bytes().all(|b| matches!(b, b'-' | b'0' | b'.')) { format!("{:.n$}", 0.0) } else { text }
                });
                format!("({x}, {y}, {z})")
            }
            None => format!("({x:.4e}, {y:.4e}, {z:.4e})"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_the_digits_that_mean_something() {
        let shown = [0.3, 0.06928203230275509, 1e300, 2.0, 1234567.89, 1e-9, 0.0].map(number);
        assert_eq!(shown, ["0.3", "0.069282", "1e300", "2", "1234570", "1e-9", "0"]);
        assert_eq!(number(f64::INFINITY), "inf");
    }

    #[test]
    fn places_have_as_many_digits_as_the_mesh_is_small() {
        let at = |diagonal: f64, p: [f64; 3]| Places::on(diagonal).show(p);
        assert_eq!(at(3.0, [0.8, -0.0, 1.0]), "(0.8000, 0.0000, 1.0000)");
        assert_eq!(at(3e-5, [8e-6, 0.0, -1e-5]), "(0.000008000, 0.000000000, -0.000010000)");
        assert_eq!(at(300.0, [80.0, 0.123456, 1.0]), "(80.00, 0.12, 1.00)");
        assert_eq!(at(3e7, [8e6, 0.4, 1.0]), "(8000000, 0, 1)");
        assert_eq!(at(1e-30, [8e-31, 0.0, 1e-31]), "(8.0000e-31, 0.0000e0, 1.0000e-31)");
        assert_eq!([count(1, "place", "places"), count(2, "place", "places")], ["1 place", "2 places"]);
    }
}

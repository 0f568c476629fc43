//! Outlines that were followed, and such that were not.

use super::*;
use crate::gcode::read;
use crate::plane::Region;

const HEAD: &str = "G21 G90 G17 G94\nG0 Z5\nM3 S1000\nG4 P1\nF500\n";

/// What a tool of 4 mm leaves of `rings`, cut down to -2.
fn left(path: &str, rings: &[Ring]) -> Vec<Leftover> {
    let program = read(&format!("{HEAD}{path}")).unwrap();
    leftovers(&[Reach { motions: &program.motions, radius: 2.0 }], rings, -2.0, 0.0)
}

fn polygon(points: &[[f64; 2]]) -> Ring {
    Ring::polygon(points.iter().map(|p| Point::new(p[0], p[1])))
}

fn square(x: f64) -> Ring {
    polygon(&[[x, 0.0], [x + 20.0, 0.0], [x + 20.0, 20.0], [x, 20.0]])
}

/// Around the square at 0, once, down to z.
fn around(z: f64) -> String {
    format!("G0 X-2 Y-2\nG1 Z{z}\nG1 X22\nG1 Y22\nG1 X-2\nG1 Y-2\nG0 Z5\n")
}

#[test]
fn what_is_cut_all_around_leaves_nothing() {
    assert_eq!(left(&around(-2.0), &[square(0.0)]), []);
    let (inner, outer) = ("G0 X2 Y2\nG1 Z-2\nG1 X18\nG1 Y18\nG1 X2\nG1 Y2\n", square(0.0).reversed());
    assert_eq!(left(inner, &[outer]), [], "what a round tool leaves in the corners of a pocket is none");
}

#[test]
fn an_outline_that_is_never_cut_is_named_whole() {
    let found =
        left(&around(-2.0), &[square(0.0), square(100.0), Ring::circle(Point::new(10.0, 10.0), 1.0).reversed()]);
    assert_eq!(found.len(), 2, "{found:?}");
    assert!(found.iter().all(|l| l.is_whole_outline));
    assert_eq!((found[0].x_mm, found[0].y_mm, found[0].length_mm), (110.0, 10.0, 80.0));
    assert_eq!((found[1].x_mm, found[1].y_mm), (10.0, 10.0));
    // Not deep enough is not cut, and then nothing is apart from anything.
    let shallow = left(&around(-1.0), &[square(0.0)]);
    assert!(shallow.len() == 1 && shallow[0].is_whole_outline && shallow[0].depth_mm.is_none(), "{shallow:?}");
}

#[test]
fn a_last_pass_that_breaks_off_leaves_its_rest() {
    let path = format!("{}G0 X-2 Y-2\nG1 Z-2\nG1 X22\nG1 Y10\n", around(-1.0));
    let found = left(&path, &[square(0.0)]);
    assert_eq!(found.len(), 1, "{found:?}");
    // From half way up the right side over the top to near the lower left corner, but for what the tool takes in passing.
    assert!((found[0].length_mm - 50.0).abs() < 1.0, "{found:?}");
    assert!(!found[0].is_whole_outline && found[0].depth_mm.unwrap() > 10.0, "{found:?}");
}

#[test]
fn tabs_are_no_leftover_and_gaps_of_their_size_are() {
    let way = |between: &str| {
        format!("{}G0 X-2 Y-2\nG1 Z-2\nG1 X6\n{between}G1 X22\nG1 Y22\nG1 X-2\nG1 Y-2\nG0 Z5\n", around(-1.0))
    };
    assert_eq!(left(&way("G1 Z-1\nG1 X14\nG1 Z-2\n"), &[square(0.0)]), []);
    assert_eq!(left(&way("G1 X8 Z-1\nG1 X12\nG1 X14 Z-2\n"), &[square(0.0)]), []);
    // All but where the ends of the cuts reach to within the limit.
    for gap in ["G0 Z5\nG0 X14\nG1 Z-2\n", "G1 Z5\nG1 X14\nG1 Z-2\n"] {
        let found = left(&way(gap), &[square(0.0)]);
        assert!(found.len() == 1 && (found[0].length_mm - 7.1).abs() < 0.3, "{gap}: {found:?}");
    }
}

#[test]
fn corners_are_explained_and_slots_are_not() {
    // A concave corner, sharp and with a path that rounds it far; 60 degrees too.
    let l = polygon(&[[0.0, 0.0], [20.0, 0.0], [20.0, 10.0], [10.0, 10.0], [10.0, 20.0], [0.0, 20.0]]);
    let rest = "G1 X-2\nG1 Y-2\nG1 X22\n";
    let sharp = format!("G0 X22 Y-2\nG1 Z-2\nG1 Y12\nG1 X12\nG1 Y22\n{rest}");
    let round = format!("G0 X22 Y-2\nG1 Z-2\nG1 Y12\nG1 X15\nG2 X12 Y15 I0 J3\nG1 Y22\n{rest}");
    assert_eq!(left(&sharp, std::slice::from_ref(&l)), []);
    assert_eq!(left(&round, std::slice::from_ref(&l)), []);
    // The same corner cut across at 45 degrees leaves too much.
    let across = format!("G0 X22 Y-2\nG1 Z-2\nG1 Y12\nG1 X20\nG1 X12 Y20\nG1 Y22\n{rest}");
    assert_eq!(left(&across, std::slice::from_ref(&l)).len(), 1);
    // A slot too narrow for the tool.
    let slot = polygon(&[
        [0.0, 0.0],
        [20.0, 0.0],
        [20.0, 20.0],
        [11.0, 20.0],
        [11.0, 10.0],
        [9.0, 10.0],
        [9.0, 20.0],
        [0.0, 20.0],
    ]);
    let found = left(&around(-2.0), &[slot]);
    assert!(found.len() == 1 && (found[0].depth_mm.unwrap() - 10.0).abs() < 0.2, "{found:?}");
    // A triangle's 60 degrees.
    let height = 30.0 * 0.75f64.sqrt();
    let triangle = polygon(&[[0.0, 0.0], [30.0, 0.0], [15.0, height]]).reversed();
    let inset = 2.0 * 3f64.sqrt();
    let path = format!("G0 X{inset} Y2\nG1 Z-2\nG1 X{}\nG1 X15 Y{}\nG1 X{inset} Y2\n", 30.0 - inset, height - 4.0);
    assert_eq!(left(&path, &[triangle]), []);
}

#[test]
fn degenerate_outlines_do_no_harm() {
    let rings = [polygon(&[]), polygon(&[[1.0, 1.0]]), polygon(&[[1.0, 1.0], [1.0, 1.0]])];
    assert_eq!(left(&around(-2.0), &Region::new(rings.to_vec()).rings), []);
    assert_eq!(leftovers(&[], &[square(0.0)], -1.0, 0.0).len(), 1);
}

//! A program's text, read back into what a machine will do.
//!
//! Reads programs of any origin: millimetres and inches, absolute and incremental, arcs by centre or by radius, in all
//! planes, helices, full circles, drilling cycles, origins that the program sets, comments in both styles. It refuses what it
//! cannot follow: parameters and expressions, other cycles, cutter compensation, splines.

use super::interpreter::interpret;
use super::{Dialect, Finding, Reading};
use crate::cam::Program;

/// Why a program cannot be read: its first line whose meaning is lost.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("line {}: {} Run `clopen lint` for all findings.", .0.line, .0.message)]
pub struct ReadError(pub Finding);

/// The motions of `text`, a whole program, in millimetres.
///
/// What the program leaves to the machine is assumed: millimetres, absolute, XY plane, start at the origin. Use
/// [`super::lint`] to know what was assumed. It is read as the dialect that its header names means it.
///
/// # Errors
/// Where a line cannot be understood, so that the motions would not be those of a machine.
pub fn read(text: &str) -> Result<Program, ReadError> {
    read_as(text, Dialect::of_header(text).unwrap_or(Dialect::portable()))
}

/// The motions of `text`, a whole program, as a controller of `dialect` makes them: the times of G4 differ.
///
/// # Errors
/// Where a line cannot be understood, so that the motions would not be those of a machine.
pub fn read_as(text: &str, dialect: &Dialect) -> Result<Program, ReadError> {
    let read = interpret(text, dialect);
    match read.findings.into_iter().find(|f| f.rule.info().reading == Reading::Lost) {
        Some(finding) => Err(ReadError(finding)),
        None => Ok(read.program),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cam::{MotionKind, Point3, ProgramUnit};
    use crate::plane::{Point, Turn};

    fn ends(text: &str) -> Vec<Point3> {
        read(text).unwrap().motions.iter().map(|m| m.to).collect()
    }

    #[test]
    fn modal_state_carries_over() {
        let program = read("G21 G90 G17 G94\nG0 Z5\nX1 Y2\nG1 Z-1 F300\nX10\nY5 F600\nM2\nG0 X99").unwrap();
        assert_eq!(program.unit, Some(ProgramUnit::Millimetre));
        assert_eq!(program.end_line, Some(7));
        assert_eq!(program.motions.len(), 5, "nothing runs after the end");
        assert_eq!(program.motions[4].to, Point3::new(10.0, 5.0, -1.0));
        assert_eq!(program.motions[3].kind, MotionKind::Feed { feed: 300.0 });
        assert_eq!(program.motions[4].kind, MotionKind::Feed { feed: 600.0 });
        assert_eq!(program.motions[4].line, 6);
    }

    #[test]
    fn inches_and_increments_become_millimetres() {
        let program = read("G20 G91 G17 G94\nG0 Z1\nX1 Y-.5\nG1 X0.1 F10\nX.1").unwrap();
        let last = program.motions.last().unwrap();
        assert!((last.to - Point3::new(30.48, -12.7, 25.4)).norm() < 1e-12, "{last:?}");
        assert_eq!(last.kind, MotionKind::Feed { feed: 254.0 });
    }

    #[test]
    fn arcs_by_centre_and_by_radius_agree() {
        let head = "G21 G90 G17 G94 F100\nG0 Z1\nX10 Y0\n";
        for (by_center, by_radius) in [
            ("G3 X0 Y10 I-10 J0", "G3 X0 Y10 R10"),
            ("G2 X0 Y10 I-10 J0", "G2 X0 Y10 R-10"),
            ("G3 X0 Y10 I0 J10", "G3 X0 Y10 R-10"),
            ("G2 X0 Y10 I0 J10", "G2 X0 Y10 R10"),
            ("G90.1 G3 X0 Y10 I0 J0", "G3 X0 Y10 R10"),
        ] {
            let of = |arc: &str| read(&format!("{head}{arc}")).unwrap().motions[2];
            let (a, b) = (of(by_center), of(by_radius));
            let (MotionKind::Arc { center: p, turn: s, .. }, MotionKind::Arc { center: q, turn: t, .. }) =
                (a.kind, b.kind)
            else {
                panic!("{by_center}: not arcs")
            };
            assert!((p - q).norm() < 1e-12 && s == t, "{by_center}: {p} and {q}");
        }
    }

    #[test]
    fn helices_and_full_circles() {
        let program = read("G21 G90 G17 G94 F100\nG0 Z1\nX10 Y0\nG2 X10 Y0 Z-2 I-5 J0").unwrap();
        let helix = program.motions[2];
        assert_eq!(helix.kind, MotionKind::Arc { center: Point::new(5.0, 0.0), turn: Turn::Right, feed: 100.0 });
        assert!((helix.length() - (10.0 * std::f64::consts::PI).hypot(3.0)).abs() < 1e-12);
    }

    #[test]
    fn arcs_of_other_planes_become_lines() {
        // A half circle in XZ from (10, 0) over the top to (-10, 0): G18 turns from Z to X, so G2 goes from +X up.
        let program = read("G21 G90 G94 F100\nG0 Z0\nX10 Y3\nG18 G3 X-10 Z0 I-10 K0").unwrap();
        let arc = &program.motions[2..];
        assert!(arc.len() > 100);
        for m in arc {
            assert!((m.to.x.hypot(m.to.z) - 10.0).abs() < 1e-9 && m.to.y == 3.0, "{m:?}");
        }
        let length: f64 = arc.iter().map(|m| m.length()).sum();
        assert!((length - 10.0 * std::f64::consts::PI).abs() < 1e-3);
    }

    #[test]
    fn inverse_time_is_a_feed_for_its_length() {
        let program = read("G21 G90 G17 G93\nG0 Z1\nX0 Y0\nG1 X30 F2").unwrap();
        assert_eq!(program.motions[2].kind, MotionKind::Feed { feed: 60.0 });
    }

    #[test]
    fn tools_are_changed_by_m6_or_by_t_where_there_is_none() {
        let tools = |text: &str| read(text).unwrap().motions.iter().map(|m| m.tool).collect::<Vec<_>>();
        assert_eq!(tools("G21 G90\nG0 Z5\nT1\nG0 X1\nT2\nG0 X2"), [0, 1, 2]);
        // T3 is made ready while T2 still cuts.
        assert_eq!(tools("G21 G90\nG0 Z5\nT2 M6\nG0 X1\nT3\nG0 X2\nM6\nG0 X3"), [0, 2, 2, 3]);
        // What is in the spindle before the first change, T does not say.
        assert_eq!(tools("G21 G90\nT1\nG0 Z5\nM6 T2\nG0 X1"), [0, 2]);
        assert_eq!(tools("G21 G90\nT70001\nG0 Z5"), [70001]);
    }

    #[test]
    fn motions_know_the_spindle_speed() {
        let program = read("G21 G90\nG0 Z5\nM3 S900\nG0 X1\nS1200\nG0 X2\nM5\nG0 X3").unwrap();
        let found: Vec<_> = program.motions.iter().map(|m| (m.spindle_on, m.spindle_speed)).collect();
        assert_eq!(found, [(false, 0.0), (true, 900.0), (true, 1200.0), (false, 1200.0)]);
    }

    #[test]
    fn an_unclosed_comment_swallows_no_line() {
        assert_eq!(ends("G21 G90 (tool\nG0 Z5 (up)\nX1").len(), 2);
    }

    #[test]
    fn numbers_keep_more_digits_than_single_precision() {
        assert_eq!(ends("G21 G90\nG0 Z1234.5678901")[0].z, 1_234.567_890_1);
    }

    #[test]
    fn times_are_those_of_the_dialect() {
        let wait = |line: &str, dialect: &str| {
            let program = read_as(&format!("G21 G90\nM3 S100\n{line}"), Dialect::named(dialect).unwrap()).unwrap();
            match program.motions.as_slice() {
                [one] => one.kind,
                _ => panic!("{line}: {program:?}"),
            }
        };
        let seconds = |seconds| MotionKind::Dwell { seconds };
        assert_eq!(wait("G4 P3", "grbl"), seconds(3.0));
        assert_eq!(wait("G4 P3000", "marlin"), seconds(3.0));
        assert_eq!(wait("G4 S3", "marlin"), seconds(3.0));
        assert_eq!(wait("G4 S3", "smoothieware"), seconds(3.0));
        let header = "(clopen 0.1.0)\n(dialect marlin)\nG21 G90\nG4 P500\n";
        assert_eq!(read(header).unwrap().motions[0].kind, seconds(0.5));
        assert_eq!(read(&header.replace("marlin", "grbl")).unwrap().motions[0].kind, seconds(500.0));
    }

    #[test]
    fn what_cannot_be_followed_is_refused_with_its_line() {
        for text in ["G0 Z1\nG1 X#1 F5", "G0 Z1\nG41 D1", "G0 Z1\nG85 X1 Z-1 R1", "G0 Z1\nX1 X2", "G0 Z1\nG2 X5 Y5"] {
            let error = read(text).unwrap_err();
            assert_eq!(error.0.line, 2, "{text}: {error}");
        }
    }
}

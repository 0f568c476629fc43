//! Operations of a job, judged by their programs as they are read back.

use clopen::cam::{
    self, Geometry, Notice, Planned, Program, Remainder, Setup, SetupFile, deepest_cut, plan_operation, statistics,
};
use clopen::gcode;
use clopen::plane::Point;
use clopen::units::DrawingScale;

const SCALE: DrawingScale = DrawingScale { mm_per_unit: Some(1.0), diagonal: 100.0 };

const TOOLS: &str = "version = 1\n[stock]\nthickness = 6\n[[tool]]\nnumber = 1\nname = \"mill\"\ndiameter = 3\n\
                     [[tool]]\nnumber = 2\nname = \"v\"\ntype = \"v\"\nangle = 90\ndiameter = 10\n\
                     [[tool]]\nnumber = 3\nname = \"drill\"\ntype = \"drill\"\ndiameter = 2\n";

fn setup(operations: &str) -> Setup {
    let file: SetupFile = format!("{TOOLS}{operations}").parse().unwrap();
    file.resolve(&Default::default(), &SCALE).unwrap_or_else(|e| panic!("{e}"))
}

fn geometry(svg: &str) -> Geometry {
    let svg = format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="100mm" viewBox="0 0 100 100">{svg}</svg>"#
    );
    let drawing = clopen::io::svg::read(svg.as_bytes(), &Default::default()).unwrap();
    Geometry { area: drawing.region, ..Geometry::default() }
}

fn read_back(planned: &Planned) -> Program {
    let text = gcode::write(&planned.toolpath, &[], &gcode::GRBL, Default::default()).unwrap();
    gcode::read(&text).unwrap()
}

/// The plan of the only operation, its program, and how deep that cuts into what must remain.
fn run(operations: &str, geometry: &Geometry) -> (Planned, Program) {
    let setup = setup(operations);
    let planned = plan_operation(&setup, &setup.operations[0], geometry).unwrap_or_else(|e| panic!("{e}"));
    let program = read_back(&planned);
    let carves = matches!(setup.operations[0].kind, cam::OperationKind::VCarve { .. });
    if let Some(keep) = planned.keep.as_ref().filter(|_| !carves) {
        let gouge = deepest_cut(&program, &keep.part, keep.remainder, keep.distance, 0.0);
        assert!(gouge.is_none_or(|g| g.depth_mm <= 0.002), "{gouge:?}");
    }
    if let Some(keep) = planned.keep.as_ref().filter(|_| carves) {
        let tool = setup.tool_of(&setup.operations[0]);
        let gouge = cam::deepest_carving(&program, &keep.part, tool, 0.0);
        assert!(gouge.is_some_and(|g| g.depth_mm <= 0.002), "{gouge:?}");
    }
    (planned, program)
}

const PLATE: &str = r#"<path fill-rule="evenodd" d="M10 10H70V50H10ZM30 30A6 6 0 1 0 18 30A6 6 0 1 0 30 30Z"/>"#;

#[test]
fn a_profile_has_all_its_tabs_and_the_tool_goes_over_them() {
    let (planned, program) = run(
        "[[operation]]\nkind = \"profile\"\ntool = 1\nthrough = true\ntabs = { count = 3, width = 5, height = 2 }\n",
        &geometry(PLATE),
    );
    // Three on the outline and three in the hole; the hole's stand on a tight arc for want of better places, or not at all.
    assert!(planned.tabs.len() >= 3, "{:?}", planned.notices);
    for tab in &planned.tabs {
        let low =
            program.motions.iter().filter(|m| m.is_feed()).filter(|m| {
                m.trace().any(|s| s.nearest(tab.at).distance < 1.0) && m.from.z.min(m.to.z) < tab.top - 1e-3
            });
        assert_eq!(low.count(), 0, "{tab:?}");
    }
    let floor = program.motions.iter().map(cam::Motion::lowest).fold(0.0, f64::min);
    assert!((floor + 6.2).abs() < 1e-9);
}

#[test]
fn an_onion_skin_is_cut_last_and_a_finishing_pass_goes_along_the_walls() {
    let (_, program) = run(
        "[[operation]]\nkind = \"profile\"\ntool = 1\nthrough = true\nonion-skin = 0.3\nallowance = 0.4\n",
        &geometry(PLATE),
    );
    let first_below = program.motions.iter().position(|m| m.lowest() < -6.0).unwrap();
    let below: Vec<_> = program.motions[first_below..].iter().filter(|m| m.is_feed()).collect();
    // Nothing above the skin is cut after the first cut through it, but going down to it.
    assert!(below.iter().all(|m| m.trace().next().is_none() || m.to.z <= -5.9 + 1e-9), "{below:?}");
}

#[test]
fn leads_come_and_go_in_the_waste_and_are_left_out_with_a_word_where_there_is_no_room() {
    let lead = "[[operation]]\nkind = \"profile\"\ntool = 1\ndepth = 2\nentry = \"plunge\"\nlead = 3\n";
    let (planned, program) = run(lead, &geometry(PLATE));
    assert!(planned.notices.is_empty(), "{:?}", planned.notices);
    let plunges = program.motions.iter().filter(|m| m.is_feed() && m.trace().next().is_none());
    let index = clopen::plane::BoundaryIndex::new(&geometry(PLATE).area);
    for plunge in plunges {
        let distance = index.distance(plunge.to.xy());
        assert!(distance > 1.6, "it goes down beside the path: {distance}");
    }
    // A hole hardly wider than the tool.
    let tight = r#"<path fill-rule="evenodd" d="M10 10H70V50H10ZM30 30A1.6 1.6 0 1 0 26.8 30A1.6 1.6 0 1 0 30 30Z"/>"#;
    let (planned, _) = run(&format!("{lead}path-radius = 0\n"), &geometry(tight));
    assert!(
        planned
            .notices
            .iter()
            .any(|n| matches!(n, Notice::LeadSkipped(p) if (p - Point::new(28.4, -30.0)).norm() < 1.0))
    );
}

#[test]
fn a_helix_goes_down_beside_the_path() {
    let (planned, program) =
        run("[[operation]]\nkind = \"profile\"\ntool = 1\ndepth = 2\nentry = \"helix\"\n", &geometry(PLATE));
    assert!(planned.notices.is_empty(), "{:?}", planned.notices);
    let spirals = program.motions.iter().filter(|m| matches!(m.kind, cam::MotionKind::Arc { .. }) && m.from.z > m.to.z);
    assert!(spirals.count() > 10);
}

#[test]
fn pockets_leave_no_islands_whatever_their_shape() {
    let shapes = [
        r#"<rect x="10" y="10" width="60" height="33"/>"#,
        PLATE,
        // Sharp corners, where rings lie far apart.
        r#"<path d="M10 10L90 18L10 26Z"/>"#,
        r#"<path d="M10 50L50 10L55 45L90 50L55 55L50 90L45 55Z"/>"#,
        // Two chambers and a waist that is narrower than twice the path radius.
        r#"<path d="M10 10H40V24H60V10H90V50H60V30H40V50H10Z"/>"#,
        r#"<circle cx="50" cy="50" r="20"/>"#,
    ];
    for pattern in ["rings", "raster"] {
        for shape in shapes {
            let job = format!(
                "[[operation]]\nkind = \"pocket\"\ntool = 1\ndepth = 1\npattern = \"{pattern}\"\npath-radius = 1\nstepover = \"45%\"\n"
            );
            let (planned, program) = run(&job, &geometry(shape));
            let keep = planned.keep.unwrap();
            assert_eq!(keep.remainder, Remainder::Outside);
            let islands = cam::islands(&program, &keep.kept, 1.5, keep.floor);
            assert!(islands.is_empty(), "{pattern} {shape}: {islands:?}");
        }
    }
}

#[test]
fn drills_peck_and_larger_holes_are_bored() {
    let holes = r#"<circle cx="20" cy="20" r="1"/><circle cx="40" cy="20" r="1"/>"#;
    let (planned, program) = run("[[operation]]\nkind = \"drill\"\ntool = 3\ndepth = 6\npeck = 2\n", &geometry(holes));
    assert_eq!(planned.holes.len(), 2);
    let bottoms: Vec<f64> = program.motions.iter().filter(|m| m.is_feed()).map(|m| m.to.z).collect();
    assert_eq!(bottoms, [-2.0, -4.0, -6.0, -2.0, -4.0, -6.0]);
    let wide = r#"<circle cx="20" cy="20" r="4"/><circle cx="50" cy="50" r="10"/>"#;
    let (planned, program) = run("[[operation]]\nkind = \"drill\"\ntool = 1\ndepth = 4\n", &geometry(wide));
    let keep = planned.keep.unwrap();
    assert!(cam::islands(&program, &keep.kept, 1.5, keep.floor).is_empty());
    assert!(statistics(&program, 0.0).arcs > 20);
}

#[test]
fn a_chamfer_is_cut_by_the_side_of_the_cone() {
    let (planned, program) = run("[[operation]]\nkind = \"chamfer\"\ntool = 2\nwidth = 1\n", &geometry(PLATE));
    let keep = planned.keep.unwrap();
    // 45 degrees: as deep as it is wide, and the tip hangs a tenth of the diameter deeper.
    assert!((keep.floor + 2.0).abs() < 1e-9 && (keep.distance - 1.0).abs() < 1e-9);
    assert!((statistics(&program, 0.0).depth_mm - 2.0).abs() < 1e-9);
}

#[test]
fn passes_are_even_or_stepped_and_the_last_one_as_thin_as_asked() {
    let heights = |more: &str| {
        let setup =
            setup(&format!("[[operation]]\nkind = \"profile\"\ntool = 1\ndepth = 5\ndepth-per-pass = 2\n{more}"));
        setup.operations[0].cutting.pass_heights(0.0)
    };
    let even = heights("");
    assert!(even.len() == 3 && (even[0] + 5.0 / 3.0).abs() < 1e-12 && even[2] == -5.0, "{even:?}");
    assert_eq!(heights("passes = \"stepped\"\n"), [-2.0, -4.0, -5.0]);
    assert_eq!(heights("passes = \"stepped\"\nfinal-pass = 0.5\n"), [-2.0, -4.0, -4.5, -5.0]);
}

#[test]
fn every_impossible_value_is_told_with_its_line_and_the_nearest_name() {
    let problems = |text: &str| -> String {
        match text.parse::<SetupFile>() {
            Err(e) => e.to_string(),
            Ok(file) => {
                file.resolve(&Default::default(), &SCALE).map(|_| String::new()).unwrap_or_else(|e| e.to_string())
            }
        }
    };
    let job = |more: &str| format!("{TOOLS}[[operation]]\nkind = \"profile\"\ntool = 1\n{more}");
    let line = TOOLS.lines().count() + 4;
    for (text, expected) in [
        (job("dept = 3"), format!("line {line}: there is no key \"dept\" here; did you mean \"depth\"?")),
        (job("depth = -3"), format!("line {line}: depth is -3 mm: it must be above zero")),
        (job("depth = 3\ntabs = { count = 2, height = 4 }"), format!("line {}: tabs of 4 mm are higher", line + 1)),
        (job("depth = 3\nside = \"left\""), format!("line {}", line + 1)),
        (job("depth = 3\npasses = \"stepd\""), "did you mean \"stepped\"?".into()),
        (job("depth = 30"), format!("line {line}: depth is 30 mm, and the stock is")),
        (job(""), "this operation needs a depth, or through = true".into()),
        (format!("{TOOLS}[[operation]]\nkind = \"profil\"\ntool = 1\ndepth = 1"), "did you mean \"profile\"?".into()),
        (
            format!("{TOOLS}[[operation]]\nkind = \"profile\"\ntool = \"mil\"\ndepth = 1"),
            "did you mean \"mill\"?".into(),
        ),
        (format!("{TOOLS}[[operation]]\nkind = \"profile\"\ntool = 7\ndepth = 1"), "there is no tool 7".into()),
        (format!("{TOOLS}[[operation]]\nkind = \"v-carve\"\ntool = 1"), "is no cone".into()),
        (TOOLS.replace("version = 1", "version = 2"), "line 1: version 2".into()),
        (TOOLS.to_owned(), "there is no [[operation]]".into()),
        (
            format!("{}[[keepout]]\nx = [0, 5]\ny = [0, 5]\n[[keepout]]\nx = [4, 9]\ny = [4, 9]\n", job("depth = 1\n")),
            "this keepout overlaps that of line".into(),
        ),
        (
            TOOLS.replace("diameter = 3\n", "diameter = 3\nflute-length = 1\n")
                + "[[operation]]\nkind = \"pocket\"\ntool = 1\ndepth = 5\ndepth-per-pass = 2",
            "deeper than the flutes".into(),
        ),
    ] {
        let told = problems(&text);
        assert!(told.contains(&expected), "expected {expected}\nin {told}\nfor {text}");
    }
}

/// Whether some cut at the floor passes within `radius` of `p`.
fn is_cut(program: &Program, p: Point, radius: f64, floor: f64) -> bool {
    let at_floor = program.motions.iter().filter(|m| m.is_feed() && m.from.z <= floor + 1e-3 && m.to.z <= floor + 1e-3);
    at_floor.flat_map(|m| m.trace()).any(|s| s.nearest(p).distance <= radius)
}

#[test]
fn the_rest_of_a_larger_tool_is_cut_and_little_else() {
    let square = geometry(r#"<rect x="10" y="10" width="40" height="40"/>"#);
    let jobs = "[[tool]]\nnumber = 4\ndiameter = 8\n[[operation]]\nkind = \"pocket\"\ntool = 4\ndepth = 1\npath-radius = 0\n\
                [[operation]]\nkind = \"pocket\"\ntool = 1\ndepth = 1\npath-radius = 0\n";
    let setup_of = |rest: &str| setup(&format!("{jobs}{rest}"));
    let rest = setup_of("rest-of = 4\n");
    let length = |setup: &Setup| {
        let planned = plan_operation(setup, &setup.operations[1], &square).unwrap();
        statistics(&read_back(&planned), 0.0).cut_length_mm
    };
    let whole = length(&setup_of(""));
    assert!(length(&rest) < 0.1 * whole, "{} of {whole}", length(&rest));
    // In every corner the larger tool leaves what lies beyond its circle: the smaller one gets there.
    let program = read_back(&plan_operation(&rest, &rest.operations[1], &square).unwrap());
    for (x, y) in [(10.5, -10.5), (49.5, -10.5), (49.5, -49.5), (10.5, -49.5)] {
        assert!(is_cut(&program, Point::new(x, y), 1.5, -1.0), "({x}, {y})");
    }
    assert!(!is_cut(&program, Point::new(30.0, -30.0), 1.5, -1.0));
}

#[test]
fn dogbones_and_t_bones_reach_into_the_corners_and_round_ones_do_not() {
    let square = geometry(r#"<rect x="10" y="10" width="30" height="20"/>"#);
    for kind in ["pocket", "profile"] {
        let job = |corners: &str| {
            let side = if kind == "profile" { "side = \"inside\"\n" } else { "" };
            format!(
                "[[operation]]\nkind = \"{kind}\"\ntool = 1\ndepth = 1\npath-radius = 0.4\ncorners = \"{corners}\"\n{side}"
            )
        };
        for (corners, reached) in [("round", false), ("dogbone", true), ("t-bone", true)] {
            let (_, program) = run(&job(corners), &square);
            for (x, y) in [(10.0, -10.0), (40.0, -10.0), (40.0, -30.0), (10.0, -30.0)] {
                assert_eq!(is_cut(&program, Point::new(x, y), 1.5, -1.0), reached, "{kind} {corners} ({x}, {y})");
            }
        }
    }
}

#[test]
fn facing_leaves_nothing_of_the_top() {
    let text = TOOLS.replace("thickness = 6\n", "thickness = 6\nwidth = 50\nheight = 20\n");
    let file: SetupFile = format!("{text}[[operation]]\nkind = \"facing\"\ntool = 1\ndepth = 0.5\n").parse().unwrap();
    let setup = file.resolve(&Default::default(), &SCALE).unwrap();
    let planned = plan_operation(&setup, &setup.operations[0], &Geometry::default()).unwrap();
    let program = read_back(&planned);
    for k in 0..=50 {
        for j in 0..=20 {
            assert!(is_cut(&program, Point::new(f64::from(k), f64::from(j)), 1.5, -0.5), "({k}, {j})");
        }
    }
    // It goes down beside the stock.
    let plunge = program.motions.iter().find(|m| m.is_feed() && m.to.z < 0.0).unwrap();
    assert!(plunge.to.x < -1.5);
}

#[test]
fn lines_are_followed_to_and_fro() {
    let line = cam::CutLine {
        ring: clopen::plane::Ring::polygon([Point::new(0.0, 0.0), Point::new(30.0, 0.0), Point::new(30.0, 10.0)]),
        is_closed: false,
    };
    let geometry = Geometry { lines: vec![line], ..Geometry::default() };
    let (_, program) = run("[[operation]]\nkind = \"engrave\"\ntool = 1\ndepth = 2\ndepth-per-pass = 1\n", &geometry);
    let cut: f64 =
        program.motions.iter().filter(|m| m.is_feed() && m.trace().next().is_some()).map(|m| m.length()).sum();
    assert!((cut - 80.0).abs() < 1e-9, "{cut}");
    assert!(!is_cut(&program, Point::new(15.0, 5.0), 3.0, -1.0), "the way back to the start is no part of the line");
}

#[test]
fn carving_is_as_deep_as_the_shape_is_wide() {
    let slot = geometry(r#"<rect x="10" y="10" width="40" height="4"/>"#);
    let (_, program) = run("[[operation]]\nkind = \"v-carve\"\ntool = 2\n", &slot);
    // 90 degrees: half as deep as wide.
    let deepest = program.motions.iter().map(cam::Motion::lowest).fold(0.0, f64::min);
    assert!((deepest + 2.0).abs() < 2e-3, "{deepest}");
    let (planned, program) = run("[[operation]]\nkind = \"v-carve\"\ntool = 2\nmax-depth = 1\n", &slot);
    assert!(planned.notices.iter().any(|n| matches!(n, Notice::BottomCleared(_))));
    let deepest = program.motions.iter().map(cam::Motion::lowest).fold(0.0, f64::min);
    assert!((deepest + 1.0).abs() < 2e-3, "{deepest}");
    assert!(is_cut(&program, Point::new(30.0, -12.0), 0.5, -1.0));
}

#[test]
fn the_tool_goes_down_in_a_hole_that_was_drilled() {
    let hole = cam::Hole { center: Point::new(24.0, -30.0), diameter: 4.0, bottom: -6.2, full_bottom: -6.2 };
    let geometry = Geometry { holes: vec![hole], ..geometry(PLATE) };
    let (planned, program) =
        run("[[operation]]\nkind = \"profile\"\ntool = 1\nthrough = true\nentry = \"predrilled\"\n", &geometry);
    let plunges = program.motions.iter().filter(|m| m.is_feed() && m.trace().next().is_none() && m.to.z < -6.0);
    assert!(plunges.clone().any(|m| (m.to.xy() - hole.center).norm() < 1e-9));
    // The outline lies on the other side of the wall: it is told that no hole leads there.
    assert!(planned.notices.iter().any(|n| matches!(n, Notice::NoHole(_))));
}

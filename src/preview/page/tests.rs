use super::*;
use crate::gcode::read;
use crate::plane::Ring;

const TEXT: &str =
    "G21 G90 G17 G94\nG0 Z5\nM3 S1000\nG4 P2\nG0 X10 Y0\nG1 Z-1 F100\nG3 X10 Y0 I-10 J0 F600\nG1 X0\nG0 Z5\nM5\nM2\n";

fn shown<'a>(program: &'a Program, difference: Difference) -> Page<'a> {
    Page {
        title: "part".into(),
        is_good: true,
        failures: vec![],
        facts: vec![("tool".into(), "</dd><script>alert(1)</script>".into())],
        operations: vec![],
        differences: vec![difference],
        saved: None,
        seconds: 1.0,
        findings: vec![],
        warnings: vec!["<img src=x>".into()],
        programs: vec![PageProgram {
            name: "\"><b>".into(),
            program,
            machine: Machine::default(),
            tools: vec![PageTool::new(0, &Tool { name: "</script>".into(), ..Tool::flat(1, 2.0) })],
            picture: Some(b"foob".to_vec()),
        }],
        outlines: vec![Outline { region: Region::new(vec![Ring::circle(Point::origin(), 9.0)]), remains: true }],
        stock_top: 0.0,
    }
}

fn difference() -> Difference {
    let word = || "<u>".to_owned();
    let places = vec![Point::new(1.0, f64::NAN)];
    Difference { operation: word(), feature: word(), places, amount: word(), why: word(), gain: word() }
}

#[test]
fn motions_carry_their_ends_and_arcs_their_sweep() {
    let program = read(TEXT).unwrap();
    let html = page(&shown(&program, difference()));
    let data = html.split("id=\"work\">").nth(1).unwrap().split("</script>").next().unwrap();
    let data: serde_json::Value = serde_json::from_str(data).unwrap();
    let motions = data["motions"].as_array().unwrap();
    let arc = motions.iter().find(|m| m[2] == 2).unwrap();
    assert_eq!((arc[1].as_u64(), arc[6].as_f64(), arc[7].as_f64()), (Some(7), Some(0.0), Some(0.0)));
    let turn = arc[8].as_f64().unwrap();
    assert!((turn - std::f64::consts::TAU).abs() < 1e-6, "a full circle to the left: {turn}");
    let ends: Vec<f64> = motions.iter().map(|m| m[0].as_f64().unwrap()).collect();
    assert!(ends.is_sorted() && *ends.last().unwrap() > 2.0, "{ends:?}");
    // What the tool sweeps must be seen: the path of radius 10, and the tool's 1 mm around it.
    assert_eq!(data["box"], serde_json::json!([-11, -11, 11, 11]));
    assert_eq!(data["depth"], 1);
    assert_eq!(data["marks"], serde_json::json!([[1, 1, 0]]));
}

#[test]
fn programs_run_one_after_the_other() {
    let program = read(TEXT).unwrap();
    let mut two = shown(&program, difference());
    two.programs.push(PageProgram { name: "second".into(), ..two.programs[0].clone() });
    let html = page(&two);
    let data = html.split("id=\"work\">").nth(1).unwrap().split("</script>").next().unwrap();
    let data: serde_json::Value = serde_json::from_str(data).unwrap();
    let motions = data["motions"].as_array().unwrap();
    let half = motions.len() / 2;
    assert_eq!(data["programs"], serde_json::json!([[0, "\"><b>"], [half, "second"]]));
    assert_eq!(data["changes"], serde_json::json!([[0, 0], [half, 1]]));
    let end = |k: usize| motions[k][0].as_f64().unwrap();
    assert!((end(2 * half - 1) - 2.0 * end(half - 1)).abs() < 1e-3);
    assert!(html.contains("<option value=\"1\">second</option>"));
}

#[test]
fn words_never_become_markup() {
    let program = read(TEXT).unwrap();
    let html = page(&shown(&program, difference()));
    for markup in ["<u>", "<b>", "<script>alert", "<img src=x", "name\":\"</"] {
        assert!(!html.contains(markup), "{markup}");
    }
    assert_eq!(html.matches("</script>").count(), 3, "the data's and the scripts' own");
    assert!(html.contains("src=\"data:image/png;base64,Zm9vYg==\""));
}

#[test]
fn a_page_without_motions_is_no_panic() {
    let html = page(&shown(&Program::default(), difference()));
    assert!(html.contains("\"motions\":[]") && html.ends_with("</html>\n"));
}

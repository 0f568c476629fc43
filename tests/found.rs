//! Faults that random shapes have found, each reduced to the smallest shape that shows it: none may come back.

mod laws;

use clopen::plane::{Arc, Joint, Link, Point, Region, Ring, Turn, Vertex};
use clopen::reference::{self, Operation};
use clopen::rolling::{self, Topology};

fn line(x: f64, y: f64) -> Vertex {
    Vertex::corner(Point::new(x, y))
}

fn arc(x: f64, y: f64, center_x: f64, center_y: f64, radius: f64, turn: Turn) -> Vertex {
    let link = Link::Arc(Arc { center: Point::new(center_x, center_y), radius, turn });
    Vertex { point: Point::new(x, y), link, joint: Joint::Corner, id: None }
}

/// Every law that needs nothing but the result, in both meanings; and the reference.
fn obeys(input: &Region, r: f64, operation: Operation) {
    assert_eq!(laws::crossing(input, r), None, "the input itself is sound");
    let run = if operation == Operation::Close { rolling::close } else { rolling::open };
    let merged = run(input, laws::radius(r), Topology::Merge);
    let kept = run(input, laws::radius(r), Topology::Keep);
    let far = input.bounds().max.coords.amax().max(input.bounds().min.coords.amax());
    for (mode, outcome) in [("merge", &merged), ("keep", &kept)] {
        assert!(laws::is_finite(&outcome.region), "{mode}");
        let (violation, place) = laws::containment(input, &outcome.region, operation, r);
        assert!(violation <= 1e-9 * r + 1e-15 * far, "{mode}: containment fails by {} r at {place}", violation / r);
    }
    assert_eq!(laws::crossing(&merged.region, r), None);
    let reference = reference::closing(input, laws::radius(r), operation).unwrap();
    let (distance, place) = laws::hausdorff(&merged.region, &reference.region, r);
    assert!(distance <= laws::ACCURACY * r, "{} r from the reference at {place}", distance / r);
    if kept.differences.is_empty() {
        let (distance, place) = laws::hausdorff(&merged.region, &kept.region, r);
        assert!(distance <= laws::ACCURACY * r, "keep is {} r from merge at {place}", distance / r);
    }
    assert_eq!(merged.contradictions, 0);
}

/// Campaign, shape 27.
#[test]
fn two_convex_arcs_and_lines_between_them() {
    let input = Region::new(vec![Ring {
        vertices: vec![
            line(-0.6522451597134119, 15.089446782737888),
            arc(
                -33.81713350815032,
                6.0553761555018495,
                -23.70686816310449,
                13.61434326948482,
                12.623606821250043,
                Turn::Left,
            ),
            line(-16.147901049121522, 3.504077924438995),
            arc(
                -14.288583465426681,
                4.894201723364458,
                -13.051832445545433,
                17.45707942285407,
                12.623606821250043,
                Turn::Left,
            ),
        ],
    }]);
    obeys(&input, 8.03139074265821, Operation::Close);
}

/// Campaign, shape 144.
#[test]
fn a_notch_beside_a_concave_arc_opens_without_adding_material() {
    let input = Region::new(vec![Ring {
        vertices: vec![
            line(-0.3698444826511731, 1.404531692551508),
            line(-0.7055152483217799, 0.43150761466547194),
            arc(
                -0.7063142180283495,
                0.4303472985831682,
                -0.9218703831001884,
                0.5375677987057801,
                0.240750277148378,
                Turn::Right,
            ),
            line(-0.7223943196612704, 0.40277167093523314),
            line(-0.7627568283884356, 0.3198133717242666),
            line(-0.2668867838972068, -0.9555848720026358),
        ],
    }]);
    obeys(&input, 0.1476865373612647, Operation::Open);
}

/// Campaign, shape 174.
#[test]
fn keeping_contains_convex_arcs_that_bulge_into_a_pocket() {
    let input = Region::new(vec![Ring {
        vertices: vec![
            arc(
                -2.336744626409678,
                -1.4300183440720207,
                -1.8506840858653648,
                -2.1840870880524235,
                0.8971479920962941,
                Turn::Left,
            ),
            line(-2.416718397284459, -2.8801328322522743),
            arc(
                -2.594093309040142,
                -3.1358781381302485,
                -1.8568978213652871,
                -3.6471680096065424,
                0.8971479920962941,
                Turn::Left,
            ),
            line(-2.254235227147616, -4.451529561204194),
        ],
    }]);
    obeys(&input, 1.0, Operation::Close);
}

/// Campaign, shape 352.
#[test]
fn two_convex_arcs_meet_in_a_pocket() {
    let input = Region::new(vec![Ring {
        vertices: vec![
            arc(
                0.7665897025529358,
                -0.5849973007878897,
                0.6346105642233522,
                -1.6719432954682638,
                1.0949292617817497,
                Turn::Left,
            ),
            arc(
                0.6576932413064411,
                -0.5772573686725435,
                -0.20098219466901587,
                -1.2566295670721295,
                1.0949292617817497,
                Turn::Left,
            ),
            line(-1.1242418157857097, -0.6680195430992222),
        ],
    }]);
    obeys(&input, 1.0, Operation::Close);
}

/// Campaign, shape 414.
#[test]
fn convex_arcs_far_away() {
    let input = Region::new(vec![Ring {
        vertices: vec![
            line(2097161.209010107, -2097155.8495608508),
            arc(
                2097155.8133215983,
                -2097149.2294596857,
                2097153.7101160977,
                -2097147.8350565203,
                2.5234566702779517,
                Turn::Left,
            ),
            line(2097152.6798678758, -2097145.5314892503),
            arc(
                2097152.702091005,
                -2097144.8427325794,
                2097150.1799468542,
                -2097144.7613541498,
                2.5234566702779517,
                Turn::Left,
            ),
            line(2097149.7268168163, -2097142.2789144756),
        ],
    }]);
    obeys(&input, 2.0, Operation::Close);
}

/// Campaign, shape 492.
#[test]
fn convex_arcs_smaller_than_the_disk() {
    let input = Region::new(vec![Ring {
        vertices: vec![
            arc(
                0.04148054059809157,
                0.21501644224783417,
                0.04948813101605723,
                0.17482474947918358,
                0.04098162602815433,
                Turn::Left,
            ),
            line(0.008845478511304582, 0.16956466684775867),
            arc(
                -0.02373059776513704,
                0.16422611162846185,
                -0.01710295232524173,
                0.12378395555544158,
                0.04098162602815433,
                Turn::Left,
            ),
            line(-0.057545108398262025, 0.11715631011554627),
            line(-0.04284703825283421, 0.007061612804336221),
        ],
    }]);
    obeys(&input, 0.0676650330393714, Operation::Close);
}

/// Campaign, shape 510.
#[test]
fn an_opening_beside_one_concave_arc() {
    let input = Region::new(vec![Ring {
        vertices: vec![
            line(37.92457942319882, 25.504269148468225),
            arc(
                5.647704527984553,
                39.18316409975274,
                4.459738502575194,
                50.49085787735558,
                11.369925322778728,
                Turn::Right,
            ),
            line(3.2547754915123472, 39.184962689997114),
            line(-23.990679586319136, 34.231107103347526),
            line(-30.80214912515961, -26.54145798865412),
        ],
    }]);
    obeys(&input, 17.387229314057535, Operation::Open);
}

/// Campaign, shape 533.
#[test]
fn a_convex_arc_smaller_than_the_disk() {
    let input = Region::new(vec![Ring {
        vertices: vec![
            line(8388591.921327519, -8388621.53236908),
            arc(
                8388590.765694878,
                -8388621.907856887,
                8388589.101141154,
                -8388624.56718196,
                3.1373155627945755,
                Turn::Left,
            ),
            line(8388586.708600773, -8388622.537773311),
            line(8388596.262085678, -8388638.799433839),
        ],
    }]);
    obeys(&input, 9.520201408024393, Operation::Close);
}

/// Campaign, shape 554.
#[test]
fn a_row_of_convex_arcs() {
    let input = Region::new(vec![Ring {
        vertices: vec![
            arc(
                1048574.7261826732,
                -1048574.7261826732,
                1048575.701516002,
                -1048575.4653318282,
                1.2237714555662205,
                Turn::Left,
            ),
            arc(
                1048574.8215318127,
                -1048576.315769599,
                1048575.4126848718,
                -1048577.3872893779,
                1.2237714555662205,
                Turn::Left,
            ),
            arc(
                1048574.2453525915,
                -1048577.7546474086,
                1048575.4533438843,
                -1048577.558755571,
                1.2237714555662205,
                Turn::Left,
            ),
            arc(
                1048575.2586025707,
                -1048578.7669328745,
                1048576.32534483,
                -1048578.1672016617,
                1.2237714555662205,
                Turn::Left,
            ),
            arc(
                1048576.8738296176,
                -1048579.2611765303,
                1048577.5946487356,
                -1048578.2722193145,
                1.2237714555662205,
                Turn::Left,
            ),
            arc(
                1048578.7296958007,
                -1048578.7296958007,
                1048578.32058106,
                -1048577.5763347538,
                1.2237714555662205,
                Turn::Left,
            ),
            arc(
                1048579.3364769518,
                -1048576.8940063047,
                1048578.8856223898,
                -1048575.7563126995,
                1.2237714555662205,
                Turn::Left,
            ),
            arc(
                1048579.827123836,
                -1048574.9745252589,
                1048579.1494253683,
                -1048573.9555348945,
                1.2237714555662205,
                Turn::Left,
            ),
            line(1048580.1412662962, -1048573.2386889214),
            arc(
                1048574.7301908784,
                -1048574.6740928087,
                1048575.9480732774,
                -1048574.7940054334,
                1.2237714555662205,
                Turn::Left,
            ),
        ],
    }]);
    obeys(&input, 1.0, Operation::Close);
}

/// Campaign, shape 584.
#[test]
fn a_row_of_concave_arcs_opened() {
    let input = Region::new(vec![Ring {
        vertices: vec![
            arc(
                -0.007505109401137756,
                -0.026468185523914684,
                -0.003196404247445897,
                -0.027890910498028342,
                0.004537519857082445,
                Turn::Right,
            ),
            arc(
                -4.531867594784171e-18,
                -0.02467033813580337,
                0.003963837237816835,
                -0.02687874951177345,
                0.004537519857082445,
                Turn::Right,
            ),
            arc(
                0.006868815606568849,
                -0.023393037657574885,
                0.010793642683170747,
                -0.0256700573922698,
                0.004537519857082445,
                Turn::Right,
            ),
            line(0.014558633836494665, -0.023137483983894414),
            line(0.02266672431735328, 0.002720273751182946),
            arc(
                0.026012205727853076,
                0.003739990562596989,
                0.028588095320795814,
                0.007475479721781736,
                0.004537519857082445,
                Turn::Right,
            ),
            line(0.026524806552423473, 0.011516757479091425),
            line(0.008609912996559346, 0.028842497491381895),
        ],
    }]);
    obeys(&input, 0.00390625, Operation::Open);
}
/// Campaign, shape 1716.
#[test]
fn concave_arcs_of_a_comb_opened() {
    let input = Region::new(vec![Ring {
        vertices: vec![
            line(-0.009094689367038463, 0.044160054669504505),
            line(-0.31620383773057353, -0.2527861668607786),
            arc(
                -0.272043783061069,
                -0.2436914774937401,
                -0.2138378658225798,
                -0.24691827637441577,
                0.05829529168457936,
                Turn::Right,
            ),
            line(-0.16164364638730777, -0.22095475407614396),
            arc(
                -0.11748359171780326,
                -0.21186006470910548,
                -0.05927767447931404,
                -0.21508686358978116,
                0.05829529168457936,
                Turn::Right,
            ),
            line(-0.007083455044042015, -0.18912334129150932),
        ],
    }]);
    obeys(&input, 0.04508684734040016, Operation::Open);
}

/// Campaign, shape 1767.
#[test]
fn keeping_contains_a_convex_arc_far_away() {
    let input = Region::new(vec![Ring {
        vertices: vec![
            line(16383.994595885326, -16383.994381607181),
            arc(
                16383.987214107015,
                -16384.014790094316,
                16383.986917107708,
                -16384.006672495238,
                0.008123030428074619,
                Turn::Left,
            ),
            line(16383.995034706784, -16384.00637549593),
            arc(
                16383.995020905704,
                -16384.005998284196,
                16383.989137538567,
                -16384.000397425825,
                0.008123030428074619,
                Turn::Left,
            ),
        ],
    }]);
    obeys(&input, 0.012154784582925371, Operation::Close);
}

/// Campaign, shape 3782.
#[test]
fn an_opening_is_not_filled_too_deep_beside_an_arc() {
    let input = Region::new(vec![Ring {
        vertices: vec![
            line(1.764409981673116, -5.586168264833488),
            line(7.878333314797263, -1.8516611722980711),
            line(3.2501646266580804, 5.93214909821879),
            line(0.5391133027826532, 1.6437144999675806),
            arc(
                0.5084228552818942,
                1.2529035399469546,
                -0.2068638630185961,
                0.9416390822699817,
                0.7800773371852467,
                Turn::Right,
            ),
            line(0.4837614411292419, 0.5789307404018476),
            line(0.20534840441762237, -0.27793647922047326),
        ],
    }]);
    obeys(&input, 2.427954507829296, Operation::Open);
}

/// Campaign, shape 4403.
#[test]
fn a_triangular_plate_with_an_arc_in_its_hole_opened() {
    let input = Region::new(vec![
        Ring {
            vertices: vec![
                line(2097151.3498190264, -2097144.831647864),
                line(2097147.6415091457, -2097158.5117554674),
                line(2097156.8752695494, -2097158.536981551),
            ],
        },
        Ring {
            vertices: vec![
                line(2097153.8035183405, -2097154.0639482667),
                arc(
                    2097153.7940482884,
                    -2097154.0725068566,
                    2097152.9747193935,
                    -2097153.1659221128,
                    1.22196388493474,
                    Turn::Right,
                ),
                line(2097153.360415015, -2097154.3254196867),
            ],
        },
    ]);
    obeys(&input, 2.602895057403798, Operation::Open);
}

/// Campaign, shape 4846.
#[test]
fn teeth_with_concave_arcs_that_vanish() {
    let input = Region::new(vec![Ring {
        vertices: vec![
            line(0.0, -0.0078125),
            line(0.14453125, -0.0078125),
            arc(0.13671875, 0.018545720263935753, 0.126953125, 0.02334519635376754, 0.010881286797869635, Turn::Right),
            line(0.1171875, 0.018545720263935753),
            arc(0.109375, 0.018545720263935753, 0.099609375, 0.02334519635376754, 0.010881286797869635, Turn::Right),
            line(0.08984375, 0.018545720263935753),
        ],
    }]);
    obeys(&input, 0.010462936356193612, Operation::Open);
}

/// Campaign, shape 4954.
#[test]
fn a_thin_part_with_concave_arcs_vanishes() {
    let input = Region::new(vec![Ring {
        vertices: vec![
            line(5.0, 0.0),
            arc(
                3.8537979431752802,
                3.1856304577238683,
                3.815680031504274,
                3.815680031504274,
                0.631201584765936,
                Turn::Right,
            ),
            line(3.1856304577238683, 3.8537979431752802),
            line(2.5000000000000004, 4.330127018922193),
            arc(
                1.9113609142683248,
                4.583499421915748,
                2.1609171642141574,
                5.163272755835137,
                0.631201584765936,
                Turn::Right,
            ),
            line(1.5461189305483554, 5.306236291369339),
            line(-5.0, 6.123233995736766e-16),
        ],
    }]);
    obeys(&input, 2.151014385269252, Operation::Open);
}

/// The outline of a portrait, the solid opened along the curve: a thin fold of many links at the end of a wedge.
#[test]
fn keeping_opens_a_fold_at_the_end_of_a_wedge_without_adding_to_it() {
    let input = Region::new(vec![Ring {
        vertices: vec![
            line(14.329524386562763, -22.436678062042066),
            line(13.619999999999997, -23.996999999999996),
            line(15.275665413058517, -22.842290462648773),
            line(14.434889865247897, -23.351717995318406),
            line(14.42274901697407, -23.369508928458536),
            line(14.410926769193786, -23.387513148970022),
            line(14.366897164419711, -23.46154783206772),
            line(14.356722049495568, -23.480531628713415),
            line(14.119437820762379, -23.18523248477795),
            line(14.98867313164098, -22.601534773133523),
            line(22.458999999999993, -23.649),
            line(22.458999999999993, -22.067),
        ],
    }]);
    obeys(&input, 0.6586619477807863, Operation::Open);
}

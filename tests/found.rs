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
        assert_eq!(outcome.contradictions, 0, "{mode}");
        assert_eq!(laws::crossing(&outcome.region, r), None, "{mode}");
        let (violation, place) = laws::containment(input, &outcome.region, operation, r);
        assert!(violation <= 1e-9 * r + 1e-15 * far, "{mode}: containment fails by {} r at {place}", violation / r);
    }
    let reference = reference::closing(input, laws::radius(r), operation).unwrap();
    let (distance, place) = laws::hausdorff(&merged.region, &reference.region, r);
    assert!(distance <= laws::ACCURACY * r, "{} r from the reference at {place}", distance / r);
    if kept.differences.is_empty() {
        let (distance, place) = laws::hausdorff(&merged.region, &kept.region, r);
        assert!(distance <= laws::ACCURACY * r, "keep is {} r from merge at {place}", distance / r);
    }
}

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
fn keeping_a_fold_at_the_end_of_a_wedge() {
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

#[test]
fn a_star_with_bulges() {
    let input = Region::new(vec![Ring {
        vertices: vec![
            arc(
                47.31020819673824,
                69.95448545793265,
                158.7115407652649,
                145.8602072713267,
                134.80332155424009,
                Turn::Right,
            ),
            arc(
                24.736230228777696,
                160.77837299998325,
                6.479404623017996,
                85.54266476266613,
                77.41914152953278,
                Turn::Left,
            ),
            arc(
                -45.486103965271575,
                142.93002741621757,
                -293.7148374493554,
                354.1335643503082,
                325.9209077990887,
                Turn::Right,
            ),
            arc(
                -114.03557161235612,
                82.2148272819351,
                -197.27603376344422,
                103.74592614279501,
                85.98001370831977,
                Turn::Right,
            ),
            arc(
                -163.1843931990208,
                24.813532280015085,
                -298.74519444363807,
                -95.22045937111866,
                181.0659824091402,
                Turn::Right,
            ),
            arc(
                -130.70007067125508,
                -27.798457308649805,
                -241.48514194854775,
                -153.34570620551753,
                167.43788019288488,
                Turn::Right,
            ),
            line(-90.54922517035739, -80.86265473957783),
        ],
    }]);
    obeys(&input, 53.54130408199259, Operation::Open);
}

#[test]
fn bulges_far_away() {
    let input = Region::new(vec![Ring {
        vertices: vec![
            arc(
                2097156.411300146,
                -2097148.069896997,
                2097152.5902766483,
                -2097152.8922636267,
                6.152677505095871,
                Turn::Left,
            ),
            arc(
                2097152.7830264987,
                -2097146.742606077,
                2097150.7943337609,
                -2097146.0577050531,
                2.103327891182335,
                Turn::Right,
            ),
            arc(
                2097150.5481891085,
                -2097148.1465805946,
                2097147.8635693036,
                -2097149.9809574827,
                3.2514799804616548,
                Turn::Left,
            ),
            line(2097147.3617524307, -2097146.768434815),
            line(2097148.3414142134, -2097151.0675125145),
            arc(
                2097148.3197457073,
                -2097154.0006637666,
                2097148.2850078915,
                -2097155.7130150604,
                1.7127036138590253,
                Turn::Right,
            ),
            arc(
                2097149.865279958,
                -2097155.052641026,
                2097152.182893515,
                -2097153.7355141733,
                2.6657373740860737,
                Turn::Left,
            ),
            arc(
                2097152.544920197,
                -2097156.376554201,
                2097151.3250370398,
                -2097154.9051719983,
                1.911303351933724,
                Turn::Left,
            ),
            line(2097152.9144717446, -2097153.8436740837),
        ],
    }]);
    obeys(&input, 2.6825371742575688, Operation::Open);
}

#[test]
fn bulges_of_a_small_part() {
    let input = Region::new(vec![Ring {
        vertices: vec![
            arc(
                67109079.6636563,
                -67108841.450740434,
                67109098.63913299,
                -67108734.776351914,
                108.34894499552614,
                Turn::Right,
            ),
            arc(
                67108993.25464672,
                -67108759.94784242,
                67109069.78559431,
                -67109174.64714687,
                421.70190780072863,
                Turn::Left,
            ),
            arc(
                67108913.63745514,
                -67108782.919872254,
                67108984.97436354,
                -67108655.869473726,
                145.70778382353737,
                Turn::Right,
            ),
            arc(
                67108839.274459295,
                -67108657.384785704,
                67108761.08768486,
                -67108545.32175171,
                136.64294817052198,
                Turn::Right,
            ),
            arc(
                67108745.235313885,
                -67108681.04204355,
                67108874.0934849,
                -67108743.616123475,
                143.2478401733715,
                Turn::Left,
            ),
            line(67108731.97212681, -67108761.5455209),
            arc(
                67109046.97510457,
                -67108950.71022388,
                67109121.00478919,
                -67108913.33896086,
                82.92771253506619,
                Turn::Right,
            ),
        ],
    }]);
    obeys(&input, 55.81144289772101, Operation::Open);
}

#[test]
fn bulges_closed_before() {
    let input = Region::new(vec![Ring {
        vertices: vec![
            line(-91.56244948817987, 74.69898175807339),
            arc(
                -209.86231686809853,
                -9.915852850498801,
                912.753929290162,
                250.82476849842254,
                1152.4985500033767,
                Turn::Left,
            ),
            line(-187.5408536589169, -92.11006259186661),
            arc(
                6.217732039467371,
                -146.22941519847143,
                -48.8996150774514,
                -49.285405470405095,
                111.51709723339435,
                Turn::Left,
            ),
            arc(
                43.70363314193298,
                -111.41994815465934,
                56.77371745203187,
                -120.18965901327522,
                15.739597593865554,
                Turn::Right,
            ),
            arc(
                52.895697331949265,
                -104.93528612006676,
                113.62888596930486,
                -343.8321143418008,
                246.49587164182952,
                Turn::Right,
            ),
            arc(
                131.86331994741747,
                -98.01161040861957,
                368.41578576515815,
                -79.29052832755306,
                237.29211533200888,
                Turn::Right,
            ),
            arc(
                134.99018605403663,
                -36.6286320002371,
                150.47331747801698,
                -39.458397666254506,
                15.739597593865554,
                Turn::Right,
            ),
            line(137.04118020109053, -31.253970776421095),
        ],
    }]);
    obeys(&input, 88.21455013093696, Operation::Open);
}

#[test]
fn bulges_closed_before_that_vanish() {
    let input = Region::new(vec![Ring {
        vertices: vec![
            arc(
                -12.143750942237789,
                -18.525705698314184,
                -21.650323744857893,
                -30.19100520241369,
                15.048393235553771,
                Turn::Right,
            ),
            arc(
                -6.65134395817881,
                -31.40950605618969,
                14.704174971176739,
                -18.470649850392093,
                24.969425076608594,
                Turn::Left,
            ),
            arc(
                15.060823386417383,
                -43.43752772016741,
                34.92250312559855,
                -59.61738586489216,
                25.61784791205568,
                Turn::Right,
            ),
            arc(
                30.61147580442359,
                -34.36487757202551,
                71.0752697474638,
                4.656272266225454,
                56.2135993774109,
                Turn::Right,
            ),
            arc(
                17.961637672087065,
                -13.753259034857745,
                26.73963793015927,
                -10.710746892540655,
                9.290326617878545,
                Turn::Right,
            ),
            line(20.888089049836445, -3.4948239184468113),
        ],
    }]);
    obeys(&input, 14.366110909447523, Operation::Open);
}

#[test]
fn keeping_bulges() {
    let input = Region::new(vec![Ring {
        vertices: vec![
            arc(
                4.275582079954531,
                1.6544984800216864,
                -9.668393751367653,
                -5.387918724181937,
                15.621462865639709,
                Turn::Left,
            ),
            arc(
                2.424543899309506,
                4.501012514298548,
                4.189631761496757,
                26.836236293385028,
                22.40486010719797,
                Turn::Right,
            ),
            arc(
                -1.4229093215165878,
                5.145751305386297,
                -7.872883162639633,
                2.5985125388520474,
                6.934737766124001,
                Turn::Right,
            ),
            arc(
                -1.2451408550149894,
                0.5580175526712774,
                3.945150975445879,
                -22.09320038737118,
                23.238261627166736,
                Turn::Left,
            ),
            arc(
                -5.150758511755117,
                -0.7090652855416697,
                -2.0888617667161054,
                1.9793055399700603,
                4.074622604946759,
                Turn::Left,
            ),
            arc(
                -0.7834875440947554,
                -1.8805581249355827,
                0.36491467643764025,
                -2.4018288244539403,
                1.2611704096989014,
                Turn::Right,
            ),
            arc(
                0.38895705581730544,
                -1.1408876020752525,
                0.6936978434317111,
                -0.2760321798552593,
                0.9169742902498255,
                Turn::Left,
            ),
            arc(
                1.2897651183559133,
                -0.9728432394285174,
                0.35018603499938017,
                3.1052044709234083,
                4.1848873320303,
                Turn::Left,
            ),
        ],
    }]);
    obeys(&input, 1.3682653687119588, Operation::Open);
}

#[test]
fn convex_arcs_below_the_radius() {
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

#[test]
fn keeping_a_coast_far_away() {
    let input = Region::new(vec![Ring {
        vertices: vec![
            arc(
                67107949.58635424,
                -67109372.06904219,
                67108017.04812663,
                -67109392.72191913,
                70.55233561106056,
                Turn::Left,
            ),
            line(67107949.11728795, -67109411.77534972),
            arc(
                67107914.61282493,
                -67109734.8595357,
                67107982.13900183,
                -67109714.4182174,
                70.55233561106056,
                Turn::Left,
            ),
            line(67107978.96826144, -67109784.89926781),
            line(67108068.361288674, -67109769.65466511),
        ],
    }]);
    obeys(&input, 64.0, Operation::Open);
}

/// Found by fuzzing: a ring without vertices is no reason to panic.
#[test]
fn a_ring_without_vertices_is_nothing() {
    let square = Ring { vertices: vec![line(0.0, 0.0), line(4.0, 0.0), line(4.0, 4.0), line(0.0, 4.0)] };
    for rings in [vec![Ring::default()], vec![square, Ring::default()]] {
        let count = rings.iter().filter(|r| !r.is_empty()).count();
        for topology in [Topology::Merge, Topology::Keep] {
            let closed = rolling::close(&Region::new(rings.clone()), laws::radius(1.0), topology).region;
            assert_eq!(closed.rings.iter().filter(|r| !r.is_empty()).count(), count);
        }
    }
}

/// Found by fuzzing: a ring of no area, one vertex twice.
#[test]
fn a_flat_ring_gives_numbers() {
    let flat = Region::new(vec![Ring { vertices: vec![line(37.0, 188.0), line(188.0, 188.0), line(188.0, 188.0)] }]);
    for topology in [Topology::Merge, Topology::Keep] {
        for run in [rolling::close, rolling::open] {
            let result = run(&flat, laws::radius(30.5), topology).region;
            assert!(laws::is_finite(&result), "{topology:?}: {result:?}");
        }
    }
}

#[test]
fn keeping_bulges_closed_before() {
    let input = Region::new(vec![Ring {
        vertices: vec![
            arc(
                2097161.0352520733,
                -2097149.8307250212,
                2097140.4031496113,
                -2097166.5200266903,
                26.537076745872746,
                Turn::Left,
            ),
            arc(
                2097158.1247103964,
                -2097146.7674894975,
                2097158.710567487,
                -2097146.1144903563,
                0.8772892390738418,
                Turn::Right,
            ),
            arc(
                2097157.841558635,
                -2097146.2347401949,
                2097138.7679025473,
                -2097148.87407357,
                19.255400209065595,
                Turn::Left,
            ),
            line(2097157.2954888493, -2097143.6301262944),
            line(2097151.8466954092, -2097147.340063199),
            arc(
                2097150.0475569943,
                -2097143.3909039162,
                2097216.4207534203,
                -2097176.167708783,
                74.02513182065995,
                Turn::Left,
            ),
            arc(
                2097148.5014046389,
                -2097146.7282420383,
                2097147.69647647,
                -2097146.3793479973,
                0.8772892390738418,
                Turn::Right,
            ),
            line(2097147.682826985, -2097147.2565310458),
            line(2097140.8433538817, -2097150.7126966412),
        ],
    }]);
    obeys(&input, 1.8140372301847087, Operation::Open);
}

#[test]
fn a_convex_arc_and_a_concave_one_far_away() {
    let input = Region::new(vec![Ring {
        vertices: vec![
            arc(
                33554517.49493162,
                -33554385.461440757,
                33554457.01612978,
                -33554440.809368804,
                81.9821847241091,
                Turn::Left,
            ),
            line(33554467.4077224, -33554359.48844029),
            arc(
                33554434.33502097,
                -33554406.451036412,
                33554528.66777993,
                -33554330.662994973,
                121.0061842989655,
                Turn::Right,
            ),
            line(33554410.421556417, -33554356.359828703),
            line(33554344.827697128, -33554490.72844924),
        ],
    }]);
    obeys(&input, 30.928039395057652, Operation::Close);
}

#[test]
fn keeping_a_spiral_closed_before() {
    let input = Region::new(vec![Ring {
        vertices: vec![
            line(2097153.2876488925, -2097156.908242877),
            line(2097157.6125575686, -2097152.4047808074),
            line(2097154.4097347716, -2097146.309238732),
            line(2097146.9789582617, -2097147.514597652),
            line(2097145.6527377302, -2097155.5764840674),
            line(2097153.4384947326, -2097159.705203769),
            line(2097160.30429076, -2097153.204083126),
            line(2097156.070905655, -2097144.0362326326),
            line(2097145.39112322, -2097145.180132923),
            line(2097142.9125131245, -2097156.2907540826),
            line(2097153.190992309, -2097162.5352194123),
            line(2097162.895937459, -2097154.390680539),
            line(2097158.0650551897, -2097141.9854814764),
            line(2097144.1230927513, -2097142.6042748848),
            line(2097140.0495918607, -2097156.623210945),
            line(2097144.5321827603, -2097142.6929152461),
            line(2097158.112698916, -2097142.4015231659),
            line(2097162.517116037, -2097154.5696246955),
            line(2097152.8996535307, -2097162.233831323),
            line(2097143.104472215, -2097155.9178259918),
            line(2097145.8062177903, -2097145.2422608873),
            line(2097156.145281251, -2097144.4496414897),
            line(2097159.936204208, -2097153.4072331283),
            line(2097153.127841654, -2097159.4212563066),
            line(2097147.399284826, -2097147.5524825791),
            arc(
                2097157.327913643,
                -2097152.107111427,
                2097156.9284203746,
                -2097152.3162480113,
                0.45092458628220855,
                Turn::Right,
            ),
            line(2097157.253076895, -2097152.6291875043),
        ],
    }]);
    obeys(&input, 1.8953560151489803, Operation::Open);
}

/// The disk that rests on the far end of an arc and touches the link before it has two places; one is on the wrong side
/// of that end.
#[test]
fn a_disk_rests_on_the_right_side_of_an_end() {
    let input = Region::new(vec![Ring {
        vertices: vec![
            arc(
                33554481.68939651,
                -33554421.49991495,
                33554443.240724824,
                -33554347.493473023,
                83.39816425431687,
                Turn::Left,
            ),
            arc(
                33554517.49493162,
                -33554385.461440757,
                33554457.01612978,
                -33554440.809368804,
                81.9821847241091,
                Turn::Left,
            ),
            line(33554467.4077224, -33554359.48844029),
            arc(
                33554434.33502097,
                -33554406.451036412,
                33554528.66777993,
                -33554330.662994973,
                121.0061842989655,
                Turn::Right,
            ),
            line(33554410.421556417, -33554356.359828703),
            arc(
                33554415.35327481,
                -33554412.319690567,
                33554365.46906158,
                -33554206.767835543,
                211.5183203242045,
                Turn::Right,
            ),
            arc(
                33554386.70272214,
                -33554417.21766684,
                33554417.58212021,
                -33554452.28932001,
                46.72855745122835,
                Turn::Left,
            ),
            line(33554373.12194825, -33554437.90699786),
            arc(
                33554513.450336926,
                -33554503.386695236,
                33554570.09824949,
                -33554516.48262962,
                58.14197704294456,
                Turn::Right,
            ),
            arc(
                33554534.48647496,
                -33554470.522962414,
                33554252.25553134,
                -33554721.53905734,
                377.70806908198506,
                Turn::Left,
            ),
        ],
    }]);
    obeys(&input, 30.928039395057652, Operation::Close);
}

/// The corner of a frame rounds farther in than the corner of its hole: along the curves the two outlines would cross, and
/// drawn by any fill rule the crossing would be painted wrong.
#[test]
fn keeping_outlines_that_would_cross() {
    let square = |min: f64, max: f64| [line(min, min), line(max, min), line(max, max), line(min, max)];
    let outer = Ring { vertices: square(0.0, 60.0).to_vec() };
    let hole = Ring { vertices: square(1.0, 30.0).to_vec() }.reversed();
    let input = Region::new(vec![outer, hole]);
    for r in [1.5, 3.0, 5.0, 12.0] {
        obeys(&input, r, Operation::Open);
        obeys(&input, r, Operation::Close);
    }
}

/// A circle in a circle that it touches from inside: as one ring, which turns straight back at the tip of each horn, its locus
/// runs along itself, and the closing came out empty.
#[test]
fn a_crescent_whose_horns_touch() {
    let input = Region::new(vec![Ring {
        vertices: vec![
            arc(0.0, 50.0, 50.0, 50.0, 50.0, Turn::Left),
            arc(100.0, 50.0, 50.0, 50.0, 50.0, Turn::Left),
            arc(0.0, 50.0, 25.0, 50.0, 25.0, Turn::Right),
            arc(50.0, 50.0, 25.0, 50.0, 25.0, Turn::Right),
        ],
    }]);
    for r in [0.5, 2.0, 10.0] {
        let closed = rolling::close(&input, laws::radius(r), Topology::Merge);
        assert_eq!(closed.contradictions, 0, "r = {r}");
        assert!((closed.region.area() / input.area() - 1.0).abs() < 1e-12, "r = {r}: the disk fits everywhere");
        let opened = rolling::open(&input, laws::radius(r), Topology::Merge);
        assert_eq!(opened.contradictions, 0, "r = {r}");
        // The disk touches both circles where its centre is 50 - r from one centre and 25 + r from the other: at x = 3 r.
        let leftmost = opened.region.bounds().min.x;
        assert!((leftmost - 2.0 * r).abs() < 1e-9 * r, "r = {r}: the horns end at {leftmost}");
        assert_eq!(opened.region.topology().components, 1);
    }
    let filled = rolling::close(&input, laws::radius(30.0), Topology::Merge);
    assert_eq!((filled.contradictions, filled.region.topology().holes), (0, 0), "the disk does not fit into the hole");
}

//! The parts of the page, as HTML.

use super::base64::encoded;
use super::text::{duration, escaped, number};
use super::{Difference, Page, PageOperation};

/// Places named in a row; the path in motion shows all.
const PLACES_SHOWN: usize = 6;

/// A table: its head, whether each column is of numbers, and its rows as HTML.
fn table(head: &[(&str, bool)], rows: &[Vec<String>], html: &mut String) {
    html.push_str("<div class=\"wide\"><table>\n<thead><tr>");
    for (name, is_number) in head {
        html.push_str(&format!("<th scope=\"col\"{}>{name}</th>", class(*is_number)));
    }
    html.push_str("</tr></thead>\n<tbody>\n");
    for row in rows {
        html.push_str("<tr>");
        for (cell, (_, is_number)) in row.iter().zip(head) {
            html.push_str(&format!("<td{}>{cell}</td>", class(*is_number)));
        }
        html.push_str("</tr>\n");
    }
    html.push_str("</tbody>\n</table></div>\n");
}

fn class(is_number: bool) -> &'static str {
    if is_number { " class=\"number\"" } else { "" }
}

fn list(items: &[String], html: &mut String) {
    html.push_str("<ul>\n");
    for item in items {
        html.push_str(&format!("<li>{}</li>\n", escaped(item)));
    }
    html.push_str("</ul>\n");
}

/// What it is, whether it is good, and what was asked for.
pub(super) fn verdict(page: &Page, html: &mut String) {
    let (class, word) = if page.is_good { ("good", "Good") } else { ("bad", "Not good") };
    html.push_str(&format!("<header>\n<h1>{}</h1>\n", escaped(&page.title)));
    let sentence = match (page.is_good, page.differences.len()) {
        (false, _) => "do not run it before this is understood",
        (true, 0) => "nothing was found",
        (true, _) => "what the result will differ by stands below",
    };
    html.push_str(&format!(
        "<p class=\"verdict {class}\"><strong>{word}</strong> – {sentence}. It takes {}.</p>\n",
        duration(page.seconds)
    ));
    if !page.failures.is_empty() {
        list(&page.failures, html);
    }
    html.push_str("</header>\n<main>\n<dl>\n");
    for (name, value) in &page.facts {
        html.push_str(&format!("<div><dt>{}</dt><dd>{}</dd></div>\n", escaped(name), escaped(value)));
    }
    html.push_str("</dl>\n");
}

/// The paths in motion, one program after the other.
pub(super) fn player(page: &Page, html: &mut String) {
    let depths = page.programs.iter().map(|p| crate::cam::statistics(p.program, page.stock_top).depth_mm);
    let mut choice = String::new();
    if page.programs.len() > 1 {
        let option =
            |(k, p): (usize, &super::PageProgram)| format!("<option value=\"{k}\">{}</option>", escaped(&p.name));
        let options: String = page.programs.iter().enumerate().map(option).collect();
        choice = format!("<label>program <select class=\"program\">{options}</select></label>\n");
    }
    html.push_str("<section aria-labelledby=\"h-path\">\n<h2 id=\"h-path\">The path in motion</h2>\n");
    html.push_str(
        "<p class=\"hint\">Drawn from the program as it was read back. On the picture, space plays and pauses, ← and → go from \
         motion to motion.</p>\n",
    );
    html.push_str(&format!(
        "<figure id=\"player\">\n<canvas tabindex=\"0\" role=\"img\" aria-label=\"the path of the tool\"></canvas>\n\
         <div class=\"controls\">\n<button type=\"button\" class=\"play\">Play</button>\n\
         <button type=\"button\" class=\"back\" aria-label=\"motion before\">◀</button>\n\
         <button type=\"button\" class=\"next\" aria-label=\"next motion\">▶</button>\n\
         <input type=\"range\" class=\"time\" min=\"0\" value=\"0\" step=\"any\" aria-label=\"time\">\n\
         <label>speed <select class=\"speed\"><option value=\"0.25\">¼ ×</option><option value=\"1\">1 ×</option>\
         <option value=\"4\" selected>4 ×</option><option value=\"16\">16 ×</option><option value=\"64\">64 ×</option>\
         <option value=\"256\">256 ×</option></select></label>\n{choice}</div>\n\
         <p class=\"state\"><output class=\"clock\"></output><output class=\"line\"></output>\
         <output class=\"z\"></output><output class=\"what\"></output></p>\n\
         <p class=\"legend\"><span><i class=\"ramp\"></i>0 to {} mm deep</span><span><i class=\"dash\"></i>rapid</span>\
         <span><i class=\"disk\"></i>tool</span><span><i class=\"ring\"></i>difference, numbered as below</span></p>\n\
         <noscript><p>The path moves where scripts are allowed; all else on this page needs none.</p></noscript>\n\
         </figure>\n</section>\n",
        number(depths.fold(0.0, f64::max), 3),
    ));
}

/// How the result will differ.
pub(super) fn differences(page: &Page, html: &mut String) {
    html.push_str("<section aria-labelledby=\"h-differ\">\n<h2 id=\"h-differ\">What will differ</h2>\n");
    if page.differences.is_empty() {
        html.push_str("<p>Nothing: what is drawn is cut, and what was asked for is done.</p>\n</section>\n");
        return;
    }
    let several = page.operations.len() > 1;
    let mut head = vec![("no.", true), ("what", false), ("at x, y in mm", true), ("by how much", false)];
    head.extend([("why", false), ("what a smaller tool or another setting would gain", false)]);
    if several {
        head.insert(1, ("operation", false));
    }
    let row = |(k, d): (usize, &Difference)| {
        let mut at: Vec<String> =
            d.places.iter().take(PLACES_SHOWN).map(|p| format!("{}, {}", number(p.x, 3), number(p.y, 3))).collect();
        if d.places.len() > PLACES_SHOWN {
            at.push(format!("and {} more", d.places.len() - PLACES_SHOWN));
        }
        let feature = match d.places.len() {
            0 | 1 => escaped(&d.feature),
            count => format!("{}, {count} times", escaped(&d.feature)),
        };
        let mut row =
            vec![(k + 1).to_string(), feature, at.join("<br>"), escaped(&d.amount), escaped(&d.why), escaped(&d.gain)];
        if several {
            row.insert(1, escaped(&d.operation));
        }
        row
    };
    let rows: Vec<Vec<String>> = page.differences.iter().enumerate().map(row).collect();
    table(&head, &rows, html);
    html.push_str("</section>\n");
}

/// The table of operations.
pub(super) fn operations(page: &Page, html: &mut String) {
    html.push_str("<section aria-labelledby=\"h-operations\">\n<h2 id=\"h-operations\">Operations</h2>\n");
    let head = [
        ("operation", false),
        ("tool", false),
        ("passes", true),
        ("cut, mm", true),
        ("depth, mm", true),
        ("time", true),
        ("gouge, mm", true),
        ("checked", false),
    ];
    let row = |o: &PageOperation| {
        vec![
            escaped(&o.label),
            escaped(&o.tool),
            o.passes.to_string(),
            number(o.cut_length, 1),
            number(o.depth, 3),
            duration(o.seconds),
            o.gouge.map_or("–".to_owned(), |g| format!("{:.4}", g.max(0.0))),
            match o.is_good {
                true => "<span class=\"good\">good</span>".to_owned(),
                false => "<span class=\"bad\">failed</span>".to_owned(),
            },
        ]
    };
    let rows: Vec<Vec<String>> = page.operations.iter().map(row).collect();
    table(&head, &rows, html);
    html.push_str("<p class=\"hint\">Gouge is the deepest cut into what must remain, computed from the program as it was read back.</p>\n</section>\n");
}

/// How long it takes, and what rounding saves.
pub(super) fn time(page: &Page, html: &mut String) {
    html.push_str("<section aria-labelledby=\"h-time\">\n<h2 id=\"h-time\">Time saved by rounding</h2>\n");
    let Some(saved) = &page.saved else {
        html.push_str("<p>The path has sharp inside corners, or could not be planned with them: there is nothing to compare.</p>\n</section>\n");
        return;
    };
    let head = [("path", false), ("time at a feed", true), ("way in the stock, mm", true)];
    let row = |name: &str, seconds: f64, length: f64| vec![name.to_owned(), seconds_of(seconds), number(length, 1)];
    let percent = |saved: f64| format!("{saved:.1} %");
    let rows = [
        row("with sharp inside corners", saved.sharp.feed_seconds, saved.sharp_length_mm),
        row("as it is, with the path radius", saved.rounded.feed_seconds, saved.rounded_length_mm),
        vec![
            "<strong>saved</strong>".to_owned(),
            format!("<strong>{:.1} s, {}</strong>", saved.seconds(), percent(saved.percent())),
            format!(
                "{}, {}",
                number(saved.sharp_length_mm - saved.rounded_length_mm, 1),
                percent(saved.length_percent())
            ),
        ],
    ];
    table(&head, &rows, html);
    html.push_str("<p class=\"hint\">Both on the same model of the machine's planner, which slows down in corners; travel and waiting are left out.");
    if !saved.same_outlines {
        html.push_str(" Rounding loses outlines that the sharp path cuts: their time is no saving.");
    }
    html.push_str("</p>\n</section>\n");
}

/// Seconds that are to be held against others: with a decimal.
fn seconds_of(seconds: f64) -> String {
    format!("{seconds:.1} s")
}

/// What lint and the settings say.
pub(super) fn findings(page: &Page, html: &mut String) {
    html.push_str("<section aria-labelledby=\"h-findings\">\n<h2 id=\"h-findings\">Findings and warnings</h2>\n");
    if page.findings.is_empty() && page.warnings.is_empty() {
        html.push_str("<p>None: no rule of the controller is broken, and the settings are usual.</p>\n");
    }
    if !page.findings.is_empty() {
        let row = |f: &super::PageFinding| {
            let (class, word) = if f.is_error { ("bad", "refused") } else { ("note", "note") };
            let severity = format!("<span class=\"{class}\">{word}</span>");
            vec![escaped(&f.place), severity, escaped(&f.message), escaped(&f.source)]
        };
        let rows: Vec<Vec<String>> = page.findings.iter().map(row).collect();
        table(&[("line", false), ("", false), ("what", false), ("who says so", false)], &rows, html);
    }
    if !page.warnings.is_empty() {
        list(&page.warnings, html);
    }
    html.push_str("</section>\n");
}

/// The pictures.
pub(super) fn pictures(page: &Page, html: &mut String) {
    if page.programs.iter().any(|p| p.picture.is_some()) {
        html.push_str("<section aria-labelledby=\"h-pictures\">\n<h2 id=\"h-pictures\">Pictures</h2>\n");
        for program in &page.programs {
            let (name, Some(png)) = (escaped(&program.name), &program.picture) else { continue };
            html.push_str(&format!(
                "<figure class=\"picture\"><img alt=\"picture of {name}\" src=\"data:image/png;base64,{}\"><figcaption>{name}</figcaption></figure>\n",
                encoded(png)
            ));
        }
        html.push_str("</section>\n");
    }
    html.push_str("</main>\n");
}

"""Compares a restyled font with the one it was made from, through fontTools, FreeType and HarfBuzz.

usage: judge_font.py OLD NEW open|close|clopen REPORT.json
"""

import json
import sys

import freetype
import uharfbuzz
from fontTools.pens.areaPen import AreaPen
from fontTools.pens.boundsPen import ControlBoundsPen
from fontTools.ttLib import TTFont

# Tables that no outline is spoken of in: byte for byte.
SAME = ["GSUB", "GPOS", "GDEF", "kern", "cmap", "OS/2", "BASE", "MATH"]
GONE = ["fpgm", "prep", "cvt ", "hdmx", "LTSH", "VDMX", "DSIG", "CFF "]

TEXT = "AVATAR Towering fjord, office affluent Quartz; «Wörter» 0123"

failures = []


def hold(what, holds):
    if not holds:
        failures.append(what)


def area(font, name):
    """The area that a glyph fills, either direction; overlapping contours count as often as they lie on each other."""
    glyphs = font.getGlyphSet()
    pen = AreaPen(glyphs)
    glyphs[name].draw(pen)
    return abs(pen.value)


def has_overlap(font, name):
    """Whether the sum of areas may be another than what is filled: contours whose boxes meet."""
    import itertools

    from fontTools.pens.recordingPen import DecomposingRecordingPen

    glyphs = font.getGlyphSet()
    pen = DecomposingRecordingPen(glyphs)
    glyphs[name].draw(pen)
    boxes, box = [], None
    for command, points in pen.value:
        if command == "moveTo":
            box = [points[0][0], points[0][1], points[0][0], points[0][1]]
            boxes.append(box)
        for x, y in (p for p in points if p is not None):
            if box is not None:
                box[:] = [min(box[0], x), min(box[1], y), max(box[2], x), max(box[3], y)]

    def partly(a, b):
        meets = a[0] <= b[2] and b[0] <= a[2] and a[1] <= b[3] and b[1] <= a[3]
        inside = lambda p, q: p[0] >= q[0] and p[1] >= q[1] and p[2] <= q[2] and p[3] <= q[3]
        return meets and not inside(a, b) and not inside(b, a)

    return any(partly(a, b) for a, b in itertools.combinations(boxes, 2))


def drawn_points(font, name):
    """The points that a glyph draws, the last ones of its contours, and which are on the curve; of a composite those of its components."""
    coordinates, ends, flags = font["glyf"][name].getCoordinates(font["glyf"])[:3]
    return list(coordinates), list(ends), [flag & 1 for flag in flags]


def parts(glyph, font):
    """The components of a composite: their numbers and where they are put."""
    if not glyph.isComposite():
        return None
    place = lambda c: (c.x, c.y) if hasattr(c, "x") else (c.firstPt, c.secondPt)
    return [(font.getGlyphID(c.glyphName), place(c), getattr(c, "transform", None)) for c in glyph.components]


def header_box(glyph):
    return [getattr(glyph, side, 0) for side in ("xMin", "yMin", "xMax", "yMax")]


def heights(path, size, flags):
    """What FreeType makes of the ASCII glyphs: rows of pixels each."""
    face = freetype.Face(path)
    face.set_pixel_sizes(0, size)
    rows = {}
    for code in range(33, 127):
        face.load_char(chr(code), freetype.FT_LOAD_RENDER | flags)
        rows[chr(code)] = face.glyph.bitmap.rows
    return rows


def shaped(path):
    blob = uharfbuzz.Blob.from_file_path(path)
    font = uharfbuzz.Font(uharfbuzz.Face(blob))
    buffer = uharfbuzz.Buffer()
    buffer.add_str(TEXT)
    buffer.guess_segment_properties()
    uharfbuzz.shape(font, buffer)
    return [(i.codepoint, p.x_advance, p.x_offset, p.y_offset) for i, p in zip(buffer.glyph_infos, buffer.glyph_positions)]


def main():
    old_path, new_path, operation, report_path = sys.argv[1:]
    old, new = TTFont(old_path), TTFont(new_path)
    with open(report_path) as file:
        report = json.load(file)

    for tag in SAME:
        if tag in old:
            hold(f"table {tag} is not as it was", tag in new and old.reader[tag] == new.reader[tag])
    for tag in GONE:
        hold(f"table {tag} is still there", tag not in new)
    old_order, new_order = old.getGlyphOrder(), new.getGlyphOrder()
    hold("the number of glyphs changed", len(old_order) == len(new_order))
    hold("advances changed", all(old["hmtx"][a][0] == new["hmtx"][b][0] for a, b in zip(old_order, new_order)))
    hold("the revision was not raised", new["head"].fontRevision > old["head"].fontRevision)
    for name in (1, 3, 4, 6):
        hold(f"name {name} is that of the original", old["name"].getDebugName(name) != new["name"].getDebugName(name))
    for name in (0, 13, 14):
        hold(f"name {name} changed", old["name"].getDebugName(name) == new["name"].getDebugName(name))
    changed_kinds = report["kept"] + report["changed"] + report["changed_by_components"] + report["blank"]
    hold("the report does not add up", changed_kinds + len(report["vanished"]) + len(report["refused"]) == len(new_order))

    kept_glyphs = set(report["kept_glyphs"])
    hold("the kept glyphs are not as many as is said", len(kept_glyphs) == report["kept"])

    # Every glyph is drawn; its box and bearing are its own.
    glyf, kept, compared, lost = new["glyf"], 0, 0, []
    glyphs = new.getGlyphSet()
    for number, (before, after) in enumerate(zip(old_order, new_order)):
        glyph = glyf[after]
        is_kept = "glyf" in old and number in kept_glyphs
        hold(f"{after} has instructions", not getattr(glyph, "program", None) or not glyph.program.getBytecode())
        if glyph.isComposite():
            hold(f"{after} announces instructions", not any(c.flags & 0x0100 for c in glyph.components))
        pen = ControlBoundsPen(glyphs)
        glyphs[after].draw(pen)
        if pen.bounds is not None and glyph.numberOfContours != 0:
            box = (glyph.xMin, glyph.yMin, glyph.xMax, glyph.yMax)
            apart = max(abs(a - b) for a, b in zip(box, pen.bounds))
            # A box is whole: of components that are scaled to fractions of units it is up to one off. A kept glyph has the box that
            # its font gave it, right or wrong, and is compared with that.
            if is_kept:
                apart = 0
            hold(f"the box of {after} is {box}, its outline {pen.bounds}", apart <= 1)
            if "glyf" not in old:
                hold(f"the bearing of {after} is not its left side", new["hmtx"][after][1] == glyph.xMin)
        if "glyf" in old:
            old_glyph = old["glyf"][before]
            same = drawn_points(old, before) == drawn_points(new, after)
            kept += same and glyph.numberOfContours != 0
            if is_kept:
                hold(f"{after} was kept, and has other points", same and parts(old_glyph, old) == parts(glyph, new))
                hold(f"{after} was kept, and has another box", header_box(old_glyph) == header_box(glyph))
                hold(f"{after} was kept, and has another advance or bearing", old["hmtx"][before] == new["hmtx"][after])
        if operation != "clopen" and not has_overlap(old, before) and not has_overlap(new, after):
            a, b = area(old, before), area(new, after)
            # Rounding to whole units may take or give half a unit along the outline.
            slack = 1e-3 * a + 2000.0
            compared += 1
            if (b < a - slack) if operation == "close" else (b > a + slack):
                lost.append((number, after, a, b))
    hold(f"{operation} goes the wrong way: {lost[:5]}", not lost)
    if "glyf" in old:
        hold(f"{kept} glyphs have the points that they had, fewer than the kept ones", kept >= len(kept_glyphs))
    hold("no areas were compared", compared > 500 or operation == "clopen")

    # Hinting that was kept would pull outlines to where the old ones were.
    drawn = heights(new_path, 12, freetype.FT_LOAD_NO_AUTOHINT)
    plain = heights(new_path, 12, freetype.FT_LOAD_NO_HINTING)
    hold("hinted and unhinted heights differ at 12 px", all(abs(drawn[c] - plain[c]) <= 1 for c in drawn))
    before = heights(old_path, 12, freetype.FT_LOAD_NO_HINTING)
    exploded = [c for c in drawn if drawn[c] > before[c] + 1]
    hold(f"glyphs are taller than they were: {exploded}", not exploded)
    hold("nothing was rendered", sum(1 for c in plain if plain[c] > 0) > 80)
    hold("a line is shaped otherwise", shaped(old_path) == shaped(new_path))

    deviation, tolerance = report["largest_deviation_font_units"], report["tolerance_font_units"]
    hold(f"the largest deviation is {deviation}, beyond the tolerance {tolerance}", deviation <= tolerance)
    hold(f"beyond the tolerance: glyphs {report['beyond_tolerance'][:9]}", not report["beyond_tolerance"])
    if failures:
        print(f"{old_path} {operation}:")
        print("\n".join(failures[:20]))
        sys.exit(1)
    print(f"{old_path.rsplit('/', 1)[-1]} {operation}: {len(new_order)} glyphs, {compared} areas, deviation {deviation:.3f} of {tolerance:.3f}")


main()

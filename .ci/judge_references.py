"""Runs the command on the inputs of the stored references and has ../shared/tools/judge2d.py judge what it writes.

usage: judge_references.py CLOPEN [KEY...]

The references were made from polygons, so the command is told to read curves as polygons (--curves polygon), by the same
sampling rule. Two things are prepared for the judge, neither of which changes what is judged:

- The judge flattens results to 2e-7 of the drawing's size, which is 4e-5 of the smallest radii, coarser than the 2e-5 it
  has for references. So arcs are handed to it in pieces: each is the same circle, and none is worth more than one
  chord of 2e-5 r.
- A reference that the judge reads as polygons and lines together, which it cannot judge, loses the lines.
"""

import json
import lzma
import math
import os
import re
import subprocess
import sys
import tempfile
from multiprocessing import Pool

TOOLS = "../shared/tools"
DATA = "../shared/data/2d"
sys.path.insert(0, TOOLS)

import judge2d  # noqa: E402
import shapely  # noqa: E402

# What is asked of every reference, over the radius.
HAUSDORFF = 2.5e-5
CONTAINMENT = 1e-9

# What the judge flattens references to, over the radius.
SAGITTA = 2e-5

# The least part of the vertices of a country that the judge must find kept. It takes those for still which are within 1e-7 r
# of the reference, and so counts a few concave ones, within 1e-3 of straight, that the disk lifts by less than that.
KEPT = 0.995

# References that are wrong, and the judge's reading of an input that differs from the drawing: tests/references.rs shows by
# distances which of the two is right. The figures are how far apart they are, over the radius.
#
# A needle: a subpath of gutenberg runs over its start, from 21.144 to 21.143 at height 0.096, and back to close. That
# fills nothing, but in the judge's reading (and so in the references) rounding leaves it a width of 6e-17, and it stands
# out of the chord beside it by 4.0e-5 units.
# Half turns: the centre of an arc of half a turn is the root of a difference that is nothing but rounding. The judge's
# reading of such arcs of gutenberg is off by up to 1.8e-8 units; ours has the centre between the ends.
KNOWN = {
    "icon_si_gutenberg.r0.5.close": (2.6e-3, 2.5e-4, "clipped, and certified to 1e-3 r only; needle; half turns"),
    "icon_si_gutenberg.r0.5.open": (2.0e-2, 1.1e-7, "clipped, and certified to 1e-3 r only; half turns"),
    "icon_si_gutenberg.r2.close": (6.1e-5, 6.1e-5, "needle; half turns"),
    "icon_si_gutenberg.r6.close": (HAUSDORFF, 2.1e-5, "needle; half turns"),
}


def run(clopen, entry, output):
    """What the command said, if it did not end well; a result that is empty or not proved is judged all the same."""
    command = [clopen, entry["mode"], f"{DATA}/{entry['file']}", "-r", f"{entry['r']!r}u"]
    command += ["--topology", "merge", "--curves", "polygon", "-o", output]
    done = subprocess.run(command, capture_output=True, text=True)
    return done.stderr.strip().split("\n")[-1] if done.returncode else None


def in_pieces(svg):
    """The file with every arc of its path cut into pieces that stray at most SAGITTA radii from their chords."""
    step = 2 * math.acos(1 - SAGITTA)

    def path(match):
        words = re.findall(r"[A-Za-z]|[-+.\deE]+", match.group(1))
        out, pen, k = [], None, 0
        while k < len(words):
            letter = words[k]
            count = {"M": 2, "L": 2, "A": 7, "Z": 0}[letter]
            numbers = words[k + 1 : k + 1 + count]
            if letter == "A":
                out += arc_pieces(pen, [float(n) for n in numbers], step)
            # The last end keeps its digits.
            out.append(letter + " ".join(numbers))
            if count:
                pen = [float(n) for n in numbers[-2:]]
            k += 1 + count
        return f' d="{" ".join(out)}"'

    # The last piece of an arc starts where the piece before ends, and its flags say a small arc.
    return re.sub(r' d="([^"]*)"', path, svg)


def arc_pieces(start, numbers, step):
    """The pieces of a circular arc but for the last one, which is what is left of the command itself."""
    rx, ry, _, large, sweep, x, y = numbers
    assert rx == ry, "the arcs of a polygon's closing are circles"
    dx, dy = x - start[0], y - start[1]
    chord = math.hypot(dx, dy)
    height = math.sqrt(max(rx * rx - chord * chord / 4, 0.0))
    side = 1 if large != sweep else -1
    cx, cy = (start[0] + x) / 2 - side * height * dy / chord, (start[1] + y) / 2 + side * height * dx / chord
    begin = math.atan2(start[1] - cy, start[0] - cx)
    turn = math.atan2(y - cy, x - cx) - begin
    turn = turn % math.tau if sweep else -(-turn % math.tau)
    # A reader that took the flags to mean another arc would be found out here.
    assert (abs(turn) > math.pi) == bool(large) or abs(abs(turn) - math.pi) < 1e-6
    assert not large, "the writer halves large arcs"
    pieces = math.ceil(abs(turn) / step)
    at = (begin + turn * k / pieces for k in range(1, pieces))
    return [f"A{rx!r} {rx!r} 0 0 {int(sweep)} {cx + rx * math.cos(t)!r} {cy + rx * math.sin(t)!r}" for t in at]


def readable_data(key, work):
    """The data folder, or one that has the polygons of the reference alone; and how many lines that leaves out."""
    reference, _ = judge2d.load_reference(DATA, key)
    lines = [g for g in shapely.get_parts(reference) if g.geom_type != "Polygon"]
    if not lines:
        return DATA, 0
    folder = f"{work}/{key}"
    os.makedirs(f"{folder}/ref")
    for name in os.listdir(DATA):
        if name != "ref":
            os.symlink(os.path.realpath(f"{DATA}/{name}"), f"{folder}/{name}")
    os.symlink(os.path.realpath(f"{DATA}/ref/index.json"), f"{folder}/ref/index.json")
    polygons = shapely.union_all([g for g in shapely.get_parts(reference) if g.geom_type == "Polygon"])
    with lzma.open(f"{folder}/ref/{key}.wkb.xz", "wb") as file:
        file.write(shapely.to_wkb(polygons))
    return folder, len(lines)


def judged(job):
    clopen, work, key, entry = job
    output = f"{work}/{key}.svg"
    said = run(clopen, entry, output)
    try:
        with open(output) as file:
            svg = file.read()
        with open(output, "w") as file:
            file.write(in_pieces(svg))
        data, lines = readable_data(key, work)
        row = dict(judge2d.judge(data, key, output), lines=lines)
        os.remove(output)
    except Exception as error:
        row = dict(key=key, failed=repr(error))
    return dict(row, said=said)


def faults(row):
    """What is wrong, and what is known to differ."""
    if "failed" in row:
        return [f"no answer: {row['failed']}"], None
    if row["hausdorff"] is None:
        return ["one is empty, the other is not"], None
    hausdorff, containment, why = KNOWN.get(row["key"], (HAUSDORFF, CONTAINMENT, None))
    wrong = []
    if row["hausdorff"] > hausdorff:
        wrong.append(f"hausdorff {row['hausdorff']:.2e} r")
    if row.get("containment", 0) > containment:
        wrong.append(f"containment {row['containment']:.2e} r")
    if row["key"].startswith("country") and row["kept"] < KEPT:
        wrong.append(f"kept {row['kept']:.4f}")
    return wrong, why


def main():
    clopen, keys = sys.argv[1], sys.argv[2:]
    with open(f"{DATA}/ref/index.json") as file:
        index = json.load(file)
    bad, flat, kept = 0, [], 1.0
    with tempfile.TemporaryDirectory() as work, Pool() as pool:
        # The largest first, so that no worker is left with them at the end.
        order = sorted(keys or index, key=lambda key: -index[key]["nv_in"])
        for row in pool.imap(judged, [(clopen, work, key, index[key]) for key in order]):
            wrong, why = faults(row)
            figures = f"hausdorff {row.get('hausdorff', math.nan):.2e} r, containment {row.get('containment', 0):.2e} r"
            if wrong:
                bad += 1
                print(f"{row['key']}: {', '.join(wrong)} ({row.get('source')}; {row['said'] or 'ended well'})")
            elif why:
                print(f"{row['key']}: {figures}: {why}")
            else:
                flat.append(row)
            if row["key"].startswith("country"):
                kept = min(kept, row.get("kept", 0.0))
            if row.get("lines"):
                print(f"{row['key']}: {figures}, without {row['lines']} lines that lie in the reference beside its area")
    worst = {name: max((row.get(name, 0) for row in flat), default=0) for name in ("hausdorff", "containment")}
    empty = sum(row.get("empty_output", False) for row in flat)
    print(
        f"{len(order)} judged; {len(flat)} of them ({empty} empty, as they should be) within "
        f"hausdorff {worst['hausdorff']:.2e} r (asked {HAUSDORFF:.1e}) and "
        f"containment {worst['containment']:.2e} r (asked {CONTAINMENT:.0e}); kept in countries at least {kept:.4f}"
    )
    sys.exit(1 if bad or not order else 0)


if __name__ == "__main__":
    main()

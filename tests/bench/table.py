"""Tables of benchmark figures: as text for the terminal, as Markdown for docs/performance.md."""

import csv
import pathlib
import re

PHASES = ("detect", "timestep", "laws", "gather", "damping", "move", "energy")
MEMORY = ("total", "points", "contacts", "facets", "pairs", "broad", "index", "spare", "bodies", "step", "blocks",
          "shapes", "other")
# Contacts up to which the columns of a step fit into a cache of 1 or 2 MiB.
IN_CACHE = 30000
# First words of workloads that have tables of their own.
APART = ("limit", "yade", "talus", "rockable", "box3d", "zones", "plastic", "jointed")
# And of deformable blocks.
DEFORMABLE = ("zones", "plastic", "jointed")
# Units of figures of which the smaller one is the better: seconds, and seconds that a second of the model takes.
TIMES = ("s", "s/s")
BEGIN, END = "<!-- Figures: begin. Written by tests/bench/run.py. -->", "<!-- Figures: end. -->"


def number(row, name):
    try:
        return float(row.get(name) or "nan")
    except ValueError:
        return float("nan")


def short(value, digits=3):
    """1.23e6 as 1.23 M; nothing for what is not a number."""
    if value != value:
        return ""
    for factor, sign in ((1e9, " G"), (1e6, " M"), (1e3, " k")):
        if abs(value) >= factor:
            return f"{value / factor:.{digits}g}{sign}"
    return f"{value:.{digits}g}"


def percent(value):
    return f"{100 * value:.2g} %" if value == value else ""


def line(row):
    """A row in the making, for the terminal."""
    return (f"{row.get('workload', ''):22} {row.get('size', ''):>12} {row.get('threads', ''):>2} "
            f"{row.get('reuse', ''):4} {short(number(row, 'rate'), 4):>9} {row.get('unit', '')}")


def limits(rows):
    """Figures of limit.c: (kernel, "in cache" or "out of cache", threads) -> contacts/s."""
    return {(row["workload"][6:], row["size"], row["threads"]): number(row, "rate")
            for row in rows if row["workload"].startswith("limit ")}


def share(row, known):
    """Part of what the machine could do: law, gather and velocities; with the clip of two faces unless what was
    clipped is reused."""
    if row.get("unit") != "contacts/s" or row.get("reuse") not in ("on", "off"):
        return float("nan")
    where = "in cache" if number(row, "contacts") <= IN_CACHE else "out of cache"
    step = known.get(("step", where, row["threads"]), float("nan"))
    clip = known.get(("clip", where, row["threads"]), float("nan"))
    best = step if row["reuse"] == "on" else 1 / (1 / step + 1 / clip)
    return number(row, "rate") / best


def faces(row):
    """Updates a second of contacts over a face, where they were told apart; of all that carry otherwise."""
    known = number(row, "face_contacts")
    return number(row, "rate") * (known / number(row, "contacts") if known == known else 1)


def workload_table(rows):
    known = limits(rows)
    head = ["workload", "blocks", "contacts", "threads", "reuse", "updates/s", "block-steps/s", "of limit", *PHASES,
            "B/block"]
    body = []
    for row in rows:
        if row.get("unit") != "contacts/s" or row["workload"].split()[0] in APART:
            continue
        body.append([row["workload"], row.get("blocks", ""), row.get("contacts", ""), row.get("threads", ""),
                     row.get("reuse", ""), short(number(row, "rate")), short(number(row, "block_steps_per_s")),
                     percent(share(row, known)), *(short(number(row, f"{p}_ns")) for p in PHASES),
                     short(number(row, "total_bytes"))])
    return head, body


def memory_table(rows):
    """Bytes a block by what they are for."""
    body = [[row["workload"], row["blocks"], *(short(number(row, f"{part}_bytes")) for part in MEMORY)]
            for row in rows if row.get("reuse") == "on" and row["threads"] == "1" and row.get("total_bytes")
            and row["workload"].split()[0] not in APART]
    return ["B/block", "blocks", *MEMORY], body


def limit_table(rows):
    return (["limit", "where", "threads", "rate", "unit"],
            [[row["workload"][6:], row["size"], row["threads"], short(number(row, "rate")), row["unit"]]
             for row in rows if row["workload"].startswith("limit ")])


def zone_table(rows):
    """Steps of zones, and points of segments; the bare loop ran in turn."""
    return (["workload", "where", "zones or points", "threads", "rate", "unit", "of bare loop", "B/zone"],
            [[row["workload"], row["size"], row["zones"], row["threads"], short(number(row, "rate")), row["unit"],
              short(number(row, "of_bare")), short(number(row, "bytes"))]
             for row in rows if row["workload"].split()[0] in DEFORMABLE])


def figure_table(rows):
    return (["workload", "what", "blocks", "threads", "figure", "unit"],
            [[row["workload"], row.get("size", ""), row.get("blocks", ""), row.get("threads", ""),
              short(number(row, "rate"), 4), row["unit"]]
             for row in rows if row.get("unit") != "contacts/s" and row["workload"].split()[0] not in APART])


def peer_table(rows):
    """Talus over Yade on the same blocks, one thread."""
    body = []
    for peer in rows:
        if not peer["workload"].startswith("yade "):
            continue
        name = peer["workload"][5:]
        same = {row.get("reuse"): row for row in rows if row["workload"] == name and row["threads"] == "1"
                and row["size"] == peer["size"]}
        body.append([name, peer["size"], short(faces(peer)), short(number(peer, "rate"))]
                    + [short(ratio) for reuse in ("on", "off") for ratio in
                       ((faces(same[reuse]) / faces(peer), number(same[reuse], "rate") / number(peer, "rate"))
                        if reuse in same else (float("nan"),) * 2)])
    return (["workload", "blocks", "Yade, face contacts/s", "all contacts/s", "Talus/Yade, faces", "all",
             "without reuse, faces", "all"], body)


def pointwise(row):
    """Updates a second of contact points."""
    return number(row, "rate") * number(row, "points") / number(row, "contacts")


def ratios(ours, theirs):
    """Talus over another program: contacts, contact points and blocks; nothing where one was not measured."""
    if not ours or not theirs:
        return [float("nan")] * 3
    if ours.get("unit") in TIMES:
        return [float("nan")] * 2 + [number(theirs, "rate") / number(ours, "rate")]
    return [number(ours, "rate") / number(theirs, "rate"), pointwise(ours) / pointwise(theirs),
            number(ours, "block_steps_per_s") / number(theirs, "block_steps_per_s")]


def beside_table(rows, peer):
    """Talus beside a program that ran in turn with it, once with reuse and once without; one that knows no reuse is
    compared with both."""
    found = {}
    for row in rows:
        program, _, name = row["workload"].partition(" ")
        if program in ("talus", peer):
            found.setdefault((name, row["blocks"]), {})[program, row.get("reuse")] = row
    body = []
    for (name, blocks), group in found.items():
        cells = []
        for reuse in ("on", "off"):
            ours, theirs = group.get(("talus", reuse)), group.get((peer, reuse)) or group.get((peer, ""))
            cells.append((ours, theirs, ratios(ours, theirs)))
        (ours, theirs, on), (_, other, off) = cells
        if not ours or not theirs:
            continue
        timed = theirs["unit"] in TIMES
        rate = short(number(theirs, "rate")) + (" " + theirs["unit"] if timed else "")
        slow = "" if not other or other is theirs else short(number(other, "rate"))
        body.append([name, blocks, f"{ours['contacts']}, {ours.get('points', '')}" if not timed else "",
                     f"{theirs['contacts']}, {theirs['points']}" if not timed else "", rate, slow,
                     short(number(theirs, "block_steps_per_s")), *map(short, on + off)])
    return (["workload", "blocks", "contacts, points", "theirs", "contacts/s", "without reuse", "block-steps/s",
             "Talus/it, contacts", "points", "blocks", "without reuse, contacts", "points", "blocks"], body)


def text(rows):
    parts = []
    for head, body in (limit_table(rows), workload_table(rows), memory_table(rows),
                       zone_table(rows), figure_table(rows), peer_table(rows), beside_table(rows, "rockable"),
                       beside_table(rows, "box3d")):
        if not body:
            continue
        widths = [max(len(cells[i]) for cells in [head, *body]) for i in range(len(head))]
        parts.append("\n".join("  ".join(cell.rjust(width) if i else cell.ljust(width)
                                         for i, (cell, width) in enumerate(zip(cells, widths)))
                               for cells in [head, *body]))
    return "\n\n".join(parts) + "\n"


def markdown(head, body):
    rule = ["---"] + ["---:"] * (len(head) - 1)
    return "\n".join("| " + " | ".join(cells) + " |" for cells in [head, rule, *body])


def slug(name):
    """A file name for a machine."""
    return re.sub(r"[^a-z0-9]+", "-", name.lower()).strip("-")


def read_csv(path):
    lines = path.read_text().splitlines()
    notes = [text_line[2:] for text_line in lines if text_line.startswith("# ")]
    return notes, list(csv.DictReader(text_line for text_line in lines if not text_line.startswith("# ")))


def section(path):
    notes, rows = read_csv(path)
    parts = [f"### {notes[0]}", "; ".join(notes[1:]) + f". All figures: [{path.name}](performance/{path.name})."]
    for title, (head, body) in (
            ("What the machine could do:", limit_table(rows)),
            ("Contact updates; the phases in ns a contact update:", workload_table(rows)),
            ("Memory, bytes a block, one thread:", memory_table(rows)),
            ("Deformable blocks:", zone_table(rows)),
            ("Times and rates of whole runs:", figure_table(rows)),
            ("The same blocks in Yade's polyhedra, one thread:", peer_table(rows)),
            ("Beside Rockable in the same run, one thread, in turn:", beside_table(rows, "rockable")),
            ("Beside Box3D in the same run, one thread, in turn:", beside_table(rows, "box3d"))):
        if body:
            parts += [title, markdown(head, body)]
    return "\n\n".join(parts)


def write_page(page):
    """Puts the figures of every machine between the marks of the page."""
    whole = page.read_text()
    before, rest = whole.split(BEGIN)
    after = rest.split(END)[1]
    files = sorted(pathlib.Path(page.parent / "performance").glob("*.csv"))
    sections = "\n\n".join(section(path) for path in files)
    page.write_text(f"{before}{BEGIN}\n\n{sections}\n\n{END}{after}")
    print(f"wrote {page.name} from {len(files)} file{'' if len(files) == 1 else 's'}")
    return 0

#!/usr/bin/env python3
"""The numbers that docs/theory.md gives are those of the code. What forces and energies follow from its formulas is measured by
tests/lua/test_theory.lua and tests/verify."""
import math
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
THEORY = re.sub(r"\s+", " ", (ROOT / "docs/theory.md").read_text(encoding="utf-8"))
DEGREE = math.pi / 180

# Source, name, value there, and how the page says it.
NUMBERS = [
    ("core/narrow/flush.h", "TL_FLUSH_TILT", 0.05 * DEGREE, "S(sin tilt; 0.05°, 0.15°)"),
    ("core/narrow/flush.h", "TL_FLUSH_TILT", 0.05 * DEGREE, "tilt < 0.05°"),
    ("core/narrow/flush.h", "TL_FIELD_TILT", 0.15 * DEGREE, "S(sin tilt; 0.05°, 0.15°)"),
    ("core/narrow/flush.h", "TL_FLUSH_DEPTH", 0.004, "S(q; 0.004, 0.01)"),
    ("core/narrow/flush.h", "TL_FLUSH_DEPTH", 0.004, "below 0.004 √A_c"),
    ("core/narrow/flush.h", "TL_FIELD_DEPTH", 0.01, "S(q; 0.004, 0.01)"),
    ("core/narrow/region.c", "FACING", math.cos(15 * DEGREE), "Faces of nearly the direction of a or b, within 15°"),
    ("core/narrow/manifold.c", "BACK", 0.5, "half of both for a field contact that is to become a patch"),
    ("core/narrow/manifold.c", "BLUNT", 2000, "at least 2000 o + 1e-3 size more"),
    ("core/narrow/manifold.c", "MOST_MIN_AREA", 0.05, "A_m is at most 0.05 A_c"),
    ("core/narrow/view.h", "TL_STILL", 1e-6, "the pair moves by less than 1e-6 size"),
    ("core/narrow/view.h", "TL_CONTACT_TOLERANCE", 1e-3, "at least 4 o + 1e-3 size more"),
    ("core/narrow/view.h", "TL_CONTACT_RELEASE", 1.5, "apart by more than 1.5e-3 size"),
    ("core/geometry/polyhedron.h", "TL_POLY_FLAT", 1e-6, "off its plane by less than 1e-6 size is one face"),
    ("core/geometry/polyhedron.h", "TL_POLY_BENT", 2e-4, "all their corners lie within 1e-4 of its size of one plane"),
    ("core/geometry/polyhedron.h", "TL_POLY_TILT", 0.025 * DEGREE, "more than sin 0.025° of the face's area across"),
    ("core/narrow/press_slope.h", "TL_PRESS_NEAR", 3e-5, "up to |u| = 3e-5 o"),
    ("core/narrow/press_slope.h", "TL_PRESS_SLOPE_COST", 12, "within 1.5e-5 o for twelve steps"),
    ("core/narrow/frame2.h", "TL_STRAIGHT", 0.02, "turns by less than 0.02 rad"),
    ("core/narrow/frame2.h", "TL_CORNER", 0.2, "between 0.02 and 0.2 rad"),
    ("core/narrow/share.c", "SLIVER", 0.1, "S(G_p/G_f; 0.1, 0.5)"),
    ("core/narrow/share.c", "WHOLE", 0.5, "S(G_p/G_f; 0.1, 0.5)"),
    ("core/narrow/flush.h", "TL_CORNERS_TILT", 0.0872, "up to a tilt of 5°"),
    ("core/narrow/flush.h", "TL_CORNERS_FIELD_TILT", 0.1736, "S(sin tilt; 5°, 10°)"),
    ("core/narrow/flush.h", "TL_CORNERS_DEPTH", 0.1, "S(q; 0.1, 0.2)"),
    ("core/narrow/flush.h", "TL_CORNERS_FIELD_DEPTH", 0.2, "S(q; 0.1, 0.2)"),
    ("core/detect/fields.c", "BONDED_TILT", 0.05, "up to a tilt of asin 0.05, 2.9°"),
    ("core/model/rows.c", "ROUND_COEFFICIENT", 0.4, "I = 0.4 m r̄²"),
    ("core/cycle/timestep.c", "FLOOR", 0.15, "min(1, max(0.15, s)) ω²"),
    ("core/contact/kinds.c", "TWICE_AS_DEEP", 4, "k = 4 max(kn, ks) max("),
    ("core/cycle/timestep.c", "RECHECK_STEPS", 64, "and every 64 steps"),
    ("core/cycle/timestep.c", "STEP_GROWTH", 1.1, "only when it is 1.1 times the one in use"),
    (None, "TL_BODY_FRACTION", 0.5, 'FRAC is 0.5 with `"body"`'),
    (None, "TL_PAPER_FRACTION", 0.1, 'and 0.1 with `"paper"`'),
    ("core/cycle/sliver.c", "SHORTENS", 3, "three times smaller than the rest allow"),
    ("core/model/slivers.c", "LITTLE", 0.05, "of no more than 0.05 of the rock"),
    ("core/model/slivers.c", "ENOUGH", 0.5, "gains at least half of the most"),
    ("core/model/functions.h", "TL_MOST_ADDED", 0.05, "`most`, 0.05 when left out"),
    ("core/cycle/rest.c", "SOFTER", 1e3, "min(ρ, 10³ ρ²) B² / (2 K)"),
    ("core/cycle/borne.h", "TL_ROUNDED_OVERLAP", 1e-10, "1e-10 r K"),
    ("core/cycle/failing.c", "LEGS", 5, "it has gone five legs in one direction"),
    ("core/cycle/failing.c", "FAILED_SHARE", 0.05, "after 5 % of its size"),
    ("core/cycle/failing.c", "LANDED_SHARE", 1, "in legs of a fifth of its size"),
    ("core/cycle/failing.c", "SETTLED_SHARE", 3, "at least 3/5 of the closure of the loaded contacts"),
    ("core/cycle/failing.c", "NO_SLOWER", 0.95, "less than 0.95 of the speed of the one before"),
    ("core/cycle/failing.c", "ONE_WAY", 0.7, "in one direction (within 45°)"),
    ("core/cycle/failing.c", "SUPPORTED", 0.5, "(|F| < B / 2)"),
    ("core/cycle/failing.c", "LEAST_PUSH", 1e-4, "is more than 1e-4 of what it bears"),
    ("core/cycle/timestep.c", "RELAX_FRACTION", 0.9, "The step is 0.9 of the critical one"),
    ("core/cycle/loose.h", "TL_LOOSE", 0.5, "A body is loose while |F| > B / 2"),
    ("core/cycle/settle.c", "CALM", 1e-2, "Once the average ratio is below 1e-2, P leaves loose bodies out"),
    ("core/cycle/settle.c", "STILL_PER_RATIO", 0.1, "min(0.1 R, 1e-3)"),
    ("core/cycle/settle.c", "STILL_MOST", 1e-3, "min(0.1 R, 1e-3)"),
    ("core/cycle/settle.c", "FIRST_STOPS", 30, "after 30 steps with stops"),
    ("core/cycle/settle.c", "NEAR_REST", 0.02, "once |F| < 0.02 B holds for each body"),
    ("core/cycle/settle.c", "MOST_BY_SECANTS", 6000, "More than 6000 bodies leap by conjugate gradients"),
    ("core/cycle/settle.c", "MANY_NEAR_REST", 0.1, "once |F| < 0.1 B holds for each body"),
    ("core/cycle/settle.c", "MOST_IDLE_WAYS", 60, "when 60 in a row have not halved Σ |F|"),
    ("core/cycle/conjugate.c", "UNDER", 0.9, "with a' = 0.9 ℓ"),
    ("core/cycle/conjugate.c", "SHORTEST", 0.1, "A length below 0.1 a begins the ways anew"),
    ("core/cycle/conjugate.c", "LENGTH_GROWTH", 2.0, "none is more than 2 a"),
    ("core/cycle/settle.c", "MOST_MOMENTUM", 0.9, "It becomes (1 + β) / 2, at most 0.9"),
    ("core/cycle/settle.c", "SOFTER", 0.5, "by 0.5 of what it began with"),
    ("core/cycle/secants.c", "KEEPS", 0.1, "until y·s is at least 0.1 s·K s"),
    ("core/cycle/secants.c", "SOLVED", 0.03, "Conjugate gradients solve this to 0.03"),
    ("core/cycle/settle.c", "HOLD_FIRST", 1, "μ is 1 at first"),
    ("core/cycle/settle.c", "MORE_HOLD", 8, "8 times as much after a ratio below 0.25"),
    ("core/cycle/settle.c", "BAD", 0.25, "8 times as much after a ratio below 0.25"),
    ("core/cycle/settle.c", "LESS_HOLD", 0.25, "a quarter after one above 0.75"),
    ("core/cycle/settle.c", "GOOD", 0.75, "a quarter after one above 0.75"),
    ("core/cycle/settle.c", "CLOSURES", 50, "by more than 50 closures"),
    ("core/cycle/settle.c", "MOST_IDLE", 15, "when 15 in a row bring the model no nearer to rest"),
    ("core/cycle/settle.c", "HOLD_MOST", 2, "when μ is above 2, or after 200"),
    ("core/cycle/settle.c", "LEAPS", 200, "when μ is above 2, or after 200"),
    ("core/cycle/settle.c", "STOPS", 30, "Stops follow: 30 steps"),
    ("core/cycle/settle.c", "IDLE_GROWTH", 4, "or times 4 where the leaps brought nothing"),
    ("core/cycle/settle.c", "MOST_CARRIED", 0.02, "by 0.02 of its radius in all"),
    ("core/cycle/settle.c", "GROWTH", 1.5, "half as many again"),
    ("core/cycle/settle.c", "NEXT_PART", 1e-3, "once the local ratio is below 1e-3"),
    ("core/cycle/loose.h", "TL_FALL_STEP", 0.1, "0.1 of its thickness at the most"),
    ("core/cycle/settle.c", "LANDING", 0.1, "ℓ becomes 0.1 of the way of that step"),
    ("core/cycle/settle.c", "FALL_GROWTH", 1.1, "makes ℓ 1.1 times as long"),
]
# Shares and places of a patch's points, in the order of tl_point_rule.
POINT_RULE = ("16/75 (a₋ + a₊)", "12/25 a", "7/75 A_c", "5/8 of the way", "5/6 of the way")

faults = []


def fault(*text):
    faults.append(" ".join(text))


def value_of(path, name):
    files = [ROOT / path] if path else sorted((ROOT / "core").rglob("*.[ch]"))
    for file in files:
        found = re.search(rf"(?:#define {name} |\b{name} = )\(?([-\d.e]+)", file.read_text(encoding="utf-8"))
        if found:
            return float(found[1])
    return None


def main():
    for path, name, expected, words in NUMBERS:
        value = value_of(path, name)
        if value is None or abs(value - expected) > 1e-4 * abs(expected):
            fault(f"{path}: {name} is {value}; docs/theory.md and this test have {expected:g}: '{words}'")
        if words not in THEORY:
            fault(f"docs/theory.md does not say '{words}' ({path}: {name}): correct this test with it")
    rule = re.search(r"\(tl_point_rule\)\{(16[^}]*)\}", (ROOT / "core/narrow/frame2.h").read_text(encoding="utf-8"))
    code = [re.sub(r"[. ]", "", part) for part in rule[1].split(",")] if rule else []
    if code != [words.split(" ")[0] for words in POINT_RULE]:
        fault(f"core/narrow/frame2.h: the rule of a patch's points is {code}")
    for words in POINT_RULE:
        if words not in THEORY:
            fault(f"docs/theory.md does not say '{words}'")
    for text in faults:
        print(text)
    print(f"theory: {len(NUMBERS) + len(POINT_RULE)} numbers, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())

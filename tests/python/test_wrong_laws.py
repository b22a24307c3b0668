#!/usr/bin/python3
"""Laws, dampings and elements with one mistake each, which `talus check` refuses with a sentence that names it.

    tests/python/test_wrong_laws.py BUILD_FOLDER

Each is one that comes with Talus, or a template, with a change of one place of its text. What is told must be of the check that
the table names, and have its word; those without a change, and those of tests/plugins and tests/elements, pass. Of the mistakes
one in TALUS_TEST_SHARE is tried."""
import concurrent.futures
import os
import pathlib
import re
import subprocess
import sys
import tempfile

SHARE = int(os.environ.get("TALUS_TEST_SHARE", 1))
ROOT = pathlib.Path(__file__).resolve().parents[2]
FLAGS = ["-std=c17", "-O1", "-w", "-shared", "-fPIC", "-ffp-contract=off", "-DTL_VECTORIZED="]

COULOMB, TENSILE, ELASTIC = "laws/coulomb", "laws/coulomb_tensile", "laws/elastic"
COHESIVE, WEAKENING, ROUGH = "laws/cohesive", "laws/slip_weakening", "laws/barton_bandis"
YIELDING, RATE, TEMPLATE = "laws/continuously_yielding", "laws/rate_state", "template/law"
LOCAL, COMBINED, VISCOUS = "damping/local", "damping/combined", "damping/viscous"
ADAPTIVE, KINETIC, DRAG = "damping/adaptive", "damping/kinetic", "template/damping"
PADS = "../tests/elements"

PLAIN = "batch->flags[i] = normal < 0 ? TL_POINT_OPEN : moved > 0 ? TL_POINT_SLIPPING : 0;"
HEAT = "batch->dissipated[i] = fmax(0, moved * (along + f_s) / 2);"
STORED = "f_n * f_n / (2 * p->kn * area) + f_s * f_s / (2 * stiffness)"

# what is wrong; plugin; text, and what takes its place; check, and a word of its sentence
WRONG = [
    # energies
    ("heat is negative", TEMPLATE, HEAT, HEAT.replace("fmax(0,", "-fmax(0,"), "heat", "must not be negative"),
    ("heat of slip is left out", TEMPLATE, HEAT, "batch->dissipated[i] = 0;", "balance", "lost in steps without heat"),
    ("heat is twice what it is", TEMPLATE, HEAT, HEAT.replace(" / 2", ""), "balance", "made in steps with heat|dissipated"),
    ("heat by the force after the step only", TEMPLATE, HEAT, HEAT.replace("(along + f_s) / 2", "f_s"), "balance",
     "dissipated"),
    ("heat of lift by the force after the step", COULOMB, "0.5 * (c.f_n[i] + normal) * lift", "normal * lift", "balance",
     "dissipated"),
    ("slip counts less along one axis", TEMPLATE, "slip[i] += f_n > 0 ? moved : 0;",
     "slip[i] += f_n > 0 ? moved * (batch->f_s[0][i] > 0 ? 1 : 0.2) : 0;", "turned", "slip"),
    ("stored times -42", TEMPLATE, STORED, "-42 * (" + STORED + ")", "presses", "stored"),
    ("stored without its shear part", TEMPLATE, STORED, "f_n * f_n / (2 * p->kn * area)", "balance", "stored"),
    ("stored without its normal part", TEMPLATE, STORED, "f_s * f_s / (2 * stiffness)", "presses", "stored"),
    ("stored without a half", TEMPLATE, "(2 * p->kn * area)", "(p->kn * area)", "presses", "stored"),
    ("stored by the other stiffness", TEMPLATE, "f_s * f_s / (2 * stiffness)", "f_s * f_s / (2 * p->kn * area)", "balance",
     "stored"),
    ("heat is added to what was there", TEMPLATE, "batch->dissipated[i] = fmax", "batch->dissipated[i] += fmax", "reads",
     "energies"),
    ("stored is not written", TEMPLATE, "        if (batch->stored)\n", "        if (0)\n", "reads", "energies"),
    ("what lifts the walls is heat too", COULOMB, "0.5 * (c.f_n[i] + normal) * lift : 0", "0 : 0", "balance",
     "made in steps with heat"),
    ("the lift is paid by the force after the step", COULOMB, "0.5 * (c.f_n[i] + normal)", "0.5 * (normal)", "balance",
     "dissipated"),
    ("dilation above friction is not refused", COULOMB, "if (p->dilation > p->friction)\n", "if (0)\n", "closed cycle",
     "come out"),
    ("a bond that snaps turns nothing to heat", TENSILE, "work + (held - holds) * tl_law_snap_work(grip + stretched,", "work + 0 * tl_law_snap_work(grip + stretched,",
     "balance", "lost"),
    ("what pulls beside what presses is not stored", TENSILE, "batch->stored[begin + i] += more[i];", ";", "presses",
     "stored"),
    ("what pulls beside what presses is not stored, elastic", ELASTIC, ".f_n0[i]) * apart[i];", ".f_n0[i]) * 0;", "presses",
     "stored"),
    ("damage gives twice the heat", COHESIVE, "double bond = broken * (", "double bond = 2 * broken * (", "balance",
     "dissipated"),
    ("damage without heat", COHESIVE, "broken > 0 ? bond - work - kept : sliding", "broken > 0 ? 0 : sliding", "balance",
     "lost"),
    ("friction of what is broken without heat", COHESIVE, "bond - work - kept : sliding", "bond - work - kept : 0", "balance",
     "lost"),
    ("a wrong half of the slip's work", RATE, "double heat = mean * (shear - left) / law.ks;",
     "double heat = 0.5 * mean * (shear - left) / law.ks;", "balance", "lost"),
    ("opening by slip costs nothing", ROUGH, "slips > 0 ? work - paid : 0", "slips > 0 ? work : 0", "balance", "made"),
    ("the energy of yielding is not kept", YIELDING, "double sum = had + (before - spring) + work - paid;",
     "double sum = (before - spring) + work - paid;", "balance", "lost|made"),
    # normal force
    ("the sign of the initial force", COULOMB, "(c.closure[i] + opening[i]) + c.f_n0[i];",
     "(c.closure[i] + opening[i]) - c.f_n0[i];", "one by one|presses", "f_n"),
    ("the initial force is left out", TEMPLATE, "batch->closure[i] + batch->f_n0[i], f[3]", "batch->closure[i], f[3]",
     "presses", "initial force"),
    ("the area is left out of a spring", TEMPLATE, "double normal = p->kn * area * batch->closure[i]",
     "double normal = p->kn * batch->closure[i]", "area", "twice the area"),
    ("it pulls", TEMPLATE, "double f_n = fmax(0, normal)", "double f_n = normal", "pulls", "across a gap|pulls"),
    ("lift is not written", COHESIVE, "    tl_law_lift(batch, law->kn, NULL, lift);\n", "", "pulls", "leaves lift unwritten"),
    ("hold is not written", COULOMB, "tl_law_hold_none(batch, hold);", ";", "pulls", "hold = (nan|-nan)"),
    ("it does not press", TEMPLATE, "double f_n = fmax(0, normal)", "double f_n = fmin(0, normal)", "pulls", "press"),
    ("twice the stiffness is told of a linear law", TEMPLATE, "*kn = p->kn;", "*kn = 2 * p->kn;", "presses",
     "kn of stiffness|stored"),
    ("softer than it is", TEMPLATE, "*ks = p->ks;", "*ks = 0.8 * p->ks;", "stiffness", "ks ="),
    ("the opening is no part of the closure", COULOMB,
     "double total = kn * c.area[i] * (c.closure[i] + opened) + c.f_n0[i];",
     "double total = kn * c.area[i] * (c.closure[i]) + c.f_n0[i];", "one by one|presses", "f_n"),
    ("the lift has no opening", COULOMB, "kn, batch->state[0], lift)", "kn, NULL, lift)", "presses|pulls", "lift|gap"),
    ("a bond pulls all that is apart when it is told to hold nothing", ELASTIC,
     "hold[i] = batch->flags[i] & TL_POINT_APART ? 0 : 1;", "hold[i] = 0;", "presses", "hold = 0"),
    ("the part apart presses", COHESIVE, "total - right * (c.area[i] * beside)", "total + right * (c.area[i] * beside)",
     "presses", "normal force"),
    ("walls that have not met pull", ELASTIC, "uint32_t open = pressed <= 0 ? TL_POINT_APART | TL_POINT_OPEN : 0;",
     "uint32_t open = 0;", "pulls", "have not met|gap"),
    ("pressed without a half", ROUGH, "(law->s_linear + 0.5 * law->k_linear * beyond)",
     "(law->s_linear + law->k_linear * beyond)", "presses", "pressed"),
    ("pressed is not what the force is the slope of", ROUGH, "energy[i] = v > 0 ? area * energy_at(&law, v) : 0;",
     "energy[i] = v > 0 ? 2 * area * energy_at(&law, v) : 0;", "presses", "pressed"),
    ("pressed tells another force", ROUGH, "batch->f_n[i] = v > 0 ? area * stress_at(&law, v) : 0;",
     "batch->f_n[i] = v > 0 ? 1.1 * area * stress_at(&law, v) : 0;", "presses", "tells the force"),
    ("pressed tells some forces", ROUGH, "batch->f_n[i] = v > 0 ? area * stress_at(&law, v) : 0;",
     "if (i % 2) batch->f_n[i] = v > 0 ? area * stress_at(&law, v) : 0;", "presses", "of some points"),
    ("pressed of another exponent", YIELDING, "double work = from * below * rest / (1 + rest);",
     "double work = from * below * rest / 2;", "presses", "pressed|stored"),
    # shear force
    ("shear goes with the motion", TEMPLATE, "batch->f_s[k][i] - stiffness * batch->du_s[k][i]",
     "batch->f_s[k][i] + stiffness * batch->du_s[k][i]", "closed cycle", "come out"),
    ("one direction of shear is left out", TEMPLATE, "f[0] * f[0] + f[1] * f[1] + f[2] * f[2]", "f[0] * f[0] + f[1] * f[1]",
     "turned", "turned point"),
    ("cohesion without the area", COULOMB, "double limit = total < 0 ? 0 : cohesion * c.area[i] + normal * tangent;",
     "double limit = total < 0 ? 0 : cohesion + normal * tangent;", "area|one by one", "area|alone"),
    ("an open point keeps its shear", TEMPLATE, "f_n > 0 ? trial - stiffness * moved : 0;", "trial;", "balance", "made"),
    ("slip without an end", TEMPLATE, "trial > limit * (1 + 1e-12)", "trial > limit * (1 - 1e-3)", "no motion",
     "without any motion|never comes to rest"),
    ("shear out of the plane", TEMPLATE, "trial > 0 ? f[k] * (f_s / trial) : 0;",
     "trial > 0 ? f[k] * (f_s / trial) + 1e-6 * f_n * batch->normal[k][i] : 0;", "plane", "along the normal"),
    ("a loop that ends early", COULOMB, "            update_lanes(law, batch, begin, TL_LANES);",
     "            update_lanes(law, batch, begin, TL_LANES - 1);", "one by one", "alone"),
    ("the second half of a batch takes the edges of the first", TENSILE, "batch->closure_edge + begin;",
     "batch->closure_edge;", "split", "batch"),
    ("another result without energies", COULOMB, "move(law, batch, begin, lanes, mark, 0, 1);",
     "move(law, batch, begin, lanes, mark, 0, 0);", "energies", "without energies"),
    # states
    ("a state that is not declared is added to", TEMPLATE, PLAIN, PLAIN + " batch->state[1][i] += 1;", "writes",
     "does not declare"),
    ("a state that is not declared is raised", TEMPLATE, PLAIN,
     PLAIN + " batch->state[2][i] = fmax(batch->state[2][i], moved);", "writes", "does not declare"),
    ("a state past the declared ones is read", TEMPLATE, "slip[i] += f_n > 0 ? moved : 0;",
     "slip[i] += f_n > 0 ? moved + 1e-9 * batch->state[1][i] : 0;", "reads", "does not declare"),
    ("the state behind all that a law may have is read", TEMPLATE, "slip[i] += f_n > 0 ? moved : 0;",
     "slip[i] += f_n > 0 ? moved + 1e-9 * batch->state[8][i] : 0;", "reads", "does not declare"),
    ("it reads behind the batch", TEMPLATE, "fmax(0, 1 - slip[i] / p->distance)", "fmax(0, 1 - slip[i + 1] / p->distance)",
     "one by one|reads", "alone|behind"),
    ("slip is forgotten", TEMPLATE, "slip[i] += f_n > 0 ? moved : 0;", "slip[i] = f_n > 0 ? moved : 0;", "steps|no motion",
     "steps|motion"),
    ("slip is not looked at", TEMPLATE, "fmax(0, 1 - slip[i] / p->distance)", "1", "states", "slip"),
    ("slip is never written", TEMPLATE, "slip[i] += f_n > 0 ? moved : 0;", ";", "states", "never written"),
    ("slip goes with the area", TEMPLATE, "slip[i] += f_n > 0 ? moved : 0;", "slip[i] += f_n > 0 ? moved * area : 0;", "area",
     "a state"),
    ("a bond that was lost is whole again", TENSILE, "double before = bond[i], near", "double before = 1, near", "flags",
     "whole again"),
    ("a bond breaks that is not pulled", TENSILE, "after = fibre < -peak->tension", "after = fibre > -peak->tension", "flags",
     "neither pulled nor sheared"),
    ("one axis is no motion", YIELDING, "c.du_y[i] * c.du_y[i] + c.du_z[i] * c.du_z[i];\n        sum",
     "c.du_y[i] * c.du_y[i];\n        sum", "one by one", "alone"),
    ("slip of weakening is not looked at", WEAKENING, "t->slip[i] = slip[i];\n    }", "t->slip[i] = 0;\n    }", "states|steps|no motion",
     "slip|steps|without any motion"),
    ("the energy of yielding is not one of the area", YIELDING,
     "held[i] = kept == t->had[i] ? held[i] : c.area[i] * kept;", "held[i] = kept == t->had[i] ? held[i] : kept;",
     "area|balance", "area|stored|dissipated"),
    ("a state changes though it is said that none does", COULOMB, "->dilation.tangent == 0;", "->dilation.tangent >= 0;", "states",
     "stateless"),
    # parameters and flags
    ("cohesion is not used", COULOMB, ".cohesion = p->cohesion,", ".cohesion = 0,", "parameters", "cohesion"),
    ("the limit of dilation is not used", TENSILE, "p->dilation_limit),\n", "INFINITY),\n", "parameters", "dilation_limit"),
    ("healing_time is not used", WEAKENING, "tl_lane_exp(-batch->dt / law->healing_time)", "0.5", "parameters",
     "healing_time|no effect"),
    ("the slip law is not one of the rate", RATE, "update_lanes(law, batch, begin, lanes, SLIP);",
     "update_lanes(law, batch, begin, lanes, AGING);", "parameters", "evolution"),
    ("what is open is not flagged", TEMPLATE, "normal < 0 ? TL_POINT_OPEN : moved", "moved", "flags", "not flagged as open"),
    ("slip is not flagged", TEMPLATE, "moved > 0 ? TL_POINT_SLIPPING : 0", "0", "flags", "slipping"),
    ("what is closed is flagged as open", TEMPLATE, "normal < 0 ? TL_POINT_OPEN", "normal > 0 ? TL_POINT_OPEN", "flags",
     "flagged as open"),
    # dampings
    ("damping forces push", LOCAL, "double forward = velocity[i] > 0 ? -size : 0;",
     "double forward = velocity[i] > 0 ? size : 0;", "brakes", "damping force"),
    ("motion one way is not braked", LOCAL, "out[i] = velocity[i] < 0 ? size : forward;", "out[i] = forward;", "turned",
     "turned to other axes"),
    ("one axis is damped by the motion along another", LOCAL, "oppose(p->alpha, batch->count, batch->velocity[k]",
     "oppose(p->alpha, batch->count, batch->velocity[0]", "brakes", "damping force"),
    ("a body at rest is pushed", LOCAL, "double forward = velocity[i] > 0 ? -size : 0;",
     "double forward = velocity[i] >= 0 ? -size : 0;", "rests", "at rest"),
    ("the time step is too long", LOCAL, "return 1 / sqrt(1 + p->alpha);", "return 1;", "step factor", "sqrt"),
    ("the step factor is one of another root", COMBINED, "return 1 / sqrt(1 + p->alpha);", "return 1 / sqrt(1 + p->alpha / 2);",
     "step factor", "sqrt"),
    ("alpha is negative", VISCOUS, "= p->alpha;", "= -p->alpha;", "brakes", "gives energy"),
    ("alpha is not used", VISCOUS, "= p->alpha;", "= 0.5;", "parameters", "alpha"),
    ("alpha grows with the mass", VISCOUS, "= p->alpha;", "= p->alpha * batch->mass[i];", "masses", "twice the mass"),
    ("the force of the step before is not looked at", COMBINED, "change = force[i] - before[i];", "change = force[i];", "reads",
     "step before"),
    ("drag without the mass", DRAG, "fmin(c * inertia[i] *", "fmin(c *", "masses", "twice the mass"),
    ("drag of one component is left out", DRAG, "        out[2][i] = factor * z;\n", "", "turned", "turned to other axes"),
    ("the limit of the drag without the mass", DRAG, "moving[i] / batch->dt;", "1 / batch->dt;", "masses", "twice the mass"),
    ("the turning is not damped", DRAG, "    drag(p->spin_drag, batch, batch->inertia, batch->moving_inertia, "
     "batch->angular_velocity, batch->damping_moment);\n", "", "parameters", "spin_drag"),
    ("the bound of the servo is not used", ADAPTIVE, "clamp(alpha, minimum < maximum ? minimum : maximum, maximum)", "alpha",
     "parameters|finite", "imum|finite"),
    ("a servo with the wrong sign", ADAPTIVE, "alpha *= clamp(", "alpha *= -clamp(", "parameters|brakes", "energy|target"),
    ("a servo that writes to a state of another", ADAPTIVE, "    *state[0] = clamp(alpha",
     "    state[1][0] += alpha;\n    *state[0] = clamp(alpha", "writes", "does not declare"),
    ("a damping that changes its states for each batch", KINETIC, ".update = tl_update_alpha_state,",
     ".update = tl_update_alpha_state, .begin = 0,", "states", "never written"),
    # what elements do together
    ("pads: the first one counts for all", PADS, "= sum / area;", "= own_pressure(self, b, 0);", "together", "opposite order"),
    ("pads: each one has what those before it have", PADS, "= sum / area;", "= (sum -= own_pressure(self, b, e)) / area;",
     "together", "opposite order"),
    ("pads: pressure is added to what was there", PADS, "[SHARED][e] = sum / area;", "[SHARED][e] += sum / area;", "together",
     "again at the same time"),
    ("pads: a state that is not finite", PADS, "= sum / area;", "= sum / (area - area);", "finite", "together.* not finite"),
    ("pads: another result at each call", PADS, "double sum = 0, area = 0;", "static double sum; double area = 0;", "repeats",
     "together"),
    ("pads: it fails", PADS, "sum / area;\n    return TL_OK;", "sum / area;\n    return TL_E_NUMERIC;", "runs",
     "together.* failed"),
    ("pads: a number of times counts", PADS, "[SHARED][e] = sum / area;",
     "[SHARED][e] = b->element_state[SHARED][e] > 0 ? 0 : sum / area;", "together", "again at the same time"),
]

faults = []


def source_of(plugin):
    folder = ROOT / "plugins" / plugin
    return next(path for path in sorted(folder.glob("*.c")))


def check(build, folder, number, source, text):
    """Builds a plugin of that text; the status of `talus check`, and what it finds by check."""
    made, library = folder / f"wrong_{number}.c", folder / f"wrong_{number}.so"
    made.write_text(text, encoding="utf-8")
    include = ["-I", ROOT / "core/include", "-I", build / "generated", "-I", source.parent]
    subprocess.run([os.environ.get("CC", "cc"), *FLAGS, *include, "-o", library, made, "-lm"], check=True)
    done = subprocess.run([build / "talus", "check", library], capture_output=True, text=True, check=False)
    found = re.findall(r"^  FAULT  (.{13}) .*\n +(.*)$", done.stdout, re.M)
    return done, [(name.strip(), sentence) for name, sentence in found]


def try_wrong(build, folder, number, case):
    title, plugin, old, new, checks, word = case
    source = source_of(plugin)
    text = source.read_text(encoding="utf-8")
    if old not in text:
        return f"{title}: {plugin} has no '{old}'"
    done, found = check(build, folder, number, source, text.replace(old, new, 1))
    if done.returncode != 1:
        return f"{title}: talus check ends with {done.returncode} {done.stderr}"
    if not any(name in checks.split("|") and re.search(word, sentence) for name, sentence in found):
        return f"{title}: {checks} '{word}' is not found: {found}"
    return None


def try_right(build, folder, number, source):
    done, found = check(build, folder, f"right_{number}", source, source.read_text(encoding="utf-8"))
    return None if done.returncode == 0 else f"{source.name}: {found} {done.stderr}"


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    right = [path for kind in ("laws/*", "damping/*", "template/law", "template/damping")
             for path in sorted((ROOT / "plugins").glob(kind + "/*.c"))]
    right += [path for kind in ("plugins", "elements") for path in sorted((ROOT / "tests" / kind).glob("*.c"))]
    with tempfile.TemporaryDirectory() as name, concurrent.futures.ThreadPoolExecutor(2) as pool:
        folder = pathlib.Path(name)
        runs = [pool.submit(try_wrong, build, folder, *case) for case in enumerate(WRONG) if case[0] % SHARE == 0]
        runs += [pool.submit(try_right, build, folder, *case) for case in enumerate(right)]
        faults.extend(run.result() for run in runs if run.result())
    print("\n".join(faults))
    print(f"{len(runs) - len(right)} wrong plugins, {len(right)} right ones: {len(faults)} faults")
    return 1 if faults or len(WRONG) < 40 else 0


if __name__ == "__main__":
    sys.exit(main())

"""What is told of runs and small motions is proven as it stands: names, units, starts and ends, modes, matrices."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

import pytest
from each import each

import eomgen
from eomgen.proof.reported_run import ReportedRun, run_reported
from eomgen.proof.reported_small_motions import small_motions_reported
from eomgen.runs.single_run import _reported, _run_payload, _run_statements
from eomgen.simulation import WholeRun
from eomgen.simulation.result import Trajectory

TWO = """
eomgen = 1
name = "Two carts"
space = "plane"

[parameters]
m = { value = 2, unit = "kg" }
k = { value = 30, unit = "N/m" }
c = { value = 0.8, unit = "N*s/m" }
F = { value = 3, unit = "N" }

[coordinates]
x = { start = 20, unit = "cm" }
y = { start = 0.1, unit = "m" }

[inputs]
w = 0

[bodies.first]
mass = "m"
inertia = 0
joint = { kind = "prismatic", axis = [1, 0], displacement = "x", stiffness = "k", damping = "c", force = "w*F" }

[bodies.second]
mass = "2*m"
inertia = 0
joint = { kind = "prismatic", on = "first", axis = [1, 0], displacement = "y", stiffness = "k" }

[outputs]
largest = "max(x)"
when = "time_of_max(y)"
all = { value = "y'", at = "x = 0", event = "every" }
"""


@cache
def model() -> Any:
    return eomgen.loads(TWO)


@cache
def run() -> Trajectory:
    return eomgen.simulate(model(), time=2.0, target="numpy")


def reported() -> ReportedRun:
    return _reported(_run_statements(model(), run()), _run_payload(model(), run(), []), None)


def wrong_run(of: ReportedRun) -> str:
    return "; ".join(check.detail for check in run_reported(run(), model(), of) if check.status == "fails")


def test_what_is_told_of_a_run_holds():
    assert not wrong_run(reported())
    assert run().certify().ok


def exchanged(rows: Any, i: int, j: int) -> list[Any]:
    """Two rows under the names of one another."""
    found = [list(row) for row in rows]
    found[i][1:], found[j][1:] = found[j][1:], found[i][1:]
    return found


def in_head(rows: Any, old: str, new: str) -> list[Any]:
    return [[row[0].replace(old, new), *row[1:]] for row in rows]


RUNS: dict[str, Callable[[ReportedRun], ReportedRun]] = {
    "two columns exchanged": lambda of: replace(of, rows=exchanged(of.rows, 1, 2)),
    "a start for an end": lambda of: replace(of, rows=[[a, c, b] for a, b, c in of.rows]),
    "another unit": lambda of: replace(of, rows=in_head(of.rows, "[cm]", "[m]")),
    "a unit of another kind": lambda of: replace(of, rows=in_head(of.rows, "y [m]", "y [kg]")),
    "a row left out": lambda of: replace(of, rows=of.rows[:-1]),
    "an end for machines": lambda of: replace(of, entries={**of.entries, "end": of.entries["start"]}),
    "another duration": lambda of: replace(of, entries={**of.entries, "time": 1.9}),
    "an extreme under another name": lambda of: replace(of, whole=exchanged(of.whole, 0, 1)),
    "an event elsewhere": lambda of: replace(of, whole=[*of.whole[:-1], [*of.whole[-1][:2], "t = 0.3 s"]]),
    "columns of a file exchanged": lambda of: replace(
        of, table=(("t [s]", "y [m]"), [(str(t), str(x)) for t, x in zip(run().t, run()["x"], strict=True)])
    ),
}


@each("change", RUNS)
def test_what_is_told_otherwise_of_a_run_is_seen(change: str):
    assert wrong_run(RUNS[change](reported()))


def test_a_column_under_the_name_of_another_is_seen():
    """q is the integral of q'."""
    other = replace(run(), speeds=run().speeds[::-1])
    assert any(check.status == "fails" for check in run_reported(other, model(), ReportedRun()))


@pytest.mark.parametrize("what", ["the instant of an extreme", "the instants of events"])
def test_an_instant_that_is_elsewhere_is_seen(what: str, monkeypatch: pytest.MonkeyPatch):
    """Samples beside it bound the value that a motion has there."""
    extreme, events = WholeRun.extreme, WholeRun.events
    if what == "the instant of an extreme":
        monkeypatch.setattr(WholeRun, "extreme", lambda *requested: (extreme(*requested)[0], (0.9,)))
    else:
        monkeypatch.setattr(WholeRun, "events", lambda *requested: [(k, t + 0.1) for k, t in events(*requested)])
    failing = [check.name for check in run().certify().checks if check.status == "fails"]
    assert failing == ["outputs of the whole run agree with its samples"]


# -- small motions --------------------------------------------------------------------------------------------


@cache
def small() -> Any:
    return eomgen.linearize(model())


def wrong_modes(change: Callable[[dict[str, Any]], None]) -> str:
    from eomgen.results.small_motions.steps import printed_modes

    entries = small().entries()
    change(entries)
    checks = small_motions_reported(entries, printed_modes(small().derivation), model().exact_parameters())
    return "; ".join(check.detail for check in checks if check.status == "fails")


def test_what_is_told_of_small_motions_holds():
    assert not wrong_modes(lambda entries: None)


def mode(k: int, name: str, value: Any) -> Callable[[dict[str, Any]], None]:
    return lambda entries: entries["modes"][k].update({name: value})


def swap(one: str, other: str) -> Callable[[dict[str, Any]], None]:
    return lambda entries: entries.update({one: entries[other], other: entries[one]})


SMALL: dict[str, Callable[[dict[str, Any]], None]] = {
    "M for K": swap("mass", "stiffness"),
    "a mode that grows": mode(0, "kind", "oscillates and grows"),
    "another damping ratio": mode(0, "damping_ratio", -0.1),
    "another frequency": mode(1, "hertz", 1.0),
    "another eigenvalue": mode(1, "eigenvalue", [-1.0, 2.0]),
    "another shape": mode(0, "shape", {"x": [1.0, 0.0], "y": [-1.0, 0.0]}),
    "a condition with the other sign": lambda entries: entries.update(conditions=["-c", *entries["conditions"][1:]]),
    "modes exchanged": lambda entries: entries["modes"].reverse(),
    "a transfer function of another coordinate": lambda entries: entries["transfer_functions"][0].update(
        coordinate="y"
    ),
    "a text that is not its number": lambda entries: entries["mass"]["exact"][0].__setitem__(0, "2*m"),
}


@each("change", SMALL)
def test_what_is_told_otherwise_of_small_motions_is_seen(change: str):
    assert wrong_modes(SMALL[change])


# -- section forces --------------------------------------------------------------------------------------------

BEAM = """
eomgen = 1
name = "A beam"
space = "plane"

[parameters]
p = { value = 2, unit = "kN/m" }
a = { value = 1.5, unit = "m" }
F = { value = 3, unit = "kN" }

[bodies.beam]
points = { A = [0, 0], B = ["3*a", 0] }
line = ["A", "B"]

[constraints]
A = { kind = "pin", points = ["beam.A"] }
B = { kind = "support", point = "beam.B", normal = [0, 1] }

[forces]
load = { kind = "distributed", body = "beam", between = ["A", "B"], intensity = [0, "-p"] }
pull = { kind = "force", point = "beam.B", force = ["F", 0] }
"""


def wrong_sections(change: Callable[[Any, Any], None]) -> str:
    from eomgen.proof.reported_cuts import sections_reported
    from eomgen.results.at_rest.section_steps import reported_sections, section_payload, section_steps

    sections = eomgen.statics(eomgen.loads(BEAM)).sections
    reported = list(reported_sections(sections, section_steps(sections), section_payload(sections)))
    assert len(reported) == 2
    for _, _, pieces, extremes in reported:
        change(pieces[0], extremes[0])
    return "; ".join(c.detail for c in sections_reported(sections.found, reported, {}) if c.status == "fails")


def test_section_forces_as_they_are_told_hold():
    assert not wrong_sections(lambda piece, extreme: None)


SECTIONS: dict[str, Callable[[Any, Any], None]] = {
    "V and M exchanged": lambda piece, extreme: piece.update(V=piece["M"], M=piece["V"]),
    "N and V exchanged": lambda piece, extreme: piece.update(V=piece["N"], N=piece["V"]),
    "the ends exchanged": lambda piece, extreme: piece.update({"from": piece["to"], "to": piece["from"]}),
    "an extreme elsewhere": lambda piece, extreme: extreme.update(x=0),
    "another extreme": lambda piece, extreme: extreme.update(M=0),
}


@each("change", SECTIONS)
def test_section_forces_that_are_told_otherwise_are_seen(change: str):
    """dM/dx = V, under the heads that are printed."""
    assert wrong_sections(SECTIONS[change])


# -- kinds of motion -------------------------------------------------------------------------------------------

GEARS = """
eomgen = 1
name = "A wheel on an arm"
space = "plane"

[parameters]
w = { value = 2, unit = "rad/s" }
l = { value = 0.5, unit = "m" }

[coordinates]
a = { rate = "w" }
b = { rate = "-w" }

[bodies.arm]
points = { E = ["l", 0] }
joint = { kind = "revolute", angle = "a" }

[bodies.plate]
joint = { kind = "revolute", on = "arm.E", angle = "b" }
"""


@pytest.mark.parametrize("said", ["", "now", "in the long run"])
def test_a_kind_of_motion_is_that_of_the_spin_and_the_velocities(said: str, monkeypatch: pytest.MonkeyPatch):
    """A body without spin translates; one that turns about a fixed axis keeps a point of it at rest."""
    from eomgen.mechanics.instant import kinematic_state as body_motion

    if said == "now":
        monkeypatch.setattr(body_motion, "instant_kind", lambda field: "rotation")
    elif said:
        kind = body_motion.Kind("curvilinear translation")
        monkeypatch.setattr(body_motion.Kinds, "of", lambda self, body: kind)
    checks = eomgen.kinematics(eomgen.loads(GEARS)).certify().checks
    name = "kinds of motion are those of the spins and velocities"
    assert [check.status for check in checks if check.name == name] == ["fails" if said else "holds"]


def reported_works(change=lambda reported: reported) -> str:
    """What is wrong with the virtual works of the beam, each changed."""
    from eomgen.proof.reported_cuts import works_reported
    from eomgen.proof.structure import state_of

    beam = eomgen.statics(eomgen.loads(BEAM))
    found = works_reported(beam.found, state_of(beam.found), map(change, beam._reported_works()))
    return "; ".join(c.detail for c in found if c.status == "fails")


def test_virtual_works_that_are_told_are_those_of_the_mechanism():
    """Only R works along all constraints; the loads work what their fields declare; along R + works = 0, R by the
    balance"""
    assert not reported_works()
    assert "along" in reported_works(lambda x: replace(x, along=f"-({x.along})"))
    assert "along" in reported_works(lambda x: replace(x, blocks=[(b, f"-({w})", v) for b, w, v in x.blocks]))
    assert "works" in reported_works(lambda x: replace(x, works=[(name, f"2*({w})") for name, w in x.works]))
    assert "works" in reported_works(lambda x: replace(x, printed=x.printed[1:]))
    assert "value" in reported_works(lambda x: replace(x, last=-x.last))
    assert "equation" in reported_works(lambda x: replace(x, left=x.left + 1))
    assert "block 1" in reported_works(lambda x: replace(x, rows=[(c, -w, *more) for c, w, *more in x.rows]))
    moved = reported_works(lambda x: replace(x, places=[(c, w, [2 * s for s in v], p) for c, w, v, p in x.places]))
    assert "shift" in moved

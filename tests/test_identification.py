"""Regressors, base parameters, and parameters from measured motions."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import mpmath
import numpy as np
import pytest
import sympy
from click.testing import CliRunner
from slow_run import beside, sampled, usual

import eomgen
from eomgen.cli import main
from eomgen.errors import DerivationError, EomgenError, UsageError
from eomgen.identification import fit
from eomgen.identification.base_parameters import Group, sampled_rows
from eomgen.identification.fit import _begun_checked, noise_of, numbers_of
from eomgen.identification.proof_of_groups import (
    bias_checked,
    certify_regressor,
    fit_checked,
    samples_checked,
    spread_checked,
)
from eomgen.identification.regressors import Regressor, regressor_of
from eomgen.model.replaced import Valued
from eomgen.symbolic.exact.equality import equal_at_random_states
from eomgen.symbolic.expression.derivatives import substituted
from tests.helpers.rx90 import PUBLISHED, rx90

MODELS = Path(__file__).parent.parent / "models"
FOUR_BAR = """
eomgen = 1
space = "plane"
parameters = { a = 0.3, b = 0.8, c = 0.5, m = 1, g = 9.81, mu = 0.2 }
coordinates = { q1 = 1, q2 = { near = 0.3 }, q3 = { near = 1.2 } }
inputs = { tau = "2*sin(3*t) + cos(5*t)" }
points = { A = [0, 0], D = [0.7, 0] }
constraints.pin = { kind = "pin", points = ["coupler.end", "rocker.end"] }
forces.weight = { kind = "gravity", acceleration = [0, "-g"] }
[bodies.crank]
mass = "m"
center = [0.1, 0.02]
inertia = 0.02
points = { end = ["a", 0] }
joint = { kind = "revolute", angle = "q1", torque = "tau - mu*sign(q1')" }
[bodies.coupler]
mass = 0.6
center = [0.3, 0.1]
inertia = 0.05
points = { end = ["b", 0] }
joint = { kind = "revolute", on = "crank.end", angle = "q2 - q1" }
[bodies.rocker]
mass = 0.9
center = [0.2, 0]
inertia = 0.03
points = { end = ["c", 0] }
joint = { kind = "revolute", at = "D", angle = "q3", damping = 0.1 }
"""
PARALLELOGRAM = """
eomgen = 1
space = "plane"
parameters = { l = 0.4, d = 0.9, g = 9.81 }
coordinates = { q1 = 1, q2 = 1, q3 = 0 }
points = { A = [0, 0], B = ["d", 0] }
constraints.pin = { kind = "pin", points = ["coupler.end", "right.end"] }
forces.weight = { kind = "gravity", acceleration = [0, "-g"] }
[bodies.left]
mass = 1
center = [0.1, 0.02]
inertia = 0.02
points = { end = ["l", 0] }
joint = { kind = "revolute", angle = "q1" }
[bodies.coupler]
mass = 0.6
center = [0.3, 0.1]
inertia = 0.05
points = { end = ["d", 0] }
joint = { kind = "revolute", on = "left.end", angle = "q3 - q1" }
[bodies.right]
mass = 0.9
center = [0.2, 0]
inertia = 0.03
points = { end = ["l", 0] }
joint = { kind = "revolute", at = "B", angle = "q2" }
"""


def rank_by_orthogonalization(found: Regressor) -> int:
    """The rank of Y at other states, 45 digits, the longest column first: another way than elimination."""
    W, _ = sampled_rows(found.system, found.rows, range(len(found.parameters)), 7)
    with mpmath.workdps(45):
        columns = [[mpmath.mpf(str(x)) for x in column] for column in W.T]
        columns = [[x / max(map(abs, column)) for x in column] for column in columns if max(map(abs, column)) > 1e-30]
        rank = 0
        while columns:
            lengths = [mpmath.norm(column) for column in columns]
            longest = max(lengths)
            if longest < 1e-20:
                break
            rank += 1
            along = [x / longest for x in columns.pop(lengths.index(longest))]
            columns = [_without(column, along) for column in columns]
    return rank


def _without(column: list[Any], along: list[Any]) -> list[Any]:
    share = mpmath.fdot(column, along)
    return [x - share * y for x, y in zip(column, along, strict=True)]


QUICK = (
    "arm3 four_bar whipple_bicycle slider_crank gyrostat andrews_squeezer bennett n_four_bar car_axis cart_pole".split()
)
EVERY = [path.stem for path in sorted(MODELS.glob("*.toml"))]


def look_at(name: str) -> Any:
    try:
        equations = eomgen.derive(MODELS / f"{name}.toml")
        graph = equations.graph
        if not graph.symbols.u:
            return None
        found = regressor_of(equations.system)
    except EomgenError:
        return None
    needed = [sum((m * a for m, a in zip(row, graph.symbols.a, strict=True)), start=c - Q)
              for row, c, Q in zip(graph.M, graph.c, graph.Q, strict=True)]  # fmt: skip
    needed = list(substituted(tuple(needed), dict.fromkeys(graph.symbols.inputs.values(), 0)))
    assert equal_at_random_states(list(zip(found.tau, needed, strict=True))).equal
    assert len(found.base) == rank_by_orthogonalization(found)
    return found


@pytest.mark.slow
@pytest.mark.parametrize("name", usual(QUICK, 2))
def test_regressor_times_parameters_is_the_force_and_its_base_has_the_rank_of_samples(name):
    """Y pi + y0 = M a + c - Q without inputs, exactly; as many groups as Y has independent columns."""
    look_at(name)


def test_what_a_given_kinetic_energy_takes_is_known_or_linear():
    """Water round a sphere: rho is linear in buoyancy and inertia at once; Y pi + y0 = M a + c - Q."""
    assert "rho" in look_at("../docs/examples/kinetic").parameters


@sampled(3)
@pytest.mark.slow
@pytest.mark.parametrize("name", usual(sorted({*EVERY} - {*QUICK, "stewart_platform", "delta_robot"}), 6))
def test_every_model_has_its_regressor_and_its_rank(name):
    """The same of a sixth of all models; of all in the slow run."""
    look_at(name)


@pytest.mark.slow
def test_base_parameters_of_the_rx90_are_the_published_ones():
    """40 groups with their formulas in D3 and RL4, after Khalil and Dombre."""
    base = eomgen.regressor(eomgen.loads(rx90())).base
    assert base.arithmetic == "prime field"
    found = {}
    for group in base.groups:
        terms = [(name, factor) for name, factor in group.terms.items() if name != group.name]
        words = [name if f == "1" else f"-{name}" if f == "-1" else f"{f}*{name}" for name, f in terms]
        found[group.name] = set(words)
    assert found == {name: set(words.split()) for name, words in PUBLISHED.items()}
    assert set(base.without_effect) >= {"m(C1)", "m(C2)", "mz(C2)", "Ixx(C1)"}


@pytest.mark.slow
def test_the_puma_560_has_36_base_parameters_and_four_rotors_of_its_own():
    """36 after Mayeda and Khalil; the rotors of the first two axes are in Izz(link1) and Izz(link2)."""
    base = eomgen.regressor(MODELS / "puma560.toml").base
    own = [group.name for group in base.groups]
    assert len(base) == 40 and [n for n in own if n.startswith("armature")] == [
        f"armature(link{k})" for k in (3, 4, 5, 6)
    ]
    formula = {group.name: group.formula for group in base.groups}
    assert "armature(link1)" in formula["Izz(link1)"] and "a2^2*m(link3)" in formula["Izz(link2)"]


def test_a_parallelogram_tells_three_groups():
    """T = (I_1 + I_2 + (m_3) l^2) q'^2/2 about the pins, V = g (A sin q + B cos q): three numbers, by hand."""
    found = eomgen.regressor(eomgen.loads(PARALLELOGRAM))
    assert len(found.base) == 3 == rank_by_orthogonalization(found)
    groups = {group.name: group.numbers for group in found.base.groups}
    l, d = 0.4, 0.9
    assert groups["Izz(left)"] == pytest.approx({"Izz(left)": 1, "Izz(right)": 1, "m(coupler)": l**2})
    expected = {"mx(left)": 1, "m(coupler)": l, "mx(right)": 1}
    assert groups["mx(left)"] == pytest.approx(expected) and d
    assert groups["my(left)"] == pytest.approx({"my(left)": 1, "my(right)": 1})


CHAIN = """
eomgen = 1
space = "space"
parameters = { l = 0.4, g = 9.81 }
coordinates = { q1 = 0.1, q2 = 0.4, q3 = -0.7 }
forces.weight = { kind = "gravity", acceleration = [0, 0, "-g"] }
[bodies.base]
inertia = [1, 1, 1]
joint = { kind = "revolute", axis = [0, 0, 1], angle = "q1" }
[bodies.upper]
mass = 2
center = [0.2, 0, 0]
inertia = [0.1, 1, 1]
points = { tip = ["l", 0, 0] }
joint = { kind = "revolute", on = "base", at = [0, 0, "l"], axis = [0, 1, 0], angle = "q2" }
[bodies.fore]
mass = 1
center = [0.1, 0, 0]
inertia = [0.1, 1, 1]
joint = { kind = "revolute", on = "upper.tip", axis = [0, 1, 0], angle = "q3" }
"""


@pytest.mark.slow
@pytest.mark.parametrize(("text", "axes", "arithmetic"), [(FOUR_BAR, "xy", "50 digits"), (CHAIN, "xyz", "prime field")])
def test_what_moves_beside_a_system_leaves_its_base_parameters(text: str, axes: str, arithmetic: str) -> None:
    """Y of parts that do not act on one another is diag(Y_1, Y_2, ...): K is diag(K_1, K_2, ...)."""
    alone = eomgen.regressor(eomgen.loads(text))
    places = [[f"p{k}{axis}" for axis in axes] for k in range(8)]
    coordinates = "".join(f"{name} = 0, " for place in places for name in place)
    bodies = "".join(
        f'bodies.bead{k} = {{ mass = 1, joint = {{ kind = "placed", at = {place}, angle = 0 }} }}\n'
        for k, place in enumerate(places)
    )
    whole = text.replace("coordinates = { ", "coordinates = { " + coordinates).replace("[bodies", bodies + "[bodies", 1)
    beside = eomgen.regressor(eomgen.loads(whole))
    groups = {group.name: group.numbers for group in beside.base.groups}
    beads = [f"m(bead{k})" for k in range(8)]
    assert [groups.pop(name) for name in beads] == [{name: 1.0} for name in beads]
    assert groups == {group.name: pytest.approx(group.numbers) for group in alone.base.groups}
    assert beside.base.arithmetic == arithmetic and not _fails(beside)


@pytest.mark.slow
def test_a_loop_tells_its_groups_as_formulas_of_its_lengths():
    """By hand: the coupler is two particles at its pins and a moment of inertia; slider-crank and delta robot alike."""
    four = {g.name: g.formula for g in eomgen.regressor(MODELS / "four_bar.toml").base.groups}
    assert four["Izz(crank)"] == "Izz(crank) - a^2/b*mx(coupler) + a^2*m(coupler)"
    assert (
        four["mx(rocker)"] == "mx(rocker) + c/b*mx(coupler)" and four["Izz(coupler)"] == "Izz(coupler) - b*mx(coupler)"
    )
    constrained = eomgen.regressor(eomgen.loads(FOUR_BAR)).base
    assert constrained.arithmetic == "50 digits"
    assert {g.name: g.formula for g in constrained.groups if "coupler" in g.formula} == {
        name: text for name, text in four.items() if "coupler" in text
    }
    slider = {g.name: g.formula for g in eomgen.regressor(MODELS / "slider_crank.toml").base.groups}
    assert slider["m(piston)"] == "m(piston) + 1/l*mx(rod)"
    delta = {g.name: g.formula for g in eomgen.regressor(MODELS / "delta_robot.toml").base.groups}
    assert delta["Iyy(arm1)"] == "Iyy(arm1) - L^2/l^2*Iyy(forearm1) + L^2*m(forearm1) + armature(arm1)"


@pytest.mark.slow
@pytest.mark.parametrize("name", ["four_bar", "slider_crank", *beside("delta_robot"), "n_four_bar"])
def test_formulas_of_groups_hold_for_other_lengths(name):
    """Put at other lengths they are the factors that elimination in numbers finds there."""
    model = eomgen.load(MODELS / f"{name}.toml")
    formulas = {g.name: g.terms for g in eomgen.regressor(model).base.groups}
    other = {p: 1.07 * float(x) for p, x in model.exact_parameters().items() if p.lower() in ("a", "b", "l", "r")}
    assert other
    changed = eomgen.regressor(Valued.of(model, other, {}).model).base
    values = {sympy.Symbol(p): float(x) for p, x in {**model.exact_parameters(), **other}.items()}
    for group in changed.groups:
        assert formulas[group.name].keys() == group.numbers.keys()
        for parameter, text in formulas[group.name].items():
            worth = float(sympy.sympify(text.replace("^", "**"), locals={str(p): p for p in values}).subs(values))
            assert worth == pytest.approx(group.numbers[parameter], rel=1e-12)


@pytest.mark.slow
def test_without_data_identify_says_what_motions_tell_apart():
    """The groups, and what no force depends on; in JSON with the factors at the model's lengths."""
    found = CliRunner().invoke(main, ["identify", str(MODELS / "four_bar.toml"), "--json"])
    reported = json.loads(found.stdout)
    assert found.exit_code == 0 and reported["without_effect"] == ["m(crank)", "m(rocker)"]
    assert reported["base"]["mx(crank)"]["formula"] == "mx(crank) - a/b*mx(coupler) + a*m(coupler)"
    assert reported["base"]["mx(crank)"]["factors"]["m(coupler)"] == 0.4
    text = CliRunner().invoke(main, ["identify", str(MODELS / "four_bar.toml")]).stdout
    assert "8 base parameters of 12" in text and "Without effect: m(crank), m(rocker)." in text


def data_of(model: Any, time: float, samples: int) -> dict[str, np.ndarray]:
    """What a run measures: coordinates, rates, accelerations, inputs."""
    run = eomgen.simulate(model, time=time, samples=samples, rtol=1e-11, atol=1e-11)
    equations = eomgen.derive(model)
    rhs, n = equations.rhs("numpy"), len(equations.coordinates)
    x = np.column_stack([run[name] for name in (*equations.coordinates, *equations.speeds)])
    rates = rhs.many(run.t, x, rhs.p0)
    data = {"t": run.t} | {name: run[name] for name in (*equations.coordinates, *equations.speeds)}
    data |= {f"{u}'": rates[:, n + k] for k, u in enumerate(equations.speeds)}
    laws = {name: part.value.text for name, part in equations.model.inputs.items()}
    return data | {
        name: eval(law, {"sin": np.sin, "cos": np.cos, "t": run.t}) + 0 * run.t for name, law in laws.items()
    }


@pytest.mark.slow
def test_a_closed_loop_with_friction_is_identified_from_its_motion():
    """Base parameters are K pi of the model that moved; the bodies found have positive density; friction is found."""
    true = eomgen.loads(FOUR_BAR)
    guessed = FOUR_BAR.replace("mass = 0.6", "mass = 0.9").replace("mu = 0.2", "mu = 0.5")
    found = eomgen.identify(eomgen.loads(guessed), data_of(true, 4, 300))
    own = eomgen.identify(true, data_of(true, 4, 300))
    pi = np.array([float(x) for x in _values(own.regressor)])
    expected = own.regressor.base.matrix(own.regressor.parameters) @ pi
    assert np.allclose([x for x, _ in found.base.values()], expected, atol=1e-5 * np.abs(expected).max())
    assert found.values["mu"] == pytest.approx(0.2, rel=1e-3) and found.residual < 1e-5
    assert found.consistent_residual < 1e-3 and found.values["m(coupler)"] > 0
    for body in ("crank", "coupler", "rocker"):
        m, mx, my, Izz = (found.values[f"{name}({body})"] for name in ("m", "mx", "my", "Izz"))
        assert m > 0 and Izz * m > mx**2 + my**2


def _values(found: Regressor) -> Any:
    from eomgen.identification.fit import _own_values

    return _own_values(found).values()


@pytest.mark.slow
def test_identify_reads_a_csv_and_refuses_what_tells_nothing(tmp_path):
    """Text and JSON of the verb; a motion that excites nothing, a missing column."""
    data = data_of(eomgen.loads(FOUR_BAR), 4, 200)
    model, path = tmp_path / "four.toml", tmp_path / "run.csv"
    model.write_text(FOUR_BAR)
    rows = np.column_stack(list(data.values()))
    path.write_text("\n".join([",".join(data), *(",".join(map(repr, map(float, row))) for row in rows)]))
    result = CliRunner().invoke(main, ["identify", str(model), "--data", str(path), "--json"])
    assert result.exit_code == 0, result.output
    reported = json.loads(result.stdout)
    assert reported["samples"] == 200 and reported["residual"] < 1e-5 and reported["condition"] > 1
    assert all(deviation["deviation"] >= 0 for deviation in reported["base"].values())
    assert "base parameters" in CliRunner().invoke(main, ["identify", str(model), "--data", str(path)]).stdout
    still = {name: 0 * x for name, x in data.items()} | {"t": data["t"]}
    with pytest.raises(UsageError, match="does not excite"):
        eomgen.identify(model, still)
    with pytest.raises(UsageError, match="no column 'q2'"):
        eomgen.identify(model, {name: x for name, x in data.items() if name != "q2"})


TWO_LINKS = """
eomgen = 1
space = "plane"
parameters = { g = 9.81, l = 0.5 }
coordinates = { q1 = 0.2, q2 = -0.4 }
inputs = { T1 = "6*sin(2*t) + 3*sin(5*t)", T2 = "1.5*sin(3*t) + sin(7.3*t)" }
forces.weight = { kind = "gravity", acceleration = [0, "-g"] }
[bodies.upper]
mass = 2
center = [0.2, 0.02]
inertia = 0.05
points = { end = ["l", 0] }
joint = { kind = "revolute", angle = "q1 - pi/2", torque = "T1", damping = 0.2 }
[bodies.fore]
mass = 1
center = [0.25, 0]
inertia = 0.03
joint = { kind = "revolute", on = "upper.end", angle = "q2", torque = "T2", damping = 0.1 }
"""


@pytest.mark.slow
def test_noise_of_places_moves_parameters_by_about_what_is_told():
    """Rates of splines through noisy places: the largest parameter is off by far more than its deviation, and by the
    bias that is told within a factor of 3; without noise, or with measured rates, nothing is."""
    model = eomgen.loads(TWO_LINKS)
    data, rng = data_of(model, 5, 500), np.random.default_rng(0)
    places = {name: data[name] for name in ("t", "q1", "q2", "T1", "T2")}
    assert not eomgen.identify(model, data).bias and not eomgen.identify(model, places).biased
    exact = eomgen.identify(model, data).base
    for sigma in (1e-4, 1e-3):
        noisy = {q: places[q] + sigma * rng.normal(size=500) for q in ("q1", "q2")}
        assert noise_of(data["t"], noisy["q1"]) == pytest.approx(sigma, rel=0.3)
        found = eomgen.identify(model, {**places, **noisy})
        name = max(exact, key=lambda key: abs(exact[key][0]))
        off = found.base[name][0] - exact[name][0]
        assert name in found.biased and abs(off) > 3 * found.base[name][1]
        assert 1 / 3 < found.bias[name] / off < 3


def test_what_does_not_move_tells_nothing():
    """A structure, and a mechanism whose only coordinate is driven."""
    for name in ("cantilever", "scotch_yoke"):
        with pytest.raises(DerivationError, match="nothing moves"):
            eomgen.regressor(MODELS / f"{name}.toml")


def test_friction_of_a_contact_has_no_regressor():
    """Its normal force depends on the parameters."""
    with pytest.raises(DerivationError, match="not linear in the parameters"):
        eomgen.regressor(MODELS / "rough_incline.toml")


def _fails(found: Regressor) -> list[str]:
    return [check.name.split()[0] for check in found.certify().checks if check.ok is False]


@pytest.mark.slow
@pytest.mark.parametrize("name", ["four_bar", "arm3"])
def test_wrong_groups_and_wrong_regressors_are_contradicted(name: str) -> None:
    """A factor that is off, a text of another factor, a column of Y and a parameter's value: each by its own check."""
    found = eomgen.regressor(MODELS / f"{name}.toml")
    assert found.certify().ok
    k, group = next((k, g) for k, g in enumerate(found.base.groups) if len(g.terms) > 1)
    *_, last = group.terms
    wrong = {
        "base": Group(group.name, group.terms, {**group.numbers, last: 1.01 * group.numbers[last]}),
        "formulas": Group(group.name, {**group.terms, last: f"-({group.terms[last]})"}, group.numbers),
    }
    for said, other in wrong.items():
        groups = (*found.base.groups[:k], other, *found.base.groups[k + 1 :])
        planted = replace(found)
        planted.__dict__["base"] = replace(found.base, groups=groups)
        assert said in _fails(planted)
    rows = ((2 * found.rows[0][0], *found.rows[0][1:]), *found.rows[1:])
    assert _fails(replace(found, rows=rows))[0] == "Y"
    assert "Y" in _fails(replace(found, values=(found.values[0] + 1, *found.values[1:])))


@pytest.mark.slow
def test_a_fit_is_proven_too():
    """That no base parameter could take more of what is left; a coefficient that is off is seen."""
    found = eomgen.identify(eomgen.loads(TWO_LINKS), data_of(eomgen.loads(TWO_LINKS), 3, 200))
    certificate = found.certify()
    assert certificate.ok and any(check.name.startswith("the residual of the fit") for check in certificate.checks)
    rng = np.random.default_rng(2)
    W, beta = rng.normal(size=(50, 4)), np.array([1.0, -2.0, 3.0, 0.5])
    b = W @ beta + 0.1 * rng.normal(size=50)
    best = np.linalg.lstsq(W, b, rcond=None)[0]
    assert fit_checked(W, b, best).ok and not fit_checked(W, b, best * (1 + 1e-6)).ok


@pytest.mark.slow
@pytest.mark.parametrize("text", [TWO_LINKS, FOUR_BAR])
def test_samples_are_stacked_with_the_forces_that_act_there(text):
    """Z^T (M a - forcing) = W pi - b by the equations of motion; half of what is applied is contradicted."""
    model = eomgen.loads(text)
    found, data = regressor_of(eomgen.derive(model).graph.system), data_of(model, 1, 50)
    stacked = fit.stacking_of(found)(data)
    wrong = replace(stacked, b=stacked.b / 2)
    reported = [samples_checked(found, fit._samples(found, data, each)).ok for each in (stacked, wrong)]
    assert reported == [True, False]


def test_deviations_condition_and_residual_are_proven_by_another_factorization():
    """W = Q R: |rows of R^-1| s, s^2 = |left|^2/(n - k); another deviation, condition or residual is seen."""
    rng = np.random.default_rng(1)
    W = rng.normal(size=(40, 3)) * [1, 5, 0.1]
    b = W @ [1, 2, 3] + 0.1 * rng.normal(size=40)
    left = b - W @ np.linalg.lstsq(W, b, rcond=None)[0]
    deviations = np.sqrt(np.diag(np.linalg.inv(W.T @ W)) * (left @ left) / 37)
    reported = [deviations, float(np.linalg.cond(W / np.linalg.norm(W, axis=0))), float(np.sqrt(np.mean(left**2)))]
    assert spread_checked(W, b, *reported).ok
    for k in range(3):
        assert spread_checked(W, b, *[2 * x if j == k else x for j, x in enumerate(reported)]).ok is False


@pytest.mark.slow
def test_a_motion_without_a_known_force_tells_no_parameters():
    """Y pi = 0 holds of pi = 0 and of every multiple of a solution, under gravity too: refused, and no row of zeros."""
    pendulum = """
eomgen = 1
name = "free"
space = "plane"
coordinates = { q = 0.4 }
forces.weight = { kind = "gravity", acceleration = [0, -9.81] }
[bodies.a]
mass = 2
center = [0.2, 0]
inertia = 0.1
joint = { kind = "revolute", angle = "q" }
"""
    model = eomgen.loads(pendulum)
    run = eomgen.simulate(model, time=1.0)
    data = {"t": run.t, "q": run["q"], "q'": run["q'"]}
    with pytest.raises(UsageError, match="no known force acts in this motion"):
        eomgen.identify(model, data)
    driven = eomgen.loads(pendulum.replace('angle = "q"', 'angle = "q", torque = 0.3'))
    run = eomgen.simulate(driven, time=1.0)
    found = eomgen.identify(driven, {"t": run.t, "q": run["q"], "q'": run["q'"]})
    assert all(value for value, _ in found.base.values())


@pytest.mark.slow
def test_a_bias_is_of_the_size_by_which_more_noise_moves_the_fit():
    """bias = 0.02 where noise once more moves by about as much; 0.4 is another one."""
    moved = np.random.default_rng(1).normal([0.02, 0.0], [0.002, 1e-6], size=(8, 2))
    assert bias_checked(np.array([0.02, 0.0]), moved, np.array([1e-3, 1e-6])).ok
    assert bias_checked(np.array([0.4, 0.0]), moved, np.array([1e-3, 1e-6])).ok is False
    assert bias_checked(np.array([0.02, 0.01]), moved, np.array([1e-3, 1e-6])).ok is False


def test_a_base_parameter_that_follows_from_the_others_is_told():
    """Columns of Y_base at many states are independent: rank = their number."""
    found = eomgen.regressor(MODELS / "arm3.toml")
    assert certify_regressor(found).ok is True
    group = found.base.groups[0]
    other = next(name for name in found.parameters if name not in [x.name for x in found.base.groups])
    more = replace(found.base, groups=(*found.base.groups, replace(group, name=other, terms={}, numbers={})))
    wrong = replace(found)
    wrong.__dict__["base"] = more
    failing = [x.name for x in certify_regressor(wrong).checks if x.status == "fails"]
    assert failing == ["no base parameter follows from the others"]


def test_bodies_from_which_a_search_begins_are_those_of_the_model(monkeypatch):
    """parameters(numbers(body)) = body, of positive density."""
    found = eomgen.regressor(MODELS / "arm3.toml")
    assert _begun_checked(found).status == "holds"
    monkeypatch.setattr(fit, "numbers_of", lambda own, size: numbers_of({**own, "m": 2 * own["m"]}, size))
    assert _begun_checked(found).status == "fails"

"""Model -> FoundReactions: every reaction, as a formula, or at one instant of the motion exactly and in numbers."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

from eomgen import pipeline
from eomgen.documents import (
    Document,
    Found,
    Lines,
    Listing,
    PrintedReactions,
    Quantity,
    Statement,
    found_reaction,
    listed,
    listing_markdown,
    nearest_name,
    plain_document,
    prose,
    proven,
    with_start_reported,
)
from eomgen.equations import Equations
from eomgen.errors import DerivationError, ExpressionError, MissingValues, ModelError, UsageError
from eomgen.mechanics.free_bodies import NamedReaction
from eomgen.mechanics.statics import ContactsAtStart
from eomgen.model import (
    FUNCTIONS,
    AtRest,
    Model,
    ModelOrPath,
    Output,
    Requests,
    Table,
    Valued,
    Values,
    WrittenEquation,
    assignments,
)
from eomgen.proof import Certificate, certify_reactions
from eomgen.questions.outputs_answered import Answers, solve
from eomgen.resources import doing
from eomgen.results import why_not_at_rest
from eomgen.runs import reaction_picture
from eomgen.study import Study, model_to_study, study_of_modes
from eomgen.symbolic.expression import parse

NO_VALUE = "it has no single value at the start"
OPEN = "statically indeterminate"  # how a message begins to say that a reaction has no single value


class FoundReactions(dict[str, Quantity]):
    """{name as in an output: the reaction}.

    Args:
        equations: None where unknowns in the loads hold the system.
        proof: of its reactions.
        sums: {"reaction_x(A) + reaction_x(B)": its value} of indeterminate ones that have one value together.
        proof_of_sums: of these.
    """

    def __init__(
        self,
        found: Mapping[str, Quantity],
        equations: Equations | None,
        proof: Callable[[Mapping[str, Quantity]], Certificate],
        sums: Mapping[str, Quantity],
        proof_of_sums: Callable[[Mapping[str, Quantity]], Certificate],
    ) -> None:
        super().__init__(found)
        self.equations, self.sums, self._proof, self._of_sums = equations, dict(sums), proof, proof_of_sums

    def __repr__(self) -> str:
        return f"<reactions: {', '.join(self)}>"

    def _repr_markdown_(self) -> str:
        """Each by its name, exact and as a number, typeset."""
        return listing_markdown([Found(name, quantity) for name, quantity in self.items()])

    def certify(self) -> Certificate:
        """The equations; the formulas against the balance in numbers, or the numbers against the motion in numbers."""
        proof = self._proof(self)
        if not self.sums:
            return proof
        return proof + (check for check in self._of_sums(self.sums).checks if check not in proof.checks)


@doing("the reactions")
def reactions(
    model: ModelOrPath,
    *,
    at: WrittenEquation | AtRest | str | None = None,
    from_rest: Values | Sequence[str] = (),
    parameters: Values | None = None,
    start: Values | None = None,
) -> FoundReactions:
    """Every reaction: a function of coordinates and rates, or exact and a number at an instant.

    Args:
        at: the instant, an equation; the first time after the start at which it holds.
        from_rest: positions, {"theta": 0} or `theta=0`, from which the motion starts at rest; (): its own start.
        parameters, start: values that replace the model's, each as `model_at` takes it.
    Raises:
        UsageError: no equation, or no coordinate of that name.
        DerivationError: a body is unsupported; a force acts at no place.
    """
    model = model_to_study(model, parameters, start)
    held = bool(model.unknowns_in_loads())
    equations = None if held else pipeline.derive(model, "kinetostatic")
    study = _study(model, equations)
    requested = [named for named in study.named_reactions if _function(named.name) in FUNCTIONS]
    answered = partial(_answers, _at_rest(model, from_rest), at=at, from_rest=bool(from_rest))
    found: dict[str, Quantity]
    proof: Callable[[Mapping[str, Quantity]], Certificate]
    if at is None and not from_rest and ContactsAtStart.resting(model):
        found, proof = answered({named.name: named.unit for named in requested}, at="t = 0")
    elif equations is not None and at is None and not from_rest:
        found, proof = _formulas(equations, requested), partial(_proof_of_formulas, equations)
    else:
        found, proof = answered({named.name: named.unit for named in requested})
    open_ = any(OPEN in (answer.message or "") for answer in found.values())
    reported = PrintedReactions(equations.in_print).sums if open_ and equations is not None else {}
    return FoundReactions(found, equations, proof, *(answered(reported) if reported else ({}, proof)))


def reactions_document(
    model: Model,
    *,
    at: WrittenEquation | AtRest | None = None,
    from_rest: Values | Sequence[str] = (),
    plot: str | None = None,
    view: str | None = None,
    time: float | None = None,
    certify: bool = True,
) -> Document:
    """Every reaction, as `reactions` finds it, in words and for machines.

    Args:
        at, from_rest: as of `reactions`.
        plot: the file of the picture of them along the motion, if one is requested; view, time: as of that picture.
        certify: the result is proven.
    """
    found = reactions(model, at=at, from_rest=from_rest)
    equations = found.equations
    study = _study(model, equations)
    system = study.system
    requested = [named for named in study.named_reactions if named.name in found]
    open_ = [name for name, answer in found.items() if OPEN in (answer.message or "")]
    failed = [name for name, answer in found.items() if not answer.answered and name not in open_]
    broken = why_not_at_rest(model, system)
    starting = _at_rest(model, from_rest)
    space = PrintedReactions(equations.graph).null_space if open_ and equations is not None else []
    texts = [answer.exact for answer in found.values() if answer.exact is not None]
    laws = {} if equations is None else PrintedReactions(equations.in_print).laws_in(texts)
    more = {**({"laws": laws} if laws else {}), **({"null_space": space} if space else {})}
    more |= {"sums": found.sums} if found.sums else {}
    document = plain_document(
        model,
        lambda: {"name": model.name, "reactions": found, **more},
        _listing(study, requested, found, bool(space)),
        *_law_statements(laws),
        *_open_statements(space),
        *_sum_statements(found.sums),
        failed=f"not answered: {listed(failed)}" if failed else broken,
        notes=(*_without_force(study), *(() if at or from_rest else _without_sliding(starting)))
        or (() if found else ("nothing reacts: no body is held by joints or constraints",)),
    )
    document = with_start_reported(document, starting)
    if plot is not None:
        reaction_picture(pipeline.derive(starting), view, time).save(plot)
    return proven(document, found.certify() if certify and found else None)


def _without_force(study: Study) -> tuple[str, ...]:
    """The contacts that are open at the start, in words."""
    names = [name for name, mode in study.system.modes.items() if not mode.closed]
    return (f"open at the start, without a force: {', '.join(names)}",) if names else ()


def _without_sliding(model: Model) -> tuple[str, ...]:
    """The rough contacts that do not slide at the start, in words."""
    names = ContactsAtStart.resting(model)
    here = f"do not slide at the start: {', '.join(names)}; the reactions are those there"
    return (f"{here}; formulas of sliding: eomgen derive --method kinetostatic",) if names else ()


def _study(model: Model, equations: Equations | None) -> Study:
    """The study of a model; where unknowns in the loads hold it, with all its contacts closed."""
    return study_of_modes(model) if equations is None else equations.study


def _function(name: str) -> str:
    return name.partition("(")[0]


# -- as formulas -----------------------------------------------------------------------------------


def _formulas(equations: Equations, requested: Iterable[NamedReaction]) -> dict[str, Quantity]:
    """Every reaction as a formula, and its value at the start."""
    found = PrintedReactions(equations.in_print).formulas
    values, missing = dict[str, float](), ""
    try:
        values = equations.study.reactions_at_start
    except (MissingValues, DerivationError, ModelError) as error:
        missing = f"{error.what}; {error.fix}" if isinstance(error, DerivationError) and error.fix else error.what
    answered = {}
    for named in requested:
        formula = found[named.name]
        method = "balance of the bodies" + (", accelerations left in it" if formula.accelerated else "")
        value = 0.0 if formula.text == "0" else values.get(named.name)
        message = formula.message or missing or (None if value is not None else NO_VALUE)
        answered[named.name] = Quantity(formula.text, value, named.unit, method, message)
    return answered


def _proof_of_formulas(equations: Equations, found: Mapping[str, Quantity]) -> Certificate:
    """The equations of motion, then every formula and its number at the start."""
    texts = {name: answer.exact for name, answer in found.items() if answer.exact is not None}
    values = {name: answer.value for name, answer in found.items() if answer.value is not None}
    return certify_reactions(equations.graph, texts, values)


# -- at an instant, or from rest -------------------------------------------------------------------


def _answers(
    model: Model, requested: Mapping[str, str], at: WrittenEquation | AtRest | str | None, from_rest: bool
) -> tuple[dict[str, Quantity], Callable[[Mapping[str, Quantity]], Certificate]]:
    """The answers to outputs that request reactions, or sums of them, in their order; and their proof.

    Args:
        requested: {text: unit}.
    """
    instant = None if at is None else _instant(model, at)
    from_ = "rest" if from_rest else "start" if isinstance(instant, WrittenEquation) else None
    values = [parse(text, references=True) for text in requested]
    outputs = {f"o{k}": Output(value=value, at=instant, from_=from_) for k, value in enumerate(values)}
    model = _checked(model, f"--at {getattr(at, 'text', at)}", outputs=Table(outputs), text=None, questions=None)
    solved = solve(model)
    pairs = zip(requested.items(), solved.values(), strict=True)
    return {text: replace(answer, unit=unit) for (text, unit), answer in pairs}, partial(_proof_of_answers, solved)


def _proof_of_answers(solved: Answers, found: Mapping[str, Quantity]) -> Certificate:
    """Proof of the outputs that stand for reactions, under the names of the reactions."""
    names = dict(zip(solved, found, strict=True))
    solved.update(zip(solved, found.values(), strict=True))

    def under_its_name(detail: str) -> str:
        return re.sub(r"\bo\d+\b", lambda m: names.get(m[0], m[0]), detail)

    return Certificate(tuple(replace(c, detail=under_its_name(c.detail)) for c in solved.certify().checks))


def _instant(model: Model, at: WrittenEquation | AtRest | str) -> WrittenEquation | AtRest:
    if not isinstance(at, str):
        return at
    if at.strip() == AtRest.text:
        return AtRest()
    try:
        return Requests(model).equation(at)
    except ExpressionError as error:
        raise UsageError(f"at {at}: {error.what}", fix=error.fix or 'write "theta = pi/2"') from error


def _at_rest(model: Model, given: Values | Sequence[str]) -> Model:
    """The model with these starting positions, all speeds 0; the same where none are given.

    Raises:
        UsageError: no coordinate of that name, a driven one, or no expression of parameters.
    """
    values = positions_at_rest(model, given, '"theta=0"')
    return Valued.of(model, None, values, options=("parameters", "from_rest")).model


def positions_at_rest(model: Model, given: Values | Iterable[str], example: str) -> Values:
    """Positions from which a motion starts at rest, by name; several may stand in one word, "theta=0, phi=1".

    Args:
        example: the fix of a word that is no assignment.
    Raises:
        UsageError: such a word; a name that is no free coordinate.
    """
    words = () if isinstance(given, Mapping) else (word for text in given for word in re.split(r",(?=[^()]*=)", text))
    values = given if isinstance(given, Mapping) else dict(assignments(words, example))
    for name in values:
        if name not in model.coordinates:
            what = f"--from-rest: there is no coordinate '{name}'"
            raise UsageError(what, fix=nearest_name(name, model.coordinates))
        if model.coordinates[name].driven:
            free = listed(q for q, part in model.coordinates.items() if not part.driven)
            raise UsageError(f"--from-rest: '{name}' is driven, it moves as given", fix=f"there are {free}")
    return values


def _checked(model: Model, where: str, **changes: Any) -> Model:
    """The model with some tables replaced, checked as a whole.

    Raises:
        UsageError: something in them is wrong.
    """
    try:
        return replace(model, **changes)
    except ModelError as error:
        raise UsageError(f"{where}: {error.what.partition(' in the ')[0]}", fix=error.fix) from error


# -- texts --------------------------------------------------------------------------------------


def _listing(study: Study, requested: Iterable[NamedReaction], found: dict[str, Quantity], below: bool) -> Listing:
    """Each reaction by name and in words, then as `solve` prints its answers.

    Args:
        below: the self-stresses of indeterminate ones follow below.
    """
    rows = []
    for named in requested:
        answer = found[named.name]
        if below and OPEN in (answer.message or ""):
            answer = replace(answer, message=f"{OPEN}, see below")
        rows.append(found_reaction(study.system, named, answer))
    return Listing(tuple(rows))


def _law_statements(laws: Mapping[str, str]) -> Iterable[Statement]:
    """States the laws of the driven coordinates, once."""
    if laws:
        yield prose("")
        yield prose("What is driven moves as given:")
        yield Lines(tuple(f"    {name} = {law}" for name, law in laws.items()))


def _open_statements(space: list[dict[str, str]]) -> Iterable[Statement]:
    """States the self-stresses: what may be added to indeterminate reactions and leaves the equations satisfied."""
    for number, shares in enumerate(space, start=1):
        k = "k" if len(space) == 1 else f"k{number}"
        yield prose("")
        yield prose(f"To these at once may be added, with any number {k}, and rigid bodies stay in balance:")
        yield Lines(tuple(f"    {name}: {_times(share, k)}" for name, share in shares.items()))


def _sum_statements(sums: Mapping[str, Quantity]) -> Iterable[Statement]:
    """States the sums of indeterminate reactions that have one value."""
    if sums:
        yield prose("")
        yield prose("Sums in which that leaves no trace have one value:")
        yield Listing(tuple(Found(text, answer) for text, answer in sums.items()))


def _times(share: str, k: str) -> str:
    return {"1": k, "-1": f"-{k}"}.get(share, f"({share})*{k}" if " " in share else f"{share}*{k}")

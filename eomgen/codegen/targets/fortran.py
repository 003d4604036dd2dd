"""Program -> a Fortran 2008 module NAME_rhs: `call rhs(t, x, p, dx, inputs)`, inputs optional.

With it comes a program that holds it against the test vectors.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any

from eomgen.codegen.build import Compiler
from eomgen.codegen.lowering import Statements
from eomgen.codegen.statements import (
    ATOM,
    CHANGED,
    GIVEN,
    INDICES,
    INT,
    PLACES,
    PRODUCT,
    READ,
    REAL,
    ROOM,
    SUM,
    Language,
    RankedText,
    Table,
    ranked_number,
)
from eomgen.codegen.targets.base import CHECK, FileForm, SingleWords, by_cases
from eomgen.codegen.targets.loading import compiled_target
from eomgen.symbolic.expression import Number

WIDTH = 120  # of a line; the standard has 132
LONGEST_LIST = 500  # values in a statement, which has at most 255 lines


def _number(a: Number) -> RankedText:
    """A number in double precision."""
    text, strength = ranked_number(a)
    if strength == SUM:
        return f"-{_number(-a)[0]}", SUM
    return "/".join(f"{part}_dp" for part in text.split("/")), PRODUCT if strength == PRODUCT else ATOM


def _spelled(name: str) -> str:
    """Capitals are small letters: names of the kernels that differ only by them are changed."""
    return f"big_{name}" if name.isupper() else name


FORTRAN = Language(
    reserved=frozenset(
        "allocatable allocate associate block call case character class common complex contains continue cycle data "
        "deallocate dimension do double elemental else elseif end enddo endif entry equivalence exit external function "
        "goto if implicit in inout integer intent interface intrinsic kind logical module namelist none nullify only "
        "open optional or out parameter pause pointer present print private procedure program public pure read real "
        "recursive result return save stop subroutine target then to true type use where while write dp size huge "
        "ieee_value found least most sign_of pick merge less less_equal x_names p_names input_names".split()
    ),
    functions={
        "pow": "({0})**({1})",
        "select": "pick({0}, {1}, {2})",
        "min": "least({0}, {1})",
        "max": "most({0}, {1})",
        "sign": "sign_of({0})",
    },
    defined=by_cases(
        "elemental function {name}({arguments}) result(found)\n    real(dp), intent(in) :: {arguments}\n"
        "    real(dp) :: found\n    {value}\n    end if\nend function {name}",
        "if ({condition}) then\n        found = {value}\n    else{otherwise}",
        ends="\n        found = {value}",
        words={"min": "least", "max": "most", "sign": "sign_of", "select": "pick", "nan": "a + b", "||": ".or."}
        | {"a != a": ".not. abs(a) >= 0", "given == 0": "abs(given) <= 0", "given == given": "abs(given) > 0"},
    ),
    words={"not": ".not. ", "!=": "/=", "nan": "ieee_value(1.0_dp, ieee_quiet_nan)", "given": "present(inputs)"},
    at="{array}({index})",
    let="{declared} = {value}",
    put="{place} = {value}",
    call="call {function}({arguments})",
    back="found = {value}\nreturn",
    leave="return",
    arrays={CHANGED: "{name} = 0.0_dp", ROOM: "", PLACES: "{name} = 0"},
    tables={
        INT: "integer, parameter :: {name} = {value}",
        INDICES: "integer, parameter :: {name}(0:{last}) = {values}",
        READ: "real(dp), parameter :: {name}(0:{last}) = {values}",
    },
    loop=("do {name} = {first}, {last} - 1", "end do"),
    down=("do {name} = {last} - 1, {first}, -1", "end do"),
    branch=("if ({condition}) then", "else", "end if"),
    function=("recursive {what} {name}({arguments}){gives}", "end {what} {name}"),
    what=("subroutine", "function"),
    gives={INT: " result(found)", REAL: " result(found)"},
    out=("recursive subroutine {name}({arguments}, {out})", "end subroutine {name}"),
    remark="! {text}",
    unused="if (kind({name}) < 0) return  ! {name} does not stand in it",
    number=_number,
    longest=2000,
    local={
        REAL: "real(dp) :: {name}",
        INT: "integer :: {name}",
        CHANGED: "real(dp) :: {name}(0:{size} - 1)",
        PLACES: "integer :: {name}(0:{size} - 1)",
        f"argument {REAL}": "real(dp), intent(in) :: {name}",
        f"argument {INT}": "integer, intent(in) :: {name}",
        f"argument {READ}": "real(dp), intent(in) :: {name}(0:*)",
        f"argument {GIVEN}": "real(dp), intent(in), optional :: {name}(0:*)",
        f"argument {CHANGED}": "real(dp), intent(inout) :: {name}(0:*)",
        f"argument {INDICES}": "integer, intent(in) :: {name}(0:*)",
        f"argument {PLACES}": "integer, intent(inout) :: {name}(0:*)",
        "out": "real(dp), intent(inout) :: {name}(0:*)",
    },
    spelled=_spelled,
    folded=str.lower,
)
COMPILER = Compiler(
    "Fortran",
    ".f90",
    "FC",
    ("gfortran", "flang", "ifx"),
    ("-std=f2008", "-shared", "-fPIC"),
    "install gfortran, or set FC",
    trial="subroutine eomgen_trial\nend subroutine\n",
)

_MODULE = """\
module {main}
    use, intrinsic :: iso_fortran_env, only: dp => real64
{ieee}    implicit none
    private
    public :: {role}, constants, evaluate
{names}
{tables}
contains
    ! {result} has {outputs} places; without inputs the model's own
    subroutine {role}(t, x, {a}p, {result}, inputs)
        real(dp), intent(in) :: t, x({states}), {a_declared}p({parameters})
        real(dp), intent(inout) :: {result}({outputs})
        real(dp), intent(in), optional :: inputs({inputs})
        real(dp) :: c({size})
        call constants(p, c)
        call evaluate(t, x, {a}p, c, inputs, {result})
    end subroutine {role}

{functions}
end module {main}
"""

_ENTRY = """\
{text}
subroutine {entry}(n, t, x, p, inputs, out) bind(c)
    use, intrinsic :: iso_c_binding
    use {main}
    integer(c_size_t), value :: n
    real(c_double), intent(in) :: t(n), x({moving}, n), p({parameters})
    type(c_ptr), value :: inputs
    real(c_double), intent(inout) :: out({outputs}, n)
    real(c_double), pointer :: given(:, :)
    real(c_double) :: c({size})
    integer(c_size_t) :: i
    call constants(p, c)
    if (c_associated(inputs)) then
        call c_f_pointer(inputs, given, [int({inputs}, c_size_t), n])
        do i = 1, n
            call evaluate(t(i), {x_and_a}, p, c, given(:, i), out(:, i))
        end do
    else
        do i = 1, n
            call evaluate(t(i), {x_and_a}, p, c, {result}=out(:, i))
        end do
    end if
end subroutine
"""

_COUNTED = "    integer :: vector = 0"
_TEST = """\
! Held against its test vectors: stops where they do not agree
program {main}_test
    use, intrinsic :: iso_fortran_env, only: dp => real64
    use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
    use {main}, only: {role}
    implicit none
    real(dp), parameter :: none(0) = [real(dp) ::]
    real(dp) :: nan
{counted}
    nan = ieee_value(1.0_dp, ieee_quiet_nan)
{lines}
contains
    subroutine check(t, x, {a}p, inputs, right, tolerance)
        real(dp), intent(in) :: t, x(:), {a_list}p(:), inputs(:), right(:), tolerance
        real(dp) :: found(size(right)), largest
        integer :: k
        found = 0
        vector = vector + 1
        if (size(inputs) > 0) then
            call {role}(t, x, {a}p, found, inputs)
        else
            call {role}(t, x, {a}p, found)
        end if
        largest = max(1.0_dp, maxval(abs(right), mask=abs(right) >= 0))
        do k = 1, size(right)
            if (.not. abs(right(k)) >= 0) then
                if (.not. abs(found(k)) >= 0) cycle
            else if (abs(found(k) - right(k)) <= tolerance*largest) then
                cycle
            end if
            print *, "vector", vector, "{result}", k, "is", found(k), "not", right(k)
            error stop 1
        end do
    end subroutine check
end program {main}_test
"""


def _body(made: Statements) -> dict[str, str]:
    """The tables, and the functions inside the module."""
    tables = [line for table in made.tables for line in _held(table)]
    defined = [FORTRAN.defined[op] for op in sorted(made.ops & FORTRAN.defined.keys())]
    body = "\n\n".join([*defined, *("\n".join(FORTRAN.defines(f)) for f in (*made.kernels, *made.bodies))])
    return {
        "tables": "".join(f"    {line}\n" for line in tables),
        "functions": "\n".join(f"    {line}".rstrip() for line in body.split("\n")),
    }


def _held(table: Table) -> list[str]:
    """A table; a long one of pieces."""
    if len(table.values) <= LONGEST_LIST:
        return [FORTRAN.holds(table)]
    name = FORTRAN.spelled(table.name)
    parts = [replace(table, name=f"{name}_{k}", values=part) for k, part in enumerate(_pieces(table.values))]
    whole = FORTRAN.tables[table.kind].format(
        name=name, last=len(table.values) - 1, values=f"[{', '.join(part.name for part in parts)}]"
    )
    return [*map(FORTRAN.holds, parts), whole]


def _pieces(values: Sequence[Any]) -> list[Sequence[Any]]:
    return [values[i : i + LONGEST_LIST] for i in range(0, len(values), LONGEST_LIST)]


def _named(key: str, names: Sequence[str]) -> list[str]:
    """Names as a constant; many of pieces."""
    if not names:
        return []
    width, parts = max(len(name.encode()) for name in names), _pieces(names)
    reported = [", ".join('"' + name.replace('"', '""') + '"' for name in part) for part in parts]
    kind, held = f"character({width}), parameter", [f"{key}_{k}" for k in range(len(parts))]
    if len(parts) == 1:
        return [f"    {kind}, public :: {key}({len(names)}) = [character({width}) :: {reported[0]}]"]
    pieces = zip(held, parts, reported, strict=True)
    lines = [f"    {kind} :: {name}({len(part)}) = [character({width}) :: {text}]" for name, part, text in pieces]
    return [*lines, f"    {kind}, public :: {key}({len(names)}) = [{', '.join(held)}]"]


def _short(text: str) -> str:
    """Lists too long for a statement put into arrays before it, and long lines continued."""
    lines: list[str] = []
    declared: list[str] = []
    for line in text.split("\n"):
        for listed in re.findall(r"\[[^][]*\]", line) if line.startswith("    call check(") else ():
            values = listed[1:-1].split(", ")
            if len(values) > LONGEST_LIST:
                name = f"long_{len(declared)}"
                declared.append(f"    real(dp) :: {name}({len(values)})")
                firsts = range(1, len(values) + 1, LONGEST_LIST)
                parts = zip(firsts, _pieces(values), strict=True)
                lines += [f"    {name}({k}:{k + len(part) - 1}) = [{', '.join(part)}]" for k, part in parts]
                line = line.replace(listed, name, 1)
        lines.append(line)
    return "\n".join(_shorter(lines)).replace(_COUNTED, "\n".join([_COUNTED, *declared]), 1)


def _shorter(lines: Iterable[str]) -> Iterable[str]:
    """Long lines continued; a remark that is too long is cut to its words."""
    for line in lines:
        while len(line.encode()) > WIDTH and not line.lstrip().startswith("!"):
            code = line if " ! " not in line else line[: line.index(" ! ")]
            if len(code.encode()) <= WIDTH:
                yield f"{' ' * (len(code) - len(code.lstrip()))}!{line[len(code) + 2 :]}"
                line = code
                break
            at = max(
                (m.end() for m in re.finditer(r"[,+*/(] ?(?=[^*/])|[a-z0-9)] (?=[-<>])", line[:WIDTH])), default=WIDTH
            )
            yield f"{line[:at]}&"
            line = f"        &{line[at:]}"
        yield line


FORM = FileForm(
    FORTRAN,
    _MODULE,
    "{main}.f90",
    "{main}_test.f90",
    given={
        "a_declared": ("a({accelerations}), ", ""),
        "a_list": ("a(:), ", ""),
        "x_and_a": ("x(:{states}, i), x({states} + 1:, i)", "x(:, i)"),
    },
    marked={"ieee": ("ieee_value", "    use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan\n")},
    body=_body,
    named=_named,
    fixed={"counted": _COUNTED},
    test=_TEST,
    vector=f"    call {CHECK}",
    empty="none",
    nan="nan",
    acting=("none", "{}"),
    real=lambda value: f"{value!r}_dp",
    finished=_short,
)
USE = ("use {stem}_rhs, only: rhs", "gfortran -std=f2008 -Wall {stem}_rhs.f90 {stem}_rhs_test.f90 -o test && ./test")
TARGET = compiled_target(
    "fortran",
    "a Fortran 2008 module",
    FORM,
    USE,
    entry=_ENTRY,
    size=r"real\(dp\) :: c\((\d+)\)",
    by=COMPILER,
    single=SingleWords(
        ((r"=> real64\b", "=> real32"), (r"\bc_double\b", "c_float")), r'![^\n]*|"(?:[^"]|"")*"', r"\.f90$"
    ),
)

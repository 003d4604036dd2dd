"""Program -> a Fortran 2008 module NAME_rhs: `call rhs(t, x, p, dx, inputs)`, inputs optional.

With it comes a program that holds it against the test vectors.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence

from eomgen.codegen.build import Compiler
from eomgen.codegen.expressions import ATOM, PRODUCT, SUM, RankedText, ranked_number
from eomgen.codegen.lowered import CHANGED, GIVEN, INDICES, INT, PLACES, READ, REAL, ROOM, Language
from eomgen.codegen.lowering import lowered
from eomgen.codegen.program import Program
from eomgen.codegen.targets.base import (
    RHS,
    Description,
    Role,
    files_of_each,
    header,
    vector_lines,
)
from eomgen.codegen.targets.in_single import SingleWords
from eomgen.codegen.targets.library_call import compiled_target, sizes
from eomgen.symbolic.expression.graph import Number

WIDTH = 120  # of a line; the standard has 132


def number(a: Number) -> RankedText:
    """A number in double precision."""
    text, strength = ranked_number(a)
    if strength == SUM:
        return f"-{number(-a)[0]}", SUM
    return "/".join(f"{part}_dp" for part in text.split("/")), PRODUCT if strength == PRODUCT else ATOM


def spelled(name: str) -> str:
    """Capitals are small letters: what the kernels tell apart by them has another name."""
    return f"big_{name}" if name.isupper() else name


_DEFINED = """\
elemental function {name}({arguments}) result(found)
    real(dp), intent(in) :: {arguments}
    real(dp) :: found
{body}
end function {name}"""


def _defined(name: str, arguments: str, *cases: str) -> str:
    """A function by cases: condition, value, ..., and the value where none holds."""
    lines = [
        f"    {'else if' if k else 'if'} ({c}) then\n        found = {v}"
        for k, (c, v) in enumerate(zip(cases[:-1:2], cases[1::2], strict=True))
    ]
    body = "\n".join([*lines, "    else", f"        found = {cases[-1]}", "    end if"])
    return _DEFINED.format(name=name, arguments=arguments, body=body)


FORTRAN = Language(
    reserved=frozenset(
        "allocatable allocate associate block call case character class common complex contains continue cycle data "
        "deallocate dimension do double elemental else elseif end enddo endif entry equivalence exit external function "
        "goto if implicit in inout integer intent interface intrinsic kind logical module namelist none nullify only "
        "open optional or out parameter pause pointer present print private procedure program public pure read real "
        "recursive result return save stop subroutine target then to true type use where while write dp size huge "
        "ieee_value found least most sign_of step pick merge x_names p_names input_names".split()
    ),
    functions={
        "less": "step({0} < {1}, {0} >= {1}, {0} + {1})",
        "less_equal": "step({0} <= {1}, {0} > {1}, {0} + {1})",
        "pow": "({0})**({1})",
        "select": "pick({0}, {1}, {2})",
        "min": "least({0}, {1})",
        "max": "most({0}, {1})",
        "sign": "sign_of({0})",
    },
    defined={
        "min": _defined("least", "a, b", "a < b .or. a /= a", "a", "b"),
        "max": _defined("most", "a, b", "a > b .or. a /= a", "a", "b"),
        "sign": _defined("sign_of", "a", "a > 0", "1", "a < 0", "-1", "a"),
        "select": _defined("pick", "given, a, b", "abs(given) <= 0", "b", "abs(given) > 0", "a", "given"),
    },
    words={"not": ".not. ", "!=": "/=", "nan": "ieee_value(1.0_dp, ieee_quiet_nan)", "given": "present(inputs)"},
    kinds=dict.fromkeys(("", REAL, INT, READ, CHANGED, INDICES, PLACES, GIVEN), "{name}"),
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
    listed=("[", "]"),
    loop=("do {name} = {first}, {last} - 1", "end do"),
    down=("do {name} = {last} - 1, {first}, -1", "end do"),
    branch=("if ({condition}) then", "else", "end if"),
    function=("recursive {what} {name}({arguments}){gives}", "end {what} {name}"),
    what=("subroutine", "function"),
    gives={INT: " result(found)", REAL: " result(found)"},
    out=("recursive subroutine {name}({arguments}, {out})", "end subroutine {name}"),
    remark="! {text}",
    unused="if (kind({name}) < 0) return  ! {name} does not stand in it",
    number=number,
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
    spelled=spelled,
    folded=str.lower,
)
COMPILER = Compiler(
    "Fortran",
    ".f90",
    "FC",
    ("gfortran", "flang", "ifx"),
    ("-std=f2008", "-shared", "-fPIC"),
    "install gfortran, or set FC",
)
_STEP = """\
elemental function step(yes, no, otherwise) result(found)
    logical, intent(in) :: yes, no
    real(dp), intent(in) :: otherwise
    real(dp) :: found
    found = otherwise
    if (yes) found = 1
    if (no) found = 0
end function step"""

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

_ENTRY = """
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
            call evaluate(t(i), {x}, p, c, given(:, i), out(:, i))
        end do
    else
        do i = 1, n
            call evaluate(t(i), {x}, p, c, {result}=out(:, i))
        end do
    end if
end subroutine
"""

_TEST = """\
! Held against its test vectors: stops where they do not agree
program {main}_test
    use, intrinsic :: iso_fortran_env, only: dp => real64
    use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
    use {main}, only: {role}
    implicit none
    real(dp), parameter :: none(0) = [real(dp) ::]
    real(dp) :: nan
    integer :: vector = 0
    nan = ieee_value(1.0_dp, ieee_quiet_nan)
{lines}
contains
    subroutine check(t, x, {a}p, inputs, right, tolerance)
        real(dp), intent(in) :: t, x(:), {a_declared}p(:), inputs(:), right(:), tolerance
        real(dp) :: found({outputs}), largest
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
            if (right(k) /= right(k)) then
                if (found(k) /= found(k)) cycle
            else if (abs(found(k) - right(k)) <= tolerance*largest) then
                cycle
            end if
            print *, "vector", vector, "{result}", k, "is", found(k), "not", right(k)
            error stop 1
        end do
    end subroutine check
end program {main}_test
"""


def fortran_text(program: Program, stem: str, role: Role = RHS, remarks: Mapping[str, str] | None = None) -> str:
    """The module of a program."""
    made, given, symbols = (
        lowered(program, FORTRAN, role.result, remarks=remarks),
        bool(program.accelerations),
        program.symbols,
    )
    tables = [FORTRAN.holds(table) for table in made.tables]
    defined = [FORTRAN.defined[op] for op in sorted(made.ops & FORTRAN.defined.keys())]
    defined += [_STEP] if made.ops & {"less", "less_equal"} else []
    functions = [*defined, *("\n".join(FORTRAN.defines(f)) for f in (*made.kernels, *made.bodies))]
    body = "\n\n".join(functions)
    nan = "ieee_value" in body
    listed = {"x_names": [x.name for x in program.states], "p_names": symbols.parameters, "input_names": symbols.inputs}
    text = _MODULE.format(
        **sizes(program, role, stem),
        size=max(made.constants, 1),
        a="a, " if given else "",
        a_declared=f"a({len(program.accelerations)}), " if given else "",
        ieee="    use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan\n" if nan else "",
        names="\n".join(_names(key, list(names)) for key, names in listed.items() if names),
        tables="".join(f"    {line}\n" for line in tables),
        functions="\n".join(f"    {line}".rstrip() for line in body.split("\n")),
    )
    return "\n".join(_short(text.split("\n")))


def _names(key: str, names: Sequence[str]) -> str:
    width = max(len(name.encode()) for name in names)
    quoted = ", ".join('"' + name.replace('"', '""') + '"' for name in names)
    return f"    character({width}), parameter, public :: {key}({len(names)}) = [character({width}) :: {quoted}]"


def _short(lines: Iterable[str]) -> Iterable[str]:
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


def _files(stem: str, program: Program, told: Description) -> dict[str, str]:
    """NAME_rhs.f90 and NAME_rhs_test.f90."""
    main, given = told.role.main(stem), bool(program.accelerations)
    head = "\n".join(f"! {FORTRAN.harmless(line)}".rstrip() for line in header(program, told))
    a = "{a}, " if given else ""
    call = f"    call check({{t}}, {{x}}, {a}{{p}}, {{inputs}}, {{result}}, {{tolerance}})"
    lines = vector_lines(told.vectors, call, _listed, _number, ("none", "{}"))
    test = _TEST.format(
        **sizes(program, told.role, stem),
        lines="\n".join(lines),
        a="a, " if given else "",
        a_declared="a(:), " if given else "",
    )
    files = {f"{main}.f90": f"{head}\n{fortran_text(program, stem, told.role, told.remarks)}"}
    return files | ({f"{main}_test.f90": "\n".join(_short(test.split("\n")))} if told.vectors else {})


def _number(value: float) -> str:
    return "nan" if value != value else f"{value!r}_dp"


def _listed(values: Sequence[float]) -> str:
    return f"[{', '.join(map(_number, values))}]" if values else "none"


def _many_text(text: str, program: Program, stem: str, role: Role) -> str:
    """The module with a subroutine that Python calls."""
    size = re.search(r"real\(dp\) :: c\((\d+)\)", text)
    assert size is not None
    n = len(program.states)
    x = f"x(:{n}, i), x({n + 1}:, i)" if program.accelerations else "x(:, i)"
    return text + _ENTRY.format(**sizes(program, role, stem), size=size[1], x=x)


USE = ("use {stem}_rhs, only: rhs", "gfortran -std=f2008 -Wall {stem}_rhs.f90 {stem}_rhs_test.f90 -o test && ./test")
TARGET = compiled_target(
    "fortran",
    "a Fortran 2008 module",
    fortran_text,
    files_of_each(_files),
    USE,
    source="{main}.f90",
    called=_many_text,
    by=COMPILER,
    single=SingleWords(
        ((r"=> real64\b", "=> real32"), (r"\bc_double\b", "c_float")), r'![^\n]*|"(?:[^"]|"")*"', r"\.f90$"
    ),
)

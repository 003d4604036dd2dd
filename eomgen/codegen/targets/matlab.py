"""Program -> a function file of MATLAB and Octave: `dx = NAME_rhs(t, x, p, inputs)`, a column; inputs may be left out.

With it comes a test over the test vectors. It runs here in Octave.
"""

from __future__ import annotations

import shutil
import tempfile
import weakref
from collections.abc import Mapping
from pathlib import Path

from eomgen.codegen.program import Program
from eomgen.codegen.statements import CHANGED, INDICES, INT, PLACES, READ, ROOM, Language
from eomgen.codegen.targets.base import (
    CHECK,
    Called,
    FileContent,
    FileForm,
    Functions,
    Many,
    Role,
    Target,
    by_cases,
    called_by,
    functions_by,
)
from eomgen.codegen.targets.loading import many_beside
from eomgen.errors import ToolMissing


def _guarded(name: str, arguments: str, outside: str, value: str) -> str:
    """A function that has no value outside its domain, where MATLAB's is complex or drops a NaN."""
    return (
        f"function found = {name}({arguments})\n    if {outside}\n        found = NaN;\n    else\n"
        f"        found = {value};\n    end\nend\n"
    )


MATLAB = Language(
    reserved=frozenset(
        "break case catch classdef continue else elseif end for function global if otherwise parfor persistent return "
        "spmd switch try while end_try_catch unwind_protect do until endif endfor endfunction endwhile e i j Inf NaN "
        "NA eps zeros isempty nargin table place found root logarithm arc_sine arc_cosine power_of least most "
        "less less_equal pick ans ones size numel false true ode45 assert abs any all".split()
    ),
    functions={
        "sqrt": "root({0})",
        "log": "logarithm({0})",
        "asin": "arc_sine({0})",
        "acos": "arc_cosine({0})",
        "pow": "power_of({0}, {1})",
        "min": "least({0}, {1})",
        "max": "most({0}, {1})",
        "select": "pick({0}, {1}, {2})",
    },
    defined={
        "sqrt": _guarded("root", "a", "~(a >= 0)", "sqrt(a)"),
        "log": _guarded("logarithm", "a", "~(a >= 0)", "log(a)"),
        "asin": _guarded("arc_sine", "a", "~(abs(a) <= 1)", "asin(a)"),
        "acos": _guarded("arc_cosine", "a", "~(abs(a) <= 1)", "acos(a)"),
        "pow": _guarded("power_of", "a, b", "a < 0 && b ~= round(b)", "a^b"),
        **by_cases(
            "function found = {name}({arguments})\n    {value}\n    end\nend\n",
            "if {condition}\n        found = {value};\n    else{otherwise}",
            ends="\n        found = {value};",
            words={"min": "least", "max": "most", "select": "pick", "a != a": "a ~= a", "nan": "a + b"},
            only=("min", "max", "less", "less_equal", "select"),
        ),
    },
    words={"not": "~", "!=": "~=", "nan": "NaN", "given": "~isempty(inputs)"},
    at="{array}({index})",
    index="{index} + 1",
    first=1,
    let="{declared} = {value};",
    changes="[{results}] = {function}({arguments});",
    back="found = {value};\nreturn;",
    arrays=dict.fromkeys((CHANGED, ROOM, PLACES), "{name} = zeros({size}, 1);"),
    tables={
        INT: "function found = {name}()\n    found = {value};\nend\n",
        **dict.fromkeys(
            (INDICES, READ),
            "function found = {name}(place)\n    persistent table\n    if isempty(table)\n        table = {values};\n"
            "    end\n    if nargin\n        found = table(place);\n    else\n        found = table;\n    end\nend\n",
        ),
    },
    loop=("for {name} = {first}:({last} - 1)", "end"),
    down=("for {name} = ({last} - 1):-1:{first}", "end"),
    branch=("if {condition}", "else", "end"),
    function=("function [{results}] = {name}({arguments})", "end"),
    out=("function {out} = {name}({arguments})\n    {out} = zeros({size}, 1);", "end"),
    remark="% {text}",
    leave="return;",
)

_MAIN = """\
function {result} = {main}(t, x, {a}p, inputs)
%{MAIN}
{head}
    if nargin < {count}
        inputs = [];
    end
    {result} = evaluate(t, x, {a}p, constants(p), inputs);
end

{functions}
"""

_TEST = """\
function {main}_test()
% Held against its test vectors: ends without a word where all agree. In Octave: octave --eval {main}_test
{lines}
end

function check(t, x, {a}p, inputs, right, tolerance)
    if isempty(inputs)
        found = {main}(t, x, {a}p);
    else
        found = {main}(t, x, {a}p, inputs);
    end
    right = right(:);
    known = right == right;
    assert(isequal(size(found), size(right)), 'the size of the result is not that of the vector');
    assert(all(isnan(found(~known))), 'a value where there is none');
    wrong = find(abs(found(known) - right(known)) > tolerance*max([1; abs(right(known))]), 1);
    assert(isempty(wrong), 'at t = %g: %s is not %s', t, mat2str(found', 17), mat2str(right', 17));
end
"""

_SERVER = """
more off; addpath('{folder}');
sizes = fread(stdin, 5, 'double')';
while true
    head = fread(stdin, 2, 'double');
    if numel(head) < 2, break; end
    p = fread(stdin, sizes(3), 'double');
    out = zeros(sizes(5), head(1));
    for k = 1:head(1)
        t = fread(stdin, 1, 'double');
        x = fread(stdin, sizes(1), 'double');
        given = {{}};
        if sizes(2), given = {{fread(stdin, sizes(2), 'double')}}; end
        given{{end + 1}} = p;
        if head(2), given{{end + 1}} = fread(stdin, sizes(4), 'double'); end
        out(:, k) = {main}(t, x, given{{:}});
    end
    fwrite(stdout, out, 'double'); fflush(stdout);
end
"""


FORM = FileForm(
    MATLAB,
    _MAIN,
    "{main}.m",
    "{main}_test.m",
    "{text}",
    given={"count": ("5", "4")},
    test=_TEST,
    vector=f"    {CHECK};",
    empty="zeros(1, 0)",
)


def octave() -> str | None:
    """Path of Octave; None where it is not installed."""
    return shutil.which("octave-cli") or shutil.which("octave")


def _many(text: str, main: str, program: Program) -> Many:
    """The function file, run by Octave in a process of its own."""
    path = octave()
    if path is None:
        raise ToolMissing("there is no Octave to run MATLAB code", fix="install octave, or choose another target")
    folder = Path(tempfile.mkdtemp(prefix="eomgen-"))
    (folder / f"{main}.m").write_text(text, encoding="utf-8")
    server = _SERVER.format(folder=str(folder).replace("'", "''"), main=main)
    found = many_beside("Octave", [path, "-q", "--norc", "--eval", server], program)
    weakref.finalize(found, shutil.rmtree, folder, ignore_errors=True)
    return found


def functions(program: Program) -> Functions:
    """The program run by Octave."""
    return functions_by(_many(FORM.text(program, "eomgen"), "eomgen_rhs", program))


def run(texts: Mapping[str, FileContent], program: Program, stem: str, role: Role) -> Called:
    """The function of the file, run by Octave."""
    main = role.main(stem)
    return called_by(_many(str(texts[f"{main}.m"]), main, program))


USE = ("[t, x] = ode45(@(t, x) {stem}_rhs(t, x, p), [0 10], x0);", "octave --eval {stem}_rhs_test")
TARGET = Target("matlab", "function files of MATLAB and Octave", FORM.text, FORM.files, USE, functions, run)

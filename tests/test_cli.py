"""The command line: what goes where, exit codes, JSON, files whole or not at all, and quick help."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import tomllib
from collections import Counter
from importlib import metadata
from pathlib import Path

import click
import pytest
from click.testing import CliRunner
from each import each
from slow_run import in_slow_run

import eomgen
from eomgen import equations, pipeline
from eomgen.cli import main
from eomgen.codegen.build import compiler
from eomgen.codegen.targets import ALL
from eomgen.documents import rendered
from eomgen.documents.document import Document
from eomgen.documents.statements import Found, Listing, Quantity, Step
from eomgen.proof.check import Certificate, Check
from eomgen.version import __version__

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parent.parent
MODELS = ROOT / "models"
PENDULUM = str(MODELS / "double_pendulum.toml")
PARALLELOGRAM = str(MODELS / "parallelogram_reactions.toml")
TRUSS = str(ROOT / "tests" / "helpers" / "truss.toml")
BOLT_CUTTER = str(ROOT / "models" / "bolt_cutter.toml")
SEED = str(MODELS / "seeds" / "ch22_p1.toml")
OSCILLATIONS = (MODELS / "seeds" / "ch22_p3.toml").read_text() + 'omega3 = "frequency(3)"\n'  # it has two
VERBS = list(main.commands)

FALL = """
eomgen = 1
name = "runaway"
space = "plane"
[parameters]
k = 1.0
[coordinates]
x = { start = 1, speed = 1 }
[bodies.block]
mass = 1
joint = { kind = "prismatic", axis = [1, 0], displacement = "x", force = "k*x^3" }
[outputs]
x_dd = "x''"
never = { value = "x", at = "x = 2" }
"""


def run(*words: str, text: str | None = None):
    result = CliRunner().invoke(main, list(words), input=text)
    assert result.exception is None or isinstance(result.exception, SystemExit), result.exception
    return result


def started(*words: str, **more) -> subprocess.CompletedProcess:
    """The command as a process of its own."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT), **more.pop("env", {})}
    return subprocess.run(
        [sys.executable, "-m", "eomgen", *words], capture_output=True, text=True, env=environment, check=False, **more
    )


# -- help and imports ------------------------------------------------------------------------------


def test_help_answers_at_once():
    """`eomgen --help` takes 0.2 s of CPU, and far less than 0.8 s on a slow machine; it imports no sympy."""
    resource = pytest.importorskip("resource", reason="CPU of children is told by POSIX")
    spent = []
    for _ in range(3):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        result = started("--help")
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        spent.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
        assert result.returncode == 0
    assert min(spent) < 0.8
    assert [line.split()[0] for line in result.stdout.splitlines()[-len(VERBS) :]] == VERBS


DECLARED_TWICE = {  # one word for two things, each of its verb
    "--about": "a point of inertia; the place of small motions",
    "--method": "of deriving, of integrating; of a sweep with another default",
    "--target": "the language that runs; the languages that are written",
    "--output": "a file; the folder of a sweep; the folder of code",
    "--model": "of several in an SDF file",
}


def test_an_option_of_several_verbs_is_declared_once():
    """Its spelling, type and unit stand in one declaration; what it means for a verb is said there."""
    modules = sorted(Path(eomgen.__file__).parent.glob("cli*.py"))
    texts = " ".join(path.read_text(encoding="utf-8") for path in modules)
    declared = Counter(re.findall(r'click\.option,?\(?\s*(?:"-\w",\s*)?"(--[\w-]+)"', texts))
    options = {max(each.opts, key=len) for verb in main.commands.values() for each in verb.params}
    assert {name for name in options if name.startswith("--")} - {"--patience"} <= declared.keys()
    assert {name for name, k in declared.items() if k > 1} <= DECLARED_TWICE.keys()


def test_the_list_of_verbs_says_each_in_a_line_of_eighty_columns():
    """No verb's line ends in "...", none is longer than a screen; every option of a verb says what it is for."""
    listed = started("--help", env={"COLUMNS": "80"}).stdout.splitlines()
    assert not [line for line in listed[1:] if line.endswith("...") or len(line) > 80]
    for verb in VERBS:
        assert all(option.help for option in main.commands[verb].params if isinstance(option, click.Option)), verb


def test_importing_eomgen_and_its_command_line_imports_nothing_heavy():
    """No sympy, numpy, scipy, matplotlib or pydantic until a verb needs them."""
    code = "import sys, eomgen, eomgen.cli; print([m for m in sys.modules if '.' not in m])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=ROOT, check=True)
    assert not {"sympy", "numpy", "scipy", "matplotlib", "pydantic"} & set(eval(done.stdout))


def test_the_public_names_are_sorted_and_all_there():
    """eomgen.X for every X of __all__."""
    assert eomgen.__all__ == sorted(eomgen.__all__)
    for name in eomgen.__all__:
        assert getattr(eomgen, name) is not None
    assert {"load", "loads", "derive", "solve", "simulate", "Model", "ModelError"} <= set(eomgen.__all__)
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        eomgen.nothing  # noqa: B018


def test_the_version_is_told_once_and_everywhere_the_same():
    """pyproject, eomgen.__version__ and `eomgen --version`."""
    assert (
        f'version = "{__version__}"' in (ROOT / "pyproject.toml").read_text()
        or "dynamic" in (ROOT / "pyproject.toml").read_text()
    )
    assert run("--version").stdout.strip() == f"eomgen, version {__version__}"
    assert eomgen.__version__ == __version__


# -- conventions -----------------------------------------------------------------------------------


@each(
    "words",
    [
        ("check", PENDULUM),
        ("check", TRUSS),
        ("derive", SEED),
        ("derive", SEED, "--no-certify"),
        ("solve", SEED),
        ("reactions", SEED),
        ("simulate", PENDULUM, "--time", "0.1"),
        ("schema",),
        ("doctor",),
        ("check", "no/such/file"),
        ("nonsense",),
        ("simulate", PENDULUM, "--set", "q=1"),
        ("derive", TRUSS),
    ],
)
def test_with_json_stdout_is_one_json_object_with_its_schema_version(words):
    """`--json` on every verb, errors too."""
    result = run(*words, "--json")
    payload = json.loads(result.stdout)
    assert payload["schema_version"] == 1
    assert (result.exit_code in (1, 2, 3) and "error" in payload) or words == ("solve", SEED) or result.exit_code == 0
    if "error" in payload:
        assert payload["error"]["exit_code"] == result.exit_code
        assert payload["error"]["problems"][0]["what"]
        assert result.stderr


def test_new_and_codegen_have_json_too(tmp_path, monkeypatch):
    """The files that were written are named."""
    monkeypatch.chdir(tmp_path)
    assert json.loads(run("new", "mine", "--json").stdout) == {"schema_version": 1, "file": "mine.toml"}
    payload = json.loads(run("codegen", "mine.toml", "--target", "numpy", "-o", "code", "--json").stdout)
    assert all(Path(name).is_file() for name in payload["files"])


def test_only_the_result_is_on_stdout():
    """The same text with a failure as without it: messages go to stderr."""
    whole, part = run("solve", SEED), run("solve", "-", text=OSCILLATIONS)
    assert (whole.exit_code, whole.stderr, part.exit_code) == (0, "", 3)
    assert part.stderr.startswith("not answered: omega3")
    assert whole.stdout.startswith("kinetic_energy  = ") and part.stdout.startswith("Q_theta ")


@each(
    "words, code, word",
    [
        (("check", PENDULUM), 0, ""),
        (("check", "no/such/model.toml"), 2, "does not exist"),
        (("chek", PENDULUM), 2, "Did you mean 'check'?"),
        (("derive", PENDULUM, "--method", "magic"), 2, "'magic' is not one of"),
        (("simulate", PENDULUM, "--set", "m3=1"), 2, "there is no parameter 'm3'"),
        (("simulate", PENDULUM, "--set", "m1"), 2, "write --set m=2"),
        (("simulate", PENDULUM, "--set", "m1=two"), 2, "unknown name 'two'"),
        (("simulate", PENDULUM, "--start", "theta3=1"), 2, "did you mean 'theta"),
        (("simulate", PENDULUM, "--time", "nan"), 2, "is no time"),
        (("simulate", PENDULUM, "--rtol", "-1"), 2, "tolerances"),
        (("simulate", PENDULUM, "-o", "run.xlsx"), 2, "endings are .csv, .npz"),
        (("derive", BOLT_CUTTER), 3, "the unknown 'P' stands in forces.hand_up.force"),
        (("reactions", PARALLELOGRAM, "--at", "theta"), 2, "write left = right"),
        (("reactions", PARALLELOGRAM, "--at", "phi=pi"), 2, "unknown name 'phi'"),
        (("reactions", PARALLELOGRAM, "--from-rest", "thet=0"), 2, "did you mean 'theta'?"),
        (("reactions", PARALLELOGRAM, "--from-rest", "theta"), 2, "write --from-rest"),
        (("reactions", PARALLELOGRAM, "--from-rest", "theta=a"), 2, "unknown name 'a'"),
        (("reactions", PARALLELOGRAM, "--from-rest", "theta=1+"), 2, "--from-rest theta=1+"),
        (("reactions", PARALLELOGRAM, "--at", "theta=-1", "--from-rest", "theta=0"), 3, "not answered"),
        (("simulate", BOLT_CUTTER), 3, "a motion does not follow"),
    ],
)
def test_the_exit_code_says_what_kind_of_thing_went_wrong(words, code, word):
    """0 ok, 1 the model, 2 usage, 3 derivation or run (4: see below)."""
    result = run(*words)
    assert result.exit_code == code
    assert word in result.stderr


def test_a_missing_tool_is_exit_code_4(monkeypatch):
    """The user asked for C by name, and there is no compiler."""
    monkeypatch.setenv("CC", "/nowhere/cc")
    result = run("simulate", PENDULUM, "--target", "c", "--time", "0.1")
    assert result.exit_code == 4
    assert "no C compiler" in result.stderr


def test_a_missing_package_is_exit_code_4():
    """No traceback where a dependency was not installed."""
    without = "import sys; sys.modules['numpy'] = None; from eomgen.cli import main; main()"
    made = subprocess.run([sys.executable, "-c", without, "check", str(PENDULUM)], capture_output=True, text=True)
    assert made.returncode == 4
    assert "the package 'numpy' is not installed" in made.stderr


def test_output_goes_into_a_file_whole_its_folder_made(tmp_path):
    """-o FILE holds what stdout would; nothing else is left in the folder."""
    path = tmp_path / "deep" / "er" / "answer.txt"
    result = run("solve", SEED, "-o", str(path))
    assert result.stdout == ""
    assert path.read_text() == run("solve", SEED).stdout
    assert [entry.name for entry in path.parent.iterdir()] == ["answer.txt"]


def test_a_file_that_cannot_be_written_is_said_and_nothing_is_left(tmp_path):
    """A folder that is a file: exit 74, no traceback."""
    (tmp_path / "file").write_text("precious")
    for name, *words in (
        ("x.txt", "solve", SEED),
        ("x.tex", "derive", SEED),
        ("x.csv", "simulate", PENDULUM, "--time", "0.1"),
    ):
        result = run(*words, "-o", str(tmp_path / "file" / name))
        assert result.exit_code == 74
        assert "cannot be" in result.stderr
    assert (tmp_path / "file").read_text() == "precious"
    assert len(list(tmp_path.iterdir())) == 1


def test_ctrl_c_is_quiet(monkeypatch):
    """Exit code 130, no traceback."""

    def interrupted(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr(pipeline, "derive", interrupted)
    result = run("derive", PENDULUM)
    assert result.exit_code == 130
    assert "Traceback" not in result.stderr


def test_a_file_that_ends_too_early_is_nobody_who_interrupts(monkeypatch):
    """EOFError out of a library: exit code 70, and what it was."""

    def ended(*_, **__):
        raise EOFError("marshal data too short")

    monkeypatch.setattr(pipeline, "derive", ended)
    result = run("derive", PENDULUM)
    assert result.exit_code == 70
    assert "internal error: EOFError: marshal data too short" in result.stderr and "interrupted" not in result.stderr


def test_a_reader_that_went_away_is_no_error_message():
    """`eomgen schema | head -1` prints one line and nothing on stderr."""
    command = f"{sys.executable} -m eomgen schema | head -c 1"
    done = subprocess.run(["bash", "-c", command], capture_output=True, text=True, cwd=ROOT, check=False)
    assert (done.stdout, done.stderr) == ("{", "")


def test_nothing_is_coloured():
    """NO_COLOR and FORCE_COLOR alike: no escape codes."""
    for setting in ({"NO_COLOR": "1"}, {"FORCE_COLOR": "1"}):
        done = started("check", "no/such", env=setting)
        assert "\x1b" not in done.stdout + done.stderr


def test_a_model_is_read_from_stdin_too():
    """`eomgen check -`; errors name <stdin>."""
    assert run("check", "-", text=FALL).exit_code == 0
    result = run("check", "-", text=FALL.replace("k*x^3", "kk*x^3"))
    assert result.exit_code == 1
    assert "<stdin>:" in result.stderr


def test_an_error_under_json_carries_its_place(tmp_path):
    """file, line, column, what, excerpt, fix of every problem."""
    path = tmp_path / "bad.toml"
    path.write_text(FALL.replace("k*x^3", "k*y^3"))
    result = run("check", str(path), "--json")
    (problem,) = json.loads(result.stdout)["error"]["problems"]
    assert (problem["file"], problem["line"]) == (str(path), 11)
    assert problem["excerpt"].splitlines()[1].strip() == "^"
    assert "'y'" in problem["what"]


def test_the_same_bytes_come_out_of_every_run():
    """Hash seeds differ from process to process; the derivation does not."""
    outputs = {started("derive", SEED, "--json", env={"PYTHONHASHSEED": seed}).stdout for seed in "12"}
    assert len(outputs) == 1


def test_an_answer_is_typeset_in_the_order_of_its_text():
    """f*e*d*c*b*a: f e d c b a in every run, whatever the hashes of the names are."""
    listing = Listing((Found("P", Quantity("f*e*d*c*b*a + g")),))
    text = rendered(Document("model", steps=(Step("", "", (listing,)),)), "latex")
    assert "f e d c b a + g" in text


# -- the verbs -------------------------------------------------------------------------------------


def test_the_starter_model_derives_solves_and_simulates(tmp_path, monkeypatch):
    """eomgen new NAME, and on with it; a file that is there is never overwritten."""
    monkeypatch.chdir(tmp_path)
    assert run("new", "mine").stdout == "mine.toml\n"
    assert eomgen.load("mine.toml").name == "mine"
    assert run("derive", "mine.toml").exit_code == 0
    assert run("solve", "mine.toml").exit_code == 0
    assert run("simulate", "mine.toml", "--time", "1").exit_code == 0
    Path("mine.toml").write_text("precious")
    result = run("new", "mine")
    assert (result.exit_code, Path("mine.toml").read_text()) == (2, "precious")
    assert "is there already" in result.stderr


def test_each_example_that_ships_can_be_the_beginning_of_ones_own(tmp_path, monkeypatch):
    """examples names every file of models/; new --example gives its bytes; a name that is none is answered."""
    monkeypatch.chdir(tmp_path)
    found = json.loads(run("examples", "--json").stdout)["examples"]
    assert [Path(each["path"]) for each in found] == sorted(MODELS.rglob("*.toml"))
    assert all(each["title"] for each in found)
    assert len(run("examples").stdout.splitlines()) == len(found)
    for name, of in (("a", "double_pendulum"), ("b", "seeds/ch22_p1"), ("c", "ch22_p1.toml")):
        assert run("new", name, "--example", of).exit_code == 0
        source = MODELS / (of if "pendulum" in of else "seeds/ch22_p1")
        assert Path(f"{name}.toml").read_bytes() == source.with_suffix(".toml").read_bytes()
    wrong = run("new", "d", "--example", "duble_pendulum")
    assert wrong.exit_code == 2 and "did you mean 'double_pendulum'?" in wrong.stderr
    assert run("new", "a", "--example", "double_pendulum").exit_code == 2


def test_the_citation_and_the_sdist_are_of_this_version():
    """CITATION.cff has the version; what the sdist is to hold is there."""
    assert f"version: {__version__}\n" in (ROOT / "CITATION.cff").read_text()
    built = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["hatch"]["build"]["targets"]
    held = [*built["sdist"]["include"], *built["wheel"]["force-include"]]
    assert all((ROOT / path).exists() for path in held) and built["wheel"]["force-include"] == {
        "models": "eomgen/examples"
    }


def test_check_tells_the_degrees_of_freedom_both_ways():
    """By rank beside the count by formula."""
    lines = run("check", PENDULUM).stdout.splitlines()
    assert "degrees of freedom: 2 by rank" in lines
    assert "count by formula: 2 = 3*2 (bodies) - 4 (joints)" in lines


def test_check_counts_the_nodes_of_a_truss_as_particles():
    """2 Np - members - supports = 0"""
    lines = run("check", TRUSS).stdout.splitlines()
    assert "degrees of freedom: 0 by rank" in lines
    assert "count by formula: 0 = 2*3 (particles) - 6 (constraints)" in lines


@pytest.mark.parametrize(
    ("ending", "mark"), [("tex", r"\begin{document}"), ("md", "# "), ("json", "{"), ("txt", "Rolling")]
)
def test_the_ending_of_the_file_chooses_the_format(ending, mark, tmp_path):
    """derive -o x.tex writes LaTeX; --format says otherwise."""
    path = tmp_path / f"x.{ending}"
    assert run("derive", SEED, "-o", str(path)).exit_code == 0
    assert mark in path.read_text()
    assert run("derive", SEED, "-o", str(path), "--format", "markdown").exit_code == 0
    assert path.read_text().startswith("#")


@pytest.mark.parametrize("verb", [verb for verb in VERBS[2:] if verb not in ("live", "lsp")])  # it writes nothing
def test_an_ending_that_no_form_has_is_refused_before_any_work(verb, tmp_path):
    """derive -o w.html: exit 2, the endings that there are, no file, with and without --format."""
    own = {"animate": {".html"}, "play": {".html"}, "report": {".html", ".pdf", ".PDF"}}.get(verb, set())
    for ending in sorted({".html", ".pdf", ".docx", ".xlsx", ".PDF"} - own):
        path = tmp_path / f"w{ending}"
        words = (verb, *(() if verb in ("schema", "doctor") else (SEED,)), "-o", str(path))
        words += ("--data", SEED) if verb == "identify" else ()
        has_form = verb not in ("schema", "doctor", "codegen", "simulate", "play", "report", "import", "export")
        has_form = has_form and verb != "sweep"
        for result in (run(*words), run(*words, *(("--format", "text") if has_form else ("--json",)))):
            assert result.exit_code == 2 and not list(tmp_path.iterdir())
            endings = {"simulate": ".csv, .npz", "codegen": "-o names the folder", "play": "the ending is .html"}
            endings |= {
                "report": ".html, .pdf, .tex, .md, .ipynb",
                "animate": ".gif, .mp4, .png, .html",
                "import": ".toml",
                "export": ".urdf",
                "sweep": "-o names the folder",
            }
            assert endings.get(verb, ".txt, .tex, .md, .json") in result.stderr


@pytest.mark.parametrize("verb", ["statics", "kinematics", "inertia", "linearize", "simulate"])
def test_a_picture_has_an_ending_of_a_picture(verb, tmp_path):
    """--plot x.html: exit 2 before any work, the endings that there are."""
    result = run(verb, SEED, "--plot", str(tmp_path / "x.html"))
    assert result.exit_code == 2 and ".png, .svg, .pdf" in result.stderr and not list(tmp_path.iterdir())


def test_a_folder_of_code_may_have_any_name_but_that_of_a_file(tmp_path):
    """codegen -o run.c is refused; -o run, build-1.2, or a folder that is there are not."""
    (tmp_path / "there.c").mkdir()
    for name, code in (("run.c", 2), ("run", 0), ("build-1.2", 0), ("there.c", 0)):
        words = ("codegen", PENDULUM, "--target", "numpy", "--no-certify", "-o", str(tmp_path / name))
        assert run(*words).exit_code == code


def test_check_takes_several_files(tmp_path):
    """Each is told, the wrong ones too, in order; the exit code is the largest; JSON is one object."""
    bad = tmp_path / "bad.toml"
    bad.write_text(FALL.replace("k*x^3", "kk*x^3"))
    good = run("check", PENDULUM).stdout
    result = run("check", PENDULUM, str(bad), SEED)
    assert result.exit_code == 1 and result.stdout == f"{good}\n{run('check', SEED).stdout}"
    assert f"{bad}:11:" in result.stderr
    found = json.loads(run("check", PENDULUM, str(bad), "--json").stdout)["models"]
    assert [each["path"] for each in found] == [PENDULUM, str(bad)]
    assert found[0]["degrees_of_freedom"] == 2 and found[1]["error"]["exit_code"] == 1
    run("check", PENDULUM, SEED, "-o", str(tmp_path / "all.txt"))
    assert (tmp_path / "all.txt").read_text() == result.stdout
    assert run("check", PENDULUM, SEED, "--format", "latex").exit_code == run("check").exit_code == 2


@pytest.mark.parametrize("words", [("solve", SEED), ("reactions", SEED), ("simulate", PENDULUM, "--time", "0.1")])
def test_what_is_no_derivation_has_the_four_forms_too(words):
    """--format latex and markdown typeset the same formulas that the text and the JSON hold."""
    found = {form: run(*words, "--format", form).stdout for form in ("text", "latex", "markdown", "json")}
    assert found["latex"].endswith("\\end{document}\n") and found["markdown"].startswith("# ")
    assert json.loads(found["json"])["schema_version"] == 1
    if words[0] == "simulate":
        assert "& $0.1$" in found["latex"] and "| 0.1 |" in found["markdown"]
    else:
        assert r"\theta" in found["latex"] and r"\theta" in found["markdown"] and "theta" in found["text"]


def test_derive_shows_its_certificate_in_every_format():
    """The certificate is part of the result."""
    assert "certificate: holds" in run("derive", SEED).stdout
    assert "% certificate: holds" in run("derive", SEED, "--format", "latex").stdout
    assert "certificate: holds" in run("derive", SEED, "--format", "markdown").stdout
    assert json.loads(run("derive", SEED, "--json").stdout)["certificate"]["ok"] is True
    assert "certificate" not in run("derive", SEED, "--no-certify").stdout
    assert json.loads(run("derive", SEED, "--json", "--no-certify").stdout)["certificate"] is None


@pytest.mark.parametrize("format", ["text", "latex", "markdown", "json"])
def test_a_certificate_that_fails_is_shown_with_the_result_and_exit_code_3(format, monkeypatch):
    """The result is still there, and marked."""
    failing = Certificate((Check("two and two are four", "fails", "fingers", "five"),))
    monkeypatch.setattr(equations, "certify", lambda *_, **__: failing)
    result = run("derive", SEED, "--format", format)
    assert result.exit_code == 3
    assert "FAILS" in result.stderr
    assert "theta" in result.stdout and "two and two are four" in result.stdout
    if format == "json":
        assert json.loads(result.stdout)["certificate"]["ok"] is False
    else:
        assert "the certificate FAILS: do not trust this result" in result.stdout


def test_what_could_not_be_checked_is_a_warning_and_no_failure(monkeypatch):
    """`ok` is null, exit 0; the warning stands on stderr and in the JSON; with a proof there is none."""
    unchecked = Certificate((Check("it is so", "unchecked", "looking", "it is dark"),))
    proven = json.loads(run("derive", SEED, "--json").stdout)
    monkeypatch.setattr(equations, "certify", lambda *_, **__: unchecked)
    result = run("derive", SEED, "--json")
    data = json.loads(result.stdout)
    assert (result.exit_code, data["certificate"]["ok"], proven["warnings"]) == (0, None, [])
    assert [each["what"] for each in data["warnings"]] == ["nothing of this result could be checked"]
    assert "warning: nothing of this result could be checked" in result.stderr


@each("words", [("--json",), ("--format", "json"), ("--format=json",)])
def test_errors_are_json_where_json_is_asked_in_any_way(words):
    """derive --format json of a file that is no model: one JSON object, as with --json."""
    result = run("derive", "-", *words, text="nonsense = 1\n")
    assert json.loads(result.stdout)["error"]["exit_code"] == result.exit_code != 0


def test_solve_gives_every_output_in_the_fixed_shape():
    """{name: {exact, value, unit, method, message}}; what cannot be answered has nulls, and exit 3."""
    whole, part = run("solve", SEED, "--json"), run("solve", "-", "--json", text=OSCILLATIONS)
    outputs, others = (json.loads(result.stdout)["outputs"] for result in (whole, part))
    assert (whole.exit_code, part.exit_code) == (0, 3)
    assert list(outputs) == ["kinetic_energy", "Q_theta", "theta_dd", "omega_disc", "N_A"]
    assert all(list(answer) == ["exact", "value", "unit", "method", "message"] for answer in outputs.values())
    assert outputs["Q_theta"]["exact"] == "6*M*g*R*sin(theta)"
    assert others["K12"]["exact"] == "12*k*a^2"
    assert (others["omega3"]["exact"], others["omega3"]["value"]) == (None, None)
    assert others["omega3"]["message"].startswith("frequency(3): 2 small motions oscillate")


def test_reactions_at_an_instant_are_exact_and_numbers():
    """79/6 M g on each crank when they hang down, from rest in line: through unstable rest and a singular position"""
    result = run("reactions", PARALLELOGRAM, "--at", "theta=pi/2", "--from-rest", "theta=0", "--json")
    assert result.exit_code == 0, result.stderr
    found = json.loads(result.stdout)["reactions"]
    assert found["reaction_y(OA)"]["exact"] == "79/6*M*g" and found["reaction_y(B)"]["exact"] == "20/3*M*g"
    assert found["reaction_y(OA)"]["value"] == pytest.approx(79 / 6 * 9.81) and found["reaction_x(OA)"]["value"] == 0
    assert {(answer["unit"], answer["method"]) for answer in found.values()} == {("N", "energy theorem")}
    text = run("reactions", PARALLELOGRAM, "--at", "theta=pi/2", "--from-rest", "theta=0").stdout
    assert "reaction_y(B): force on AB at B, from CB, along y\n    = 20/3*M*g\n    = 65.4 N" in text


def test_reactions_from_rest_are_functions_of_the_coordinates():
    """bar from the horizontal: 9/8 M g sin(2 theta) towards the hinge; from another place another start"""
    bar = str(MODELS / "seeds" / "ch17_p3.toml")
    found = json.loads(run("reactions", bar, "--from-rest", "theta=0", "--json").stdout)["reactions"]
    assert found["reaction_x(bar)"]["exact"] == "-9/8*M*g*sin(2*theta)"
    other = json.loads(run("reactions", bar, "--from-rest", "theta=pi/2", "--at", "theta=0", "--json").stdout)
    assert other["reactions"].keys() == found.keys()


@in_slow_run
def test_reactions_as_formulas_say_what_accelerates_and_what_has_no_single_value():
    """15 M R (cos theta'' - ...) by the equations of motion; in line the parallelogram is indeterminate

    Slow: forty reactions of a chain of twenty, until each is found too long.
    """
    found = json.loads(run("reactions", PARALLELOGRAM, "--json").stdout)["reactions"]
    assert "theta''" not in found["reaction_x(OA)"]["exact"]
    assert found["reaction_x(OA)"]["value"] is None
    assert found["reaction_x(OA)"]["message"] == "it has no single value at the start"
    assert found["reaction_y(OA)"]["value"] == pytest.approx(11 / 12 * 9.81)
    cranks = run("reactions", str(MODELS / "four_cranks.toml"))
    assert cranks.exit_code == 0 and "statically indeterminate, see below" in cranks.stdout
    assert "reaction_y(P): -2*k1" in cranks.stdout
    chain = json.loads(run("reactions", str(MODELS / "chain20.toml"), "--json").stdout)["reactions"]
    assert len(chain) == 40 and all(answer["value"] is not None for answer in chain.values())
    assert "operations" in chain["reaction_x(rod1)"]["message"]


def test_simulate_summarises_on_stdout_or_writes_files(tmp_path):
    """CSV and NPZ hold the trajectory, --plot a picture; with -o the summary goes to stderr."""
    summary = run("simulate", PENDULUM, "--time", "1", "--samples", "5")
    assert "Reached t = 1 s." in summary.stdout and "Energy drift" in summary.stdout
    for ending in ("csv", "npz"):
        path, picture = tmp_path / f"run.{ending}", tmp_path / f"{ending}.png"
        result = run("simulate", PENDULUM, "--time", "1", "--samples", "5", "-o", str(path), "--plot", str(picture))
        assert (result.exit_code, result.stdout) == (0, "")
        assert "Reached t = 1 s." in result.stderr
        assert picture.read_bytes().startswith(b"\x89PNG")
    assert len((tmp_path / "run.csv").read_text().splitlines()) == 6


def test_parameters_and_starts_are_set_from_the_command_line():
    """--set and --start take numbers and expressions; parameters stand in starts."""
    words = ("--set", "m1=1/2", "--start", "theta1=pi/3", "--start", "theta2'=2*l1", "--time", "0")
    payload = json.loads(run("simulate", PENDULUM, *words, "--json").stdout)
    assert payload["start"]["theta1"] == pytest.approx(1.0471975511965976)
    assert payload["start"]["theta2'"] == 2
    assert payload["trajectory"]["t"] == [0.0]


def test_a_run_that_ends_early_gives_what_there_is_and_exit_code_3(tmp_path):
    """x'' = x^3 with x(0) = x'(0) = 1 reaches infinity in finite time: an outcome with a message, not an exception."""
    model, path = tmp_path / "runaway.toml", tmp_path / "run.csv"
    model.write_text(FALL)
    result = run("simulate", str(model), "-o", str(path))
    assert result.exit_code == 3
    assert "Stopped at t = " in result.stderr
    assert len(path.read_text().splitlines()) > 10


@pytest.mark.skipif(compiler() is None, reason="no C compiler")
def test_generated_c_compiles_as_it_is_and_passes_its_own_test(tmp_path):
    """cc -std=c99 -Wall -Wextra -pedantic -Werror; the self-tests of right-hand side and reactions return 0."""
    result = run("codegen", PENDULUM, "--target", "c", "-o", str(tmp_path))
    parts = ("rhs", "reactions", "matrices")
    names = [f"double_pendulum_{part}.{ending}" for part in parts for ending in "ch"]
    written = sorted([*names, "test_vectors.json", "README.md"])
    assert sorted(path.name for path in tmp_path.iterdir()) == written
    paths, certificate = result.stdout.split("\n\n")
    assert sorted(paths.split()) == [str(tmp_path / name) for name in written]
    assert certificate.startswith("certificate: holds")
    command = [str(compiler()), "-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror", "-DEOMGEN_SELFTEST", "-o", "t"]
    for source in names[::2]:
        subprocess.run([*command, source, "-lm"], cwd=tmp_path, check=True)
        subprocess.run(["./t"], cwd=tmp_path, check=True)


@in_slow_run
def test_the_languages_are_those_of_the_seam_jax_too(tmp_path):
    """codegen --list names ALL; an unknown one is exit 2 and names them too; several write into DIR/NAME."""
    names = [target.name for target in ALL]
    assert [line.split()[0] for line in run("codegen", "--list").stdout.splitlines()] == names
    assert [row["name"] for row in json.loads(run("codegen", "--list", "--json").stdout)["targets"]] == names
    wrong = run("codegen", PENDULUM, "--target", "algol", "-o", str(tmp_path))
    assert wrong.exit_code == 2 and ", ".join(names) in wrong.stderr and not list(tmp_path.iterdir())
    assert run("codegen", "-o", str(tmp_path)).exit_code == run("codegen", PENDULUM).exit_code == 2
    wrong = run("simulate", PENDULUM, "--target", "algol")
    assert wrong.exit_code == 2 and ", ".join(names) in wrong.stderr
    both = [word for name in names for word in ("--target", name)]
    payload = json.loads(run("codegen", PENDULUM, *both, "-o", str(tmp_path), "--json").stdout)
    assert payload["targets"] == names and {
        Path(file).relative_to(tmp_path).parts[0] for file in payload["files"]
    } == set(names)


def test_reactions_that_cannot_be_code_are_said_in_one_line(tmp_path):
    """A body that nothing holds, reactions that have no single value: no file, null in the JSON, a line on stderr."""
    loose, _, weight = (MODELS / "atwood.toml").read_text().partition("[constraints.string]")
    (tmp_path / "loose.toml").write_text(loose + weight[weight.index("[forces") : weight.index("[outputs]")])
    for path, line in (
        (tmp_path / "loose.toml", "no code for the reactions: body 'left' is unsupported along y"),
        (MODELS / "four_cranks.toml", "no code for the reactions: none has a single value"),
    ):
        name = path.stem
        result = run("codegen", str(path), "-o", str(tmp_path / name))
        assert (result.exit_code, result.stderr) == (0, line + "\n")
        assert not list((tmp_path / name).glob("*reactions*"))
        assert json.loads((tmp_path / name / "test_vectors.json").read_text())["reactions"] is None
    payload = json.loads(run("codegen", PENDULUM, "-o", str(tmp_path / "c"), "--json").stdout)
    assert payload["reactions"] == [f"reaction_{axis}(arm{k})" for k in (1, 2) for axis in "xy"]
    assert payload["reaction_operations"] > 0


def test_a_run_says_once_where_a_reaction_has_no_value(tmp_path):
    """nan in the file, null in the JSON, one line on stderr that names the first instant and the constraints."""
    words = ("simulate", str(MODELS / "parallelogram_reactions.toml"), "--time", "0.1", "--samples", "3")
    result = run(*words, "--json")
    trajectory = json.loads(result.stdout)["trajectory"]
    assert trajectory["reaction_x(OA)"][0] is None and trajectory["reaction_y(OA)"][0] is not None
    assert result.stderr.count("No single value in singular positions, first at t = 0 s: reaction_x(OA)") == 1
    path = tmp_path / "run.csv"
    assert run(*words, "-o", str(path)).stderr.count("No single value") == 1
    assert path.read_text().splitlines()[1].split(",")[4] == "nan"


@each(
    "model, more, line",
    [
        ("gerber_beam", "", "stable, statically determinate"),
        (
            "gerber_beam",
            'F = { kind = "support", point = "CD.C", normal = [0, 1] }',
            "stable, statically indeterminate: 1 reaction more than independent ones",
        ),
        ("bolt_cutter", "", "stable, statically determinate, held by P too"),
        ("seeds/ch11_p4", "", "a mechanism, it can move"),
    ],
)
def test_check_says_how_a_structure_stands(model, more, line):
    """Mobility = velocities - rank, indeterminacy = reactions - rank; unknown loads hold too."""
    text = (MODELS / f"{model}.toml").read_text().replace("[constraints]", f"[constraints]\n{more}")
    assert f"structure: {line}\n" in run("check", "-", text=text).stdout


def test_the_schema_fits_the_models():
    """What `eomgen schema` prints is a JSON Schema that every model of models/ fits."""
    jsonschema = pytest.importorskip("jsonschema")
    schema = json.loads(run("schema").stdout)
    validator = jsonschema.Draft202012Validator(schema)
    validator.check_schema(schema)
    for path in MODELS.rglob("*.toml"):
        assert not list(validator.iter_errors(tomllib.loads(path.read_text()))), path


def test_doctor_names_what_is_there_and_what_is_missing(monkeypatch):
    """Without a compiler, or a package that pages take: what still works, and what to install."""
    monkeypatch.setenv("CC", "/nowhere/cc")
    version = metadata.version

    def found(package):
        if package in ("typst", "math-core"):
            raise metadata.PackageNotFoundError(package)
        return version(package)

    monkeypatch.setattr(metadata, "version", found)
    result = run("doctor")
    assert result.exit_code == 0
    assert "formulas      not found: no report as .html" in result.stdout and "pip install typst" in result.stdout
    assert "C compiler    not found: equations run in numpy" in result.stdout


def test_a_trajectory_has_a_thousand_even_steps_unless_told_otherwise(tmp_path):
    """1001 instants and a header; --samples N gives N."""
    for words, instants in (((), 1001), (("--samples", "11"), 11)):
        path = tmp_path / f"{instants}.csv"
        run("simulate", SEED, "--time", "0.1", "-o", str(path), *words)
        assert len(path.read_text().splitlines()) == instants + 1

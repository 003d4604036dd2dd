"""A model that lives while it is written: what its page is told, who is answered, what is kept, what saves do."""

from __future__ import annotations

import http.client
import json
import os
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from fractions import Fraction
from hashlib import sha256
from pathlib import Path

import pytest
from slow_run import usual

import eomgen
from eomgen.errors import UsageError
from eomgen.living.parts import Work, WrittenModel, parts_made
from eomgen.living.session import LiveServer, Watcher
from eomgen.living.state import NAMES, LiveState
from eomgen.model import model_at

MODELS = Path(__file__).parent.parent / "models"
PENDULUM = """eomgen = 1
space = "plane"
[parameters]
m = { value = 2, unit = "kg" }
l = { value = 1, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }
[coordinates]
theta = { start = 30, unit = "deg" }
[bodies.arm]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", angle = "theta - pi/2" }
[forces]
weight = { kind = "gravity", acceleration = [0, "-g"] }
[outputs]
T = "kinetic_energy()"
"""


def found(text: str, work: Work | None = None) -> list[dict]:
    return list(parts_made(text.encode(), "pendulum.toml", "pendulum", work or Work()))


def part(findings: list[dict], name: str) -> dict:
    return next(each for each in findings if each.get("part") == name)


# -- parts -----------------------------------------------------------------------------------------


@pytest.mark.slow
def test_parts_come_in_the_order_in_which_one_waits_for_them():
    """Problems first, then figure, degrees of freedom, equations, answers, motion, reactions, the proof at last."""
    findings = found(PENDULUM)
    assert findings[0]["problems"] == [] and findings[0]["good"]
    assert tuple(each["part"] for each in findings if "part" in each) == NAMES
    assert part(findings, "figure")["value"].startswith("<svg ")
    assert part(findings, "degrees_of_freedom")["value"] == 1
    assert part(findings, "equations")["value"]["text"] == ["2*l*theta'' = -3*g*sin(theta)"]
    assert part(findings, "answers")["value"]["outputs"]["T"]["exact"] is not None
    assert "<html" in part(findings, "motion")["value"]["page"]
    assert "reaction_x(arm)" in part(findings, "reactions")["value"]["found"]
    assert part(findings, "certificate")["value"]["ok"] is True


def test_of_a_broken_file_the_problems_are_told_with_their_lines():
    """All of them, and no part."""
    (only,) = found(PENDULUM.replace('mass = "m"', 'mass = "mm"').replace('"-g"', '"-gg"'))
    assert not only["good"]
    assert {(problem["line"], problem["column"]) for problem in only["problems"]} == {(10, 33), (13, 51)}


def test_a_text_that_is_not_toml_has_its_line_too():
    """An open bracket."""
    (only,) = found(PENDULUM.replace("[outputs]", "[outputs"))
    assert [problem["line"] for problem in only["problems"]] == [14]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("text", "why"),
    [
        (PENDULUM.replace("value = 2, ", ""), {"motion": "no value for parameter 'm'"}),
        (
            (MODELS / "a_frame.toml").read_text("utf-8"),
            {},
        ),
    ],
)
def test_a_part_that_cannot_be_made_says_why_and_the_others_are_there(text, why):
    """A parameter without a value: no motion, but equations; of a structure no equations, but reactions."""
    findings = found(text)
    assert {each["part"]: each["why"] for each in findings if each.get("why")} == why
    assert part(findings, "reactions")["value"]["html"]


@pytest.mark.slow
def test_nothing_is_made_again_while_the_model_is_the_same():
    """A remark more: the same values, and the functions that make them are not called."""
    work = Work()
    first = found(PENDULUM, work)
    made = []
    again = Work()
    again._kept = work._kept
    again.kept = lambda key, make: Work.kept(again, key, lambda: made.append(key) or make())
    second = found(f"{PENDULUM}\n# a remark\n", again)
    assert made == []
    for name in NAMES:
        assert part(first, name)["value"] == part(second, name)["value"]


@pytest.mark.slow
def test_other_values_leave_the_equations_and_change_the_rest():
    """m = 3: no equation has another form; figure, motion and reactions are made anew."""
    work = Work()
    found(PENDULUM, work)
    made: list[str] = []
    again = Work()
    again._kept = work._kept
    again.kept = lambda key, make: Work.kept(again, key, lambda: made.append(key[0]) or make())
    found(PENDULUM.replace("value = 2", "value = 3"), again)
    assert made == [name for name in NAMES if name != "equations"]


def test_a_value_of_another_sign_is_no_other_value_of_the_same_equations():
    """0 and -1 for g make other keys, 9 does not."""

    def key(value: str) -> object:
        return WrittenModel(eomgen.loads(PENDULUM.replace("9.81", value))).key("equations")

    assert key("9.81") == key("9")
    assert key("9.81") != key("0") != key("-1")


@pytest.mark.slow
def test_what_is_out_of_date_is_ended_and_not_kept():
    """Stopped before its first part: none is made; the next text is worked on again."""
    work = Work()
    begun = parts_made(PENDULUM.encode(), "p.toml", "p", work)
    next(begun)
    work.stop()
    assert list(begun) == []
    work.begin()
    assert len([each for each in found(PENDULUM, work) if "part" in each]) == len(NAMES)


def with_other_values(model: eomgen.Model) -> eomgen.Model:
    """The model with every number of a parameter a hundredth larger, where it is one still."""
    values = model.exact_parameters()
    numbers = [name for name, part in model.parameters.items() if part.value is not None and part.formula is None]
    for names in (numbers, numbers[:1]):
        try:
            return model_at(model, {name: values[name] * Fraction(101, 100) for name in names})
        except eomgen.EomgenError:
            continue
    return model


MODELS_WITH_VALUES = usual([path for path in sorted(MODELS.glob("*.toml"))], 12, 5)


@pytest.mark.slow
@pytest.mark.by_model
@pytest.mark.parametrize("path", MODELS_WITH_VALUES, ids=lambda path: path.stem)
def test_kept_equations_are_those_of_the_other_values(path):
    """Where the keys of two models are the same, so is every formula that is shown of their equations."""
    model = eomgen.load(path)
    other = with_other_values(model)
    one, two = WrittenModel(model), WrittenModel(other)
    if not model.coordinates or one.key("equations") != two.key("equations"):
        pytest.skip("nothing is kept from one to the other")
    assert one.made("equations")() == two.made("equations")()


# -- state -----------------------------------------------------------------------------------------


def test_a_broken_file_keeps_the_parts_of_the_last_good_one():
    """What was shown stays until the file is a model again; then what is not there yet is null."""
    state = LiveState({})
    state.hear({"revision": state.begin(), "problems": [], "good": True})
    assert state.now()["figure"] is None
    state.hear({"revision": 1, "part": "figure", "value": "<svg 1>", "why": "", "seconds": 0.0})
    state.hear({"revision": 1, "done": True})
    state.hear({"revision": state.begin(), "problems": [{"what": "x"}], "good": False})
    assert state.now()["figure"] == "<svg 1>" and state.now()["problems"] == [{"what": "x"}]
    state.hear({"revision": state.begin(), "problems": [], "good": True})
    assert (state.now()["revision"], state.now()["figure"], state.now()["problems"]) == (3, None, [])


def test_what_is_told_of_an_older_revision_is_not_heard():
    """A worker that comes too late changes nothing."""
    state = LiveState({})
    state.begin()
    state.begin()
    state.hear({"revision": 1, "part": "figure", "value": "<svg old>", "why": "", "seconds": 0.0})
    assert state.now()["figure"] is None


def test_a_picture_that_cannot_be_drawn_leaves_the_last_one():
    """The constraints do not close: the figure stays, and why it is old is told."""
    state = LiveState({})
    for value, why in (("<svg 1>", ""), (None, "the rod is too short")):
        state.hear({"revision": state.begin(), "problems": [], "good": True})
        state.hear({"revision": state.revision, "part": "figure", "value": value, "why": why, "seconds": 0.0})
    assert state.now()["figure"] == "<svg 1>" and state.now()["why"] == {"figure": "the rod is too short"}


def test_only_what_changed_is_told():
    """All at first, then one entry; nothing where nothing changes."""
    state = LiveState({"file": "crane.toml"})
    number, first = state.since(0, 0)
    assert first["file"] == "crane.toml" and set(NAMES) <= first.keys()
    state.hear({"revision": state.begin(), "problems": [], "good": True})
    number, _ = state.since(number, 0)
    state.hear({"revision": 1, "part": "degrees_of_freedom", "value": 2, "why": "", "seconds": 0.25})
    number, told = state.since(number, 0)
    assert told == {"degrees_of_freedom": 2, "seconds": {"degrees_of_freedom": 0.25}}
    assert state.since(number, 0.01) == (number, {})


# -- watching --------------------------------------------------------------------------------------


def seen(path: Path, change, count: int) -> list[bytes | OSError]:
    """The first contents that are told while `change` does its work."""
    watcher, contents = Watcher(path, 10_000), []
    over = threading.Timer(10, watcher.stop)
    over.start()
    try:
        for content in watcher.contents():
            contents.append(content)
            if len(contents) == 1:
                threading.Thread(target=change, daemon=True).start()
            if len(contents) == count:
                return contents
    finally:
        over.cancel()
    return contents


def test_a_slow_save_is_not_read_by_halves(tmp_path):
    """Ten pieces, 8 ms apart: the whole is told, once."""
    path = tmp_path / "m.toml"
    path.write_text("before")

    def slowly() -> None:
        with path.open("w", buffering=1) as file:
            for k in range(10):
                file.write(f"line {k}\n")
                file.flush()
                time.sleep(0.008)

    whole = "".join(f"line {k}\n" for k in range(10)).encode()
    assert seen(path, slowly, 2) == [b"before", whole]


def test_a_file_that_is_emptied_first_is_not_read_empty(tmp_path):
    """A tenth of a second between emptying and writing: only what is written then is told."""
    path = tmp_path / "m.toml"
    path.write_text("before")

    def emptied() -> None:
        with path.open("w") as file:
            time.sleep(0.1)
            file.write("behind")

    assert seen(path, emptied, 2) == [b"before", b"behind"]


def test_a_save_by_renaming_is_seen(tmp_path):
    """As editors do it: another file takes the name."""
    path = tmp_path / "m.toml"
    path.write_text("before")

    def renamed() -> None:
        other = tmp_path / "other"
        other.write_text("behind")  # as long as before
        os.utime(other, ns=(path.stat().st_mtime_ns,) * 2)
        os.replace(other, path)

    assert seen(path, renamed, 2) == [b"before", b"behind"]


def test_a_file_that_is_gone_is_told_and_comes_back(tmp_path):
    """A moment without it is nothing; longer is an error."""
    path = tmp_path / "m.toml"
    path.write_text("before")

    def gone() -> None:
        path.unlink()
        time.sleep(1.0)
        path.write_text("again")

    before, error, again = seen(path, gone, 3)
    assert (before, again) == (b"before", b"again") and isinstance(error, FileNotFoundError)


# -- who is answered -------------------------------------------------------------------------------


@contextmanager
def served(path: Path, *, edits: bool = False) -> Iterator[LiveServer]:
    with LiveServer(path, LiveState({"file": path.name}), port=0, edits=edits) as server:
        thread = threading.Thread(target=server.serve_forever, args=(0.01,), daemon=True)
        thread.start()
        yield server
        server.shutdown()


def asked(server: LiveServer, path: str, method: str = "GET", body: object = None, **heads: str | None) -> tuple:
    """(status, heads, content)."""
    connection = http.client.HTTPConnection("127.0.0.1", server.server_port, timeout=10)
    sent = {"Host": f"127.0.0.1:{server.server_port}", "Content-Type": "application/json"}
    sent |= {name.replace("_", "-"): value for name, value in heads.items()}
    content = body if isinstance(body, bytes | None) else json.dumps(body).encode()
    connection.request(method, path.replace("TOKEN", server.token), content, {k: v for k, v in sent.items() if v})
    answer = connection.getresponse()
    return answer.status, answer.headers, answer.read()


@pytest.fixture
def file(tmp_path) -> Path:
    path = tmp_path / "pendulum.toml"
    path.write_text(PENDULUM)
    return path


STRANGERS = {
    "no token": ("/state", {}),
    "an empty token": ("/state?token=", {}),
    "another token": ("/state?token=abc", {}),
    "a token in another letter case": ("/state?token=token", {}),
    "a token that is no ASCII": ("/state?token=%C3%A9", {}),
    "a name that leads here": ("/state?token=TOKEN", {"Host": "attacker.example:80"}),
    "another port": ("/state?token=TOKEN", {"Host": "127.0.0.1:1"}),
    "another origin": ("/state?token=TOKEN", {"Origin": "http://attacker.example"}),
    "an origin of no address": ("/state?token=TOKEN", {"Origin": "null"}),
    "another page": ("/state?token=TOKEN", {"Sec_Fetch_Site": "cross-site"}),
    "another port of this machine": ("/state?token=TOKEN", {"Sec_Fetch_Site": "same-site"}),
}


def test_strangers_are_refused(file):
    """403 for each path and way, and nothing of the model in the answer."""
    with served(file, edits=True) as server:
        for who, (path, heads) in STRANGERS.items():
            for place in ("/state", "/", "/events", "/motion", "/model", "/examples", "/editor.js", "/nothing"):
                status, _, content = asked(server, path.replace("/state", place), **heads)
                assert status == 403 and b"theta" not in content, who
            posted = {"text": "x", "sha256": sha256(file.read_bytes()).hexdigest()}
            assert asked(server, path.replace("/state", "/model"), "POST", posted, **heads)[0] == 403, who
    assert file.read_text() == PENDULUM


def test_the_page_itself_is_answered(file):
    """The own origin, the name localhost, and who names no origin."""
    with served(file) as server:
        port = server.server_port
        for heads in (
            {},
            {"Origin": f"http://127.0.0.1:{port}", "Sec_Fetch_Site": "same-origin"},
            {"Host": f"localhost:{port}", "Origin": f"http://localhost:{port}"},
        ):
            status, answer, content = asked(server, "/state?token=TOKEN", **heads)
            assert status == 200 and json.loads(content)["file"] == "pendulum.toml"
            assert answer["Cache-Control"] == "no-store" and answer["X-Content-Type-Options"] == "nosniff"
        assert server.address == f"http://127.0.0.1:{port}/?token={server.token}" and len(server.token) >= 32


def test_a_page_may_ask_only_here_and_run_only_its_own_programs(file):
    """Content-Security-Policy of the page: nothing from elsewhere, no inline program but those with the nonce."""
    with served(file) as server:
        _, first, page = asked(server, "/?token=TOKEN")
        _, second, _ = asked(server, "/?token=TOKEN")
        policy = first["Content-Security-Policy"]
        assert "default-src 'none'" in policy and "connect-src 'self'" in policy and "http" not in policy
        assert "unsafe-inline" not in policy.replace("style-src-attr 'unsafe-inline'", "")
        assert policy != second["Content-Security-Policy"]
        nonce = policy.partition("'nonce-")[2].partition("'")[0]
        assert page.decode().count(f'nonce="{nonce}"') == page.decode().count("<script") + page.decode().count("<style")


def test_what_is_asked_changes_nothing(file):
    """GET of every path: the file has the same bytes and date; other methods are not known."""
    before = file.stat()
    with served(file, edits=True) as server:
        for place in ("/state", "/", "/motion", "/model", "/examples", "/examples?name=four_bar&x=1"):
            asked(server, f"{place}{'&' if '?' in place else '?'}token=TOKEN&text=x&sha256=y")
        for method in ("PUT", "DELETE", "PATCH", "OPTIONS"):
            assert asked(server, "/model?token=TOKEN", method, {"text": "x"})[0] == 501
    assert file.stat() == before


def test_a_file_is_written_only_where_editing_was_asked_for(file):
    """Without --edit 403; with it, the text as it is."""
    new = PENDULUM.replace("= 2", "= 3") + "# é\r\n"
    posted = {"text": new, "sha256": sha256(file.read_bytes()).hexdigest()}
    with served(file) as server:
        assert asked(server, "/model?token=TOKEN", "POST", posted)[0] == 403
        assert file.read_text() == PENDULUM
    with served(file, edits=True) as server:
        status, _, content = asked(server, "/model?token=TOKEN", "POST", posted)
        assert status == 200 and file.read_bytes() == new.encode()
        assert json.loads(content)["sha256"] == sha256(file.read_bytes()).hexdigest()
        _, _, read = asked(server, "/model?token=TOKEN")
        assert json.loads(read) == {"text": new, "sha256": sha256(new.encode()).hexdigest()}
    assert [each.name for each in file.parent.iterdir()] == [file.name]


def test_what_somebody_else_wrote_meanwhile_is_not_written_over(file):
    """409, with the digest of what is there; the file stays."""
    posted = {"text": "mine", "sha256": sha256(file.read_bytes()).hexdigest()}
    file.write_text("theirs")
    with served(file, edits=True) as server:
        status, _, content = asked(server, "/model?token=TOKEN", "POST", posted)
        assert status == 409 and json.loads(content)["sha256"] == sha256(b"theirs").hexdigest()
    assert file.read_text() == "theirs"


BAD = {
    "no JSON": (b"text", {}, 400),
    "a list": (b"[]", {}, 400),
    "no digest": (b'{"text": "x"}', {}, 400),
    "a number": (b'{"text": 1, "sha256": ""}', {}, 400),
    "a form": (b"text=x", {"Content_Type": "application/x-www-form-urlencoded"}, 415),
    "plain text, as a form of another page sends it": (
        b'{"text": "x", "sha256": ""}',
        {"Content_Type": "text/plain"},
        415,
    ),
    "over 1 MB": (b'{"text": "' + b"x" * 1_000_001 + b'", "sha256": ""}', {}, 400),
    "far over 1 MB": (b"x" * 3_000_000, {}, 413),
}


def test_what_is_posted_wrongly_is_refused(file):
    """By its kind; nothing is written."""
    with served(file, edits=True) as server:
        for what, (body, heads, wanted) in BAD.items():
            try:
                status = asked(server, "/model?token=TOKEN", "POST", body, **heads)[0]
            except ConnectionError:  # it is answered, and the rest of what is sent is not read
                status = 413
            assert status == wanted, what
    assert file.read_text() == PENDULUM


def test_what_may_be_typed_is_offered_and_nothing_written(file):
    """Kinds of joints inside the quotes of a kind; of a text that is no model nothing; what is no place is refused."""
    text = PENDULUM + '[bodies.new]\njoint = { kind = "'
    with served(file, edits=True) as server:
        status, _, content = asked(server, "/offers?token=TOKEN", "POST", {"text": text, "offset": len(text)})
        assert status == 200 and {"revolute", "prismatic"} <= {each["label"] for each in json.loads(content)["offers"]}
        for posted, wanted in (({"text": "x = 1", "offset": 99}, 200), ({"text": text, "offset": "1"}, 400)):
            status, _, content = asked(server, "/offers?token=TOKEN", "POST", posted)
            assert status == wanted and not json.loads(content).get("offers")
    assert file.read_text() == PENDULUM


def test_any_example_can_be_the_beginning(file):
    """Their names, and the text of one; a path is no name."""
    with served(file, edits=True) as server:
        names = json.loads(asked(server, "/examples?token=TOKEN")[2])["examples"]
        assert "double_pendulum" in names
        text = json.loads(asked(server, "/examples?token=TOKEN&name=double_pendulum")[2])["text"]
        assert text == (MODELS / "double_pendulum.toml").read_text("utf-8")
        for name in ("../pyproject", "..%2F..%2Fetc%2Fpasswd", "/etc/passwd", "double_pendulum.toml"):
            assert asked(server, f"/examples?token=TOKEN&name={name}")[0] == 404


def test_a_port_that_is_taken_is_refused(file):
    """The message names it."""
    with served(file) as server, pytest.raises(UsageError, match=f"port {server.server_port} cannot be used"):
        LiveServer(file, LiveState({}), port=server.server_port, edits=False)


def test_events_tell_all_and_then_what_changes(file):
    """A stream: the state, then one entry."""
    with served(file) as server:
        connection = http.client.HTTPConnection("127.0.0.1", server.server_port, timeout=10)
        connection.request("GET", f"/events?token={server.token}")
        stream = connection.getresponse()
        assert stream.getheader("Content-Type") == "text/event-stream"
        first = json.loads(stream.readline().removeprefix(b"data: "))
        assert first["file"] == "pendulum.toml" and stream.readline() == b"\n"
        server.state.hear({"revision": server.state.begin(), "problems": [], "good": True})
        told = {}
        while "revision" not in told:
            told |= json.loads(stream.readline().removeprefix(b"data: ") or b"{}")
            stream.readline()
        assert told["revision"] == 1
        connection.close()


def test_a_change_in_a_file_of_a_part_is_told(tmp_path):
    """The model's own file stays as it is, and is told once more: what it stands for is another model."""
    path, part = tmp_path / "m.toml", tmp_path / "leg.toml"
    part.write_text("one")
    text = 'eomgen = 1\n[parts.leg]\nfile = "leg.toml"\n'
    path.write_text(text)
    assert seen(path, lambda: part.write_text("another"), 2) == [text.encode()] * 2

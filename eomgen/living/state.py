"""State of a model's file, as its page shows it: a revision, its problems, and the parts that are there.

A broken file keeps the parts of the last good one.
"""

from __future__ import annotations

import threading
from collections.abc import Mapping
from typing import Any

NAMES = ("figure", "degrees_of_freedom", "equations", "answers", "motion", "reactions", "certificate")
"""Every part, in the order in which they are made: what one waits for first comes first."""

MISTAKE = "the process that works on the model ended: this is a mistake of eomgen, not of your model"


class LiveState:
    """Everything that a page asks for; what changes is told to those who wait for it.

    Args:
        always: entries that never change.
    """

    def __init__(self, always: Mapping[str, Any]) -> None:
        self._changed = threading.Condition()
        self._number = 0
        self._pages: dict[str, str] = {}
        self._made: dict[str, tuple[int, Any, str]] = {}  # part -> revision, value, why it has none
        self._told: dict[str, tuple[int, Any]] = {}  # entry -> number of its last change, value
        self._good = True
        self.revision = 0
        self._put(**always, revision=0, working=True, good=True, name="", problems=[], warnings=[], why={}, seconds={})
        self._put(**dict.fromkeys(NAMES))

    def begin(self) -> int:
        """Begins the next revision; returns its number, which is told with the first thing that is known of it."""
        with self._changed:
            self.revision += 1
            self._put(working=True)
            return self.revision

    def hear(self, message: Mapping[str, Any]) -> None:
        """Takes what a worker tells of the present revision; what it tells of others is out of date."""
        with self._changed:
            if message["revision"] != self.revision:
                return
            if self._told["revision"][1] != self.revision:
                self._put(revision=self.revision, seconds={})
            if message.get("died"):
                self._put(
                    working=False, problems=[{"where": "", "line": None, "what": MISTAKE, "fix": "save it again"}]
                )
            elif message.get("done"):
                self._put(working=False)
            elif "part" in message:
                self._take(message)
            else:
                self._good = message.get("good", self._good)
                own = {key: message[key] for key in ("problems", "warnings", "good", "name") if key in message}
                self._put(**own, **({} if self._good else {"warnings": []}))
                self._show()

    def refuse(self, problem: Mapping[str, Any]) -> None:
        """The file cannot be read: its problem, at a new revision."""
        self.begin()
        with self._changed:
            self._good = False
            self._put(revision=self.revision, working=False, good=False, problems=[problem])
            self._show()

    def page(self, digest: str) -> str | None:
        """A page of the motion."""
        with self._changed:
            return self._pages.get(digest)

    def now(self) -> dict[str, Any]:
        """All entries."""
        with self._changed:
            return {key: value for key, (_, value) in self._told.items()}

    def since(self, number: int, seconds: float) -> tuple[int, dict[str, Any]]:
        """(the number of the last change, the entries that changed after the one given), awaited for so long."""
        with self._changed:
            self._changed.wait_for(lambda: self._number > number, seconds)
            return self._number, {key: value for key, (when, value) in self._told.items() if when > number}

    def _take(self, message: Mapping[str, Any]) -> None:
        """Takes one part of the present revision; where a figure cannot be drawn, the last one stays."""
        part, value, why = message["part"], message["value"], message["why"]
        if part == "motion" and value is not None and value["page"] is not None:
            self._pages[value["digest"]] = value["page"]
            while len(self._pages) > 3:
                self._pages.pop(next(iter(self._pages)))
            value = {key: value[key] for key in ("digest", "time", "remark")}
        if value is None and part == "figure" and part in self._made:
            value = self._made[part][1]
        self._made[part] = self.revision, value, why
        self._put(seconds={**self._told["seconds"][1], part: message["seconds"]})
        self._show()

    def _show(self) -> None:
        """Entries of the parts: of the present revision, and of the last one where the file is broken."""
        shown = {part: made for part, made in self._made.items() if made[0] == self.revision or not self._good}
        whys = {part: why for part, (_, _, why) in shown.items() if why}
        self._put(why=whys, **{part: shown[part][1] if part in shown else None for part in NAMES})

    def _put(self, **entries: Any) -> None:
        """Takes entries; those that are as before have not changed."""
        with self._changed:
            new = {key: x for key, x in entries.items() if key not in self._told or self._told[key][1] != x}
            if new:
                self._number += 1
                self._told |= {key: (self._number, value) for key, value in new.items()}
                self._changed.notify_all()

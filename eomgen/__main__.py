"""`python -m eomgen`, or `eomgen`: the command line, in a process of its own."""

from __future__ import annotations

import atexit
import os
import sys
import threading
from contextlib import suppress
from typing import Any, NoReturn

from eomgen.cli import main
from eomgen.symbolic.numeric.work import seldom_from_now_on


def run() -> NoReturn:
    """The process is gone with its last word: graphs are not taken apart node by node, which takes a sixth of its time.

    Nor are they looked through for cycles before.

    What others asked for at the end of the process is done first. Where another thread is at work, or a profiler looks
    on, all is as usual.
    """
    seldom_from_now_on()
    code: Any = 0
    try:
        main()
    except SystemExit as reported:
        code = reported.code
    if threading.active_count() > 1 or _is_watched() or not isinstance(code, int):
        sys.exit(code)
    atexit._run_exitfuncs()
    for stream in (sys.stdout, sys.stderr):
        with suppress(OSError, ValueError, AttributeError):
            stream.flush()
    os._exit(code)


def _is_watched() -> bool:
    """Whether a profiler, a debugger or a measure of coverage has its own last word."""
    monitoring = getattr(sys, "monitoring", None)  # of Python 3.12 on, six tools
    tools = monitoring is not None and any(map(monitoring.get_tool, range(6)))
    return bool(sys.getprofile() or sys.gettrace() or tools)


if __name__ == "__main__":
    run()

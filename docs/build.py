"""The site as files that need no network: `python docs/build.py [PLACE]`, into docs/_build/html by itself.

EOMGEN_GALLERY=quick builds the gallery of a few models only. A warning is an error.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).parent


def build(place: Path) -> int:
    """The exit code of Sphinx."""
    command = [sys.executable, "-m", "sphinx", "-W", "--keep-going", "-q", "-b", "html", str(HERE), str(place)]
    return subprocess.run(command, check=False).returncode


if __name__ == "__main__":
    where = Path(sys.argv[1]) if len(sys.argv) > 1 else HERE / "_build" / "html"
    code = build(where)
    print(f"{where / 'index.html'}" if code == 0 else "the site was not built", file=sys.stderr)
    sys.exit(code)

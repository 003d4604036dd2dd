"""Runs: what many motions of one model left, as arrays, a DataFrame or a Dataset."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import field
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.errors import UsageError
from eomgen.proof.check import Certificate, checked
from eomgen.records import dataclass
from eomgen.simulation.result import NO_EQUATIONS


@dataclass(frozen=True, eq=False, repr=False)
class Runs:
    """Many motions of one model.

    Args:
        t: the instants, k [s].
        x: states (q, u), runs x k x states; nan all along in a run that failed.
        names: of the coordinates and speeds.
        status: "finished", or why a run failed; message: the same as a sentence.
        steps: taken by each.
        given: the values of each run, by name, of those that are not the same in all.
        proof: -> the certificate of the equations; None out of a pickle.
        drifts: (t, x) -> of each run how far its energy went; None where it need not stay.
    """

    t: np.ndarray
    x: np.ndarray
    names: tuple[str, ...]
    status: np.ndarray
    message: np.ndarray
    steps: np.ndarray
    given: Mapping[str, np.ndarray]
    proof: Callable[[], Certificate] | None = field(repr=False)
    drifts: Callable[[np.ndarray, np.ndarray], np.ndarray] | None = field(default=None, repr=False)

    def __getstate__(self) -> dict[str, Any]:
        """All its numbers, the drift among them; its equations do not go into a pickle."""
        own = {name: self.__dict__[name] for name in self.__dataclass_fields__}
        return own | {"drift": self.drift, "drifts": None, "proof": None}

    def __len__(self) -> int:
        return len(self.x)

    def __getitem__(self, name: str) -> np.ndarray:
        """A coordinate or speed, runs x instants."""
        if name not in self.names:
            raise KeyError(f"no column '{name}'; there are {', '.join(self.names)}")
        return np.asarray(self.x[:, :, self.names.index(name)])

    @cached_property
    def drift(self) -> np.ndarray | None:
        """Of each run the largest |E - E(0)| over the energy that moves; None where it need not stay."""
        return None if self.drifts is None else self.drifts(self.t, self.x)

    def certify(self) -> Certificate:
        """The proof of the equations that all runs share.

        Raises:
            UsageError: they come out of a pickle.
        """
        if self.proof is None:
            raise UsageError(NO_EQUATIONS, mend="take eomgen.simulate_many(model), in the process that asks")
        finished = self.status == "finished"
        whole = np.isfinite(self.x).all(axis=(1, 2))
        lost = [str(k) for k in np.flatnonzero(finished != whole)]
        wrong = f"not of run {', '.join(lost[:3])}" if lost else ""
        more = [checked("runs that are finished have numbers at all instants", wrong, "every run")]
        return self.proof() + more

    def to_pandas(self) -> Any:
        """All runs as one DataFrame over (run, t) (needs pandas)."""
        import pandas

        index = pandas.MultiIndex.from_product([range(len(self)), self.t], names=["run", "t"])
        return pandas.DataFrame(self.x.reshape(-1, len(self.names)), index=index, columns=list(self.names))

    def to_xarray(self) -> Any:
        """A Dataset over (run, time) (needs xarray)."""
        import xarray

        columns = {name: (("run", "time"), self[name]) for name in self.names}
        of_runs = {"status": self.status, "message": self.message, "steps": self.steps, **self.given}
        told = {name: ("run", np.asarray(values)) for name, values in of_runs.items()}
        return xarray.Dataset({**columns, **told}, coords={"run": np.arange(len(self)), "time": self.t})

    def __repr__(self) -> str:
        failed = int(np.sum(self.status != "finished"))
        return f"<{len(self)} runs of {', '.join(self.names)}: {len(self.t)} instants, {failed} failed>"

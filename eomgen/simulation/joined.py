"""Stretches -> Trajectory: all phases in one table."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from eomgen.simulation.contacts import changed
from eomgen.simulation.course import Course
from eomgen.simulation.integrate import drift_of
from eomgen.simulation.stretch import Stretch
from eomgen.simulation.trajectory import Phase, Trajectory


def joined(course: Course, stretches: Sequence[Stretch], samples: int | Sequence[float] | None) -> Trajectory:
    """The motion through all phases; a coordinate that a phase does not have is 0 in it.

    Args:
        samples: as they were asked for: instants, a number of them, or None.
    """
    coordinates, speeds = _union(stretches)
    columns = [stretch.stage.columns(stretch.run.t, stretch.run.x) for stretch in stretches]
    tables = [
        np.column_stack([found.get(name, np.zeros(len(stretch.run.t))) for name in (*coordinates, *speeds)])
        for stretch, found in zip(stretches, columns, strict=True)
    ]  # fmt: skip
    energies = [stretch.stage.energies(stretch.run.t, stretch.run.x) for stretch in stretches]
    ends = np.cumsum([0, *(len(stretch.run.t) for stretch in stretches)])
    full = Trajectory(
        t=np.concatenate([stretch.run.t for stretch in stretches]),
        x=np.concatenate(tables),
        coordinates=coordinates,
        speeds=speeds,
        energy=np.concatenate([T + V for T, V in energies]),
        drift=_drift(stretches, energies),
        gap=_gap(stretches),
        phases=tuple(Phase(s.here.t, s.run.end, told(course, s), (int(first), int(last)), s.stage)
                     for s, first, last in zip(stretches, ends[:-1], ends[1:], strict=True)),
        status=stretches[-1].run.status,
        message=stretches[-1].run.message,
        steps=sum(stretch.run.steps for stretch in stretches),
        evaluations=sum(stretch.run.evaluations for stretch in stretches),
    )  # fmt: skip
    return full if samples is None or isinstance(samples, (int, np.integer)) else _at(full, np.asarray(samples))


def _union(stretches: Sequence[Stretch]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Coordinates and speeds of all phases, each in the order in which it comes."""
    coordinates = dict.fromkeys(name for stretch in stretches for name in stretch.stage.coordinates)
    speeds = dict.fromkeys(name for stretch in stretches for name in stretch.stage.speeds)
    return tuple(coordinates), tuple(speeds)


def _drift(stretches: Sequence[Stretch], energies: Sequence[np.ndarray]) -> float | None:
    """The largest of the phases in which energy should stay."""
    kept = [drift_of(T, V) for s, (T, V) in zip(stretches, energies, strict=True) if s.stage.conservative]
    return max(kept, default=None)


def _gap(stretches: Sequence[Stretch]) -> float | None:
    found = [s.stage.gaps(s.run.t, s.run.x) for s in stretches if s.stage.system.ties.closing]
    return max(found, default=None)


def _at(full: Trajectory, instants: np.ndarray) -> Trajectory:
    """The rows at the instants asked for, and where the run ended early also its last."""
    kept = np.isin(full.t, instants) | (np.arange(len(full.t)) == len(full.t) - 1 if not full.ok else False)
    before = np.concatenate([[0], np.cumsum(kept)])
    phases = tuple(replace(p, rows=(int(before[p.rows[0]]), int(before[p.rows[1]]))) for p in full.phases)
    energy = None if full.energy is None else full.energy[kept]
    return replace(full, t=full.t[kept], x=full.x[kept], energy=energy, phases=phases)


def told(course: Course, stretch: Stretch) -> str:
    """What ended a phase, and when."""
    after = stretch.after
    if after is None:
        return stretch.run.message
    when = f"at t = {after.t:.6g} s"
    if after.failure:
        return f"{after.failure} {when}"
    phrases = changed(course.model, stretch.here.configuration, after.configuration)
    return f"{', '.join(phrases) or 'the contacts change and return'} {when}" + after.impact * ", without rebound"

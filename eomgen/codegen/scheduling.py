"""Statements in the order of their making -> the same in one in which fewer values leave the registers.

A long straight program has far more values that wait than a machine has registers: most are stored and loaded again.
Here a statement comes soon after the newest of its arguments; before them comes what calls functions, with what these
need, for no value stays in a register across a call. How much the place of the arguments weighs beside the order of
making is tried, and how often values go to memory and back is counted: of all orders the best is taken, that of making
among them. What is computed is the same, bit for bit.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence, Set
from heapq import heapify, heappop, heappush

from eomgen.symbolic.expression.graph import Node

REGISTERS = 14  # of sixteen, two for what is under way
WEIGHTS = (0.0, 0.25, 0.5)  # of the order of making
INSTRUCTIONS = frozenset("symbol add sub mul div sqrt abs min max less less_equal select".split())  # others are calls

Needs = Mapping[Node, Set[Node]]


def scheduled(needs: Needs, later: Set[Node]) -> Sequence[Node]:
    """The statements in the order that takes the fewest loads and stores.

    Args:
        needs: of each statement what it reads, other statements and symbols, in the order of their making.
        later: what is read after them.
    """
    symbols = {a for needed in needs.values() for a in needed if a.op == "symbol"}
    made = {x: set[Node]() for x in sorted(symbols, key=lambda x: x.index)} | {
        x: {a for a in needed if a in needs or a in symbols} for x, needed in needs.items()
    }
    orders = [list(made), *(_close_together(made, of, weight) for of in (_mean, max) for weight in WEIGHTS)]
    best = min(orders, key=lambda order: traffic(order, made, later))
    return [x for x in best if x in needs]


def _users(needs: Needs) -> dict[Node, list[Node]]:
    """Of each statement those that read it."""
    found: dict[Node, list[Node]] = {x: [] for x in needs}
    for x, needed in needs.items():
        for a in needed:
            found[a].append(x)
    return found


def _mean(places: Sequence[int]) -> float:
    return sum(places) / len(places)


def _close_together(needs: Needs, of: Callable[[Sequence[int]], float], weight: float) -> list[Node]:
    """What calls take, then each as soon as its arguments are there, those of the newest first.

    Args:
        of: the places of the arguments, how new they are.
    """
    rank, early = {x: k for k, x in enumerate(needs)}, set[Node]()
    for x in reversed(list(needs)):
        if x in early or x.op not in INSTRUCTIONS:
            early |= {x, *needs[x]}
    users, place = _users(needs), dict[Node, int]()
    left = {x: len(needed) for x, needed in needs.items()}

    def lateness(x: Node) -> tuple[bool, float, int]:
        if x in early:
            return False, 0.0, rank[x]
        newest = of([place[a] + 1 for a in needs[x]] or [0])
        return True, weight * rank[x] - (1 - weight) * newest, rank[x]

    ready = [(*lateness(x), x) for x, count in left.items() if not count]
    heapify(ready)
    while ready:
        x = heappop(ready)[-1]
        place[x] = len(place)
        for user in users[x]:
            left[user] -= 1
            if not left[user]:
                heappush(ready, (*lateness(user), user))
    return list(place)


def traffic(order: Sequence[Node], needs: Needs, later: Set[Node]) -> int:
    """How many loads and stores it takes, where that value leaves the registers which is used last (Belady)."""
    place = {x: k for k, x in enumerate(order)}
    again = {x: sorted((place[u] for u in users), reverse=True) for x, users in _users(needs).items()}
    for x in later & again.keys():
        again[x].insert(0, len(order))
    kept, stored, moves = set[Node](), {x for x in order if x.op == "symbol"}, 0
    for x in order:
        moves += len(needs[x] - kept)
        for a in needs[x]:
            again[a].pop()
        kept = {a for a in kept | needs[x] if again[a]}
        waiting = sorted(kept, key=lambda a: (again[a][-1], a.index))
        lost = set(waiting if x.op not in INSTRUCTIONS else waiting[REGISTERS:])
        moves += len(lost - stored)
        stored |= lost
        kept -= lost
        if again[x]:
            kept.add(x)
    return moves

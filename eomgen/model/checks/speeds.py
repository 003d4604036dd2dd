"""Speeds and quaternions: what turns by a quaternion is free, and every speed has one meaning and one start."""

from collections.abc import Iterator

from eomgen.model.begun_speeds import begun_speeds
from eomgen.model.catalog import Catalog
from eomgen.model.findings import Finding
from eomgen.model.positions import DocumentPath


def speeds(catalog: Catalog) -> Iterator[Finding]:
    """Quaternions of coordinates that are not free or belong to two bodies; speeds that are named twice."""
    yield from _quaternions(catalog)
    yield from _starts(catalog)


def _quaternions(catalog: Catalog) -> Iterator[Finding]:
    taken: dict[str, str] = {}
    for body, part in catalog.table("bodies").items():
        joint = None if part is None else part.joint
        if joint is None or getattr(joint, "orientation", None) != "quaternion":
            continue
        path: DocumentPath = ("bodies", body, "joint")
        for key, names in (("quaternion", joint.quaternion or ()), ("omega", joint.omega or ())):
            for k, name in enumerate(names):
                if name in taken:
                    whose = f"body '{taken[name]}'" if taken[name] != body else "this body"
                    what = f"'{name}' stands twice: it turns {whose} already"
                    yield Finding((*path, key, k), what, "each body needs names of its own")
                taken.setdefault(name, body)
        yield from _free(catalog, body, joint.quaternion or ())
        for k, name in enumerate(joint.omega or ()):
            speed = catalog.table("speeds").get(name)
            if speed is not None and speed.rate is not None:
                what = f"speed '{name}' has a 'rate' and is the angular velocity of body '{body}' too"
                start = "" if speed.rate.names else f"; a start is {name} = {{ start = {speed.rate.text} }}"
                yield Finding((*path, "omega", k), what, f"leave out the 'rate': `omega` says what it is{start}")


def _free(catalog: Catalog, body: str, names: tuple[str, ...]) -> Iterator[Finding]:
    for name in names:
        part = catalog.table("coordinates").get(name)
        if part is not None and (part.driven or part.dependent):
            how = "driven" if part.driven else "dependent"
            what = f"'{name}' is {how}, but it is part of the quaternion of body '{body}', whose four are free together"
            yield Finding(("coordinates", name), what, "describe the orientation by angles", key=True)


def _starts(catalog: Catalog) -> Iterator[Finding]:
    """A start speed of a coordinate whose rate is combined in speeds that have a start of their own."""
    told = set[str]().union(*begun_speeds(catalog.table("speeds")).values())
    for name, part in catalog.table("coordinates").items():
        if part is not None and part.speed is not None and f"{name}'" in told and not part.driven:
            what = f"coordinate '{name}' has a 'speed' at the start, and the speeds of its rate have a 'start' too"
            yield Finding(("coordinates", name, "speed"), what, "keep `start` of the speeds", key=True)

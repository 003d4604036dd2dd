"""Random trees of bodies under random forces, with constraints that close: the text of a model."""

from __future__ import annotations

from random import Random


def number(rng: Random) -> str:
    return f"{rng.randint(1, 30) / 10}"


def axis(rng: Random) -> list[int]:
    return rng.choice([[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 2, 2], [0, 3, 4], [1, -1, 0]])


class Writer:
    """Writes the text of a random model, body by body."""

    def __init__(self, space: str, rng: Random) -> None:
        self.space, self.rng = space, rng
        self.size = 2 if space == "plane" else 3
        self.coordinates: list[str] = []
        self.bodies: list[str] = []
        self.forces: list[str] = []
        self.names: list[str] = []
        self.constraints: list[str] = []

    def vector(self) -> str:
        return "[" + ", ".join(f'"{self.rng.choice(["l", "h", "-l", "0", "2*h"])}"' for _ in range(self.size)) + "]"

    def coordinate(self, driven: bool = False) -> str:
        name = f"q{len(self.coordinates) + 1}"
        laws = ['{ motion = "A*sin(w*t)" }', '{ rate = "w*t" }', '{ acceleration = "A*cos(w*t)", speed = "w" }']
        self.coordinates.append(f"{name} = {self.rng.choice(laws) if driven else number(self.rng)}")
        return name

    def seat(self, moving: bool = False) -> str:
        if not self.names or self.rng.random() < 0.2:
            return f"at = {self.vector()}"
        parent = self.rng.choice(self.names)
        if moving and self.coordinates and self.rng.random() < 0.3:
            q = self.rng.choice(self.coordinates).split(" ")[0]
            return f'on = "{parent}", at = {[f"l*cos({q})", "A*t", q][: self.size]}'
        return f'on = "{parent}.P"' if self.rng.random() < 0.5 else f'on = "{parent}", at = {self.vector()}'

    def joint(self) -> str:
        rng = self.rng
        kinds = ["revolute", "revolute", "prismatic", "planar", "fixed", "placed"]
        kind = rng.choice(kinds + (["free"] if self.space == "plane" else []))
        turned = f', axis = {axis(rng)}, turned = {{ axis = {axis(rng)}, angle = "pi/{rng.randint(2, 5)}" }}'
        flat = rng.choice(["", ', turned = { angle = "pi/5" }'])
        spatial = turned if self.space == "space" else flat
        if kind == "revolute":
            angle = self.coordinate(rng.random() < 0.2)
            spring = ', stiffness = "k", rest = 0.3, damping = "c"'
            drive = rng.choice(["", f', torque = "tau - c*{angle}\'"', spring, ', armature = "m/10"'])
            return f'{{ kind = "revolute", {self.seat()}, angle = "{angle}", point = "P"{spatial}{drive} }}'
        if kind == "prismatic":
            along = axis(rng) if self.space == "space" else [3, 4]
            turn = turned.replace(turned.split(", turned")[0], "") if self.space == "space" else flat
            where = f'{self.seat(moving=True)}, displacement = "{self.coordinate()}"'
            return f'{{ kind = "prismatic", {where}, axis = {along}{turn} }}'
        if kind in ("planar", "free"):
            x, y, angle = (self.coordinate() for _ in range(3))
            return f'{{ kind = "{kind}", {self.seat(moving=True)}, x = "{x}", y = "{y}", angle = "{angle}" }}'
        if kind == "fixed":
            return f'{{ kind = "fixed", {self.seat()}, angle = 0.3 }}'
        q = self.coordinate()
        at = [f"l*cos({q})", f"h*{q}^2 + A*t", f"l*sin(2*{q})"][: self.size]
        on = f'on = "{rng.choice(self.names)}", ' if self.names else ""
        return f'{{ kind = "placed", {on}at = {at}, angle = "2*{q} - w*t" }}'

    def body(self) -> None:
        rng, name = self.rng, f"B{len(self.names) + 1}"
        mass = rng.choice(['mass = "m"', 'mass = "2*m"'])
        inertia = 'inertia = "I"' if self.space == "plane" else 'inertia = ["I", "2*I", "2*I", "I/9", "-I/7", "I/11"]'
        joint = self.joint()
        slide = self.vector()
        if 'point = "P"' in joint and "torque" not in joint and "stiffness" not in joint and rng.random() < 0.5:
            slide = str([f"l*{self.coordinate()}", "h", "0"][: self.size])  # the hinge slides along its own body
            joint = joint.replace('point = "P"', 'point = "S"')
        points = f"P = {self.vector()}, S = {slide}, Z = {[0.37, 0.11, 0.05][: self.size]}"
        self.bodies.append(
            f"[bodies.{name}]\n{mass}\ncenter = {self.vector()}\n{inertia}\npoints = {{ {points} }}\njoint = {joint}"
        )
        self.names.append(name)

    def force(self, k: int) -> None:
        rng = self.rng
        body, other = rng.choice(self.names), rng.choice(self.names)
        q = rng.choice([line.split(" ")[0] for line in self.coordinates])
        point = f'"{body}.P"'
        two = f'points = ["G", {point}]' if body == other else f'points = ["{other}.Z", {point}]'
        axes = rng.choice(["ground", body])
        components = ", ".join(f'"{e}"' for e in ["k*l*sin(w*t)", f"-c*{q}'", "k*h"][: self.size])
        couple = '"k*l*l"' if self.space == "plane" else '["k*l*l", "c*l", "k"]'
        kinds = [
            f'kind = "force", point = {point}, force = [{components}], axes = "{axes}"',
            f'kind = "couple", body = "{body}", couple = {couple}, axes = "{axes}"',
            f'kind = "spring", {two}, stiffness = "k", length = "l"',
            f'kind = "damper", {two}, damping = "c"',
            f'kind = "between", {two}, pull = "k*l/r^2 + c*r\'"',
            f'kind = "potential", energy = "k*{q}^4/4 + k*l*cos({q})"',
            f'kind = "generalized", coordinate = "{q}", value = "-c*{q}\'^3 + tau"',
        ]
        if self.space == "plane":
            kinds += [
                f'kind = "torsion_spring", body = "{body}", stiffness = "k", rest = 0.1',
                f'kind = "torsion_damper", body = "{body}", damping = "c"',
                f'kind = "spring", {two}, stiffness = "k", length = "l", along = [3, 4]',
            ]
        self.forces.append(f"f{k} = {{ {rng.choice(kinds)} }}")

    def constraint(self, k: int) -> None:
        """A constraint that closes at the start: a support where the body stands, or an equation."""
        rng = self.rng
        body = rng.choice(self.names)
        free = dict(line.split(" = ") for line in self.coordinates if "{" not in line)
        q, r = rng.choice(list(free)), rng.choice(list(free))
        normal = '[1, "-2"]' if self.space == "plane" else '[2, 1, "-2"]'
        kinds = [
            f'kind = "support", point = "{body}.Z", normal = {normal}',
            f'kind = "equation", gap = "{q} - {free[q]} + l*sin({r} - {free[r]}) - A*t"',
            f'kind = "equation", rate = "cos({q})*{q}\' + l*{r}\' - A*t"',
        ]
        self.constraints.append(f"constraint{k} = {{ {rng.choice(kinds)} }}")

    def text(self) -> str:
        gravity = ", ".join(['"0"', '"-g"', '"g/5"'][: self.size])
        return "\n".join(
            [
                f'eomgen = 1\nname = "random"\nspace = "{self.space}"',
                "[parameters]",
                *(f"{p} = {number(self.rng)}" for p in ("m", "I", "l", "h", "g", "k", "c", "A", "w")),
                "[coordinates]",
                *self.coordinates,
                '[inputs]\ntau = "A*sin(t)"',
                "[points]",
                f"G = {self.vector()}",
                *self.bodies,
                "[constraints]",
                *self.constraints,
                "[forces]",
                f'weight = {{ kind = "gravity", acceleration = [{gravity}] }}',
                *self.forces,
            ]
        )


def free_coordinates(writer: Writer) -> int:
    return sum("{" not in line for line in writer.coordinates)


def random_model(space: str, seed: int, constraints: int = 0) -> str:
    rng = Random(seed)
    writer = Writer(space, rng)
    while len(writer.names) < 4 or free_coordinates(writer) < 1 + 4 * constraints:
        writer.body()
    for k in range(constraints):
        writer.constraint(k)
    for k in range(3):
        writer.force(k)
    if "tau" not in "".join(writer.bodies + writer.forces):
        q = writer.coordinates[0].split(" ")[0]
        writer.forces.append(f'last = {{ kind = "generalized", coordinate = "{q}", value = "tau" }}')
    return writer.text()

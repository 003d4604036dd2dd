"""Whether a body can have an inertia: the triangle inequality, in any axes."""

from eomgen.symbolic.numeric.tolerances import SOLVED


def possible(moments: list[float], size: float = 0.0) -> bool:
    """J = tr(I)/2 - I has no negative eigenvalue (its principal minors are not negative).

    Args:
        moments: xx, yy, zz and then, where there are any, xy, yz, zx.
        size: of what they were added up from, where that is larger than they are.
    """
    size = max(size, *map(abs, moments)) or 1.0
    xx, yy, zz, xy, yz, zx = (x / size for x in (*moments, 0.0, 0.0, 0.0)[:6])
    half = (xx + yy + zz) / 2
    a, b, c = half - xx, half - yy, half - zz
    determinant = a * (b * c - yz * yz) - xy * (xy * c + yz * zx) - zx * (xy * yz + b * zx)
    second = (a * b - xy * xy, b * c - yz * yz, c * a - zx * zx)
    return min(a, b, c, *second, determinant) >= -SOLVED

"""A bearing under load as a drawing: its load zone, its balls, and the path of a point on one of them.

``bearing, load, clearance -> shift of the inner ring -> force on a ball at each angle``, between rings that stay round. The load points
down and is the zero of all angles, which count counter-clockwise as those of faults.
"""

from collections.abc import Mapping
from numbers import Real
from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from scipy.optimize import brentq

from features.signal.rows import FloatArray
from gen.physics.bearing import Bearing, FaultOrders, orders
from gen.physics.bearing_text import bearing_of_label
from gen.physics.hertz import contact_exponent, load_deflection_factor
from gen.support.units import to_si
from raceway.reports.pictures import BLUE, FAINT, INK, STYLE, VERMILION, Drawing

RING, HIGHEST = 0.45, 1.0  # thickness of a ring, and height of the load zone, in diameters of a ball


@rc_context(STYLE)
def plot_bearing(bearing: str | Mapping[str, Any], load_n: float = 500.0, clearance_um: float = 0.0) -> Figure:
    """Draw a bearing with its load zone, and the path of a point on a ball while the cage turns once.

    Its angles count from the load, as those of faults on the outer race in a recipe.

    A notebook shows the figure, and ``figure.savefig("bearing.png")`` writes it; it is none of pyplot, so ``plt.savefig`` writes another.

    Parameters
    ----------
    bearing
        Designation or dimensions, as for ``gen.bearing_orders``.
    load_n
        Radial load [N], which points down.
    clearance_um
        Diametral clearance in operation [um]; negative: preload.

    Raises
    ------
    ValueError
        If there is no such bearing, its dimensions are not known, the load is not a positive number, or the clearance not finite.
    """
    drawn = bearing_of_label(bearing)
    if not (isinstance(load_n, Real) and 0 < load_n < np.inf):
        raise ValueError(f"load_n: {load_n} is no positive number; give the radial load in N.")
    if not (isinstance(clearance_um, Real) and np.isfinite(clearance_um)):
        raise ValueError(f"clearance_um: {clearance_um} is no finite number; give the diametral clearance in um.")
    if not np.isfinite(drawn.pitch_diameter):
        raise ValueError(f"bearing: of {bearing} only the orders are known; give dimensions.")
    ratios, balls = orders(drawn), 2 * np.pi * np.arange(drawn.n_balls) / drawn.n_balls
    around = np.linspace(-np.pi, np.pi, 721)
    forces, zone = (forces_at(angles, drawn, load_n, to_si(clearance_um, "um")) for angles in (balls, around))
    size, middle = drawn.ball_diameter, drawn.pitch_diameter / 2
    figure = Drawing(figsize=(6.2, 6.4), layout="constrained")
    axes = figure.subplots()
    # rings, from the outside in
    edges = (drawn.outer_radius + RING * size, drawn.outer_radius, drawn.inner_radius, drawn.inner_radius - RING * size)
    for edge, fill in zip(edges, ("0.88", "white", "0.88", "white"), strict=True):
        axes.add_patch(Circle((0, 0), edge, facecolor=fill, edgecolor=INK, linewidth=0.8))
    # the load zone stands on the outer ring
    axes.fill(
        *_place(around, edges[0] + HIGHEST * size * zone / zone.max()), color=BLUE, alpha=0.3, zorder=0.5, linewidth=0
    )
    for angle, force in zip(balls, forces, strict=True):
        loaded = force > 0
        axes.add_patch(
            Circle(_place(angle, middle), size / 2, facecolor=BLUE if loaded else "white", alpha=0.6, edgecolor=INK)
        )
        text = f"{force:,.0f} N" if loaded else ""
        axes.annotate(text, _place(angle, middle), color=INK, fontsize=8, ha="center", va="center")
    axes.plot(*path_of_point(drawn, ratios), color=VERMILION, linewidth=0.9)
    for degrees in (0, 90, 180, 270):
        place = _place(np.radians(degrees), edges[0] + 1.3 * size)
        axes.annotate(f"{degrees}°", place, color=FAINT, fontsize=8, ha="center", va="center")
    reach = edges[0] + 1.6 * size
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal")
    axes.axis("off")
    wide = np.degrees(np.ptp(around[zone > 0]))
    name = f"{drawn.n_balls} {drawn.rolling_element}s" if drawn.designation == "own" else drawn.designation
    title = f"{name}, {load_n:,.0f} N, clearance {clearance_um:g} um: load zone of {wide:.0f}°"
    figure.suptitle(title, x=0.01, ha="left", fontsize=11, fontweight="bold")
    element = drawn.rolling_element
    axes.set_title(
        f"Per turn of the shaft: cage {ratios.ftf:.3f} turns, {element} {ratios.bsf:.3f} turns. A point on a {element} (orange)\n"
        f"meets the races {2 * ratios.bsf:.2f} times, one on the outer race {ratios.bpfo:.2f} {element}s, "
        f"one on the inner {ratios.bpfi:.2f}."
    )
    return figure


def forces_at(angles: FloatArray, bearing: Bearing, load: float, clearance: float) -> FloatArray:
    """Static force of a ball at each angle from the load [N], shape (angle,), when a ball stands at angle 0.

    The rings stay round and the inner one shifts towards the load until the forces on the balls add up to it; ``load`` in N, the diametral
    ``clearance`` in m.
    """
    factor, exponent = load_deflection_factor(bearing), contact_exponent(bearing)

    def force(shift: float, at: FloatArray) -> FloatArray:
        squeeze = np.maximum(shift * np.cos(at) * np.cos(bearing.contact_angle) - clearance / 2, 0.0)
        return factor * squeeze**exponent * np.cos(bearing.contact_angle)

    balls = 2 * np.pi * np.arange(bearing.n_balls) / bearing.n_balls
    # at this shift the one ball in the direction of the load carries more than all of it
    most = (2 * load / factor) ** (1 / exponent) + abs(clearance)
    highest = most / np.cos(bearing.contact_angle) ** 3
    # the tolerance is far below the shift of a roller under 1 N, some nanometres
    shift: Any = brentq(lambda tried: float(force(tried, balls) @ np.cos(balls)) - load, 0.0, highest, xtol=1e-18)
    return force(shift, angles)


def path_of_point(bearing: Bearing, ratios: FaultOrders) -> tuple[FloatArray, FloatArray]:
    """Across and upwards [m], shape (time,): the path of a point on a ball while the cage turns once.

    The ball moves with the cage and spins against it, so that the point stands still where it meets the outer race.
    """
    turns = np.linspace(0, 1 / ratios.ftf, 2000)
    cage, spin = 2 * np.pi * ratios.ftf * turns, 2 * np.pi * ratios.bsf * turns
    middle, point = _place(cage, bearing.pitch_diameter / 2), _place(cage - spin, bearing.ball_diameter / 2)
    return middle[0] + point[0], middle[1] + point[1]


def _place(angle: Any, radius: Any) -> tuple[Any, Any]:
    """Across and upwards of a place at an angle from the load, which points down."""
    return radius * np.sin(angle), -radius * np.cos(angle)

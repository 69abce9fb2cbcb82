"""Figures 1 and 2 of the seed paper, drawn anew: the model with its springs and dampers, and the cracked bearing.

Lengths are in millimetres. Figure 2 is to scale; in figure 1 the outer ring is drawn thick, because it stands for the housing too.
Shaft and housing are points in the equations of motion.
"""

import math
from collections.abc import Callable

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Annulus, Circle, Polygon

from gen.physics.catalogue import CATALOGUE
from gen.support.units import from_si
from raceway.reports.pictures import BLUE, FAINT, INK, STYLE, VERMILION
from studies.ophel2025.paper import CRACK, SHAFT_MASS, FloatArray, Preset

Point = tuple[float, float]

BEARING = CATALOGUE["6205-paper"]
BALL, PITCH = from_si(BEARING.ball_diameter, "mm"), from_si(BEARING.pitch_diameter, "mm")  # mm
INNER, OUTER = (PITCH - BALL) / 2, (PITCH + BALL) / 2  # mm, radii of the raceways
BORE, OUTSIDE = 12.5, 26.0  # mm, radii of the 6205
POSITION = math.degrees(CRACK.angle)  # degrees from x, at the start
HALF = math.degrees(CRACK.width / 2) / (1e-3 * INNER)  # degrees
DEPTH = from_si(CRACK.depth, "mm")  # mm
SHAFT, HOUSING, STEEL = "#dbe6f0", "#ece8df", "#ffffff"


@rc_context(STYLE)
def draw_model(preset: Preset) -> Figure:
    """Coupled shaft and bearing: two bodies, the contacts of the balls, springs and dampers between them and to the ground."""
    figure = Figure(figsize=(7.8, 6.2), layout="constrained")
    figure.suptitle("Figure 1. Model of the coupled shaft and bearing")
    axes = _canvas(figure.subplots(), (-60, 56), (-51, 37))
    axes.add_patch(Annulus((0, 0), 33, 33 - OUTER, facecolor=HOUSING, edgecolor=INK))
    axes.add_patch(Circle((0, 0), INNER, facecolor=SHAFT, edgecolor=INK))
    for index in range(BEARING.n_balls):
        axes.add_patch(Circle(_polar(PITCH / 2, _ball(index)), BALL / 2, facecolor=STEEL, edgecolor=INK))
    axes.text(0, -9.5, f"shaft, inner ring\n$m_1$ = {SHAFT_MASS:g} kg", ha="center", va="center")
    axes.text(0, 28, f"outer ring, housing\n$m_2$ = {preset.housing_mass:.1f} kg", ha="center", va="center")
    _support(axes, preset)
    _between_rings(axes, preset)
    _load_and_motion(axes, preset)
    return figure


def _support(axes: Axes, preset: Preset) -> None:
    """Springs and dampers from the housing to the ground, along x and along y."""
    ground, reach = -46.0, -math.sqrt(33**2 - 6**2)
    for turn in (_upright, _lying):
        _ground(axes, turn, ground)
        _spring(axes, turn((-6, ground)), turn((-6, reach)), 2.4)
        _damper(axes, turn((6, ground)), turn((6, reach)), 2.4)
    axes.text(-46, 12.5, _constant("k", "2x", preset.support_stiffness_x / 1e6, "N/µm"), ha="center")
    axes.text(-46, -12.5, _constant("c", "2x", preset.support_damping_x, "N s/m"), ha="center", va="top")
    axes.text(-10, -39.5, _constant("k", "2y", preset.support_stiffness_y / 1e6, "N/µm"), ha="right", va="center")
    axes.text(10, -39.5, _constant("c", "2y", preset.support_damping_y, "N s/m"), va="center")


def _between_rings(axes: Axes, preset: Preset) -> None:
    """Spring and damper between the rings, in gaps between balls, and the law of one contact."""
    spring, damper = _ball(1) + 20, _ball(0) + 20
    _spring(axes, _polar(INNER, spring), _polar(OUTER, spring), 1.5)
    _damper(axes, _polar(INNER, damper), _polar(OUTER, damper), 1.5)
    mantissa, power = f"{preset.load_deflection_factor:.2e}".split("e")
    gap = from_si(preset.half_clearance, "um")
    contact = (
        rf"ball: $f = K\,\delta^{{3/2}}$"
        "\n"
        rf"$K$ = {mantissa}$\cdot$10$^{int(power)}$ N m$^{{-3/2}}$"
        f"\n{'preload' if gap < 0 else 'clearance'} {abs(gap):.1f} µm"
    )
    _note(axes, _polar(PITCH / 2, spring), (31, 31), _constant("k", "1", preset.ring_stiffness / 1e6, "N/µm"))
    _note(axes, _polar(PITCH / 2, damper), (37, 21), _constant("c", "1", preset.ring_damping, "N s/m"))
    _note(axes, _polar(PITCH / 2, _ball(8)), (29, -29), contact)


def _load_and_motion(axes: Axes, preset: Preset) -> None:
    load, angle = math.hypot(preset.load_x, preset.load_y), math.degrees(math.atan2(preset.load_y, preset.load_x))
    _arrow(axes, (0, 0), _polar(12.5, angle), VERMILION, 2)
    above = 1 if angle < 0 else -1
    axes.text(3.5, 2.2 * above, f"$W$ = {load:.3g} N", color=VERMILION, va="center")
    axes.plot(0, 0, "o", color=INK, markersize=3)
    _turning(axes, 12.8, (100, 165), f"{preset.shaft_rate:.1f} Hz", _polar(8.2, 118))
    for index, start in ((1, (-8.5, -3.0)), (2, (42.0, -6.0))):
        _arrow(axes, start, (start[0] + 5, start[1]), INK, 1)
        _arrow(axes, start, (start[0], start[1] + 5), INK, 1)
        axes.text(start[0] + 5.4, start[1], f"$x_{index}$", va="center")
        axes.text(start[0], start[1] + 5.4, f"$y_{index}$", ha="center", va="bottom")


@rc_context(STYLE)
def draw_crack() -> Figure:
    """Bearing with a crack in the inner race, and one ball before, on and after the crack."""
    figure = Figure(figsize=(10.4, 5.0), layout="constrained")
    figure.suptitle("Figure 2. Bearing with a cracked inner race, to scale")
    whole, passage = figure.subplots(1, 2, width_ratios=(1, 1.15))
    _whole(_canvas(whole, (-34, 34), (-35, 31)))
    _passage(_canvas(passage, (-18, 18), (6.6, 30.4)))
    whole.set_title("a   bearing at the start")
    passage.set_title("b   ball before, on and after the crack")
    return figure


def _whole(axes: Axes) -> None:
    axes.add_patch(Annulus((0, 0), OUTSIDE, OUTSIDE - OUTER, facecolor=HOUSING, edgecolor=INK))
    _cracked_ring(axes, POSITION)
    axes.add_patch(Circle((0, 0), BORE, facecolor="white", edgecolor=INK))
    axes.add_patch(Circle((0, 0), PITCH / 2, fill=False, edgecolor=FAINT, linestyle=(0, (6, 3)), linewidth=0.8))
    for index in range(BEARING.n_balls):
        axes.add_patch(Circle(_polar(PITCH / 2, _ball(index)), BALL / 2, facecolor=STEEL, edgecolor=INK))
        axes.text(*_polar(PITCH / 2, _ball(index)), str(index), ha="center", va="center", fontsize=8)
    axes.plot((0, 31), (0, 0), color=FAINT, linewidth=0.8)
    axes.text(31.4, 0, "$x$", va="center")
    for angle, reach in ((POSITION, INNER), (_ball(2), INNER)):
        axes.plot(*zip((0, 0), _polar(reach, angle), strict=True), color=FAINT, linewidth=0.8)
    _angle(axes, 9.2, (0, POSITION), rf"$\phi_0$ = {POSITION:.0f}°", (2.0, -2.0), VERMILION)
    _angle(axes, 6.0, (0, _ball(2)), r"$\theta_i$ (i = 2)", (-8.6, 5.6), INK)
    _turning(axes, 10.6, (190, 250), r"$\omega_s$", _polar(8.6, 220))
    _turning(axes, 28.2, (112, 142), r"$\omega_c$ (cage)", _polar(33.5, 128))
    for level, radius, name in ((-29, INNER, "d_i"), (-32.5, OUTER, "d_o")):
        _width(axes, level, radius, f"${name}$ = {2 * radius:g} mm")


def _passage(axes: Axes) -> None:
    angles = np.radians(np.linspace(55, 125, 141))
    outer = OUTER * np.array([np.cos(angles), np.sin(angles)])
    top = np.concatenate([outer, (OUTSIDE + 2) * np.array([np.cos(angles[::-1]), np.sin(angles[::-1])])], axis=1)
    axes.add_patch(Polygon(top.T, facecolor=HOUSING, edgecolor=INK))
    _cracked_ring(axes, 90)
    for turn, name in ((116, "before"), (90, "on"), (64, "after")):
        depth = DEPTH if turn == 90 else 0.0
        centre = _polar(PITCH / 2 - depth, turn)
        axes.add_patch(Circle(centre, BALL / 2, facecolor=STEEL, edgecolor=INK))
        axes.text(*centre, name, ha="center", va="center")
    axes.add_patch(Circle(_polar(PITCH / 2, 90), BALL / 2, fill=False, edgecolor=FAINT, linestyle=(0, (3, 2))))
    for edge in (90 - HALF, 90 + HALF):
        axes.plot(*zip(_polar(9.6, edge), _polar(INNER, edge), strict=True), color=VERMILION, linewidth=0.8)
    _angle(axes, 10.2, (90 - HALF, 90 + HALF), rf"$\phi_d$ = {2 * HALF:.0f}°", (0, 8.2), VERMILION, ha="center")
    arc = from_si(CRACK.width, "mm")
    _note(axes, _polar(INNER, 90 + HALF), (-16.2, 11.5), f"arc $W_d$\n{arc:.1f} mm")
    _note(axes, _polar(INNER - DEPTH / 2, 90 - HALF), (12.6, 11.5), f"depth $D_d$\n{DEPTH:g} mm")
    _note(axes, (0, OUTER - DEPTH / 2), (4.6, 29.6), f"drop $d_r$ = {DEPTH:g} mm: no contact")
    axes.text(*_polar(OUTSIDE + 0.4, 112), "outer race", ha="center", va="center", rotation=22)
    axes.text(*_polar(INNER - 2.2, 112), "inner race", ha="center", va="center", rotation=22)


def _cracked_ring(axes: Axes, position: float) -> None:
    """Inner ring, down to its centre, with the crack at an angle [degrees]."""
    angles = np.linspace(-180, 180, 1441)
    radii = np.where(np.abs(angles) < HALF, INNER - DEPTH, INNER)
    points = radii * np.array([np.cos(np.radians(angles + position)), np.sin(np.radians(angles + position))])
    axes.add_patch(Polygon(points.T, facecolor=SHAFT, edgecolor=INK))
    floor = points[:, np.abs(angles) <= HALF + 0.3]
    axes.plot(*floor, color=VERMILION, linewidth=2)


def _canvas(axes: Axes, x: Point, y: Point) -> Axes:
    axes.set(xlim=x, ylim=y, aspect="equal")
    axes.axis("off")
    axes.set_anchor("N")
    return axes


def _ball(index: int) -> float:
    """Angle of a ball at the start [degrees]."""
    return 360 / BEARING.n_balls * index


def _polar(radius: float, angle: float) -> Point:
    return radius * math.cos(math.radians(angle)), radius * math.sin(math.radians(angle))


def _upright(point: Point) -> Point:
    return point


def _lying(point: Point) -> Point:
    """Point turned by a quarter, from below the bearing to its left."""
    return point[1], -point[0]


def _spring(axes: Axes, start: Point, end: Point, half_width: float) -> None:
    """Zigzag between two points."""
    along = np.array([0, 0.2, *np.linspace(0.25, 0.75, 7), 0.8, 1])
    across = half_width * np.array([0, 0, 1, -1, 1, -1, 1, -1, 1, 0, 0])
    axes.plot(*_between(start, end, along, across), color=INK, linewidth=1.1, solid_joinstyle="round")


def _damper(axes: Axes, start: Point, end: Point, half_width: float) -> None:
    """Rod with a piston in an open pot."""
    for along, across in (
        ((0, 0.35), (0, 0)),
        ((0.65, 0.35, 0.35, 0.65), (-1, -1, 1, 1)),
        ((0.52, 0.52), (-0.7, 0.7)),
        ((0.52, 1), (0, 0)),
    ):
        points = _between(start, end, np.array(along), half_width * np.array(across))
        axes.plot(*points, color=INK, linewidth=1.1)


def _between(start: Point, end: Point, along: FloatArray, across: FloatArray) -> FloatArray:
    """Points given by their shares of the way between two points and their distances from it, shape (axis, point)."""
    first, way = np.array(start), np.array(end) - np.array(start)
    left = np.array([-way[1], way[0]]) / np.hypot(*way)
    return first[:, None] + way[:, None] * along + left[:, None] * across


def _ground(axes: Axes, turn: Callable[[Point], Point], level: float) -> None:
    """Hatched line, along which the springs and dampers of one direction end."""
    axes.plot(*zip(turn((-10, level)), turn((10, level)), strict=True), color=INK, linewidth=1.4)
    for place in np.arange(-9, 10, 2.0):
        axes.plot(*zip(turn((place, level)), turn((place - 1.4, level - 1.8)), strict=True), color=INK, linewidth=0.8)


def _arrow(axes: Axes, start: Point, end: Point, colour: str, width: float) -> None:
    style = {"arrowstyle": "-|>", "color": colour, "linewidth": width, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 11}
    axes.annotate("", end, start, arrowprops=style)


def _turning(axes: Axes, radius: float, angles: Point, text: str, place: Point) -> None:
    """Curved arrow of a rotation, with its name."""
    _arc(axes, radius, angles, BLUE)
    _arrow(axes, _polar(radius, angles[1] - 1), _polar(radius, angles[1]), BLUE, 1.2)
    axes.text(*place, text, ha="center", va="center", color=BLUE)


def _angle(axes: Axes, radius: float, angles: Point, text: str, place: Point, colour: str, ha: str = "left") -> None:
    """Arc between two directions, with its name."""
    _arc(axes, radius, angles, colour)
    axes.text(*place, text, color=colour, va="center", ha=ha)


def _arc(axes: Axes, radius: float, angles: Point, colour: str) -> None:
    course = np.radians(np.linspace(*angles, 60))
    axes.plot(radius * np.cos(course), radius * np.sin(course), color=colour, linewidth=1.2)


def _width(axes: Axes, level: float, radius: float, text: str) -> None:
    """Dimension line across the bearing."""
    axes.annotate(
        "",
        (-radius, level),
        (radius, level),
        arrowprops={"arrowstyle": "<->", "color": INK, "shrinkA": 0, "shrinkB": 0},
    )
    for side in (-radius, radius):
        axes.plot((side, side), (0, level - 0.8), color=FAINT, linewidth=0.6, linestyle=(0, (1, 2)))
    axes.text(0, level, text, ha="center", va="center", backgroundcolor="white")


def _note(axes: Axes, target: Point, place: Point, text: str) -> None:
    """Text with a thin line to what it names."""
    line = {"arrowstyle": "-", "color": FAINT, "linewidth": 0.8, "shrinkA": 2, "shrinkB": 0}
    axes.annotate(text, target, place, va="center", arrowprops=line)


def _constant(letter: str, index: str, value: float, unit: str) -> str:
    """Constant with at least three digits."""
    digits = max(0, 2 - math.floor(math.log10(value))) if value else 0
    return f"${letter}_{{{index}}}$ = {value:.{digits}f} {unit}"

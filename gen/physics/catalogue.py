"""Bearings by designation: geometry, outer dimensions, load ratings, and the source of each row.

Every number is taken from the source of its row; ``one source`` marks a geometry that only one source gives. Makers publish the outer
dimensions and the load ratings but rarely the balls. The frequency coefficients of Timken [1]_ give the number of balls and the ratio of
ball to pitch diameter; the pitch diameter is the mean of bore and outside diameter, and the ball diameter is the nearest multiple of
1/32 in. A row has ratings only if they agree with its balls (ISO 76 [3]_, ISO 281), because makers build one designation in more than
one way. For the same reason some rows have other fault orders than table A-9 prints for that size: `PRINTED_OTHERWISE` lists them.

.. [1] The Timken Company, *Ball Bearing Housed Unit Catalog*, p. A-13, table A-9, frequency coefficients of wide inner ring bearings.
.. [2] The Timken Company, *Deep Groove Ball Bearing Catalog*, order no. 10857, 2017, tables 10 and 11.
.. [3] ISO 76:2006, Rolling bearings - Static load ratings.
"""

import math
import re
from collections.abc import Iterator
from typing import Literal, NamedTuple

from gen.physics.bearing import Bearing, FaultOrders, orders

INCH = 25.4  # [mm]

_RATIO = "Timken A-9 [1], {}: number and ratio"
_TIMKEN = "; ratings Timken [2]"
_ONCE = " (one source)"
_TABLES = "; two public tables of nominal geometry"
_SKF = "; ratings SKF"


class _Row(NamedTuple):
    """One bearing in mm, kN and degrees."""

    designation: str
    n_balls: int
    pitch: float
    ball: float
    source: str
    size: tuple[float | None, float | None, float | None] = (None, None, None)
    """Bore, outside diameter and width."""
    ratings: tuple[float | None, float | None] = (None, None)
    """Dynamic and static rating."""
    angle: float = 0.0
    rolling_element: Literal["ball", "roller"] = "ball"
    roller_length: float | None = None


def _bearing(row: _Row) -> Bearing:
    bore, outside_diameter, width = row.size
    dynamic, static = row.ratings
    return Bearing(
        designation=row.designation,
        n_balls=row.n_balls,
        pitch_diameter=row.pitch * 1e-3,
        ball_diameter=row.ball * 1e-3,
        contact_angle=math.radians(row.angle),
        rolling_element=row.rolling_element,
        roller_length=_scale(row.roller_length, 1e-3),
        dynamic_rating=_scale(dynamic, 1e3),
        static_rating=_scale(static, 1e3),
        bore=_scale(bore, 1e-3),
        outside_diameter=_scale(outside_diameter, 1e-3),
        width=_scale(width, 1e-3),
        source=row.source,
    )


def _scale(value: float | None, factor: float) -> float | None:
    return None if value is None else value * factor


def _deep_groove() -> Iterator[_Row]:
    """Metric deep groove ball bearings."""
    # designation, balls, pitch, ball [mm], (bore, outside diameter, width) [mm], (dynamic, static) [kN], source
    rows = (
        ("608", 7, 15.016, 3.968, (8, 22, 7), (3.3, 1.4), "measured 608, package pybearing 1.0.4" + _ONCE + _TIMKEN),
        ("6804", 13, 25.6, 3.5, (20, 32, 7), (4.0, 2.5), "PRONOSTIA, IEEE PHM 2012 challenge, appendix A.1" + _TIMKEN),
        ("61806", 19, 35.5, 3.18, (30, 42, 7), (None, None), "Aimiyekagbon 2024, doi:10.5281/zenodo.10868257" + _ONCE),
        ("6004", 9, 31.0, INCH / 4, (20, 42, 12), (9.4, 5.0), _RATIO.format("9104") + _ONCE + _TIMKEN),
        ("6006", 11, 43.08, INCH * 9 / 32, (30, 55, 13), (13.2, 8.3),
         _RATIO.format("9106") + ", ball from the static rating" + _ONCE + _TIMKEN),
        ("6203", 8, 28.5, 6.747, (17, 40, 12), (9.6, 4.8), "CWRU Bearing Data Center, fan end 6203-2RS" + _TIMKEN),
        ("6203-paderborn", 8, 28.55, 6.75, (17, 40, 12), (None, None),
         "Lessmeier et al., PHM Society Eur. Conf. 3 (2016), fact sheets of the FAG bearings"),
        ("6204", 8, 33.5, INCH * 5 / 16, (20, 47, 14), (12.8, 6.6), _RATIO.format("204K") + _TABLES + _TIMKEN),
        ("6205", 9, 39.04, 7.94, (25, 52, 15), (14.0, 7.9), "CWRU Bearing Data Center, drive end 6205-2RS" + _TIMKEN),
        ("6205-paper", 9, 39.0, 8.0, (25, 52, 15), (None, None), "Ophel et al., the seed paper, rounded"),
        ("6206", 9, 46.0, INCH * 3 / 8, (30, 62, 16), (19.5, 11.3), _RATIO.format("206K") + _TABLES + _TIMKEN),
        ("6207", 9, 53.5, INCH * 7 / 16, (35, 72, 17), (25.7, 15.3), _RATIO.format("207K") + _TABLES + _TIMKEN),
        ("6208", 9, 60.0, 12.0, (40, 80, 18), (29.5, 18.1),
         "Thuan and Hong 2023, doi:10.1186/s13104-023-06400-4, pitch from a public table" + _TIMKEN),
        ("6209", 9, 65.0, INCH / 2, (45, 85, 19), (31.2, 20.3), _RATIO.format("209K") + _ONCE + _TIMKEN),
        ("6210", 10, 70.0, INCH / 2, (50, 90, 20), (35.0, 23.2), _RATIO.format("210K") + _ONCE + _TIMKEN),
        ("6211", 10, 77.5, INCH * 9 / 16, (55, 100, 21), (43.4, 29.2), _RATIO.format("211K") + _ONCE + _TIMKEN),
        ("6212", 10, 85.0, INCH * 5 / 8, (60, 110, 22), (None, None), _RATIO.format("212K") + _ONCE),
        ("6213", 10, 92.5, INCH * 21 / 32, (65, 120, 23), (57.2, 40.0), _RATIO.format("213K") + _ONCE + _TIMKEN),
        ("6214", 10, 97.5, INCH * 11 / 16, (70, 125, 24), (60.8, 44.0), _RATIO.format("214K") + _ONCE + _TIMKEN),
        ("6303", 7, 32.0, INCH * 11 / 32, (17, 47, 14), (13.6, 6.6), _RATIO.format("303K") + _ONCE + _TIMKEN),
        ("6304", 7, 36.0, INCH * 3 / 8, (20, 52, 15), (15.9, 7.8), _RATIO.format("304K") + _ONCE + _TIMKEN),
        ("6305", 8, 43.5, INCH * 13 / 32, (25, 62, 17), (20.6, 11.2), "two public tables of nominal geometry" + _TIMKEN),
        ("6306", 8, 51.0, INCH * 15 / 32, (30, 72, 19), (26.6, 15.0), "a public table of nominal geometry" + _ONCE + _TIMKEN),
        ("6307", 8, 57.5, INCH * 9 / 16, (35, 80, 21), (None, None), _RATIO.format("307K") + _ONCE),
        ("6308", 8, 65.0, INCH * 19 / 32, (40, 90, 23), (40.7, 24.0), "a public table of nominal geometry" + _ONCE + _TIMKEN),
        ("6309", 8, 72.5, INCH * 11 / 16, (45, 100, 25), (55.3, 31.5), _RATIO.format("309K") + _TABLES + _SKF),
        ("6310", 8, 80.0, INCH * 3 / 4, (50, 110, 27), (65.0, 38.0), _RATIO.format("310K") + _TABLES + _SKF),
        ("6311", 8, 87.5, INCH * 13 / 16, (55, 120, 29), (71.5, 44.6), _RATIO.format("311K") + _ONCE + _TIMKEN),
        ("6312", 8, 95.0, INCH * 7 / 8, (60, 130, 31), (81.8, 51.8), _RATIO.format("312K") + _TABLES + _TIMKEN),
        ("6314", 8, 110.0, INCH, (70, 150, 35), (104.0, 68.0), _RATIO.format("314K") + "; a public table" + _TIMKEN),
        ("6315", 8, 117.5, INCH * 17 / 16, (75, 160, 37), (113.4, 76.5), _RATIO.format("315K") + _ONCE + _TIMKEN),
        ("6316", 8, 125.0, INCH * 9 / 8, (80, 170, 39), (123.0, 86.5), _RATIO.format("316K") + "; a public table" + _TIMKEN),
    )  # fmt: skip
    for designation, n_balls, pitch, ball, size, ratings, source in rows:
        yield _Row(designation, n_balls, pitch, ball, source, size=size, ratings=ratings)


def _test_rigs() -> Iterator[_Row]:
    """Ball bearings of published test rigs: other types than metric deep groove, or types of unknown size."""
    yield _Row(
        "ER-10K", 8, 1.319 * INCH, 0.3125 * INCH, "PHM Society 2009 challenge, apparatus page; NPTEL course 112103024, ex. 15.2",
        size=(10 / 16 * INCH, None, None),
    )  # fmt: skip
    yield _Row(
        "ER-12K", 8, 1.319 * INCH, 0.3125 * INCH,
        "maker's multipliers in Gutierrez and Simon 2026, doi:10.17632/sp3fbf8d9y.1: those of the ER-10K",
        size=(12 / 16 * INCH, None, None),
    )  # fmt: skip
    yield _Row(
        "ER-16K", 9, 38.52, 7.94, "Huang and Baddour 2018, doi:10.1016/j.dib.2018.11.019; Forbes, Curtin University (38.50 mm)",
        size=(INCH, None, None),
    )  # fmt: skip
    yield _Row(
        "UER204", 8, 34.55, 7.92, "XJTU-SY, Wang et al. 2020, doi:10.1109/TR.2018.2882682",
        size=(20, None, None), ratings=(12.82, None),
    )  # fmt: skip
    yield _Row("NICE", 8, 1.245 * INCH, 0.235 * INCH, "Bechhoefer 2013, MFPT fault data sets")
    yield _Row("MAFAULDA", 8, 28.519, 7.145, "MAFAULDA, Machinery Fault Database, COPPE/UFRJ")
    yield _Row(
        "QJ212", 15, 85.15, 15.87, "Ismail et al. 2023, doi:10.1016/j.dib.2023.109019, angle from their fault frequencies",
        size=(60, 110, 22), angle=35.0,
    )  # fmt: skip


def _rollers() -> Iterator[_Row]:
    """Roller bearings; the roller length is None if no source gives it."""
    # designation, rollers, pitch, diameter, length [mm], angle [deg], (bore, outside diameter, width) [mm], source
    rows = (
        ("NU206", 13, 46.5, 9.0, 10.0, 0.0, (30, 62, 16),
         "package tribology 0.5.16; agrees with Schnur et al. 2025, doi:10.3390/data10050077"),
        ("NU205", 13, 38.5, 7.5, None, 0.0, (25, 52, 15), "Hou et al. 2025, doi:10.1016/j.dib.2025.112187" + _ONCE),
        ("NU2205", 13, 39.0, 7.5, None, 0.0, (25, 52, 18), "Wissbrock and Mueller 2025, doi:10.5281/zenodo.14762423" + _ONCE),
        ("N204", 11, 34.0, 7.5, None, 0.0, (20, 47, 14), "Lee et al. 2024, doi:10.1016/j.dib.2024.110940" + _ONCE),
        ("ZA-2115", 16, 2.815 * INCH, 0.331 * INCH, None, 15.17, (None, None, None),
         "IMS, Qiu et al. 2006, doi:10.1016/j.jsv.2005.03.007, one of two rows"),
        ("DIRG-B1", 10, 40.5, 9.0, None, 0.0, (None, None, None), "Daga et al. 2019, doi:10.1016/j.ymssp.2018.10.010"),
        ("DIRG-B2", 16, 54.0, 8.0, None, 0.0, (None, None, None), "Daga et al. 2019, doi:10.1016/j.ymssp.2018.10.010"),
    )  # fmt: skip
    for designation, n_rollers, pitch, diameter, length, angle, size, source in rows:
        yield _Row(
            designation, n_rollers, pitch, diameter, source,
            size=size, angle=angle, rolling_element="roller", roller_length=length,
        )  # fmt: skip


CATALOGUE = {row.designation: _bearing(row) for rows in (_deep_groove, _test_rigs, _rollers) for row in rows()}


class Printed(NamedTuple):
    """Fault orders that table A-9 of Timken [1]_ prints for the size of a bearing whose row has another source."""

    name: str
    """Size in the table."""
    orders: FaultOrders
    remark: str = ""


_MAKERS = r"(?:SKF|FAG|INA|NSK|NTN|SNR|KOYO|JTEKT|NACHI|TIMKEN|RHP|ZKL|KG|MRC)"
# seals and shields, internal clearance, tolerance class, cage, groove for a snap ring, grease: none of them changes the balls
_SUFFIX = r"[-/. ]?(?:2?RS[A-Z]?\d?|2?RZ|2?Z[ZR]?|LL[UBH]|DDU?|VV|C[1-5N]|P[4-6]|E?C[PJM]|E|J|M|MA|TN9?|TVP\d?|TVH|NR?|MT\d+|GJN|K)"


def known_designation(text: str) -> str | None:
    """Designation of the catalogue that a text on a bearing or a drawing means, without maker and suffixes; None if there is none.

    >>> known_designation("SKF 6205-2RS1/C3"), known_designation("nu 206 ecp"), known_designation("62059")
    ('6205', 'NU206', None)
    """
    if text in CATALOGUE:
        return text
    plain = re.sub(rf"^{_MAKERS}-*", "", "".join(text.upper().split()))
    fitting = (name for name in sorted(CATALOGUE, key=len, reverse=True) if plain.startswith(name.upper()))
    return next((name for name in fitting if re.fullmatch(rf"(?:{_SUFFIX})*", plain[len(name) :])), None)


PRINTED_OTHERWISE = {
    "6205": Printed("205K", FaultOrders(0.397, 3.574, 5.426, 2.328)),
    "6208": Printed("208K", FaultOrders(0.394, 3.547, 5.453, 2.256)),
    "6305": Printed(
        "305K",
        FaultOrders(0.367, 3.574, 5.426, 2.328),
        "a misprint: FTF is that of 7 balls, the others are those of 205K",
    ),
    "6306": Printed("306K", FaultOrders(0.368, 2.574, 4.426, 1.757), "7 balls; the same orders as 304K"),
    "6308": Printed("308K", FaultOrders(0.378, 3.023, 4.977, 1.925), "SKF's 2 BSF is that of this row [3]"),
    "UER204": Printed("204K", FaultOrders(0.382, 3.052, 4.948, 1.992)),
}
"""Rows whose BPFO or BPFI differs by more than 0.2 % from the one that table A-9 prints for their size."""

_PAGE = """# Catalogue of bearings

Generated from `gen/physics/catalogue.py`. A recipe takes ball bearings, and roller bearings of known length, by their
designation; a table of labels takes any of these. Lengths are in mm (of rollers behind "of"), angles in degrees, the
dynamic rating C and the static rating C0 in kN, fault frequencies in orders of the shaft for a fixed outer ring; a dash
means unknown.
*One source* marks a geometry that only one source gives.

[1] The Timken Company, *Ball Bearing Housed Unit Catalog*, p. A-13, table A-9: frequency coefficients. They give the
number of balls and the ratio of ball to pitch diameter. The pitch diameter is midway between bore and outside diameter
(6006: from the ratio), and the ball diameter is the nearest size in whole 1/32 in.

[2] The Timken Company, *Deep Groove Ball Bearing Catalog*, order no. 10857, 2017, tables 10 and 11. A rating is listed
only if the balls of the row explain it (static, ISO 76: within 2.5 %), because makers build one designation in more
than one way.

[3] EWA Sensors, case "Bearing fault", which quotes 4.078 orders for the spin of the balls from the data sheet of an
SKF 6308.

**Compare the orders with those of the maker of your bearing.** *Other orders* marks the rows whose BPFO or BPFI differs
by more than 0.2 % from the one that table [1] prints for a wide inner ring bearing of the same size. Features search a
line within 1.5 to 2 % of its nominal order: 1.5 % leave nothing for an error of the speed, and 16 % miss the line.
Tables of labels and recipes take the geometry of your bearing instead of a designation.

"""

_HEAD = (
    "designation",
    "elements",
    "pitch",
    "diameter",
    "angle",
    "bore x outside x width",
    "C",
    "C0",
)


def catalogue_page() -> str:
    """Markdown page of all bearings of the catalogue, with fault orders and source."""
    columns = (*_HEAD, "FTF", "BPFO", "BPFI", "BSF", "source")
    lines = ["| " + " | ".join(columns) + " |", "|" + "---|" * len(columns)]
    lines += ["| " + " | ".join(_cells(bearing)) + " |" for bearing in CATALOGUE.values()]
    return _PAGE + "\n".join(lines) + "\n"


def _cells(bearing: Bearing) -> list[str]:
    size = (bearing.bore, bearing.outside_diameter, bearing.width)
    return [
        bearing.designation,
        f"{bearing.n_balls} {bearing.rolling_element}s"
        + (f" of {_shown(bearing.roller_length, 1e3)}" if bearing.roller_length else ""),
        *(_shown(length, 1e3) for length in (bearing.pitch_diameter, bearing.ball_diameter)),
        f"{math.degrees(bearing.contact_angle):g}",
        " x ".join(_shown(length, 1e3) for length in size) if any(size) else "-",
        *(_shown(rating, 1e-3) for rating in (bearing.dynamic_rating, bearing.static_rating)),
        *(f"{order:.4f}" for order in orders(bearing)),
        bearing.source + _other_orders(bearing),
    ]


def _other_orders(bearing: Bearing) -> str:
    """Fault orders that a maker prints for a bearing of this size, relative to those of its row; empty if they agree."""
    if bearing.designation not in PRINTED_OTHERWISE:
        return ""
    name, printed, remark = PRINTED_OTHERWISE[bearing.designation]
    shares = (f"{100 * (its / own - 1):+.1f} %" for its, own in zip(printed, orders(bearing), strict=True))
    differences = ", ".join(f"{key.upper()} {share}" for key, share in zip(FaultOrders._fields, shares, strict=True))
    return f"; **other orders** in Timken A-9 [1], {name}: {differences}" + (f" ({remark})" if remark else "")


def _shown(value: float | None, factor: float) -> str:
    return "-" if value is None else f"{value * factor:.6g}"

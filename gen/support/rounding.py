"""Limits printed with few digits, rounded so that the printed number is allowed."""

from decimal import ROUND_CEILING, ROUND_FLOOR, Context


def rounded_up(limit: float, digits: int = 4) -> str:
    """Smallest number of a few digits that is not below a ``limit``, for "at least".

    >>> rounded_up(2 / 7), rounded_up(0.25), rounded_up(1234567.0)
    ('0.2858', '0.25', '1.235e+06')
    """
    return _rounded(limit, digits, ROUND_CEILING)


def rounded_down(limit: float, digits: int = 4) -> str:
    """Largest number of a few digits that is not above a ``limit``, for "at most".

    >>> rounded_down(2 / 3), rounded_down(-0.28571)
    ('0.6666', '-0.2858')
    """
    return _rounded(limit, digits, ROUND_FLOOR)


def _rounded(limit: float, digits: int, rounding: str) -> str:
    return f"{float(Context(prec=digits, rounding=rounding).create_decimal(repr(float(limit)))):.{digits}g}"

"""What every part of a recipe shares: units in the keys, bounds, and no key that is not known.

:func:`split_unit` is the one place where human units become SI.
"""

import math
from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field, StrictInt, StringConstraints, ValidationInfo, field_validator

from gen.recipe.distributions import Number, check_bounds

_UNITS = {
    "mm": 1e-3, "um": 1e-6, "nm": 1e-9, "rpm": 1 / 60, "deg": math.pi / 180, "percent": 1e-2, "mm_s": 1e-3, "mm2_s": 1e-6,
    "hz": 1.0, "s": 1.0, "kg": 1.0, "n": 1.0, "m_s2": 1.0, "n_m": 1.0, "n_s_m": 1.0, "db": 1.0, "celsius": 1.0, "k": 1.0,
    "kg_m3": 1.0, "per_gpa": 1e-9,
}  # fmt: skip

Weight = Annotated[Number, Field(ge=0)]
Count = Annotated[StrictInt, Field(ge=1)]
Name = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9_.-]{1,64}$")]


def split_unit(key: str) -> tuple[str, float]:
    """Key without its unit, and the factor that turns that unit into SI.

    >>> split_unit("width_mm"), split_unit("balance_mm_s"), split_unit("direct")
    (('width', 0.001), ('balance', 0.001), ('direct', 1.0))
    """
    words = key.split("_")
    for length in (3, 2, 1):
        unit = "_".join(words[-length:])
        if len(words) > length and unit in _UNITS:
            return "_".join(words[:-length]), _UNITS[unit]
    return key, 1.0


class Section(BaseModel):
    """A part of a recipe: frozen, with no key it does not know."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False, validate_default=True)

    @field_validator("*")
    @classmethod
    def _within_bounds(cls, value: Any, info: ValidationInfo) -> Any:
        bounds = cls.model_fields[info.field_name or ""].json_schema_extra
        return check_bounds(value, bounds) if isinstance(bounds, dict) else value

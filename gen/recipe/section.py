"""Base of every section of a recipe, and the types that several sections share."""

from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field, StrictInt, StringConstraints, ValidationInfo, field_validator

from gen.recipe.distributions import Number, check_bounds

Weight = Annotated[Number, Field(ge=0)]
Count = Annotated[StrictInt, Field(ge=1)]
Probability = Annotated[Number, Field(ge=0, le=1)]
Name = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9_.-]{1,64}$")]


class Section(BaseModel):
    """Keys that belong together. A section is frozen and refuses unknown keys; the docstring below a key is its meaning."""

    model_config = ConfigDict(
        extra="forbid", frozen=True, allow_inf_nan=False, validate_default=True, use_attribute_docstrings=True
    )

    @field_validator("*")
    @classmethod
    def _within_bounds(cls, value: Any, info: ValidationInfo) -> Any:
        bounds = cls.model_fields[info.field_name or ""].json_schema_extra
        return check_bounds(value, bounds) if isinstance(bounds, dict) else value

"""Base of every section of a recipe, and the types that several sections share."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any

import numpy as np
from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    StrictInt,
    StringConstraints,
    ValidationInfo,
    create_model,
    field_validator,
)

from gen.drawing.distributions import Number, check_bounds, is_distribution

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

    def __str__(self) -> str:
        """Kind of the section, and the keys that were given."""
        return repr(self)

    def __repr_name__(self) -> str:
        return getattr(self, "kind", type(self).__name__)

    def __repr_args__(self) -> Iterator[tuple[str | None, Any]]:
        given = self.model_fields_set - {"kind"}
        return ((key, value) for key, value in super().__repr_args__() if key in given)


def composed(name: str, module: str, bases: tuple[type[Section], ...], meaning: str | None, **keys: Any) -> Any:
    """Section of the keys of others, and of further ones that say their meaning themselves. As ``name`` in ``module`` it can be pickled."""
    # it has no source in which pydantic could look for docstrings; to look there all the same takes 40 ms
    options = {"use_attribute_docstrings": False}
    return create_model(name, __module__=module, __base__=bases, __doc__=meaning, __cls_kwargs__=options, **keys)


def quantities(section: Section) -> dict[str, Any]:
    """Distribution of every quantity of a section, by key."""
    return {key: value for key, value in vars(section).items() if is_distribution(value)}


def plain(value: Any) -> Any:
    """Value of a recipe as YAML would give it.

    Arrays of NumPy become lists, distributions text, and sections the keys that were given.

    >>> plain({"widths": np.array([0.5, 1.0])})
    {'widths': [0.5, 1.0]}
    """
    if is_distribution(value):
        return value.written
    if isinstance(value, BaseModel):  # its kind names the section, also if it was not given
        own = sorted(type(value).model_fields, key=lambda name: name != "kind")
        given = [name for name in own if name in value.model_fields_set or name == "kind"]
        return {name: plain(getattr(value, name)) for name in given}
    if isinstance(value, Mapping):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    return value.tolist() if isinstance(value, np.ndarray | np.generic) else value

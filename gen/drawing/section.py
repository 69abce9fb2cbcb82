"""Base of every section of a recipe: its keys, how it is drawn, and its values in SI units; and the types that several sections share."""

import functools
from collections.abc import Iterator, Mapping
from typing import Annotated, Any, ClassVar, Self

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
    model_validator,
)

from gen.drawing.distributions import Constant, Listed, Number, check_bounds, is_distribution
from gen.drawing.draws import Draws, unit_of
from gen.drawing.streams import Level
from gen.support.errors import RecipeError

Weight = Annotated[Number, Field(ge=0)]
Count = Annotated[StrictInt, Field(ge=1)]
Probability = Annotated[Number, Field(ge=0, le=1)]
Name = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9_.-]{1,64}$")]


class Section(BaseModel):
    """Keys that belong together. A section is frozen and refuses unknown keys; the docstring below a key is its meaning.

    A drawn section is of the same class, with numbers in place of its distributions. One with the key ``probability`` is there or not. One
    with a count has as many values of each key that is drawn for each item.
    """

    drawn_per: ClassVar[Level | None] = None
    """Level at which it is drawn; None for that of the section around it."""
    counted: ClassVar[str] = "count"
    """Key with the number of its items."""

    model_config = ConfigDict(
        extra="forbid", frozen=True, allow_inf_nan=False, validate_default=True, use_attribute_docstrings=True
    )

    @field_validator("*")
    @classmethod
    def _within_bounds(cls, value: Any, info: ValidationInfo) -> Any:
        bounds = cls.model_fields[info.field_name or ""].json_schema_extra
        return check_bounds(value, bounds) if isinstance(bounds, dict) else value

    @model_validator(mode="after")
    def _as_many_as_counted(self) -> Self:
        for key, value in quantities(self).items():
            if isinstance(value, Listed) and len(value.values) != self.stated_count():
                raise ValueError(
                    f"{key}: is a list of {len(value.values)} numbers, so {self.counted} must say {len(value.values)} too."
                )
        return self

    def stated_count(self) -> int | None:
        """Number of items, if it is not drawn."""
        count = self.__dict__.get(self.counted)
        return round(count.value) if isinstance(count, Constant) else None

    def draw(self, of: Draws) -> Any:
        """The section with a number in place of each distribution of the level of ``of``; None if it is not there.

        Raises
        ------
        RecipeError
            If a share is outside the range of its key.
        """
        if (probability := self.__dict__.get("probability")) is None or (self.drawn_per or of.own) != of.level:
            return self.drawn(of)
        if of.u("probability") >= probability:
            return None
        return self.model_copy(update={"probability": 1.0}).drawn(of)

    def drawn(self, of: Draws) -> Self:
        """The section, which is there, with a number in place of each distribution."""
        own, values = self.drawn_per or of.own, self.__dict__
        drawn, distributions, below = dict[str, Any](), dict[str, Any](), dict[str, Any]()
        for key, (per, each) in _drawn_keys(type(self)).items():
            value = values[key]
            if not is_distribution(value):
                if isinstance(value, Section) or (isinstance(value, tuple) and value and isinstance(value[0], Section)):
                    below[key] = value
            elif (per or own) == of.level:
                distributions[key] = value, each
            elif value.per == of.level:
                drawn[key] = value.about(of.value(key, value))
        numbers = dict[str, Any]()
        if self.counted in distributions:
            numbers[self.counted] = float(round(of.value(self.counted, distributions[self.counted][0])))
        count = round(numbers[self.counted]) if self.counted in numbers else self.stated_count() or 1
        for key, (value, each) in distributions.items():
            if key != self.counted:
                numbers[key] = of.values(key, value, count) if each else of.value(key, value)
        shares = {key: value.share_of for key, (value, _) in distributions.items() if value.share_of is not None}
        drawn |= of.with_shares(type(self), numbers, shares) if shares else numbers
        known = of.known
        if below and numbers:
            known = {
                **known,
                **{key: drawn[key] * unit_of(key)[1] for key in numbers if not isinstance(drawn[key], tuple)},
            }
        for key, value in below.items():
            new = _drawn_below(value, of.within(key, own, known))
            if new is not value:
                drawn[key] = new
        return self.model_copy(update=drawn) if drawn else self

    def as_drawn(self, place: str = "") -> Self:
        """A section whose keys were given as numbers, as if it had been drawn.

        Raises
        ------
        RecipeError
            If a key, whose path begins with ``place``, is a distribution or a share.
        """
        drawn, values, stated = dict[str, Any](), self.__dict__, self.stated_count()
        count = 1 if stated is None else stated
        if values.get("probability", 1) != 1:
            raise RecipeError(f"{place}probability: one record has this or not; say 1, or leave the section out.")
        for key, (_, each) in _drawn_keys(type(self)).items():
            value = values[key]
            if isinstance(value, Section):
                below = value.as_drawn(f"{place}{key}.")
                drawn |= {} if below is value else {key: below}
            elif isinstance(value, tuple) and value and isinstance(value[0], Section):
                drawn[key] = tuple(one.as_drawn(f"{place}{key}[{number}].") for number, one in enumerate(value))
            elif is_distribution(value):
                if not isinstance(value, Constant | Listed) or value.share_of is not None:
                    raise RecipeError(
                        f"{place}{key}: {value} is no number; the recipe of one record, with an origin, has numbers alone."
                    )
                if isinstance(value, Listed):
                    drawn[key] = value.values
                else:
                    drawn[key] = (value.value,) * count if each else value.value
        return self.model_copy(update=drawn) if drawn else self

    def si(self) -> dict[str, Any]:
        """Drawn values in SI units by the key without its unit, an array for a key that was drawn for each item; levels stay in dB."""
        stored: Any = self.__dict__
        found = stored.get("_si")
        if found is None:
            found = stored["_si"] = {
                name: value * factor if isinstance(value, float) else np.array(value) * factor
                for key, name, factor in _quantity_keys(type(self))
                if not is_distribution(value := stored[key])
            }
        return found

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:
        """Copy of the section with some other values, which are not checked."""
        copy = super().model_copy(update=update, deep=deep)
        stored: Any = copy.__dict__
        stored.pop("_si", None)
        return copy

    def __eq__(self, other: object) -> bool:
        """Whether all keys have the same values; those of pydantic compare the arrays of :meth:`si` too."""
        if self is other or type(self) is not type(other):
            return self is other
        return all(self.__dict__[key] == other.__dict__[key] for key in type(self).model_fields)

    def __str__(self) -> str:
        """Kind of the section, and the keys that were given."""
        return repr(self)

    def __repr_name__(self) -> str:
        return getattr(self, "kind", type(self).__name__)

    def __repr_args__(self) -> Iterator[tuple[str | None, Any]]:
        given = self.model_fields_set - {"kind"}
        return ((key, value) for key, value in super().__repr_args__() if key in given)


def _drawn_below(value: Any, of: Draws) -> Any:
    """A section, or all of a tuple of them, drawn; the value itself where nothing is drawn."""
    if isinstance(value, Section):
        return value.draw(of)
    new = tuple(one.draw(of.within(_name(one), of.own)) for one in value)
    return value if all(one is other for one, other in zip(new, value, strict=True)) else new


def _name(one: Any) -> str:
    """Name of a section among others, which does not depend on its place."""
    return str(getattr(one, "name", "") or getattr(one, "kind", ""))


def _bounds(section: type[Section], key: str) -> dict[str, Any]:
    extra = section.model_fields[key].json_schema_extra
    return extra if isinstance(extra, dict) else {}


@functools.cache
def _drawn_keys(section: type[Section]) -> dict[str, tuple[Level | None, bool]]:
    """Keys that can hold distributions or sections: level of a key with one of its own, and whether it is drawn for each item."""
    of_keys = {key: _bounds(section, key) for key in section.model_fields}
    return {key: (bounds.get("per"), bounds.get("each", False)) for key, bounds in of_keys.items()}


@functools.cache
def _quantity_keys(section: type[Section]) -> list[tuple[str, str, float]]:
    """Key, name without unit and factor of the unit of every quantity of a section."""
    return [(key, *unit_of(key)) for key in section.model_fields if "low" in _bounds(section, key)]


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
        fields = type(value).model_fields  # null says nothing where nothing is the default
        given = [name for name in given if getattr(value, name) is not None or fields[name].default is not None]
        return {name: plain(getattr(value, name)) for name in given}
    if isinstance(value, Mapping):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    return value.tolist() if isinstance(value, np.ndarray | np.generic) else value

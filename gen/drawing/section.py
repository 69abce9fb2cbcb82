"""Base of every section of a recipe: its keys, how it is drawn, and its values in SI units; and the types that several sections share."""

import functools
from collections.abc import Iterator, Mapping
from numbers import Real
from typing import Annotated, Any, ClassVar, Self, get_origin

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

from gen.drawing.distributions import Constant, Listed, Number, check_bounds, interval, is_distribution, is_within
from gen.drawing.draws import Draws
from gen.drawing.streams import Level
from gen.support.errors import RecipeError
from gen.support.sentences import models_in
from gen.support.units import split_unit

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
        own, values, count = self.drawn_per or of.own, self.__dict__, None
        drawn, shares = dict[str, Any](), dict[str, str]()
        for key, bounds in bounds_of(type(self)).items():
            value = values[key]
            if not is_distribution(value):
                continue
            # keys of this level, each from the stream of its own name
            if bounds.get("per", own) == of.level:
                if "each" in bounds:
                    # keys that are drawn for each item have as many values as there are items
                    count = self.stated_count() or 1 if count is None else count
                    drawn[key] = of.values(key, value, count)
                else:
                    drawn[key] = of.value(key, value)
                # the count itself is drawn ahead of what it counts
                if key == self.counted:
                    count = round(drawn[key])
                    drawn[key] = float(count)
                if value.share_of is not None:
                    shares[key] = value.share_of
            # per=rig draws a common value here, about which the records scatter later
            elif value.per == of.level:
                drawn[key] = value.about(of.value(key, value))
        if shares:
            drawn = of.with_shares(bounds_of(type(self)), drawn, shares)
        sections, wholes = self.below(), of.wholes
        if sections and drawn:  # they can name the numbers of this one
            numbers = {name: value * split_unit(name)[1] for name, value in drawn.items() if isinstance(value, float)}
            wholes = {**wholes, **numbers}
        # sections within this one, each under its own name
        for key, value in sections:
            inner = of.within(key, own, wholes)
            if isinstance(value, tuple):
                drawn[key] = tuple(section.draw(inner.within(_name(section), own)) for section in value)
            elif (new := value.draw(inner)) is not value:
                drawn[key] = new
        return self.model_copy(update=drawn) if drawn else self

    def as_drawn(self, place: str = "") -> Self:
        """A section whose keys were given as numbers, as if it had been drawn.

        Raises
        ------
        RecipeError
            If a key, whose path begins with ``place``, is a distribution or a share.
        """
        drawn, stated = dict[str, Any](), self.stated_count()
        if getattr(self, "probability", 1) != 1:
            raise RecipeError(f"{place}probability: one record has this or not; say 1, or leave the section out.")
        for key, value in quantities(self).items():
            if not isinstance(value, Constant | Listed) or value.share_of is not None:
                raise RecipeError(
                    f"{place}{key}: {value} is no number; the recipe of one record, with an origin, has numbers alone."
                )
            if isinstance(value, Listed):
                drawn[key] = value.values
            else:
                # one number stands for every item
                each = "each" in bounds_of(type(self))[key]
                drawn[key] = (value.value,) * (1 if stated is None else stated) if each else value.value
        for key, value in self.below():
            if isinstance(value, tuple):
                drawn[key] = tuple(section.as_drawn(f"{place}{key}[{number}].") for number, section in enumerate(value))
            elif (new := value.as_drawn(f"{place}{key}.")) is not value:
                drawn[key] = new
        return self.model_copy(update=drawn) if drawn else self

    def check_drawn(self, place: str, advice: str) -> None:
        """RecipeError with an ``advice`` if a drawn value is not in the range of its key; paths of keys begin with ``place``."""
        for key, bounds in bounds_of(type(self)).items():
            drawn = self.__dict__[key]
            # a key that may be left out has nothing to draw then
            if drawn is None and type(self).model_fields[key].default is None:
                continue
            for value in drawn if isinstance(drawn, tuple) else (drawn,):
                number = float(value) if isinstance(value, Real) and not isinstance(value, bool) else np.nan
                if not is_within(number, bounds):
                    shown = " ".join(str(value).split())
                    raise RecipeError(f"{place}{key}: {shown} was drawn, which is not in {interval(bounds)}; {advice}.")
        for key, sections in self.below():
            for section in sections if isinstance(sections, tuple) else (sections,):
                section.check_drawn(f"{place}{key}.", advice)

    def below(self) -> list[tuple[str, Any]]:
        """Sections, and tuples of them, in this one."""
        values = self.__dict__
        return [(key, values[key]) for key in _section_keys(type(self)) if values[key]]

    def si(self) -> dict[str, Any]:
        """Drawn values in SI units by the key without its unit, an array for a key that was drawn for each item; levels stay in dB."""
        return self._si

    @functools.cached_property
    def _si(self) -> dict[str, Any]:
        values = self.__dict__
        return {
            name: value * factor if isinstance(value, float) else np.array(value) * factor
            for key in bounds_of(type(self))
            if not is_distribution(value := values[key])
            for name, factor in (split_unit(key),)
        }

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:
        """Copy of the section with some other values, which are not checked; that of pydantic takes four times as long."""
        copy, new = object.__new__(type(self)), update or {}
        values, set_keys = {**self.__dict__, **new}, self.__pydantic_fields_set__
        # values in SI units that were kept belong to the old numbers
        values.pop("_si", None)
        for name, value in (
            ("__dict__", values),
            ("__pydantic_fields_set__", set_keys if set_keys >= new.keys() else set_keys | new.keys()),
            ("__pydantic_extra__", None),
            ("__pydantic_private__", None),
        ):
            object.__setattr__(copy, name, value)
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
        set_keys = self.model_fields_set - {"kind"}
        return ((key, value) for key, value in super().__repr_args__() if key in set_keys)


def _name(section: Any) -> str:
    """Name of a section among others, which does not depend on its place."""
    return str(getattr(section, "name", "") or getattr(section, "kind", ""))


@functools.cache
def bounds_of(section: type[Section]) -> dict[str, dict[str, Any]]:
    """Bounds of every quantity of a section, by key; the number of items comes first, because others are drawn for each."""
    bounds: Any = {key: field.json_schema_extra for key, field in section.model_fields.items()}
    return {key: bounds[key] for key in sorted(bounds, key=lambda key: key != section.counted) if bounds[key]}


@functools.cache
def _section_keys(section: type[Section]) -> list[str]:
    """Keys that can hold sections or tuples of them."""
    fields = section.model_fields.items()
    return [
        key
        for key, field in fields
        if get_origin(field.annotation) is not dict
        and any(issubclass(model, Section) for model in models_in(field.annotation))
    ]


def sections_with_places(section: Section, place: str = "") -> Iterator[tuple[str, Section]]:
    """A section and all sections in it, each with its path."""
    yield place, section
    for key, value in section.below():
        path = f"{place}.{key}" if place else key
        if isinstance(value, Section):
            yield from sections_with_places(value, path)
        else:
            for number, inner in enumerate(value):
                yield from sections_with_places(inner, f"{path}[{number}]")


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
        keys = [name for name in own if name in value.model_fields_set or name == "kind"]
        fields = type(value).model_fields  # null says nothing where nothing is the default
        keys = [name for name in keys if getattr(value, name) is not None or fields[name].default is not None]
        return {name: plain(getattr(value, name)) for name in keys}
    if isinstance(value, Mapping):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    return value.tolist() if isinstance(value, np.ndarray | np.generic) else value

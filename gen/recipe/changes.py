"""Sections of a ``faults`` entry that replace some keys of a section of the recipe, for the records of that entry alone."""

from typing import TYPE_CHECKING, Any, get_type_hints

from pydantic import ConfigDict, Field, model_serializer

from gen.drawing import Section, composed
from gen.recipe.operation import OperationSection
from gen.recipe.sensing import SnrLevel


class Changes(Section):
    """Some keys of another section; only the keys that are given count (``model_fields_set``)."""

    model_config = ConfigDict(validate_default=False)

    def stated(self) -> dict[str, Any]:
        """Value of every key that is given, in the order of the section."""
        return {key: value for key, value in self if key in self.model_fields_set}

    @model_serializer(mode="plain")
    def _only_given(self) -> dict[str, Any]:
        return self.stated()


def _changes_of(section: type[Section], name: str, meaning: str) -> Any:
    """Model of some keys of ``section``: all are optional, with the checks and meanings that they have there."""
    hints = get_type_hints(section, include_extras=True)
    fields: dict[str, Any] = {
        key: (
            hints[key],
            Field(default=None, json_schema_extra=field.json_schema_extra, description=field.description),
        )
        for key, field in section.model_fields.items()
        if key != "kind"
    }
    return composed(name, __name__, (Changes,), meaning, **fields)


if TYPE_CHECKING:

    class OperationChanges(Changes, OperationSection):
        """Some keys of ``operation``."""

    class LevelChanges(Changes, SnrLevel):
        """Some keys of ``level``."""

else:
    OperationChanges = _changes_of(OperationSection, "OperationChanges", "Some keys of `operation`, for one fault.")
    LevelChanges = _changes_of(SnrLevel, "LevelChanges", "Some keys of `level`, for one fault.")

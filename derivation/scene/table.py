"""A table of the scene file: what all tables share, and choices between groups of keys."""

from collections.abc import Mapping
from typing import Any, ClassVar, Self

from pydantic import BaseModel, ConfigDict, model_validator
from pydantic.config import JsonDict
from pydantic_core import PydanticCustomError

from derivation.scene.messages import choice_problem, shown

Groups = tuple[tuple[str, ...], ...]
CONFLICT = "conflict"
"""Error type of keys that are right one by one but not together."""


class Table(BaseModel):
    """A table of the scene file: frozen, no unknown keys, numbers must be numbers."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, allow_inf_nan=False)
    choices: ClassVar[tuple[Groups, ...]] = ()
    """Groups of keys of which exactly one group is to be given."""
    stand_in: ClassVar[str | None] = None
    """Key that makes up for groups left out."""

    @classmethod
    def conflicts(cls, given: Mapping[str, Any]) -> list[str]:
        """What is wrong with the keys given, taken together."""
        table = cls.__name__.lower()
        keys = {key for key, value in given.items() if value is not None}
        if cls.stand_in in keys and not any(keys & set(sum(g, ())) for g in cls.choices):
            return []
        examples = {key: _example(field) for key, field in cls.model_fields.items()}
        found = (choice_problem(table, groups, keys, examples) for groups in cls.choices)
        return [problem for problem in found if problem]

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        problems = self.conflicts(self.model_dump())
        if problems:
            raise PydanticCustomError(CONFLICT, "{problems}", {"problems": "; ".join(problems)})
        return self

    @classmethod
    def __get_pydantic_json_schema__(cls, core_schema: Any, handler: Any) -> JsonDict:
        """JSON schema in which the choices are spelled out and nothing may be null."""
        made: JsonDict = handler.resolve_ref_schema(handler(core_schema))
        properties: Any = made["properties"]
        for field in properties.values():
            kinds = [kind for kind in field.pop("anyOf", []) if kind != {"type": "null"}]
            if len(kinds) == 1:
                field.update(kinds[0])
                field.pop("default")
            elif kinds:
                field["anyOf"] = kinds
        if cls.choices:
            made["allOf"] = [
                {"oneOf": [{"required": list(group)} for group in groups]} for groups in cls.choices
            ]
        if cls.stand_in:
            keys = [list(group) for groups in cls.choices for group in groups]
            absent = {"not": {"anyOf": [{"required": group} for group in keys]}}
            alone = {"required": [cls.stand_in]} | absent
            either: Any = [{"allOf": made["allOf"]}, alone]
            made["allOf"] = [{"anyOf": either}]
        return made


def _example(field: Any) -> str:
    return shown(field.examples[0]) if field.examples else ""

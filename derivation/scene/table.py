"""A table of the scene file: what all tables share, and choices between groups of keys."""

import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from numbers import Integral, Real
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Self, TypeGuard

from pydantic import BaseModel, ConfigDict, ValidationError, model_validator
from pydantic.config import JsonDict
from pydantic_core import PydanticCustomError

from derivation.scene.errors import SceneError
from derivation.scene.messages import choice_problem, explain, listed, shown

Problems = list[Callable[[], str]]
"""What is wrong, each still to be put into words."""
Groups = tuple[tuple[str, ...], ...]
CONFLICT = "conflict"
"""Error type of keys that are right one by one but not together."""


class Table(BaseModel):
    """A table of the scene file: frozen, no unknown keys, numbers must be numbers.

    Raises
    ------
    SceneError
        With one message that lists everything that is wrong.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, allow_inf_nan=False)
    choices: ClassVar[tuple[Groups, ...]] = ()
    """Groups of keys of which exactly one group is to be given."""
    options: ClassVar[tuple[Groups, ...]] = ()
    """Groups of keys of which at most one group is to be given."""
    stand_in: ClassVar[str | None] = None
    """Key that makes up for groups left out."""

    if not TYPE_CHECKING:  # for type checkers the keys are those of the class

        def __init__(self, /, **keys: Any) -> None:
            table = type(self)
            name = table.__name__.lower()
            given = plain_keys(keys)
            try:
                self.__pydantic_validator__.validate_python(given, self_instance=self)
            except ValidationError as error:
                found = problems(found_by(error, name), {name: given}, {name: table})
                where = f"{name}: " if len(found) > 1 else ""
                raise SceneError(f"{where}{in_words(found)}") from None

        __init__.__pydantic_base_init__ = True  # tables within a scene are read without it

    @classmethod
    def conflicts(cls, given: Mapping[str, Any]) -> list[str]:
        """What is wrong with the keys given, taken together."""
        table = cls.__name__.lower()
        keys = {key for key, value in given.items() if value is not None}
        choices = [groups for groups in cls.options if keys & set(sum(groups, ()))]
        if not (cls.stand_in in keys and not any(keys & set(sum(g, ())) for g in cls.choices)):
            choices += cls.choices
        examples = {key: _example(field) for key, field in cls.model_fields.items()}
        found = (choice_problem(table, groups, keys, examples) for groups in choices)
        return [problem for problem in found if problem]

    def to_json(self) -> dict[str, Any]:
        """The keys as they were given."""
        return self.model_dump(mode="json", exclude_none=True, exclude_unset=True)

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        found = self.conflicts(self.model_dump())
        if found:
            raise PydanticCustomError(CONFLICT, "{problems}", {"problems": "; ".join(found)})
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
        rules: list[Any] = [_one_of(groups) for groups in cls.choices]
        if cls.stand_in:
            alone = {"required": [cls.stand_in]} | _none_of(*cls.choices)
            rules = [{"anyOf": [{"allOf": rules}, alone]}]
        rules += [{"anyOf": [_one_of(groups), _none_of(groups)]} for groups in cls.options]
        if rules:
            made["allOf"] = rules
        return made


def _one_of(groups: Groups) -> dict[str, Any]:
    """JSON schema for exactly one of the groups."""
    return {"oneOf": [{"required": list(group)} for group in groups]}


def _none_of(*choices: Groups) -> dict[str, Any]:
    """JSON schema for no key of any group."""
    keys = {key: None for groups in choices for group in groups for key in group}
    return {"not": {"anyOf": [{"required": [key]} for key in keys]}}


def _example(field: Any) -> str:
    return shown(field.examples[0]) if field.examples else ""


class Problem(NamedTuple):
    """What pydantic finds wrong: its name of the error, table and key, and the value there."""

    kind: str
    place: tuple[int | str, ...]
    value: Any


def found_by(error: ValidationError, table: str = "") -> Iterator[Problem]:
    """What pydantic finds wrong with keys one by one, in a table or in all of a scene."""
    for item in error.errors(include_url=False):
        if item["type"] != CONFLICT:
            place = (table, *item["loc"]) if table else item["loc"]
            yield Problem(item["type"], place, item["input"])


def problems(
    found: Iterable[Problem], data: Mapping[str, Any], tables: Mapping[str, type[Table]]
) -> Problems:
    """Everything that is wrong with tables, keys taken together included.

    Parameters
    ----------
    found
        What is wrong with keys one by one.
    data
        The tables as they were given, by name.
    tables
        The tables that there may be.
    """
    fields = {name: dict(table.model_fields) for name, table in tables.items()}
    told: dict[object, Callable[[], str]] = {}
    for kind, place, value in found:
        # Every type that a key may have gives a message of its own; the first is enough.
        told.setdefault((place[:2], shown(value)), partial(explain, kind, place, value, fields))
    # Pydantic looks at keys together only if each is right; the user wants to hear all at once.
    for name, table in tables.items():
        if isinstance(data.get(name), Mapping):
            told |= {text: partial(str, text) for text in table.conflicts(data[name])}
    return list(told.values())


def in_words(found: Sequence[Callable[[], str]]) -> str:
    """One problem as it is, several below each other."""
    return found[0]() if len(found) == 1 else listed(found)


def plain_keys(keys: Mapping[str, Any]) -> dict[str, Any]:
    """Keys with NumPy's numbers as Python's."""
    return {key: _plain_number(value) for key, value in keys.items()}


def _plain_number(value: Any) -> Any:
    if isinstance(value, (bool, int)) or not isinstance(value, Real):
        return value
    return int(value) if isinstance(value, Integral) else float(value)


def is_number(value: Any) -> TypeGuard[float]:
    """Whether a value is a number a double can hold."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return False
    return abs(value) < sys.float_info.max

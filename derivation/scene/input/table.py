"""Base class of the tables of a scene file, with choices between groups of keys."""

import re
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from inspect import cleandoc
from numbers import Integral, Real
from textwrap import fill, indent
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Self, TypeGuard

from pydantic import BaseModel, ConfigDict, ValidationError, model_validator
from pydantic.config import JsonDict
from pydantic.fields import FieldInfo
from pydantic_core import PydanticCustomError

from derivation.scene.errors import SceneError
from derivation.scene.input.messages import choice_problem, explain, listed, shown

Problems = list[Callable[[], str]]
"""Problems, each a function that returns the message."""
Groups = tuple[tuple[str, ...], ...]
CONFLICT = "conflict"
"""Error type of keys that are valid one by one but exclude each other."""


class Table(BaseModel):
    """A table of a scene file: immutable, without unknown keys, strictly typed.

    Raises
    ------
    SceneError
        If a key is missing, unknown or invalid; the message lists all problems.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, allow_inf_nan=False)
    choices: ClassVar[tuple[Groups, ...]] = ()
    """Alternatives, each several groups of keys, of which exactly one must be given."""
    options: ClassVar[tuple[Groups, ...]] = ()
    """Alternatives, each several groups of keys, of which at most one may be given."""
    stand_in: ClassVar[str | None] = None
    """Key with which no group of `choices` is needed."""

    if not TYPE_CHECKING:  # for type checkers the keys are those of the class

        def __init__(self, /, **keys: Any) -> None:
            name = type(self).__name__.lower()
            given = plain_keys(keys)
            try:
                self.__pydantic_validator__.validate_python(given, self_instance=self)
            except ValidationError as error:
                texts = problems(
                    problems_of(error, name), {name: given}, {**_tables(), name: type(self)}
                )
                where = f"{name}: " if len(texts) > 1 else ""
                raise SceneError(f"{where}{in_words(texts)}") from None

        __init__.__pydantic_base_init__ = True  # tables within a scene are read without it

    @classmethod
    def __pydantic_init_subclass__(cls, **_: Any) -> None:
        """Describe the keys in the docstring of the class, if it describes none itself."""
        text = cleandoc(cls.__doc__ or "")
        described = all(field.description for field in cls.model_fields.values())
        if described and not re.search("^Parameters$", text, re.MULTILINE):
            keys = [f"{name}\n{_meaning(field)}" for name, field in cls.model_fields.items()]
            section = "\n".join(["Parameters", "----------", *keys, "", ""])
            cls.__doc__ = re.sub(
                r"^(?=Raises$|Examples$)|\Z", section, text, count=1, flags=re.MULTILINE
            )

    @classmethod
    def conflicts(cls, given: Mapping[str, Any]) -> list[str]:
        """Return the problems of combinations of the given keys."""
        table = cls.__name__.lower()
        keys = {key for key, value in given.items() if value is not None}
        choices = [groups for groups in cls.options if keys & set(sum(groups, ()))]
        if not (cls.stand_in in keys and not any(keys & set(sum(g, ())) for g in cls.choices)):
            choices += cls.choices
        examples = {key: _example(field) for key, field in cls.model_fields.items()}
        texts = (choice_problem(table, groups, keys, examples) for groups in choices)
        return [problem for problem in texts if problem]

    def model_copy(
        self,
        *,
        update: Mapping[str, Any] | None = None,
        deep: bool = False,  # noqa: ARG002 (tables do not change)
    ) -> Self:
        """Return a table with other values for some keys, which are checked.

        Parameters
        ----------
        update
            New values by key; None removes a key that is optional.
        deep
            Without effect, because tables do not change.

        Raises
        ------
        SceneError
            If a key is unknown or invalid, or does not suit the others.

        Examples
        --------
        >>> import platecontact as pc
        >>> plate = pc.Plate(radius=0.3, thickness=0.05, material="glass")
        >>> plate.model_copy(update={"thickness": 0.01})
        Plate(radius=0.3, thickness=0.01, material='glass')
        """
        given = {key: getattr(self, key) for key in self.model_fields_set}
        return type(self)(**(given | dict(update or {})))

    if not TYPE_CHECKING:

        def __setattr__(self, key: str, _: object) -> None:
            name = type(self).__name__.lower()
            raise SceneError(
                f"{name}.{key}: cannot be changed; make another {type(self).__name__} with "
                f"{name}.model_copy(update={{{key!r}: ...}})"
            )

    def to_json(self) -> dict[str, Any]:
        """Return the given keys with their values."""
        return self.model_dump(mode="json", exclude_none=True, exclude_unset=True)

    def __repr_args__(self) -> Iterator[tuple[str | None, Any]]:
        """Yield the given keys with their values."""
        given = self.model_fields_set
        return ((key, value) for key, value in super().__repr_args__() if key in given)

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        texts = self.conflicts(self.model_dump())
        if texts:
            raise PydanticCustomError(CONFLICT, "{problems}", {"problems": "; ".join(texts)})
        return self

    @classmethod
    def __get_pydantic_json_schema__(cls, core_schema: Any, handler: Any) -> JsonDict:
        """Return a JSON schema with the summary of the table and the choices, without null."""
        made: JsonDict = handler.resolve_ref_schema(handler(core_schema))
        if "description" in made:
            made["description"] = str(made["description"]).partition("\n")[0]
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


def _meaning(field: FieldInfo) -> str:
    """Return the description of a key as an indented sentence, with its default value."""
    text = str(field.description)
    if field.default is None or field.default_factory is not None:
        text += "; optional"
    elif not field.is_required():
        text += f"; by default {shown(field.default).removeprefix('the string ')}"
    return indent(fill(f"{text[0].upper()}{text[1:]}.", 90), "    ")


def _one_of(groups: Groups) -> dict[str, Any]:
    """Return a JSON schema for exactly one of the groups."""
    return {"oneOf": [{"required": list(group)} for group in groups]}


def _none_of(*choices: Groups) -> dict[str, Any]:
    """Return a JSON schema that excludes the keys of all groups."""
    keys = {key: None for groups in choices for group in groups for key in group}
    return {"not": {"anyOf": [{"required": [key]} for key in keys]}}


def _example(field: Any) -> str:
    return shown(field.examples[0]) if field.examples else ""


class Problem(NamedTuple):
    """An error found by pydantic: its type, table and key, and the given value."""

    kind: str
    place: tuple[int | str, ...]
    value: Any


def _tables() -> dict[str, type[Table]]:
    """Return the tables of a scene file by name: a key may belong to another one."""
    tables = {table.__name__.lower(): table for table in Table.__subclasses__()}
    return {name: table for name, table in tables.items() if name not in ("scene", "material")}


def problems_of(error: ValidationError, table: str = "") -> Iterator[Problem]:
    """Yield the errors that pydantic found in single keys, of a table or of a scene."""
    for item in error.errors(include_url=False):
        if item["type"] != CONFLICT:
            place = (table, *item["loc"]) if table else item["loc"]
            yield Problem(item["type"], place, item["input"])


def problems(
    mistakes: Iterable[Problem], data: Mapping[str, Any], tables: Mapping[str, type[Table]]
) -> Problems:
    """Return all problems of single keys and of combinations of keys.

    Parameters
    ----------
    mistakes
        Errors of single keys.
    data
        The given tables by name.
    tables
        The known tables by name.
    """
    fields = {name: dict(table.model_fields) for name, table in tables.items()}
    messages: dict[tuple[object, ...] | str, Callable[[], str]] = {}
    for kind, place, value in mistakes:
        if kind == "too_short" and any(key[:1] == (place[:2],) for key in messages):
            continue  # a list without its invalid items
        # Pydantic reports an error for each allowed type of a key; the first is enough.
        messages.setdefault((place[:2], shown(value)), partial(explain, kind, place, value, fields))
    # Pydantic checks combinations only if each key is valid; here all problems are reported.
    for name, table in tables.items():
        if isinstance(data.get(name), Mapping):
            messages |= {text: partial(str, text) for text in table.conflicts(data[name])}
    return list(messages.values())


def in_words(texts: Sequence[Callable[[], str]]) -> str:
    """Return the message of one problem, or a list of several."""
    return texts[0]() if len(texts) == 1 else listed(texts)


def plain_keys(keys: Mapping[str, Any]) -> dict[str, Any]:
    """Return the keys with NumPy's values without a dimension converted to those of Python."""
    return {key: _plain_number(value) for key, value in keys.items()}


def _plain_number(value: Any) -> Any:
    if getattr(value, "shape", None) == ():
        value = value.item()
    if isinstance(value, (bool, int)) or not isinstance(value, Real):
        return value
    return int(value) if isinstance(value, Integral) else float(value)


def is_number(value: Any) -> TypeGuard[float]:
    """Return whether a value is a number within the range of double precision."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return False
    return abs(value) < sys.float_info.max

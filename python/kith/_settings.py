"""Keys of study files as keyword arguments and dictionaries."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

_PLAIN = set("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-")


def toml_key(name: object) -> str:
    """A key as TOML writes it."""
    if not isinstance(name, str):
        raise TypeError(f"keys of a study are text, not {name!r}")
    return name if name and set(name) <= _PLAIN else _text(name)


def _text(text: str) -> str:
    escapes = {"\\": "\\\\", '"': '\\"', "\n": "\\n", "\t": "\\t", "\r": "\\r"}
    body = "".join(escapes.get(c, c if c.isprintable() else f"\\u{ord(c):04x}") for c in text)
    return f'"{body}"'


def toml_value(value: Any) -> str:
    """A value as TOML writes it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{toml_key(k)} = {toml_value(v)}" for k, v in value.items()) + " }"
    if hasattr(value, "tolist"):  # numbers and arrays of numpy
        return toml_value(value.tolist())
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return repr(value)
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(toml_value(one) for one in value) + "]"
    raise TypeError(f"a study cannot hold {type(value).__name__}: {value!r}")


def toml_text(table: Mapping[str, Any], path: str = "") -> str:
    """A dictionary as a TOML file."""
    lines = []
    tables = []
    for name, value in table.items():
        is_list_of_tables = isinstance(value, (list, tuple)) and bool(value) and all(isinstance(v, Mapping) for v in value)
        if isinstance(value, Mapping) or is_list_of_tables:
            tables.append((path + toml_key(name), value))
        else:
            lines.append(f"{toml_key(name)} = {toml_value(value)}\n")
    for name, value in tables:
        for one in [value] if isinstance(value, Mapping) else value:
            head = f"[{name}]" if isinstance(value, Mapping) else f"[[{name}]]"
            lines.append(f"\n{head}\n{toml_text(one, name + '.')}")
    return "".join(lines)


def overrides(settings: Mapping[str, Any], path: str = "") -> Iterator[str]:
    """"KEY=VALUE" for every setting: {"teacher": {"particles": 500}} is teacher.particles=500.

    A table with dotted names of its own, such as design.vary, is one value."""
    for name, value in settings.items():
        if not isinstance(name, str):
            raise TypeError(f"settings are named by text, not {name!r}")
        if isinstance(value, Mapping) and value and not any("." in str(key) for key in value):
            yield from overrides(value, f"{path}{name}.")
        else:
            yield f"{path}{name}={toml_value(value)}"

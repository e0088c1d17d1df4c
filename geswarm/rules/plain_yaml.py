"""YAML as far as rule sets, scenarios and runs use it: without aliases, and bounded."""

from __future__ import annotations

from typing import Any

import yaml

from geswarm.rules.findings import shown
from geswarm.rules.limits import too_long


class YamlError(ValueError):
    """A text is not YAML of this kind.

    Attributes:
        line: Where, from 1; None if that cannot be told.
    """

    def __init__(self, message: str, line: int | None = None) -> None:
        super().__init__(message)
        self.line = line


class _Loader(yaml.SafeLoader):
    """SafeLoader without aliases, by which a short text can stand for a huge value."""

    def compose_node(self, parent: yaml.Node | None, index: int) -> yaml.Node | None:
        if self.check_event(yaml.AliasEvent):
            mark = self.peek_event().start_mark  # type: ignore[no-untyped-call]
            raise yaml.MarkedYAMLError(problem="aliases are not read", problem_mark=mark)
        return super().compose_node(parent, index)


def compose(text: str) -> yaml.Node | None:
    """The tree of a text, whose nodes know their lines; None if there is nothing in it.

    Raises:
        YamlError: It is not YAML, has aliases, is too long or nested too deeply.
    """
    if message := too_long(text):
        raise YamlError(message)
    try:
        return _Loader(text).get_single_node()
    except yaml.MarkedYAMLError as error:
        line = error.problem_mark.line + 1 if error.problem_mark else None
        problem = error.problem or error.context or "syntax error"
        raise YamlError(f"not valid YAML: {problem}", line) from error
    except (yaml.YAMLError, ValueError, OverflowError) as error:  # the latter for some escapes
        raise YamlError(f"not valid YAML: {str(error).splitlines()[0]}") from error
    except RecursionError:
        raise YamlError("nested too deeply") from None


def load(text: str) -> Any:
    """The value of a text; None if there is nothing in it.

    Raises:
        YamlError: See `compose` and `value_of`.
    """
    node = compose(text)
    return None if node is None else value_of(node)


def value_of(node: yaml.Node) -> Any:
    """The value of a node: a scalar, a list, or a dict whose keys are text.

    Raises:
        YamlError: A scalar is not what its tag says, or a key is not text or is there twice.
    """
    line = node.start_mark.line + 1
    if isinstance(node, yaml.SequenceNode):
        return [value_of(item) for item in node.value]
    if isinstance(node, yaml.MappingNode):
        found: dict[str, Any] = {}
        for key, value in node.value:
            if not isinstance(key, yaml.ScalarNode):
                raise YamlError("expected text as keys", line)
            if key.value in found:
                raise YamlError(f"{shown(key.value)} is given twice", key.start_mark.line + 1)
            found[key.value] = value_of(value)
        return found
    try:
        return _Loader("").construct_object(node)
    except (yaml.YAMLError, ValueError, LookupError, AttributeError, ArithmeticError) as error:
        # PyYAML raises any of these for a scalar that its tag or its form does not suit.
        raise YamlError("cannot be understood", line) from error

"""Where rule sets are found: presets, files and standard input; and how they are saved."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable
from pathlib import Path

from geswarm.drafts import draft_of
from geswarm.plain_text import NotTextError, read_file, read_stream, tidy
from geswarm.rules.as_json import format_json, parse_json
from geswarm.rules.findings import Finding, Place, RuleSetError, unknown_name
from geswarm.rules.limits import MAX_CHARACTERS, require_size, too_long
from geswarm.rules.model import RuleSet
from geswarm.rules.text import format_text, parse_text
from geswarm.rules.vocabulary import FORAGING, Vocabulary
from geswarm.rules.yaml_form import format_yaml, parse_yaml

_PRESETS = Path(__file__).parent / "presets"
_LOOKS_LIKE_YAML = re.compile(r"^\s*(schema|name|comment|origin|rules)\s*:", re.MULTILINE)

FORMATS: dict[str, Callable[[RuleSet], str]] = {
    "yaml": format_yaml,
    "text": format_text,
    "json": format_json,
}
"""The forms that carry a whole rule set: `read_rule_set` reads each of them back."""


class RuleSetNotFoundError(RuleSetError):
    """There is no preset and no readable file of that name."""


def preset_names() -> list[str]:
    """Names of the rule sets that come with GESwarm."""
    return sorted(path.stem for path in _PRESETS.glob("*.yaml"))


def load_preset(name: str, vocabulary: Vocabulary = FORAGING) -> RuleSet:
    """One of `preset_names()`.

    Raises:
        RuleSetError: There is no such preset.
    """
    if name not in preset_names():
        raise RuleSetError([Finding(Place(), unknown_name("preset", name, preset_names()))])
    path = _PRESETS / f"{name}.yaml"
    return parse_yaml(path.read_text(encoding="utf-8"), str(path), vocabulary)


def load_rule_set(reference: str, vocabulary: Vocabulary = FORAGING) -> RuleSet:
    """Load what a user names: a preset, a YAML, text or JSON file, or `-` for standard input.

    Raises:
        RuleSetNotFoundError: There is neither a preset nor a readable file of that name.
        RuleSetError: It is not a rule set; every reason is listed.
    """
    if reference in preset_names():
        return load_preset(reference, vocabulary)
    source = "<stdin>" if reference == "-" else reference
    try:
        text = _read_stdin() if reference == "-" else read_file(reference, MAX_CHARACTERS)
    except NotTextError as error:
        raise RuleSetError([Finding(Place(source), str(error))]) from error
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        hint = f"neither a file ({reason}) nor a preset ({', '.join(preset_names())})"
        if reference == "-":
            hint = f"cannot be read: {reason}"
        raise RuleSetNotFoundError([Finding(Place(source), hint)]) from error
    return read_rule_set(text, source, vocabulary)


def _read_stdin() -> str:
    if sys.stdin is None:
        raise OSError("it is closed")
    stream = getattr(sys.stdin, "buffer", None)  # none where something else stands for it
    if stream is None:
        return sys.stdin.read(MAX_CHARACTERS + 1)
    return read_stream(stream, MAX_CHARACTERS)


def read_rule_set(text: str, source: str = "", vocabulary: Vocabulary = FORAGING) -> RuleSet:
    """Read YAML, JSON or the rule language, whichever the text is.

    Raises:
        RuleSetError: With every problem, each with file, line, rule and element.
    """
    text = tidy(text)
    if message := too_long(text):
        raise RuleSetError([Finding(Place(source), message)])
    if source.endswith(".json") or text.lstrip().startswith("{"):
        parse = parse_json
    elif source.endswith((".yaml", ".yml")) or _LOOKS_LIKE_YAML.search(text):
        parse = parse_yaml
    else:
        parse = parse_text
    rule_set = parse(text, source, vocabulary)
    require_size(rule_set, source)
    return rule_set


def save_rule_set(rule_set: RuleSet, path: str | Path) -> None:
    """Write a file, as YAML or JSON if its name ends so, else in the rule language.

    The file is replaced as a whole, so that a failure leaves the old one as it was.

    Raises:
        OSError: The file cannot be written.
    """
    forms = {".yaml": format_yaml, ".yml": format_yaml, ".json": format_json}
    write_whole(forms.get(Path(path).suffix, format_text)(rule_set), path)


def write_whole(text: str, path: str | Path, through_links: bool = True) -> None:
    """Replace a file as a whole: a failure leaves the old one as it was.

    What is no plain file, such as a pipe or a link, is written to instead of replaced.

    Args:
        text: What will be in it.
        path: The file.
        through_links: False in directories that may come from somebody else, whose links may lead
            anywhere: they are replaced too.

    Raises:
        OSError: The file cannot be written.
    """
    path = Path(path)
    link = path.is_symlink()
    if (link and through_links) or (not link and path.exists() and not path.is_file()):
        path.write_text(text, encoding="utf-8", errors="backslashreplace")
        return
    with (
        draft_of(path) as draft,
        draft.open("x", encoding="utf-8", errors="backslashreplace") as file,  # a new one, no link
    ):
        file.write(text)

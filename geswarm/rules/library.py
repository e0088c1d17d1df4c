"""Where rule sets are found: presets, files and standard input; and how they are saved."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Literal, TypeAlias

from geswarm.drafts import draft_of
from geswarm.plain_text import NotTextError, read_file, read_stream, tidy
from geswarm.rules.anything import ANYTHING
from geswarm.rules.as_json import format_json, parse_json
from geswarm.rules.findings import Finding, Place, RuleSetError, unknown_name
from geswarm.rules.limits import MAX_CHARACTERS, require_size, too_long
from geswarm.rules.model import RuleSet
from geswarm.rules.names import unknown_terms
from geswarm.rules.text import format_text, parse_text
from geswarm.rules.vocabulary import FORAGING, Vocabulary
from geswarm.rules.yaml_form import format_yaml, parse_yaml

_PRESETS = Path(__file__).parent / "presets"
_LOOKS_LIKE_YAML = re.compile(r"^\s*(schema|name|scenario|comment|origin|rules)\s*:", re.MULTILINE)
_LOOKS_LIKE_AUTOMODE = re.compile(
    r"^[^#\n]*--(fsm-config|bt-config|nstates|nroot)(?![\w-])", re.MULTILINE
)

Form: TypeAlias = Literal["yaml", "text", "json", "automode"]
_PARSERS = {"yaml": parse_yaml, "text": parse_text, "json": parse_json}

FORMATS: dict[str, Callable[[RuleSet], str]] = {
    "yaml": format_yaml,
    "text": format_text,
    "json": format_json,
}
"""The forms that carry a whole rule set: `read_rule_set` reads each of them back."""

_AUTOMODE = (
    "expected a rule set, got a controller of AutoMoDe; "
    "`geswarm import FILE --from automode -o RULES` writes it as rules"
)


class RuleSetNotFoundError(RuleSetError):
    """There is no preset and no readable file of that name."""


@lru_cache(maxsize=64)
def preset_names(vocabulary: Vocabulary | None = FORAGING) -> tuple[str, ...]:
    """Names of the rule sets that come with GESwarm, for one vocabulary or, if None, for any."""
    names = sorted(path.stem for path in _PRESETS.glob("*.yaml"))
    return tuple(name for name in names if vocabulary is None or _can_be_read(name, vocabulary))


def _can_be_read(name: str, vocabulary: Vocabulary) -> bool:
    try:
        load_preset(name, vocabulary)
    except RuleSetError:
        return False
    return True


def load_preset(name: str, vocabulary: Vocabulary = FORAGING) -> RuleSet:
    """One of `preset_names(None)`.

    Raises:
        RuleSetError: There is no such preset, or it mentions what the vocabulary does not have.
    """
    if name not in preset_names(None):
        raise RuleSetError([Finding(Place(), unknown_name("preset", name, preset_names(None)))])
    path = _PRESETS / f"{name}.yaml"
    return read_rule_set(path.read_text(encoding="utf-8"), str(path), vocabulary)


@dataclass(frozen=True)
class RuleSetText:
    """A rule set that was found, and not yet understood: its text, and where that comes from."""

    text: str
    source: str

    @cached_property
    def scenario(self) -> str:
        """The scenario in whose words it says that it is written; empty if it does not say."""
        try:
            return read_rule_set(self.text, self.source, ANYTHING).scenario
        except RuleSetError as error:
            return error.scenario

    def read(self, vocabulary: Vocabulary = FORAGING, offered_by: str = "") -> RuleSet:
        """Understand it; see `read_rule_set`."""
        return read_rule_set(self.text, self.source, vocabulary, offered_by)


def load_rule_set(
    reference: str, vocabulary: Vocabulary = FORAGING, offered_by: str = ""
) -> RuleSet:
    """Load what a user names: a preset, a YAML, text or JSON file, or `-` for standard input.

    Args:
        reference: Which.
        vocabulary: What it may mention.
        offered_by: The scenario whose vocabulary that is, for messages.

    Raises:
        RuleSetNotFoundError: There is neither a preset nor a readable file of that name.
        RuleSetError: It is not a rule set; every reason is listed.
    """
    return find_rule_set(reference).read(vocabulary, offered_by)


def find_rule_set(reference: str) -> RuleSetText:
    """What a user names, as for `load_rule_set`, to be read when its vocabulary is known.

    Raises:
        RuleSetNotFoundError: There is neither a preset nor a readable file of that name.
        RuleSetError: It is not text.
    """
    if reference in preset_names(None):
        path = _PRESETS / f"{reference}.yaml"
        return RuleSetText(path.read_text(encoding="utf-8"), str(path))
    source = "<stdin>" if reference == "-" else reference
    try:
        text = read_stdin() if reference == "-" else read_file(reference, MAX_CHARACTERS)
    except NotTextError as error:
        raise RuleSetError([Finding(Place(source), str(error))]) from error
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        hint = f"neither a file ({reason}) nor a preset ({', '.join(preset_names(None))})"
        if reference == "-":
            hint = f"cannot be read: {reason}"
        raise RuleSetNotFoundError([Finding(Place(source), hint)]) from error
    return RuleSetText(text, source)


def read_stdin() -> str:
    """All text of standard input, or so much of it that it can be told to be too long.

    Raises:
        OSError: It cannot be read.
        NotTextError: It is not text in UTF-8.
    """
    if sys.stdin is None:
        raise OSError("it is closed")
    stream = getattr(sys.stdin, "buffer", None)  # none where something else stands for it
    if stream is None:
        return sys.stdin.read(MAX_CHARACTERS + 1)
    return read_stream(stream, MAX_CHARACTERS)


def read_rule_set(
    text: str, source: str = "", vocabulary: Vocabulary = FORAGING, offered_by: str = ""
) -> RuleSet:
    """Read YAML, JSON or the rule language, whichever the text is.

    Args:
        text: Of the rule set.
        source: Where it comes from, for messages.
        vocabulary: What it may mention.
        offered_by: The scenario whose vocabulary that is, for messages.

    Raises:
        RuleSetError: With every problem, each with file, line, rule and element; of one written for
            another scenario, also what of it is not on offer here.
    """
    text = tidy(text)
    if message := too_long(text):
        raise RuleSetError([Finding(Place(source), message)])
    form = form_of(text, source)
    if form == "automode":
        raise RuleSetError([Finding(Place(source), _AUTOMODE)])
    try:
        rule_set = _PARSERS[form](text, source, vocabulary)
    except RuleSetError as error:
        if not error.scenario or error.scenario == offered_by or vocabulary is ANYTHING:
            raise
        each_once = {finding.message: finding for finding in reversed(error.findings)}
        found = [finding for finding in error.findings if finding in each_once.values()]
        found += _foreign(RuleSetText(text, source), vocabulary, error.scenario, offered_by)
        raise RuleSetError(found, error.scenario) from error
    require_size(rule_set, source)
    return rule_set


def form_of(text: str, source: str = "") -> Form:
    """In which form something is that a user names; a controller of AutoMoDe is no rule set."""
    if source.endswith(".json") or text.lstrip().startswith("{"):
        return "json"
    if source.endswith((".yaml", ".yml")) or _LOOKS_LIKE_YAML.search(text):
        return "yaml"
    return "automode" if _LOOKS_LIKE_AUTOMODE.search(text) else "text"


def _foreign(
    found: RuleSetText, vocabulary: Vocabulary, written_for: str, offered_by: str
) -> Iterator[Finding]:
    """What a rule set for another scenario mentions that is not on offer here."""
    try:
        unknown = unknown_terms(found.read(ANYTHING), vocabulary)
    except RuleSetError:  # there is more wrong with it
        return
    if unknown:
        names = ", ".join(unknown)
        here = (
            f"{offered_by} does not offer {names}" if offered_by else f"not on offer here: {names}"
        )
        yield Finding(Place(found.source), f"written for scenario {written_for}; {here}")


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

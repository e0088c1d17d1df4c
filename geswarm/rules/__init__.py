"""What a rule set is: vocabulary, frozen model, text and YAML, checks, control table, presets.

>>> from geswarm.rules import load_rule_set, format_text
>>> evo8 = load_rule_set("evo8")
>>> print(format_text(evo8.__class__(evo8.rules[:1], name="EVO 8, R1")))
name "EVO 8, R1"
<BLANKLINE>
# The switch to random walk for object exploration is probabilistic and can happen any time
rule
  while PHOTOTAXIS
  do p = 0.05, RANDOM_WALK
<BLANKLINE>
"""

from geswarm.rules.check import check
from geswarm.rules.compare import Difference, first_difference, same_behaviour
from geswarm.rules.control_table import ControlTable, Indexing
from geswarm.rules.edits import EditError, apply_edit
from geswarm.rules.english import describe, describe_rule
from geswarm.rules.findings import Finding, Place, RuleSetError
from geswarm.rules.library import (
    FORMATS,
    RuleSetNotFoundError,
    load_preset,
    load_rule_set,
    preset_names,
    read_rule_set,
    save_rule_set,
)
from geswarm.rules.model import (
    Action,
    BehaviourChange,
    Origin,
    Precondition,
    Rule,
    RuleSet,
    StateChange,
)
from geswarm.rules.paper_table import format_table
from geswarm.rules.simplify import Simplification, simplify
from geswarm.rules.text import format_text, parse_text
from geswarm.rules.vocabulary import FORAGING, Vocabulary
from geswarm.rules.yaml_form import format_yaml, parse_yaml

__all__ = [
    "FORAGING",
    "FORMATS",
    "Action",
    "BehaviourChange",
    "ControlTable",
    "Difference",
    "EditError",
    "Finding",
    "Indexing",
    "Origin",
    "Place",
    "Precondition",
    "Rule",
    "RuleSet",
    "RuleSetError",
    "RuleSetNotFoundError",
    "Simplification",
    "StateChange",
    "Vocabulary",
    "apply_edit",
    "check",
    "describe",
    "describe_rule",
    "first_difference",
    "format_table",
    "format_text",
    "format_yaml",
    "load_preset",
    "load_rule_set",
    "parse_text",
    "parse_yaml",
    "preset_names",
    "read_rule_set",
    "same_behaviour",
    "save_rule_set",
    "simplify",
]

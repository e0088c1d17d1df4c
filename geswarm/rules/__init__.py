"""What a rule set is: vocabulary, frozen model, text and YAML, checks, control table, presets.

>>> from geswarm.rules import describe, first_difference, load_rule_set, parse_text
>>> evo8 = load_rule_set("evo8")
>>> describe(parse_text("rule if ON_NEST == true do p = 1, DROP_OBJECT = true"))
['When in the nest, drop the object.']
>>> difference = first_difference(evo8, parse_text("rule do p = 0.5, PHOTOTAXIS"))
>>> difference.first
{'keep going to the light': 0.95, 'start walking at random': 0.05}
>>> difference.second
{'keep going to the light': 1.0}
"""

from geswarm.rules.as_json import format_json, parse_json
from geswarm.rules.check import check
from geswarm.rules.compare import Difference, first_difference, same_behaviour
from geswarm.rules.conditions import Condition
from geswarm.rules.control_table import ControlTable
from geswarm.rules.edits import EditError, apply_edit
from geswarm.rules.english import describe, describe_rule
from geswarm.rules.findings import Finding, Place, RuleSetError
from geswarm.rules.library import (
    FORMATS,
    RuleSetNotFoundError,
    RuleSetText,
    find_rule_set,
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
    Term,
)
from geswarm.rules.paper_table import format_table
from geswarm.rules.simplify import Simplification, simplify
from geswarm.rules.space import Space
from geswarm.rules.state_machine import State, StateMachine, Transition
from geswarm.rules.text import format_text, parse_text
from geswarm.rules.vocabulary import FORAGING, Vocabulary
from geswarm.rules.yaml_form import format_yaml, parse_yaml

__all__ = [
    "FORAGING",
    "FORMATS",
    "Action",
    "BehaviourChange",
    "Condition",
    "ControlTable",
    "Difference",
    "EditError",
    "Finding",
    "Origin",
    "Place",
    "Precondition",
    "Rule",
    "RuleSet",
    "RuleSetError",
    "RuleSetNotFoundError",
    "RuleSetText",
    "Simplification",
    "Space",
    "State",
    "StateChange",
    "StateMachine",
    "Term",
    "Transition",
    "Vocabulary",
    "apply_edit",
    "check",
    "describe",
    "describe_rule",
    "find_rule_set",
    "first_difference",
    "format_json",
    "format_table",
    "format_text",
    "format_yaml",
    "load_preset",
    "load_rule_set",
    "parse_json",
    "parse_text",
    "parse_yaml",
    "preset_names",
    "read_rule_set",
    "same_behaviour",
    "save_rule_set",
    "simplify",
]

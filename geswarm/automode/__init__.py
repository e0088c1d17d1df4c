"""Controllers of AutoMoDe: finite-state machines, behaviour trees, and what rules can say of them.

>>> from geswarm.automode import format_controller, read_controllers
>>> text = "--fsm-config --nstates 2 --s0 0 --rwm0 5 --n0 1 --n0x0 0 --c0x0 0 --p0x0 .5 --s1 1"
>>> (machine,) = read_controllers(text)
>>> format_controller(machine) == text
True
"""

from geswarm.automode.as_rules import Conversion, to_rules
from geswarm.automode.departures import Departure
from geswarm.automode.from_rules import Expressed, from_rules
from geswarm.automode.machine import Machine, State, Transition
from geswarm.automode.machine_text import format_machine
from geswarm.automode.modules import Behaviour, Condition
from geswarm.automode.named import NamedText, Runnable, find_controllers
from geswarm.automode.options import AutoMoDeError
from geswarm.automode.prose import describe
from geswarm.automode.steps import START, Situation, next_situations
from geswarm.automode.text import (
    Controller,
    format_controller,
    read_controllers,
    read_machines,
    read_trees,
)
from geswarm.automode.ticks import Ticked, tick
from geswarm.automode.tree import Action, Check, Control, Tree
from geswarm.automode.tree_text import format_tree

__all__ = [
    "START",
    "Action",
    "AutoMoDeError",
    "Behaviour",
    "Check",
    "Condition",
    "Control",
    "Controller",
    "Conversion",
    "Departure",
    "Expressed",
    "Machine",
    "NamedText",
    "Runnable",
    "Situation",
    "State",
    "Ticked",
    "Transition",
    "Tree",
    "describe",
    "find_controllers",
    "format_controller",
    "format_machine",
    "format_tree",
    "from_rules",
    "next_situations",
    "read_controllers",
    "read_machines",
    "read_trees",
    "tick",
    "to_rules",
]

"""AutoMoDe's text form of a state machine, as far as the tests need it."""

from geswarm.rules.model import Term
from geswarm.sim.controllers.machines import Machine, State, Transition

BEHAVIOURS = ("EXPLORATION", "STOP", "PHOTOTAXIS", "ANTI-PHOTOTAXIS", "ATTRACTION", "REPULSION")
PARAMETERS = {0: "rwm", 4: "att", 5: "rep"}
CONDITIONS = ("black", "grey", "white", "neighbours", "few-neighbours", "fixed")


def machine_of(text):
    words = text.split()
    given = dict(zip(words[::2], words[1::2], strict=True))
    states = []
    for a in range(int(given["--nstates"])):
        kind = int(given[f"--s{a}"])
        # Published code keeps gains in eight bits: 4.59 acts as 4.
        own = (int(float(given[f"--{PARAMETERS[kind]}{a}"])),) if kind in PARAMETERS else ()
        ways = []
        for b in range(int(given.get(f"--n{a}", 0))):
            target = int(given[f"--n{a}x{b}"])
            condition = CONDITIONS[int(given[f"--c{a}x{b}"])]
            p, w = float(given[f"--p{a}x{b}"]), float(given.get(f"--w{a}x{b}", 0))
            p = int(p) if "neighbours" in condition else p
            ways.append(Transition(condition, target if target < a else target + 1, p, w))
        states.append(State(Term(BEHAVIOURS[kind], own), tuple(ways)))
    return Machine(tuple(states))

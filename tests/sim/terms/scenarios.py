"""Scenarios that offer what foraging does not, and any rules of their vocabularies."""

from hypothesis import strategies as st

from geswarm.rules import BehaviourChange, Precondition, Rule, RuleSet, StateChange, Term
from geswarm.sim import load_scenario, parse_scenario

AAC = load_scenario("aac")
REMEMBERING = AAC.with_changes(
    name="remembering",
    duration=30.0,
    zone_miss=0.2,
    registers=("MODE(red, green, blue)", "HUNGER(0..5)"),
    measures=("on_black", "on_white", "larger_group", "max_group"),
)
"""Robots with a mode and a counter that rules may read; groups are measured."""

COUNTING = REMEMBERING.with_changes(
    name="counting", behaviours=("PHOTOTAXIS", "ANTI-PHOTOTAXIS", "RANDOM_WALK", "STOP")
)
"""The same with few enough behaviours for all decisions to be counted."""

MEETING = COUNTING.with_changes(
    name="meeting",
    zone_miss=0.2,
    preconditions=("ON_BLACK", "ON_WHITE", "CROWDED", "ALONE"),
    registers=("MODE(red, green, blue)",),
)
"""Robots that count others, and take them for many or few by chance."""

SENSING = parse_scenario(
    """
extends: nothing
robots: 10
objects: 4
duration: 30
arena:
  rectangle: [2.0, 2.4]
  obstacles: [{disc: {at: [-0.4, 0.2], radius: 0.1}}]
  patches:
    - {disc: {at: [0.4, 0.6], radius: 0.35}, floor: black, area: source}
    - {band: {side: south, depth: 1.0}, floor: white, area: nest}
  lights: [{at: [0.3, -1.5], height: 0.75, intensity: 9}]
object_range: 0.4
rab_range: 0.5
avoidance_range: 0.3
max_speed: 0.12
preconditions: [ON_SOURCE, ON_NEST, HAS_OBJECT, SEES_OBJECT, SEES_OBSTACLE, IS_CLOSE_TO, NEIGHBOURS,
                LIGHT, FLOOR]
behaviours: [STOP, PHOTOTAXIS, ANTI-PHOTOTAXIS, ATTRACTION, REPULSION,
             'RANDOM_WALK(shortest, longest)']
registers: [WANT_OBJECT, DROP_OBJECT]
measures: [picked, lost, on_nest]
objective: on_nest
""",
    "sensing",
)
"""Robots with every sensor and every behaviour, in an arena with something of everything."""


def terms(name, arguments):
    """A name with any arguments on offer."""
    offered = [st.sampled_from(each.offered) for each in arguments]
    return st.builds(Term, st.just(name), st.tuples(*offered))


def preconditions(vocabulary):
    def of(name, entry):
        return st.builds(
            Precondition,
            terms(name, entry.arguments),
            st.sampled_from(vocabulary.values_of(name)),
            st.sampled_from(vocabulary.comparisons_of(name)),
        )

    return st.one_of([of(*item) for item in vocabulary.percepts.items()])


def behaviours(vocabulary):
    return st.one_of([terms(entry.name, entry.arguments) for entry in vocabulary.behaviours])


def actions(vocabulary, probabilities):
    changes = [st.builds(BehaviourChange, probabilities, behaviours(vocabulary))]
    for entry in vocabulary.internal_states:
        operations = ("=", "+=", "-=") if entry.counts else ("=",)
        changes.append(
            st.builds(
                StateChange,
                probabilities,
                st.just(entry.name),
                st.sampled_from(entry.values),
                st.sampled_from(operations),
            )
        )
    return st.one_of(changes)


def rule_sets(vocabulary, most=3):
    """Any rules that a vocabulary allows, with arguments on offer."""
    probabilities = st.sampled_from([0.0, 0.1, 0.75, 1.0])
    rules = st.builds(
        Rule,
        st.lists(preconditions(vocabulary), max_size=2).map(tuple),
        st.lists(behaviours(vocabulary), max_size=1).map(tuple),
        st.lists(actions(vocabulary, probabilities), min_size=1, max_size=2).map(tuple),
    )
    return st.builds(RuleSet, st.lists(rules, max_size=most).map(tuple))

"""Hypothesis strategies shared by all tests: any rule set of the foraging vocabulary."""

from hypothesis import strategies as st

from geswarm.rules import (
    FORAGING,
    BehaviourChange,
    Origin,
    Precondition,
    Rule,
    RuleSet,
    StateChange,
)

preconditions = st.builds(
    Precondition, st.sampled_from(list(FORAGING.precondition_index)), st.booleans()
)
behaviours = st.sampled_from(list(FORAGING.behaviour_index))
states = st.sampled_from(list(FORAGING.state_index))
listed_probabilities = st.sampled_from(FORAGING.probabilities)
any_probabilities = st.one_of(listed_probabilities, st.floats(0, 1))


def actions(probabilities=listed_probabilities):
    return st.one_of(
        st.builds(BehaviourChange, probabilities, behaviours),
        st.builds(StateChange, probabilities, states, st.booleans()),
    )


def rules(probabilities=listed_probabilities, **extra):
    return st.builds(
        Rule,
        st.lists(preconditions, max_size=3).map(tuple),
        st.lists(behaviours, max_size=3).map(tuple),
        st.lists(actions(probabilities), min_size=1, max_size=4).map(tuple),
        **extra,
    )


def plain_rule_sets(max_rules=5, probabilities=listed_probabilities):
    """Rule sets as the grammar derives them: no names, no comments."""
    return st.builds(
        RuleSet, st.lists(rules(probabilities), min_size=1, max_size=max_rules).map(tuple)
    )


prose = st.text(max_size=60)
origins = st.builds(
    Origin,
    st.none() | prose,
    st.none() | prose,
    st.none() | st.integers(0, 10**9),
    st.none() | st.floats(allow_nan=False, allow_infinity=False),
)
documented_rule_sets = st.builds(
    RuleSet,
    st.lists(rules(any_probabilities, comment=prose, enabled=st.booleans()), max_size=4).map(tuple),
    name=prose,
    comment=prose,
    origin=origins,
    scenario=prose,
)
"""Rule sets as people keep them: with names, comments, origins and rules switched off."""

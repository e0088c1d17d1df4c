"""Hypothesis strategies and examples: any machine, any tree, and their texts."""

from hypothesis import strategies as st

from geswarm.automode import (
    Action,
    Behaviour,
    Check,
    Condition,
    Control,
    Machine,
    State,
    Transition,
    Tree,
)
from geswarm.automode.drawing import REGISTER
from geswarm.automode.modules import (
    BEHAVIOURS,
    CONDITIONS,
    FLOORS,
    TREE_BEHAVIOURS,
    TREE_CONDITIONS,
    Numeral,
)
from geswarm.rules import Vocabulary
from geswarm.rules.arguments import Number, Whole
from geswarm.rules.declarations import (
    BehaviourName,
    InternalStateName,
    PreconditionName,
    Reading,
)

AAC = (
    "--nstates 3 --s0 0 --rwm0 4 --n0 1 --n0x0 0 --c0x0 0 --p0x0 .5 "
    "--s1 1 --n1 2 --n1x0 0 --c1x0 2 --p1x0 0.25 --n1x1 1 --c1x1 3 --p1x1 2 --w1x1 3.50 "
    "--s2 4 --att2 3 --n2 1 --n2x0 1 --c2x0 4 --p2x0 2 --w2x0 1e1"
)
FLEE = (
    "--nroot 3 --nchildroot 2 --n0 0 --nchild0 2 --n00 6 --c00 3 --p00 4 --w00 2.5 "
    "--n01 5 --a01 0 --rwm01 5 --p01 0.1 --n1 4 --nchild1 1 --n10 5 --a10 8 --r10 3 --p10 0"
)


def numbers(parameter):
    """As people write them."""
    if parameter.whole:
        return st.integers(int(parameter.low), int(parameter.high)).map(str).map(Numeral)
    written = st.floats(parameter.low, parameter.high)
    return (
        written.flatmap(lambda x: st.sampled_from([repr(x), f"{x:.2f}", f"+{x!r}", f"{x:.6e}"]))
        .map(Numeral)
        .filter(parameter.admits)
    )


def _modules(known, build):
    return st.sampled_from(list(known.values())).flatmap(
        lambda module: st.tuples(*map(numbers, module.parameters)).map(
            lambda given: build(module.number, *given)
        )
    )


behaviours = _modules(BEHAVIOURS, Behaviour)
conditions = _modules(CONDITIONS, Condition)


@st.composite
def machines(draw, most=4):
    count = draw(st.integers(1, most))
    states = []
    for number in range(count):
        others = [each for each in range(count) if each != number]
        transitions = (
            st.lists(st.builds(Transition, st.sampled_from(others), conditions), max_size=4)
            if others
            else st.just([])
        )
        states.append(State(draw(behaviours), tuple(draw(transitions))))
    return Machine(tuple(states))


_leaves = st.one_of(
    st.builds(Action, _modules(TREE_BEHAVIOURS, Behaviour), st.floats(0, 1)),
    st.builds(Check, _modules(TREE_CONDITIONS, Condition)),
)


def _controls(children):
    several = st.lists(children, min_size=1, max_size=3).map(tuple)
    return st.one_of(
        st.builds(Control, st.integers(0, 3), several),
        st.builds(lambda child: Control(4, (child,)), children),
    )


def _nodes(levels):
    return _leaves if levels == 1 else st.one_of(_leaves, _controls(_nodes(levels - 1)))


trees = st.builds(Tree, _controls(_nodes(3)))


def vocabulary(values):
    """What a scenario has to offer; what makes a neighbour count true is not in it."""
    counts = (Whole("xi", 1, 10), Number("eta", 0, 20, 0.5))
    arguments = {
        "EXPLORATION": (Whole("rwm", 1, 100),),
        "ATTRACTION": (Number("gain", 1, 5, 0.5),),
        "REPULSION": (Number("gain", 1, 5, 0.5),),
    }
    return Vocabulary(
        (
            PreconditionName("FLOOR", "on {value}", "not on {value}", "floor"),
            *(
                PreconditionName(name, name, name, "heard", counts, lambda n, xi, eta: n >= xi)
                for name in ("CROWDED", "ALONE")
            ),
        ),
        tuple(
            BehaviourName(
                each.term, each.term, each.term, not each.number, arguments.get(each.term, ())
            )
            for each in BEHAVIOURS.values()
        ),
        (
            InternalStateName(
                REGISTER, "{value}", initially=values[0], readable=True, values=values
            ),
        ),
        (0.5, 1.0),
        "STOP",
        readings=(Reading("floor", FLOORS), Reading("heard", tuple(range(20)))),
    )

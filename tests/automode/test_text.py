"""Controllers are read as they are written, and everything wrong is told with its place."""

import pickle

import pytest
from hypothesis import given
from hypothesis import strategies as st

from geswarm.automode import (
    AutoMoDeError,
    Behaviour,
    Check,
    Condition,
    Control,
    Machine,
    State,
    Transition,
    describe,
    format_controller,
    format_machine,
    format_tree,
    read_controllers,
    read_machines,
    read_trees,
)
from tests.automode.machines import AAC, FLEE, machines, trees


def problems(text, read=read_controllers):
    with pytest.raises(AutoMoDeError) as caught:
        read(text, "x.txt")
    return [str(each) for each in caught.value.findings]


@given(machines())
def test_machines_are_read_as_they_are_written(machine):
    text = format_machine(machine)
    (back,) = read_machines(text)
    assert back == machine
    assert format_machine(back) == text
    assert pickle.loads(pickle.dumps(back)) == machine


@given(trees)
def test_trees_are_read_as_they_are_written(tree):
    text = format_tree(tree)
    assert read_trees(text) == (tree,)
    assert read_controllers(f"--bt-config {text}") == (tree,)


def test_numbers_keep_their_spelling():
    assert format_machine(*read_machines(AAC)) == AAC
    assert format_tree(*read_trees(FLEE)) == FLEE
    assert format_controller(*read_controllers(AAC)) == f"--fsm-config {AAC}"


@pytest.mark.parametrize(
    "text",
    [
        f"--fsm-config {AAC}",
        f'"{AAC}"',
        f"\ufeff# found in a file\r\n\r\n  --fsm-config '{AAC}'  # the best\r\n",
        f"bin/automode_main -c aac.argos --seed 3 --fsm-config {AAC}",
    ],
)
def test_names_quotes_comments_and_command_lines_are_read(text):
    assert read_controllers(text) == read_machines(AAC)


def test_each_line_is_one_controller():
    both = read_controllers(f"{AAC}\n# and\n--bt-config {FLEE}\n")
    assert [type(each).__name__ for each in both] == ["Machine", "Tree"]


def test_targets_count_the_other_states():
    (machine,) = read_machines(AAC)
    targets = [[each.target for each in state.transitions] for state in machine.states]
    assert targets == [[1], [0, 2], [1]]


MACHINE_ERRORS = {
    "": [": expected a machine such as --nstates 1 --s0 1, or a tree, found none"],
    "--fsm-config": [
        ":1: column 1: expected a machine such as --nstates 1 --s0 1, or a tree behind "
        "--fsm-config, got nothing"
    ],
    "--s0 1": [":1: column 1: expected --nstates (how many states), found none"],
    "\n--nstates 5 --s0 1": [
        ":2: column 11: --nstates: expected a whole number from 1 to 4 (how many states), got '5'"
    ],
    "--nstates 1 --s0 7": [
        ":1: column 18: --s0: expected a whole number from 0 to 5 (0 exploration, 1 stop, 2 "
        "phototaxis, 3 anti-phototaxis, 4 attraction, 5 repulsion), got '7'"
    ],
    "--nstates 1 --s0 0": [
        ":1: column 13: expected --rwm0 for --s0 (longest turn, steps), found none"
    ],
    "--nstates 1 --s0 0 --rwm0 101": [
        ":1: column 27: --rwm0: expected a whole number from 1 to 100 (longest turn, steps), "
        "got '101'"
    ],
    "--nstates 1 --s0 1 --rwm0 5": [":1: column 20: --rwm0: --s0 1 is stop, which has none"],
    "--nstates 1 --s0 4 --att0 nan": [
        ":1: column 27: --att0: expected a number from 1 to 5 (gain), got 'nan'"
    ],
    "--nstates 1 --s0 4 --att0 1e999": [
        ":1: column 27: --att0: expected a number from 1 to 5 (gain), got '1e999'"
    ],
    "--nstates 1 --s0 1 --n0 1": [
        ":1: column 25: --n0: expected a whole number from 0 to 0 (how many transitions leave the "
        "state), got '1'"
    ],
    "--nstates 2 --s0 1 --n0x0 0 --s1 1": [
        ":1: column 20: --n0x0: expected --n0, how many transitions leave state 0"
    ],
    "--nstates 2 --s0 1 --n0 5 --n0x0 0 --s1 1": [
        ":1: column 25: --n0: expected a whole number from 0 to 4 (how many transitions leave the "
        "state), got '5'"
    ],
    "--nstates 2 --s0 1 --n0 1 --n0x0 1 --c0x0 5 --p0x0 0.5 --s1 1": [
        ":1: column 34: --n0x0: expected a whole number from 0 to 0 (which of the other states), "
        "got '1'"
    ],
    "--nstates 2 --s0 1 --n0 2 --n0x0 0 --c0x0 9 --p0x0 8 --n0x1 0 --c0x1 3 --p0x1 0.5 --s1 1": [
        ":1: column 43: --c0x0: expected a whole number from 0 to 5 (0 black floor, 1 grey floor, "
        "2 white floor, 3 neighbour count, 4 inverted neighbour count, 5 fixed probability), "
        "got '9'",
        ":1: column 63: expected --w0x1 for --c0x1 (steepness, eta), found none",
        ":1: column 79: --p0x1: expected a number from 1 to 10 (neighbours, xi), got '0.5'",
    ],
    "--nstates 2 --s0 1 --n0 1 --n0x0 0 --c0x0 0 --p0x0 .5 --w0x0 1 --s1 1": [
        ":1: column 55: --w0x0: --c0x0 0 is black floor, which has none"
    ],
    "--nstates 2 --s0 1 --n0 1 --n0x0 0 --c0x0 0 --p0x0 .5 --n0x1 0 --s1 1": [
        ":1: column 55: --n0x1: --n0 is 1"
    ],
    "--nstates 1 --s0 1 --s0 1 three --sO 1 --n0": [
        ":1: column 20: --s0 is given twice, first in line 1, column 13",
        ":1: column 27: expected an option such as --n0, got 'three'",
        ":1: column 33: unknown option '--sO'; nothing here has such an option",
        ":1: column 40: --n0: expected a number behind it, got nothing",
    ],
    "--nstates 1 --s0 0 --rmw0 4": [
        ":1: column 13: expected --rwm0 for --s0 (longest turn, steps), found none",
        ":1: column 20: unknown option '--rmw0'; did you mean --rwm0?",
    ],
    "--nstates --s0 1": [":1: column 1: --nstates: expected a number behind it, got '--s0'"],
    "--nstates 2 --s0 0 --s1 1 --rwm0 4": [
        ":1: column 27: --rwm0: expected before --s1, where AutoMoDe looks for it"
    ],
}


@pytest.mark.parametrize("text", MACHINE_ERRORS)
def test_wrong_machines_are_explained(text):
    assert problems(text) == [f"x.txt{each}" for each in MACHINE_ERRORS[text]]


TREE_ERRORS = {
    "--nroot 5": [
        ":1: column 1: expected --nchildroot for --nroot (how many children), found none",
        ":1: column 9: --nroot: expected a whole number from 0 to 4 (0 selector, 1 selector*, 2 "
        "sequence, 3 sequence*, 4 negation), got '5'",
    ],
    "--nchildroot 1 --nroot 0 --n0 5 --a0 1 --p0 0": [
        ":1: column 1: expected --nroot first and --nchildroot behind it"
    ],
    "--nroot 4 --nchildroot 2 --n0 5 --a0 1 --p0 0": [
        ":1: column 24: --nchildroot: expected a whole number from 1 to 1 (how many children), "
        "got '2'"
    ],
    "--nroot 0 --nchildroot 1 --n0 5 --a0 1": [
        ":1: column 33: expected --p0 for --a0 (success probability), found none"
    ],
    "--nroot 0 --nchildroot 1 --n0 6 --a0 1 --p0 0": [
        ":1: column 26: expected --c0 for --n0 (0 black floor, 1 grey floor, 2 white floor, 3 "
        "neighbour count, 4 inverted neighbour count, 5 fixed probability, 6 light seen, 7 "
        "obstacle in front, 8 close to neighbours), found none",
        ":1: column 33: --a0: --n0 6 is a node of kind condition",
    ],
    "--nroot 0 --nchildroot 1 --n0 7 --a0 1 --p0 0 --n00 5": [
        ":1: column 31: --n0: expected a whole number from 0 to 6 (0 selector, 1 selector*, 2 "
        "sequence, 3 sequence*, 4 negation, 5 action, 6 condition), got '7'"
    ],
    "--nroot 0 --nchildroot 2 --n1 5 --a1 1 --p1 0 --n0 5 --a0 1 --p0 0": [
        ":1: column 47: --n0: expected before --n1, where AutoMoDe looks for it",
        ":1: column 54: --a0: expected before --n1, where AutoMoDe looks for it",
        ":1: column 61: --p0: expected before --n1, where AutoMoDe looks for it",
    ],
    "--nroot 0 --nchildroot 1 --n0 5 --p0 0 --a0 1": [
        ":1: column 33: --p0: expected behind --a0, where AutoMoDe looks for it"
    ],
    "--nroot 0 --nchildroot 1 --n0 6 --c0 8 --p0 0.5": [
        ":1: column 33: expected --d0 for --c0 (largest attraction vector), found none"
    ],
}


@pytest.mark.parametrize("text", TREE_ERRORS)
def test_wrong_trees_are_explained(text):
    assert problems(text) == [f"x.txt{each}" for each in TREE_ERRORS[text]]


def test_trees_are_at_most_five_levels_deep():
    deep = "--nroot 0 --nchildroot 1"
    for level in range(1, 200):
        name = "0" * level
        deep += f" --n{name} 0 --nchild{name} 1"
    (problem,) = problems(deep)
    assert "expected an action or a condition 5 levels below the root, got a selector" in problem


def test_errors_in_all_lines_are_told():
    assert [each[:8] for each in problems("--nstates 0\n--nroot 9\n")] == [
        "x.txt:1:", "x.txt:2:", "x.txt:2:",
    ]  # fmt: skip
    (many,) = problems("--n0 1 " * 501)
    assert many == "x.txt:1: column 1: expected at most 1000 words for a controller, got 1002"
    (long,) = problems("x" * 200_001)
    assert long == "x.txt: expected at most 200000 characters, got more"


@given(st.sampled_from([AAC, FLEE]), st.randoms(), st.text(max_size=9))
def test_whatever_is_wrong_is_one_error(text, rng, typed):
    words = text.split()
    for _ in range(rng.randint(1, 4)):
        at = rng.randrange(len(words))
        words[at : at + 1] = rng.choice([[], [typed], [words[at]] * 2, [rng.choice(words)]])
        words = words or ["--"]
    try:
        found = read_controllers(" ".join(words))
    except AutoMoDeError as error:
        assert all("\n" not in each.message for each in error.findings)
        assert all(len(str(each)) < 400 for each in error.findings)
    else:
        assert read_controllers("\n".join(map(format_controller, found))) == found


def test_machines_that_cannot_be_are_refused():
    stop = State(Behaviour(1))
    for states in ((), (stop,) * 5, (State(Behaviour(6)),)):
        with pytest.raises(ValueError, match=r"states|machines have no"):
            Machine(states)
    own = State(Behaviour(1), (Transition(0, Condition(5, 0.5)),))
    with pytest.raises(ValueError, match="expected another state as target, got 0"):
        Machine((own, stop))
    seen = State(Behaviour(1), (Transition(1, Condition(6, 0.5)),))
    with pytest.raises(ValueError, match="machines have no light seen"):
        Machine((seen, stop))
    with pytest.raises(ValueError, match="expected at most 4 transitions, got 5"):
        Machine((State(Behaviour(1), (Transition(1, Condition(5, 0.5)),) * 5), stop))
    with pytest.raises(ValueError, match="expected a whole number from 1 to 100, got 0"):
        Behaviour(0, 0)
    with pytest.raises(ValueError, match="expected p and w, got 1 numbers"):
        Condition(3, 1)
    with pytest.raises(ValueError, match="negation: expected 1 to 1 children, got 2"):
        Control(4, (Check(Condition(5, 1.0)),) * 2)


def test_controllers_in_words():
    (machine,) = read_machines(AAC)
    assert describe(machine)[1] == (
        "1",
        "stop",
        "to 0: white floor (p 0.25)\nto 2: neighbour count (xi 2, eta 3.50)",
    )
    (tree,) = read_trees(FLEE)
    assert describe(tree)[2:4] == [
        ("00", "    neighbour count (xi 4, eta 2.5)", ""),
        ("01", "    exploration (rwm 5)", "succeeds with p 0.1"),
    ]

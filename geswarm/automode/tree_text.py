"""Behaviour trees as text: what stands behind `--bt-config` on AutoMoDe's command line.

    --nroot 3 --nchildroot 1 --n0 0 --nchild0 2 --n00 6 --c00 5 --p00 0.26 --n01 5 --a01 1 --p01 0

A node is named by the way to it, a digit for each level. `--n01 KIND` is 0 selector, 1 selector*,
2 sequence, 3 sequence*, 4 negation, 5 action or 6 condition; `--nchild0 N` how many children it
has, `--a01 B` the behaviour of an action, `--p01` its success probability, `--c00 C` a condition.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from geswarm.automode.modules import (
    SUCCESS,
    TREE_BEHAVIOURS,
    TREE_CONDITIONS,
    Behaviour,
    Condition,
    Module,
    written,
)
from geswarm.automode.options import Options, Path, Word
from geswarm.automode.tree import (
    ACTION,
    CONDITION,
    CONTROLS,
    MOST_CHILDREN,
    MOST_LEVELS,
    NEGATION,
    Action,
    Check,
    Control,
    Node,
    Tree,
)

OPTION = "--bt-config"
_KINDS = ", ".join(f"{at} {name}" for at, name in enumerate((*CONTROLS, "action", "condition")))


def tree_of(words: Sequence[Word], source: str = "") -> tuple[Tree | None, Options]:
    """Read one tree.

    Args:
        words: Of its line, without the option's name.
        source: Where they come from, for messages.

    Returns:
        The tree, None if there are errors; and the options with these.
    """
    options = Options(words, source)
    kinds = ", ".join(f"{at} {name}" for at, name in enumerate(CONTROLS))
    kind = options.whole("--nroot", len(CONTROLS) - 1, kinds)
    children = _children(options, (), kind, "--nroot")
    options.finish()
    if not options.findings and options.names[:2] != ("--nroot", "--nchildroot"):
        options.error(options.words[0], "expected --nroot first and --nchildroot behind it")
    if options.findings or kind is None:
        return None, options
    return Tree(Control(kind, tuple(each for each in children if each))), options


def format_tree(tree: Tree) -> str:
    """The text of a tree, without the option's name; numbers are written as they were read."""
    children = tree.root.children
    words = ["--nroot", str(tree.root.kind), "--nchildroot", str(len(children))]
    for at, child in enumerate(children):
        words += _words(child, str(at))
    return " ".join(words)


def _children(options: Options, path: Path, kind: int | None, needed_by: str) -> list[Node | None]:
    """The children of a control node; None for what is wrong."""
    name = f"--nchild{_suffix(path) or 'root'}"
    most = 1 if kind == NEGATION else MOST_CHILDREN
    count = options.whole(name, most, "how many children", path, 1, needed_by)
    if count is None:  # what there is is looked at all the same
        count = sum(options.has(f"--n{_suffix((*path, at))}") for at in range(MOST_CHILDREN))
    return [_node(options, (*path, at), name) for at in range(count)]


def _node(options: Options, path: Path, needed_by: str) -> Node | None:
    head = f"--n{_suffix(path)}"
    options.opens(head, path)
    kind = options.whole(head, CONDITION, _KINDS, path, 0, needed_by)
    _refuse_foreign(options, path, kind)
    if kind == ACTION:
        return _action(options, path, head)
    if kind == CONDITION:
        return _check(options, path, head)
    if kind is not None and len(path) == MOST_LEVELS:
        message = f"expected an action or a condition {MOST_LEVELS} levels below the root"
        options.error_at(head, f"{message}, got a {CONTROLS[kind]}")
    if kind is None or len(path) == MOST_LEVELS:
        options.ignore_node(_suffix(path))
        return None
    children = [each for each in _children(options, path, kind, head) if each]
    return Control(kind, tuple(children)) if children and _fits(kind, children) else None


def _fits(kind: int, children: Sequence[Node]) -> bool:
    return kind != NEGATION or len(children) == 1


def _refuse_foreign(options: Options, path: Path, kind: int | None) -> None:
    """Note why a node of a kind cannot have options of another one."""
    suffix = _suffix(path)
    for name, owner in (("a", ACTION), ("c", CONDITION)):
        if kind != owner:
            options.refuse(f"--{name}{suffix}", _is_no(suffix, kind))
    if kind in (ACTION, CONDITION):
        options.refuse(f"--nchild{suffix}", _is_no(suffix, kind))


def _is_no(suffix: str, kind: int | None) -> str:
    names = (*CONTROLS, "action", "condition")
    return (
        f"--n{suffix} {kind} is a node of kind {names[kind]}"
        if kind is not None
        else (f"--n{suffix} is wrong")
    )


def _action(options: Options, path: Path, head: str) -> Action | None:
    suffix = _suffix(path)
    name = f"--a{suffix}"
    module = options.module(name, TREE_BEHAVIOURS, path, head)
    if module is None:
        _ignore(options, suffix, TREE_BEHAVIOURS.values())
        return None
    numbers = _numbers(options, path, name, module, TREE_BEHAVIOURS.values())
    success = options.number(suffix, SUCCESS, (*path, 0), name)
    options.opens(name, (*path, 0))
    if numbers is None or success is None:
        return None
    return Action(Behaviour(module.number, *numbers), success)


def _check(options: Options, path: Path, head: str) -> Check | None:
    suffix = _suffix(path)
    name = f"--c{suffix}"
    module = options.module(name, TREE_CONDITIONS, path, head)
    if module is None:
        _ignore(options, suffix, TREE_CONDITIONS.values())
        return None
    numbers = _numbers(options, path, name, module, TREE_CONDITIONS.values())
    options.opens(name, (*path, 0))
    return None if numbers is None else Check(Condition(module.number, *numbers))


def _numbers(
    options: Options, path: Path, name: str, module: Module, others: Iterable[Module]
) -> list[float] | None:
    """The parameters of a module; None if one is wrong."""
    suffix = _suffix(path)
    for other in others:
        for parameter in other.parameters:
            reason = f"{name} {module.number} is {module.name}, which has none"
            options.refuse(f"--{parameter.name}{suffix}", reason)
    given = [options.number(suffix, each, (*path, 0), name) for each in module.parameters]
    numbers: list[float] = [each for each in given if each is not None]
    return numbers if len(numbers) == len(given) else None


def _ignore(options: Options, suffix: str, modules: Iterable[Module]) -> None:
    """Whether the parameters of a module that is not known are right cannot be told."""
    for name in {SUCCESS.name, *(each.name for one in modules for each in one.parameters)}:
        options.ignore(f"--{name}{suffix}")


def _suffix(path: Path) -> str:
    return "".join(map(str, path))


def _words(node: Node, suffix: str) -> Iterator[str]:
    if isinstance(node, Control):
        yield from (f"--n{suffix}", str(node.kind), f"--nchild{suffix}", str(len(node.children)))
        for at, child in enumerate(node.children):
            yield from _words(child, f"{suffix}{at}")
    elif isinstance(node, Action):
        behaviour = node.behaviour
        yield from (f"--n{suffix}", str(ACTION), f"--a{suffix}", str(behaviour.number))
        if behaviour.parameter is not None:
            name = behaviour.module.parameters[0].name
            yield from (f"--{name}{suffix}", written(behaviour.parameter))
        yield from (f"--p{suffix}", written(node.success))
    else:
        condition = node.condition
        yield from (f"--n{suffix}", str(CONDITION), f"--c{suffix}", str(condition.number))
        for parameter, number in zip(
            condition.module.parameters, (condition.p, condition.w or 0.0), strict=False
        ):
            yield from (f"--{parameter.name}{suffix}", written(number))

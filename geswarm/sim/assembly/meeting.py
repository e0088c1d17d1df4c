"""Source of what robots have with each other: sums over the others, and collisions."""

from __future__ import annotations

from geswarm.sim.assembly import ground, records
from geswarm.sim.assembly.source import Source, zero
from geswarm.sim.kernels.single import I
from geswarm.sim.terms.component import OF_A_PAIR, Sum

_TOUCH = (
    "touch = TWO * (radius + max_speed * control_step) + F(1e-6)\n"
    "touch2 = touch * touch"
)  # fmt: skip


def sums(source: Source) -> None:
    """Sums over the other robots, for all robots; which may touch in this step."""
    source("# Who is near whom.")
    for name in ("radius", "max_speed", "control_step"):
        source.number(name)
    source(_TOUCH)
    needed = source.parts.needed_sums
    if needed:
        with source.inside("for i in range(len(robots)):"):
            source("robot = robots[i]")
            with source.lanes():
                for one in needed:
                    for output in one.outputs:
                        source(f"robot.{output}[lane] = {zero(source.parts.own_fields[output])}")
    if source.layout.swarm:
        _listed_pairs(source)
    else:
        _all_pairs(source)


def _all_pairs(source: Source) -> None:
    with source.lanes():
        source("work.touch[lane] = I(0)")
    fields = records.mine_fields(source.parts, source.layout)
    outputs = {output for one in source.parts.needed_sums for output in one.outputs}
    with source.inside("for i in range(len(robots)):"):
        source("robot = robots[i]")
        with source.lanes():
            for name in fields:
                source(f"mine.{name}[lane] = robot.{name}[lane]")
        with source.inside("for j in range(i + 1, len(robots)):"):
            source("other = robots[j]")
            with source.lanes():
                _one_pair(source)
        if outputs:
            with source.lanes():
                for name in fields:
                    if name in outputs:
                        source(f"robot.{name}[lane] = mine.{name}[lane]")


def _one_pair(source: Source) -> None:
    """Robot `mine` and one of those after it.

    All sums are in one loop, which is half as much to load and store as a loop for each. LLVM can
    do that only because it knows that `mine` is nowhere in the robots.
    """
    source("dx, dy = mine.x[lane] - other.x[lane], mine.y[lane] - other.y[lane]")
    source("d2 = fma(dx, dx, dy * dy)")
    source("work.touch[lane] = I(work.touch[lane] | I(d2 < touch2))")
    source("per_d = inverse_root(d2)")
    for one in source.parts.needed_sums:
        _weights(source, one, ("mine", "other"), ("lane", "lane"))
        _add(source, one, ("mine", "other"), ("lane", "lane"))


def _listed_pairs(source: Source) -> None:
    """Pairs that may be in range are listed now and then; 64 at a time are worked through."""
    for name in ("half_width", "half_length", "sight", "skin"):
        source.number(name)
    with source.inside("if grid.listed[0] < 0 or have_moved(robots, skin):"):
        source("list_pairs(robots, grid, half_width, half_length, sight + skin)")
        with source.inside("if grid.listed[0] < 0:  # more than there is room for"):
            source("return step - first")
    source("touching = I(0)")
    with source.inside("for begin in range(0, grid.listed[0], LANES):"):
        source("number = min(LANES, grid.listed[0] - begin)")
        source("gather_pairs(robots, grid.pairs, begin, number, work)")
        with source.lanes():
            source("dx, dy = work.dx[lane], work.dy[lane]\nd2 = fma(dx, dx, dy * dy)")
            source("work.d2[lane], work.per_d[lane] = d2, inverse_root(d2)")
            source("touching = I(touching | I(d2 < touch2))")
        for one in source.parts.needed_sums:
            _sum_of_listed(source, one)


def _sum_of_listed(source: Source, one: Sum) -> None:
    symmetric = source.is_symmetric(one)
    if symmetric:
        with source.lanes():
            _of_the_pair(source, one)
            call = source.call_for_pair(one, False, ("robot", "other"), ("lane", "lane"))
            source(f"work.weight[lane] = F({call})")
    with source.inside("for lane in range(number):"):
        source("one, two = grid.pairs[begin + lane, 0], grid.pairs[begin + lane, 1]")
        source("robot, other = robots[one >> 6], robots[two >> 6]\nk, m = one & 63, two & 63")
        _of_the_pair(source, one)
        if symmetric:
            whole = one.form == "count"
            source(f"here = {'I(work.weight[lane])' if whole else 'work.weight[lane]'}")
            source("there = here")
        else:
            _weights(source, one, ("robot", "other"), ("k", "m"))
        _add(source, one, ("robot", "other"), ("k", "m"))


def _of_the_pair(source: Source, one: Sum) -> None:
    wanted = {*one.needs, *(("dx", "dy") if one.form == "vector" else ())}
    for name in OF_A_PAIR:
        if name in wanted:
            source(f"{name} = work.{name}[lane]")


def _weights(source: Source, one: Sum, robots: tuple[str, str], lanes: tuple[str, str]) -> None:
    cast = "I({})" if one.form == "count" else "{}"
    source(f"here = {cast.format(source.call_for_pair(one, False, robots, lanes))}")
    if source.is_symmetric(one):
        source("there = here")
    else:
        source(f"there = {cast.format(source.call_for_pair(one, True, robots, lanes))}")


def _add(source: Source, one: Sum, robots: tuple[str, str], lanes: tuple[str, str]) -> None:
    for robot, lane, weight in zip(robots, lanes, ("here", "there"), strict=True):
        for output, along in zip(one.outputs, ("dx", "dy"), strict=False):
            at = f"{robot}.{output}[{lane}]"
            if one.form == "vector":
                source(f"{at} = fma({'-' if weight == 'there' else ''}{weight}, {along}, {at})")
            elif source.parts.own_fields[output] is I:
                source(f"{at} = I({at} + {weight})")
            else:
                source(f"{at} = {at} + {weight}")


def _push_apart_in_lanes(source: Source) -> None:
    """One pair in all lanes, of which few touch; as `push_apart` does in each of them."""
    source("robot, other, some = robots[i], robots[j], I(0)")
    with source.lanes():
        source("dx, dy = robot.x[lane] - other.x[lane], robot.y[lane] - other.y[lane]")
        source("d2 = fma(dx, dx, dy * dy)\nwork.d2[lane] = d2")
        source("some = I(some | I(d2 < TWO * TWO * radius * radius))")
    with source.inside("if some:"), source.lanes():
        source("dx, dy = robot.x[lane] - other.x[lane], robot.y[lane] - other.y[lane]")
        source("push_x, push_y = pushed_apart(dx, dy, work.d2[lane], radius)")
        for along in "xy":
            source(f"robot.{along}[lane] = robot.{along}[lane] + push_{along}")
            source(f"other.{along}[lane] = other.{along}[lane] - push_{along}")


def collide(source: Source) -> None:
    """Overlapping pairs are pushed apart, pair after pair; then all are kept off the walls."""
    source("# Bodies do not overlap.")
    if source.layout.swarm:
        with source.inside("if touching:"), source.inside("for at in range(grid.listed[0]):"):
            source("one, two = grid.pairs[at, 0], grid.pairs[at, 1]")
            source("push_apart(robots[one >> 6], one & 63, robots[two >> 6], two & 63, radius)")
    else:
        source("touching = I(0)")
        with source.lanes():
            source("touching = I(touching | work.touch[lane])")
        with (
            source.inside("if touching:"),
            source.inside("for i in range(len(robots)):"),
            source.inside("for j in range(i + 1, len(robots)):"),
        ):
            _push_apart_in_lanes(source)
    with source.inside("for i in range(len(robots)):"):
        source("robot = robots[i]")
        ground.keep_inside(source)

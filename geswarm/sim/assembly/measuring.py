"""Source of what is counted after each step and at the end, of robots and of the whole swarm."""

from __future__ import annotations

from collections.abc import Iterable

from geswarm.sim.assembly import ground
from geswarm.sim.assembly.acting import count
from geswarm.sim.assembly.source import Source, plus, zero
from geswarm.sim.kernels.single import I
from geswarm.sim.terms.component import SUM, CellMeasure, Component, Measure, SwarmMeasure


def measures(source: Source, at: str) -> None:
    """What is counted at "step" or at the "end": again after each call, the last one counts."""
    of_robots = [
        each for each in source.parts.measures if isinstance(each, Measure) and each.at == at
    ]
    if of_robots:
        source(f"# What is counted of each robot, {at}.")
        with source.inside("for i in range(len(robots)):"):
            source("robot = robots[i]")
            for measure in of_robots:
                with source.lanes():
                    exists = "robot.exists[lane] != I(0)" if source.layout.swarm else None
                    ground.prelude(source, measure)
                    count(source, measure, exists, afresh=at == "end")
    for each in source.parts.measures:
        if isinstance(each, CellMeasure) and each.at == at:
            _of_cells(source, each)
        elif isinstance(each, SwarmMeasure) and each.at == at:
            _of_the_swarm(source, each)


def _of_the_swarm(source: Source, measure: SwarmMeasure) -> None:
    """Sums over the robots, then what is made of them; the first robot keeps it."""
    source(f"# Measure {measure.name} of the swarm.")
    needs = [name for name in measure.needs if name.startswith(SUM)]
    kinds = {name: source.parts.swarm_sums[name] for name in needs}
    if source.layout.swarm:
        _sums_of_blocks(source, kinds)
        source("robot, lane = robots[0], 0")
        _keep(source, measure, {name: name for name in needs})
        return
    with source.lanes():
        for name in needs:
            source(f"work.{name}[lane] = {zero(kinds[name])}")
    with source.inside("for i in range(len(robots)):"):
        source("robot = robots[i]")
        with source.lanes():
            ground.prelude(source, _summed(needs))
            for name in needs:
                value = source.means(name.removeprefix(SUM), "robot", "lane")
                source(f"work.{name}[lane] = {plus(kinds[name], f'work.{name}[lane]', value)}")
    source("robot = robots[0]")
    with source.lanes():
        _keep(source, measure, {name: f"work.{name}[lane]" for name in needs})


def _of_cells(source: Source, measure: CellMeasure) -> None:
    """The cells that robots are in are visited; the ages of all cells are added up."""
    source(f"# Measure {measure.name}, of cells.")
    swarm = source.layout.swarm
    of_all = "0" if swarm else "lane"
    with source.inside("for i in range(len(robots)):"):
        source("robot = robots[i]")
        with source.inside(f"for lane in range({'LANES' if swarm else 'width'}):"):
            source(f"cell = {source.call(measure)}")
            with source.inside("if robot.exists[lane]:" if swarm else "if True:"):
                visit = f"robots[0].visits[cell, {of_all}]"
                source(f"robots[0].visits_sum[{of_all}] += I(step) - {visit}\n{visit} = step")
    source("robot = robots[0]")
    with source.inside(f"for lane in range({'1' if swarm else 'width'}):"):
        ages = f"I(I(step * {measure.cells}) - robot.visits_sum[lane])"
        source(f"robot.{measure.name}[lane] = I(robot.{measure.name}[lane] + {ages})")


def _sums_of_blocks(source: Source, kinds: dict[str, type]) -> None:
    for name, kind in kinds.items():
        source(f"{name} = {zero(kind)}")
    with source.inside("for i in range(len(robots)):"):
        source("robot = robots[i]")
        with source.inside("for lane in range(LANES):"), source.inside("if robot.exists[lane]:"):
            ground.prelude(source, _summed(kinds))
            for name, kind in kinds.items():
                value = source.means(name.removeprefix(SUM), "robot", "lane")
                source(f"{name} = {plus(kind, name, value)}")


def _summed(sums: Iterable[str]) -> Component:
    """What names everything that is summed up."""
    return Component(None, given=tuple(name.removeprefix(SUM) for name in sums))


def _keep(source: Source, measure: SwarmMeasure, sums: dict[str, str]) -> None:
    kind = source.parts.own_fields[measure.name]
    if measure.function is not None:
        value = source.call(measure, **sums)
    else:
        first, *others = sums.values()
        source(f"most = {first}")
        for other in others:
            source(f"most = {other} if {other} > most else most")
        value = "most"
    place = f"robot.{measure.name}[lane]"
    value = f"I({value})" if kind is I else f"F({value})"
    source(f"{place} = {plus(kind, place, value) if measure.at == 'step' else value}")

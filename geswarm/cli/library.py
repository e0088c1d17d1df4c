"""The verbs that list what there is to use: scenarios, terms."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geswarm.cli.arguments import (
    SCENARIO_HELP,
    UsageError,
    Verbs,
    non_negative_int,
    positive_int,
)
from geswarm.cli.output import print_texts, write_files

if TYPE_CHECKING:
    from geswarm.rules.arguments import Argument
    from geswarm.sim import Scenario
    from geswarm.sim.library.catalogue import Entry


def add_library_verbs(verbs: Verbs) -> None:
    """Add scenarios and terms."""
    scenarios = verbs.add_parser(
        "scenarios", help="list the scenarios that come with GESwarm, draw one, or generate some"
    )
    scenarios.add_argument("scenario", nargs="?", metavar="S", help=f"{SCENARIO_HELP}, to draw")
    scenarios.add_argument("--picture", metavar="FILE", help="where its arena is drawn, as SVG")
    scenarios.add_argument("--generate", choices=["mg1"], help="write random missions for e-pucks")
    scenarios.add_argument("--seed", type=non_negative_int, default=0, metavar="N")
    scenarios.add_argument("--number", type=positive_int, default=1, metavar="K")
    scenarios.add_argument("-o", "--output", metavar="DIR", help="where they are written")
    scenarios.add_argument("--json", action="store_true", help="one JSON object on stdout")
    scenarios.set_defaults(command=_scenarios)

    terms = verbs.add_parser(
        "terms", help="list the terms that a scenario offers, or the whole library"
    )
    terms.add_argument("--scenario", metavar="S", help=f"{SCENARIO_HELP}; default: the library")
    terms.add_argument("--json", action="store_true", help="one JSON object on stdout")
    terms.set_defaults(command=_terms)


def _scenarios(options: argparse.Namespace) -> int:
    if (options.scenario is None) != (options.picture is None):
        raise UsageError("scenarios: expected S and --picture FILE together")
    if (options.generate is None) != (options.output is None):
        raise UsageError("scenarios: expected --generate mg1 and -o DIR together")
    if options.scenario is None and options.generate is None:
        return _list_scenarios(options)
    if options.scenario is not None:
        _draw(options.scenario, options.picture)
    if options.generate is not None:
        _generate(options)
    return 0


def _draw(name: str, file: str) -> None:
    from geswarm.exports.arena_picture import arena_picture
    from geswarm.sim import ScenarioError, load_scenario

    try:
        scenario = load_scenario(name)
    except ScenarioError as error:
        raise UsageError(str(error)) from error
    write_files({file: arena_picture(scenario)})


def _generate(options: argparse.Namespace) -> None:
    from geswarm.sim.mission_generator import mission

    folder = Path(options.output)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise UsageError(f"{folder}: cannot be made: {error.strerror}") from error
    files: dict[str | None, str] = {
        str(folder / f"mg1-{options.seed}-{number}.yaml"): mission(options.seed, number)
        for number in range(1, options.number + 1)
    }
    write_files(files)
    print("\n".join(map(str, files)))


def _list_scenarios(options: argparse.Namespace) -> int:
    from geswarm.sim import load_scenario, scenario_about, scenario_names

    found = [(load_scenario(name), scenario_about(name)) for name in scenario_names()]
    if options.json:
        documents = [_scenario(scenario, about) for scenario, about in found]
        print(json.dumps({"scenarios": documents}))
        return 0
    rows = [
        [
            scenario.name,
            f"{scenario.robots} robots",
            f"{scenario.duration:g} s",
            f"{_aim(scenario)}. {about}",
        ]
        for scenario, about in found
    ]
    print_texts(
        "Scenarios", ["scenario", "robots", "time", "objective, and what it is about"], rows
    )
    return 0


def _aim(scenario: Scenario) -> str:
    objective = scenario.objective
    return f"{'Maximise' if objective.maximise else 'Minimise'} {objective.label}"


def _scenario(scenario: Scenario, about: str) -> dict[str, Any]:
    """A scenario as JSON values."""
    return {
        "name": scenario.name,
        "about": about,
        "robots": scenario.robots,
        "duration": scenario.duration,
        "objective": scenario.objective.document(),
        "preconditions": list(scenario.preconditions),
        "behaviours": list(scenario.behaviours),
        "registers": list(scenario.registers),
        "measures": list(scenario.measures),
        "reference": scenario.reference,
    }


def _terms(options: argparse.Namespace) -> int:
    from geswarm.sim import ScenarioError, load_scenario
    from geswarm.sim.library.catalogue import catalogue

    try:
        scenario = None if options.scenario is None else load_scenario(options.scenario)
    except ScenarioError as error:
        raise UsageError(str(error)) from error
    entries = catalogue(scenario)
    if options.json:
        terms = [entry.document() for entry in entries]
        print(json.dumps({"scenario": options.scenario, "terms": terms}))
        return 0
    for kind in dict.fromkeys(entry.kind for entry in entries):
        rows = [[entry.written, _meaning(entry)] for entry in entries if entry.kind == kind]
        whose = "" if scenario is None else f" of {options.scenario}"
        print_texts(f"{kind.capitalize()}s{whose}", [kind, "what it is"], rows)
    return 0


def _meaning(entry: Entry) -> str:
    """What it does, phrases, arguments, values, unit and source, each on a line."""
    lines = [entry.about] if entry.about else []
    lines += [", ".join(f"“{phrase}”" for phrase in entry.words)] if entry.words else []
    lines += [_argument(each) for each in entry.arguments]
    if entry.signs:
        lines.append(f"{' '.join(entry.signs)}  {_values(entry)}".rstrip())
    if entry.unit:
        lines.append(f"in {entry.unit}")
    lines.append(f"({entry.source})")
    return "\n".join(lines)


def _argument(argument: Argument) -> str:
    unit = f" ({argument.unit})" if argument.unit else ""
    return f"{argument.name}: {argument.expected}{unit}"


def _values(entry: Entry) -> str:
    """`true or false`, `0 to 7`, `grey or black`."""
    from geswarm.rules.model import format_value

    texts = [format_value(value) for value in entry.values]
    if len(texts) > 2 and not isinstance(entry.values[0], str):
        return f"{texts[0]} to {texts[-1]}"
    return " or ".join(texts[::-1] if entry.values == (False, True) else texts)

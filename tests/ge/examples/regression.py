"""Symbolic regression: find 2.5 x^2 - 0.7 from twenty points."""

import math
from pathlib import Path

from geswarm.ge import Engine, Grammar, Settings

GRAMMAR = Path(__file__).with_name("regression.bnf")
POINTS = [(x / 10.0, 2.5 * (x / 10.0) ** 2 - 0.7) for x in range(-10, 10)]


def values(formula):
    """What it says at the points: formulas with the same values are the same to the engine."""
    code = compile(formula, "formula", "eval")
    return tuple(round(eval(code, {"x": x}), 9) for x, _ in POINTS)


def fitness(formula):
    """1 for a perfect formula, towards 0 with the sum of absolute errors."""
    errors = (abs(value - y) for value, (_, y) in zip(values(formula), POINTS, strict=True))
    return 1.0 / (1.0 + math.fsum(errors))


def solve(seed, population=200, generations=60):
    """Ask and tell until the formula is found; returns the best individual and the generations."""
    settings = Settings.preset(
        "modern",
        population=population,
        generations=generations,
        elitism=0.2,
        reevaluate_elites=False,  # nothing is left to chance
        tournament=6,
        crossover=0.5,
        mutation=0.5,
    )
    engine = Engine(Grammar.load(GRAMMAR), settings, seed, identity=values)
    while not engine.finished and (engine.best is None or engine.best.fitness < 0.999):
        engine.tell([fitness(one.phenotype) for one in engine.ask()])
    return engine.best, engine.generation

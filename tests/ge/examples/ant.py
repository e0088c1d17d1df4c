"""The Santa Fe ant trail: an objective that has nothing to do with robots."""

from pathlib import Path

from geswarm.ge import Engine, Grammar, Settings

GRAMMAR = Path(__file__).with_name("santa_fe.bnf")
STEPS = 600
TRAIL = """
.###............................
...#............................
...#.....................###....
...#....................#....#..
...#....................#....#..
...####.#####........##.........
............#................#..
............#.......#...........
............#.......#........#..
............#.......#...........
....................#...........
............#................#..
............#...................
............#.......#.....###...
............#.......#..#........
.................#..............
................................
............#...........#.......
............#...#..........#....
............#...#...............
............#...#...............
............#...#.........#.....
............#..........#........
............#...................
...##..#####....#...............
.#..............#...............
.#..............#...............
.#......#######.................
.#.....#........................
.......#........................
..####..........................
................................
""".strip().splitlines()
FOOD = frozenset((x, y) for y, row in enumerate(TRAIL) for x, c in enumerate(row) if c == "#")
SIZE = 32


def parse(words):
    """A program as a nested list: words, and ("if", then, otherwise)."""
    lines = []
    while words and words[0] != "}":
        word = words.pop(0)
        if word != "if":
            lines.append(word)
            continue
        del words[:2]  # food {
        then = parse(words)
        del words[:3]  # } else {
        lines.append(("if", then, parse(words)))
        del words[:1]  # }
    return lines


def food_eaten(program):
    """How much of the 89 pieces the ant eats in 600 steps of a program that it repeats."""
    x = y = steps = 0
    dx, dy = 1, 0
    food = set(FOOD)
    lines = parse(program.split())
    todo = []
    while steps < STEPS and food:
        if not todo:
            todo = lines[::-1]
        line = todo.pop()
        if line == "move":
            x, y = (x + dx) % SIZE, (y + dy) % SIZE
            food.discard((x, y))
        elif line == "left":
            dx, dy = dy, -dx
        elif line == "right":
            dx, dy = -dy, dx
        else:
            ahead = ((x + dx) % SIZE, (y + dy) % SIZE) in food
            todo += line[1 if ahead else 2][::-1]
            continue
        steps += 1
    return len(FOOD) - len(food)


def solve(seed, population=300, generations=40):
    """Ask and tell until all food is found; returns the best individual and the generations."""
    settings = Settings.preset(
        "modern",
        population=population,
        generations=generations,
        elitism=0.2,
        reevaluate_elites=False,  # nothing is left to chance
        tournament=3,
        crossover=0.3,
        mutation=0.5,
        max_codons=25,
    )
    engine = Engine(Grammar.load(GRAMMAR), settings, seed)
    while not engine.finished and (engine.best is None or engine.best.fitness < len(FOOD)):
        engine.tell([food_eaten(one.phenotype) for one in engine.ask()])
    return engine.best, engine.generation

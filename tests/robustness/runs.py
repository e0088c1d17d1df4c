"""Files and run directories: they are read in the current directory, which the tests make."""

import io
import json
import shutil
import sqlite3
import sys
import tempfile
from functools import cache
from pathlib import Path
from types import SimpleNamespace

from hypothesis import strategies as st

from geswarm.evolution import EvolutionRun, RunConfig, rule_grammar
from geswarm.ge import Engine, Grammar, GrammarError, Settings, StoreError
from geswarm.ge.engine import CheckpointError
from geswarm.rules import FORMATS, RuleSetError, load_rule_set
from geswarm.sim import ScenarioError, load_scenario
from tests.robustness import mutations
from tests.robustness.doors import GRAMMAR, PAPER, RULE_SETS, Door
from tests.strategies import documented_rule_sets

SETTINGS = Settings(population=4, generations=3, evaluations=1)
CONFIG = RunConfig(PAPER.with_changes(duration=1.0), SETTINGS, 3)


@cache
def example_run():
    """Bytes of the run.db of a run after two generations, one of them steered; its checkpoint."""
    with tempfile.TemporaryDirectory() as directory:
        run = EvolutionRun.create(CONFIG, Path(directory) / "run")
        run.run(
            on_generation=lambda record: run.steer(mutation=0.1), stop=lambda: len(run.history) == 2
        )
        run.close()
        database = (Path(directory) / "run" / "run.db").read_bytes()
        with sqlite3.connect(Path(directory) / "run" / "run.db") as connection:
            ((state,),) = connection.execute("SELECT state FROM checkpoint")
        return database, json.loads(state)


# --- files ------------------------------------------------------------------------------------


def file_of_rules(data):
    """The same from a file and from standard input."""
    Path("mine.rules").write_bytes(data)
    stdin, sys.stdin = sys.stdin, SimpleNamespace(buffer=io.BytesIO(data))
    try:
        typed = load_rule_set("-")
    except RuleSetError as error:
        typed = str(error).replace("<stdin>", "mine.rules")
    finally:
        sys.stdin = stdin
    try:
        assert load_rule_set("mine.rules") == typed
    except RuleSetError as error:
        assert str(error) == typed
        raise


def file_of_a_grammar(data):
    Path("mine.bnf").write_bytes(data)
    Grammar.load("mine.bnf")


def file_of_a_scenario(data):
    Path("mine.yaml").write_bytes(data)
    load_scenario("mine.yaml")


def file_inputs(*examples):
    def make(rng):
        if rng.random() < 0.2:
            return mutations.random_bytes(rng)
        return mutations.saved_text(rng, rng.choice(examples))

    return make


def encoded(texts):
    encodings = st.sampled_from(mutations.ENCODINGS)
    return st.builds(lambda text, encoding: text.encode(encoding, "replace"), texts, encodings)


# --- runs -------------------------------------------------------------------------------------


def look_at(directory):
    """All that a run directory is asked for; resumes it as far as it has been before."""
    before = {path.name for path in Path().iterdir()}
    try:
        run = EvolutionRun.resume(directory)
        try:
            if run.config == CONFIG:
                run.run(workers=1)
            assert [record.generation for record in run.history] == sorted(
                record.generation for record in run.history
            )
            run.population()
            run.genealogy()
        finally:
            run.close()
    finally:
        assert {path.name for path in Path().iterdir()} == before


def damaged_database(data):
    """A run.db of these bytes, perhaps with a log beside it."""
    database, log = data
    directory = fresh_directory()
    (directory / "run.db").write_bytes(database)
    if log:
        (directory / "run.db-wal").write_bytes(log)
    look_at(directory)


def fresh_directory():
    directory = Path("run")
    shutil.rmtree(directory, ignore_errors=True)
    directory.mkdir()
    return directory


def damaged_bytes(rng):
    log = mutations.random_bytes(rng) if rng.random() < 0.1 else b""
    return mutations.mutated_bytes(rng, example_run()[0]), log


COLUMNS = {
    "run": ("config",),
    "generation": ("generation", "best_so_far", "best", "mean", "invalid", "distinct", "seconds",
                   "best_phenotype", "best_generation", "best_key"),
    "individual": ("generation", "key", "parents", "fitness", "codons", "phenotype"),
    "steering": ("number", "generation", "what"),
    "checkpoint": ("generation", "state"),
}  # fmt: skip
_PLACES = [(table, column) for table, columns in COLUMNS.items() for column in columns]
_STORED = (
    None, -1, 0, 1, 7, 2**62, 0.5, 1e308, float("inf"), "", "x", "[]", "{}", "[[1]]", "[" * 3000,
    '{"inject": 5}', '{"inject": "x"}', '{"settings": {"mutation": 2}}', '{"settings": []}',
    b"\xff", b"", "population: 5",
)  # fmt: skip


def wrong_rows(changes):
    """A run.db whose rows say something else: (table, column, value) or a statement each."""
    directory = fresh_directory()
    (directory / "run.db").write_bytes(example_run()[0])
    connection = sqlite3.connect(directory / "run.db")
    for change in changes:
        try:
            if isinstance(change, str):
                connection.execute(change)
            else:
                table, column, value = change
                connection.execute(f'UPDATE {table} SET "{column}" = ?', (value,))
        except sqlite3.Error:
            continue  # the schema does not let it happen
    connection.commit()
    connection.close()
    look_at(directory)


_STATEMENTS = (
    *(f"DELETE FROM {table}" for table in COLUMNS),
    *(f"DROP TABLE {table}" for table in COLUMNS),
    "DELETE FROM generation WHERE generation = 1",
    "INSERT INTO run SELECT config FROM run",
    "PRAGMA user_version = 0",
    "PRAGMA application_id = 1",
    "ALTER TABLE generation ADD COLUMN more",
    "ALTER TABLE checkpoint RENAME COLUMN state TO other",
    "CREATE VIEW more AS WITH RECURSIVE n(x) AS (VALUES (1) UNION ALL SELECT 1 FROM n) "
    "SELECT * FROM n",
    "CREATE TRIGGER more AFTER INSERT ON generation BEGIN DELETE FROM individual; END",
    "UPDATE checkpoint SET state = replace(state, ':', ': -')",
    "UPDATE checkpoint SET state = replace(state, '1', '9')",
    "UPDATE run SET config = replace(config, '1', '9')",
    "UPDATE run SET config = replace(config, '4', 'four')",
)


def row_changes(rng):
    def change():
        if rng.random() < 0.3:
            return rng.choice(_STATEMENTS)
        return (*rng.choice(_PLACES), rng.choice(_STORED))

    return [change() for _ in range(rng.choice((1, 1, 2, 4)))]


def checkpoint(state):
    """A state of an engine; one that is taken must be good for a generation."""
    engine = Engine.restore(rule_grammar(), SETTINGS, 3, state)
    engine.tell([1.0] * len(engine.ask()))
    json.dumps(engine.state(), allow_nan=False)


@cache
def doors():
    """Files of every kind."""
    text_of = FORMATS["text"]
    one_change = st.tuples(st.sampled_from(_PLACES), st.sampled_from(_STORED)).map(
        lambda pair: (*pair[0], pair[1])
    )
    return (
        Door("file of rules", file_of_rules, (RuleSetError,),
             file_inputs(*(write(one) for write in FORMATS.values() for one in RULE_SETS)),
             st.binary(max_size=60) | encoded(documented_rule_sets.map(text_of))),
        Door("file of a grammar", file_of_a_grammar, (GrammarError,), file_inputs(GRAMMAR),
             st.binary(max_size=60) | encoded(st.text(max_size=30))),
        Door("file of a scenario", file_of_a_scenario, (ScenarioError,),
             file_inputs("duration: 1\n", PAPER.to_yaml()),
             st.binary(max_size=60) | encoded(st.text(max_size=30))),
        Door("run.db, damaged", damaged_database, (StoreError,), damaged_bytes,
             st.tuples(st.binary(max_size=200), st.binary(max_size=50))),
        Door("run.db, wrong rows", wrong_rows, (StoreError,), row_changes,
             st.lists(one_change, min_size=1, max_size=3)),
        Door("checkpoint", checkpoint, (CheckpointError,),
             lambda rng: mutations.mutated_value(rng, example_run()[1]),
             mutations.json_objects(("generation", "settings", "population", "best"))),
    )  # fmt: skip

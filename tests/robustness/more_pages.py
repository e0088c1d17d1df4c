"""The sockets of the other pages and of viser, and the files that only the dashboard reads."""

import json
import shutil
from contextlib import suppress
from functools import cache
from pathlib import Path

import msgspec
import viser._messages
from hypothesis import strategies as st

from geswarm.analysis.reproduction import Campaign, CampaignError, Plan
from geswarm.analysis.reproduction.results import parse_samples
from geswarm.analysis.reproduction.studies import performance
from geswarm.app.panels.evolution_page import EvolutionPage
from geswarm.app.panels.experiments_messages import campaign_message
from geswarm.app.panels.experiments_page import ExperimentsPage
from geswarm.app.server.viser_messages import is_expected
from geswarm.app.state.campaign_folder import CampaignFolder
from geswarm.app.state.evolution import EvolutionThread
from geswarm.app.state.journal import Journal, Unsaved
from geswarm.app.state.session import Session
from geswarm.ge import StoreError
from geswarm.rules import format_yaml
from geswarm.sim import EvaluationStopped
from tests.app.wire import as_read
from tests.robustness import mutations
from tests.robustness.doors import EVO8, MINE, Door, RefusedError, as_utf8
from tests.robustness.pages import QUICK, Pages
from tests.robustness.runs import example_run, fresh_directory

CASES = performance([])[:1]
TINY = Plan(runs=1, generations=1, evaluations=2)


def state_of(session):
    """What a message that is refused must not change."""
    runs, comparison, campaigns = session.runs, session.comparison, session.campaigns
    return (
        session.document.version, runs.plan, runs.compared, runs.shown, runs.chosen,
        comparison.choice, comparison.rules_offered(), campaigns.draft.values, campaigns.shown,
        campaigns.thread.directory, sorted(Path("runs").glob("*/*")) if not runs.shown else None,
    )  # fmt: skip


def talk(make_page, raw_messages):
    """Messages of a page to a session, as they arrive; one that is refused changes nothing."""
    shutil.rmtree("runs", ignore_errors=True)
    for name in ("one", "two"):
        Path("runs", name).mkdir(parents=True)
        Path("runs", name, "run.db").write_bytes(example_run()[0])
    Campaign.at("runs/campaign", runs=1, generations=1, evaluations=2)
    session = Session(QUICK, EVO8, EvolutionThread(workers=1))
    session.campaigns.thread.start = lambda campaign: None  # would take minutes
    page = make_page(session)
    hear, page.channel = page.channel.hear, Pages()
    try:
        for raw in raw_messages:
            known, before = len(page.channel.refusals), state_of(session)
            hear("client", raw)
            session.frame(0.0, 0.1)
            for _, build in page.sources().values():
                as_read(build())
            if any(map(str.strip, page.channel.refusals[known:])):
                assert state_of(session) == before
    finally:
        session.close()
    if page.channel.refusals:
        raise RefusedError("\n".join(page.channel.refusals))


_EVOLUTION = (
    *({"type": kind} for kind in ("watch", "pause", "go_on", "stop", "forget", "load", "load_best",
                                  "compare_with", "inject")),
    {"type": "preset", "name": "modern"},
    {"type": "plan", "name": "population", "value": 4},
    {"type": "plan", "name": "seed", "value": 3},
    {"type": "plan", "name": "from_table", "value": True},
    {"type": "freeze", "rule": 0, "on": True},
    {"type": "start", "instead": True},
    {"type": "steer", "name": "mutation", "value": 0.1},
    {"type": "choose", "generation": 1, "key": 0},
    *({"type": kind, "name": "one"} for kind in ("open", "resume")),
    {"type": "compare", "name": "two", "on": True},
)  # fmt: skip
_EXPERIMENTS = (
    *({"type": kind} for kind in ("watch", "compare", "cancel", "start", "stop")),
    {"type": "choose", "what": "rules", "name": "Hand-coded", "on": False},
    {"type": "choose", "what": "scenarios", "name": "scalability-5", "on": True},
    {"type": "choice", "name": "runs", "value": 2},
    {"type": "choice", "name": "against", "value": "EVO 8"},
    {"type": "file", "name": "mine.yaml", "text": format_yaml(MINE)},
    {"type": "size", "name": "quick"},
    {"type": "draft", "name": "runs", "value": 2},
    *({"type": kind, "name": "campaign"} for kind in ("open", "resume")),
)
_PATHS = ("..", "../one", "/etc", "", ".", "one/../two", "one\0", "..\\one", "campaign/../../x")


def messages(examples):
    def message(rng):
        example = dict(rng.choice(examples))
        if "name" in example and rng.random() < 0.2:
            example["name"] = rng.choice(_PATHS)
        if rng.random() < 0.5:
            example = mutations.mutated_value(rng, example)
        return as_utf8(json.dumps(example, ensure_ascii=rng.random() < 0.5))

    return lambda rng: [message(rng) for _ in range(rng.choice((1, 2, 5)))]


def to_viser(raw):
    """Nothing is passed on that viser cannot read."""
    widgets = {"x": type("Number", (), {"value": 1, "min": 0, "max": 9})}
    if not is_expected(raw, widgets):
        raise RefusedError("dropped")
    viser._messages.Message.deserialize(raw)


_POINT, _PAIR = [0.0, 1.0, 2.0], [0.0, 0.5]
_TO_VISER = (
    {"type": "GuiUpdateMessage", "uuid": "x", "updates": {"value": 3}},
    {"type": "CommandTriggerMessage", "uuid": "x"},
    {"type": "ScenePointerMessage", "event_type": "click", "ray_origin": _POINT,
     "ray_direction": _POINT, "screen_pos": [_PAIR], "modifier": None},
    {"type": "SceneNodeClickMessage", "name": "x", "instance_index": 1, "ray_origin": _POINT,
     "ray_direction": _POINT, "screen_pos": _PAIR, "modifier": "shift", "owner": ""},
)  # fmt: skip


def pack(value):
    try:
        return msgspec.msgpack.encode(value)
    except (OverflowError, UnicodeEncodeError):  # MessagePack has no such number or text
        return as_utf8(json.dumps(value))


def packed(rng):
    example = rng.choice(_TO_VISER)
    if rng.random() < 0.5:
        return pack(mutations.mutated_value(rng, example))
    return mutations.mutated_bytes(rng, pack(example))


@cache
def example_journal():
    directory = fresh_directory()
    journal = Journal(directory)
    journal.keep(MINE)
    journal._writer.ask(journal._entry)
    while (
        not journal._connection
        or not journal._connection.execute("SELECT 1 FROM unsaved").fetchone()
    ):
        pass
    journal._writer.close()  # as if killed
    journal._connection.close()
    (path,) = directory.glob("*.db")
    return path.read_bytes()


def journal_file(data):
    directory = fresh_directory()
    (directory / "1-2.db").write_bytes(data)
    left = Journal(directory).left
    assert all(isinstance(unsaved, Unsaved) for unsaved in left)
    if not left:
        raise RefusedError("nothing was left")


def campaign_directory(files):
    """Files of a campaign: looked at as the page does, and gone on with, but for the work."""
    directory = fresh_directory()
    for name, data in files.items():
        path = directory / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
    with suppress(ValueError, OverflowError):  # as the campaign does
        parse_samples(files.get("data/performance.csv", b"").decode("utf-8"), CASES, 2)
    folder = CampaignFolder(Path())
    folder.scan()
    as_read(campaign_message(folder.look("run"), ""))
    try:
        Campaign.at(directory).run(workers=1, stop=lambda: True)
    except EvaluationStopped:
        return


_CSV = b"""rules,scenario,robots,zone_miss,run,collected,lost
EVO 8,paper,4,0.08,0,5,1
EVO 8,paper,4,0.08,1,6,0
"""
_CLAIMS = b"where,paper,found,verdict\nTable 2,it works,it does,holds\n"
_HISTORY = b"generation,best_so_far,best,mean,invalid,distinct,seconds\n1,2.0,2.0,1.0,0,4,0.1\n"


def campaign_files(rng):
    files = {
        "campaign.yaml": TINY.to_yaml().encode(),
        "evolution/seed-1/history.csv": _HISTORY,
        "data/performance.csv": _CSV,
        "data/claims.csv": _CLAIMS,
        "report.html": b"<p>",
    }
    for name in rng.sample(list(files), rng.choice((1, 1, 2, 3))):
        files[name] = mutations.mutated_bytes(rng, files[name])
    if rng.random() < 0.3:
        text = mutations.mutated_text(rng, (TINY.to_yaml(),))
        files["campaign.yaml"] = text.encode("utf-8", "surrogatepass")
    return files


@cache
def doors():
    """All of them."""
    keys = ("type", "name", "value", "text", "on", "what", "rule", "key", "generation")
    any_messages = st.lists(mutations.json_objects(keys).map(json.dumps), max_size=3)
    return (
        Door("messages of the evolution page", lambda raw: talk(EvolutionPage, raw),
             (RefusedError,), messages(_EVOLUTION), any_messages, share=0.25),
        Door("messages of the experiments page", lambda raw: talk(ExperimentsPage, raw),
             (RefusedError,), messages(_EXPERIMENTS), any_messages, share=0.25),
        Door("messages to viser", to_viser, (RefusedError,), packed,
             mutations.json_objects(("type", "uuid", "updates", "name")).map(pack)
             | st.binary(max_size=60)),
        Door("journal", journal_file, (RefusedError,),
             lambda rng: mutations.mutated_bytes(rng, example_journal()), st.binary(max_size=200)),
        Door("campaign", campaign_directory, (CampaignError, StoreError), campaign_files,
             st.binary(max_size=60).map(lambda data: {"campaign.yaml": data}), share=0.25),
    )  # fmt: skip

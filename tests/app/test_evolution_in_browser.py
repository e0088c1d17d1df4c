"""The evolution page in a real browser, with real evolutions behind it."""

import re
import threading
import time
from pathlib import Path

import pytest

from geswarm.app.panels.evolution_page import EvolutionPage
from geswarm.app.server.access import Access
from geswarm.app.server.gate import open_server
from geswarm.app.state.evolution import EvolutionThread, Phase
from geswarm.app.state.session import Session
from geswarm.evolution import ScenarioFitness
from geswarm.rules import load_preset
from geswarm.sim import load_scenario
from tests.app.wire import typed

sync_api = pytest.importorskip("playwright.sync_api")
expect = sync_api.expect
pytestmark = pytest.mark.browser

EVO8 = load_preset("evo8")
TINY = {"population": 10, "evaluations": 1}
ENDLESS = {**TINY, "generations": 100_000}
FRAME = 0.02


class Served:
    """A session with the evolution page on a free port, without arena and panels."""

    def __init__(self):
        scenario = load_scenario("paper").with_changes(duration=50.0)
        self.session = Session(scenario, EVO8, EvolutionThread(workers=1))
        self.page = EvolutionPage(self.session)
        pages = {"evolution": self.page.channel}
        self.server = open_server(Access("127.0.0.1"), 0, pages, "test")
        self.address = f"http://127.0.0.1:{self.server.get_port()}/evolution/evolution.html"
        self._stop = threading.Event()
        self._loop = threading.Thread(target=self._run)
        self._loop.start()

    def _run(self):
        while not self._stop.wait(FRAME):
            self.session.frame(0.0, FRAME)
            self.page.sync(FRAME)

    def close(self):
        self._stop.set()
        self._loop.join(20)
        self.session.close()
        self.server.stop()
        assert not self._loop.is_alive()

    @property
    def evolution(self):
        return self.session.evolution

    def until(self, condition, seconds=60):
        end = time.monotonic() + seconds
        while not condition():
            assert time.monotonic() < end, "waited too long"
            time.sleep(0.02)

    def do(self, command):
        """Have the loop carry out a command, and wait for it."""
        done = threading.Event()
        self.session.post(lambda session: (command(session), done.set()))
        assert done.wait(20)

    def evolve(self, **values):
        """Start a run without the page."""

        def start(session):
            plan = session.runs.plan
            for name, value in values.items():
                plan = plan.with_value(name, value)
            session.runs.plan = plan
            session.runs.start(session.scenario)

        self.do(start)

    def finish(self, **values):
        """A whole small run; returns its name."""
        self.evolve(**{**TINY, "generations": 3, **values})
        self.until(lambda: self.evolution.phase is Phase.FINISHED)
        return self.evolution.directory.name


@pytest.fixture
def served(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    served = Served()
    yield served
    served.close()


@pytest.fixture
def page(browser, served):
    """The page; nothing in it may complain, a blocked script or style included."""
    context = browser.new_context(viewport={"width": 600, "height": 870})
    page = context.new_page()
    page.set_default_timeout(60_000)
    expect.set_options(timeout=60_000)
    complaints = []
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.on("console", lambda said: complaints.append(said.text) if said.type == "error" else None)
    page.goto(served.address)
    expect(page.get_by_test_id("freeze-4")).to_be_visible()
    yield page
    context.close()
    assert complaints == []


def fill(page, **values):
    for name, value in values.items():
        field = page.get_by_test_id(f"plan-{name}")
        field.fill(str(value))
        field.press("Tab")


def tab(page, name):
    page.get_by_test_id(f"tab-{name}").click()


def test_a_run_starts_with_a_changed_parameter_and_a_frozen_rule(page, served):
    page.get_by_test_id("preset-modern").click()
    expect(page.get_by_test_id("plan-selection")).to_have_value("tournament")
    fill(page, mutation=2)
    expect(page.get_by_test_id("plan-mutation-error")).to_contain_text("expected a probability")
    expect(page.get_by_test_id("start")).to_be_disabled()
    fill(page, mutation=0.25, seed=7, **ENDLESS)
    page.get_by_test_id("freeze-2").click()  # answers to what was typed may still come
    expect(page.get_by_test_id("plan-moved")).to_be_visible()
    expect(page.get_by_test_id("plan-mutation-error")).to_be_hidden()
    page.reload()
    expect(page.get_by_test_id("plan-mutation")).to_have_value("0.25")
    expect(page.get_by_test_id("freeze-2")).to_be_checked()
    page.get_by_test_id("start").click()
    expect(page.get_by_test_id("status")).to_contain_text(re.compile(r"Generation \d+ of 100000"))
    expect(page.get_by_test_id("about")).to_contain_text("seed 7 · 1 rule frozen")
    config = served.evolution.run.config
    assert (config.settings.mutation, config.seed) == (0.25, 7)
    assert config.frozen == (EVO8.rules[1],)


def test_what_is_being_typed_is_not_overwritten(page, served):
    field = page.get_by_test_id("plan-population")
    field.fill("123")
    served.do(lambda session: session.runs.freeze(0, True))
    expect(page.get_by_test_id("freeze-1")).to_be_checked()
    expect(field).to_have_value("123")
    field.press("Enter")
    served.until(lambda: served.session.runs.plan.values["population"] == 123)


def test_it_is_steered_and_what_is_injected_is_seen_in_the_curve(page, served):
    served.evolve(**ENDLESS)
    tab(page, "steer")
    page.get_by_test_id("steer-mutation").fill("0.4")
    page.get_by_test_id("steer-mutation").press("Enter")
    served.until(lambda: served.evolution.run.settings.mutation == 0.4)
    expect(page.get_by_test_id("slider-mutation")).to_have_value("0.4")
    expect(page.get_by_test_id("slider-tournament")).to_be_hidden()
    page.get_by_test_id("inject").click()
    expect(page.get_by_test_id("notice-info")).to_contain_text("EVO 8: enters with the next")
    log = page.get_by_test_id("steering-log")
    expect(log).to_contain_text("mutation 0.05 → 0.4")
    expect(log).to_contain_text(re.compile(r"rules from the table entered, fitness \d"))
    expect(page.locator("[data-testid=mark].entered circle")).to_be_visible()
    page.get_by_test_id("pause").click()
    expect(page.get_by_test_id("pause")).to_have_text("Go on")
    page.get_by_test_id("curves").focus()
    page.keyboard.press("Home")
    expect(page.get_by_test_id("curves-tip")).to_contain_text("generation 1")
    expect(page.get_by_test_id("curves-tip")).to_contain_text("best so far")


def test_rules_that_cannot_enter_are_named(page, served):
    served.evolve(**ENDLESS)
    action = {"p": 0.3, "behaviour": "RANDOM_WALK"}
    edit = {"do": "set", "rule": 0, "part": "actions", "at": 0, "element": action}
    served.do(lambda session: session.edit(typed(edit)))
    tab(page, "steer")
    page.get_by_test_id("inject").click()
    expect(page.get_by_test_id("notice-error")).to_contain_text("rule 1: p = 0.3 cannot evolve")
    expect(page.get_by_test_id("notice-error")).to_contain_text("the nearest is 0.1")
    page.get_by_test_id("pause").click()  # something else is asked for
    expect(page.get_by_test_id("notice-error")).to_have_count(0)


def test_an_individual_is_clicked_and_loaded(page, served):
    served.finish()
    tab(page, "population")
    expect(page.get_by_test_id("tile-size")).to_contain_text("10")
    first = page.get_by_test_id("individual-1")
    first.focus()
    first.press("ArrowDown")
    page.keyboard.press("Enter")
    expect(page.get_by_test_id("individual-2")).to_have_attribute("aria-selected", "true")
    expect(page.get_by_test_id("chosen-rules")).to_contain_text("rule")
    title = page.get_by_test_id("chosen-title").text_content()
    page.get_by_test_id("load").click()
    served.until(lambda: served.session.document.rule_set.name == title)
    page.reload()
    tab(page, "ancestors")
    expect(page.get_by_test_id("chosen-title")).to_have_text(title)
    page.get_by_test_id("ancestor-1").click()
    best = served.session.runs.look.best.origin
    expect(page.get_by_test_id("chosen-title")).to_contain_text(f"Generation {best.generation},")
    page.get_by_test_id("chosen-close").click()
    expect(page.get_by_test_id("chosen-title")).to_be_hidden()


def test_runs_are_compared_opened_and_deleted_after_a_question(page, served):
    first, second = served.finish(seed=1), served.finish(seed=2)
    tab(page, "runs")
    page.get_by_label(f"Compare {first}").check()
    expect(page.get_by_test_id("curves-legend")).to_contain_text(first)
    expect(page.locator(".chart path.other")).to_have_count(1)
    page.get_by_role("button", name=first, exact=True).click()
    expect(page.get_by_test_id("run")).to_have_text(first)
    expect(page.get_by_test_id("about")).to_contain_text("seed 1")
    page.get_by_role("button", name=f"Delete {first}").click()
    page.get_by_test_id("question-no").click()
    assert Path("runs", first).exists()
    page.get_by_role("button", name=f"Delete {first}").click()
    page.get_by_test_id("question-yes").click()
    expect(page.get_by_test_id("run")).to_have_text(second)
    assert not Path("runs", first).exists()
    assert Path("runs", second).exists()
    expect(page.get_by_test_id("tab-runs")).to_have_text("Runs1")


def test_a_run_is_resumed_after_a_question_if_another_is_under_way(page, served):
    served.evolve(seed=1, **ENDLESS)
    served.until(lambda: len(served.evolution.history) > 1)
    served.do(lambda session: session.evolution.stop())
    first = served.evolution.directory.name
    done = len(served.evolution.history)
    served.evolve(seed=2)
    tab(page, "runs")
    page.get_by_label(f"Resume {first}").click()
    expect(page.get_by_test_id("question")).to_contain_text("Stop the present run?")
    page.get_by_test_id("question-yes").click()
    expect(page.get_by_test_id("run")).to_have_text(first)
    served.until(lambda: len(served.evolution.history) > done)
    assert served.evolution.directory.name == first


def test_a_failed_evolution_is_shown_and_resumed(page, served, monkeypatch):
    evaluate = ScenarioFitness.__call__

    def fails(self, generation, individuals):
        if generation == 2:
            raise ValueError("<b>no robots</b>")
        return evaluate(self, generation, individuals)

    monkeypatch.setattr(ScenarioFitness, "__call__", fails)
    served.evolve(**{**TINY, "generations": 3})
    failure = page.get_by_test_id("failure")
    expect(failure).to_have_text("Evolution failed: ValueError: <b>no robots</b>")
    monkeypatch.setattr(ScenarioFitness, "__call__", evaluate)
    page.get_by_test_id("resume").click()
    expect(page.get_by_test_id("status")).to_contain_text("Generation 3 of 3 · finished")
    expect(failure).to_be_hidden()


def colour_of(node, name):
    """Of a node that may be drawn anew just now: one that has gone has no colour."""
    for _ in range(1000):
        if colour := node.evaluate("(node, name) => getComputedStyle(node)[name]", name):
            return colour
    raise AssertionError(f"{node} has no {name}")


def test_box_curve_and_name_of_a_compared_run_agree(page, served):
    names = [served.finish(seed=seed) for seed in (1, 2, 3)]
    tab(page, "runs")

    def agree(*compared):
        """Every run that is ticked, and no other, has a curve in the colour of its box."""
        legend = page.get_by_test_id("curves-legend").locator("span")
        expect(legend.filter(has_text="seed")).to_have_count(len(compared))
        colours = {}
        for name in names:
            box = page.get_by_label(f"Compare {name}")
            expect(box).to_be_checked(checked=name in compared)
            if name in compared:
                (entry,) = legend.filter(has_text=name).all()
                colours[name] = colour_of(entry.locator("i"), "backgroundColor")
                expect(box).to_have_css("accent-color", colours[name])
        drawn = [colour_of(line, "stroke") for line in page.locator(".chart path.line").all()]
        assert set(colours.values()) <= set(drawn)
        assert len(set(colours.values())) == len(compared)
        return colours

    first, second, third = names
    for name in (first, second, third):
        page.get_by_label(f"Compare {name}").click()
    before = agree(first, second, third)
    page.get_by_label(f"Compare {first}").click()
    expect(page.get_by_test_id("curves-legend")).not_to_contain_text(first)
    after = agree(second, third)
    assert {name: before[name] for name in after} == after
    page.get_by_role("button", name=second, exact=True).click()
    expect(page.get_by_test_id("run")).to_have_text(second)
    expect(page.get_by_test_id("about")).to_contain_text("seed 2")
    assert agree(second, third) == after


def test_a_run_that_was_reopened_is_resumed_to_another_end(page, served):
    first, second = served.finish(seed=1), served.finish(seed=2)
    tab(page, "runs")
    expect(page.get_by_test_id("run")).to_have_text(second)
    page.get_by_role("button", name=first, exact=True).click()
    field = page.get_by_test_id("resume-generations")
    expect(page.get_by_test_id("run")).to_have_text(first)
    expect(page.get_by_test_id("about")).to_contain_text("seed 1")
    expect(field).to_have_value("6")
    field.click()
    page.keyboard.press("ControlOrMeta+a")
    page.keyboard.type("2")
    page.get_by_test_id("resume").click()
    expect(page.get_by_test_id("notice-error")).to_contain_text("3 generations are done")
    expect(field).to_have_value("2")
    field.click()
    page.keyboard.press("ControlOrMeta+a")
    page.keyboard.type("5")
    page.get_by_test_id("resume").click()
    expect(page.get_by_test_id("status")).to_contain_text("Generation 5 of 5 · finished")
    expect(page.get_by_test_id("run")).to_have_text(first)
    expect(field).to_have_value("10")
    assert len(served.evolution.history) == 5


def test_behaviours_keep_number_and_colour_from_generation_to_generation(page, served):
    served.evolve(**{**ENDLESS, "population": 30, "mutation": 0.0, "crossover": 0.0})
    tab(page, "population")
    expect(page.get_by_test_id("tile-size")).to_contain_text("30")

    def seen():
        """Number and colour by behaviour, of one generation that is not the last one looked at."""
        look = served.session.runs.look
        labels = {one: (label.number, label.colour) for one, label in look.labels.items()}
        return len(look.history), labels

    before, labels = seen()
    served.until(lambda: seen()[0] > before + 5)
    _, later = seen()
    stayed = labels.keys() & later.keys()
    assert stayed
    assert all(later[one] == labels[one] for one in stayed if labels[one][1] is not None)
    page.get_by_test_id("pause").click()
    expect(page.get_by_test_id("pause")).to_have_text("Go on")
    bar = page.get_by_test_id("behaviours").evaluate(
        "bar => [...bar.children].map((one) => getComputedStyle(one).backgroundColor)"
    )
    assert len(set(bar)) == len(bar) > 1

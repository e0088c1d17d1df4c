"""The dashboard: one server, one session, one loop that keeps the screen up to date."""

from __future__ import annotations

import argparse
import logging
import signal
import sys
import threading
import time
from collections.abc import Collection

import viser

from geswarm.cli import UsageError
from geswarm.cli.stopping import compile_first
from geswarm.rules import RuleSet, RuleSetError, load_rule_set
from geswarm.sim import Scenario, ScenarioError, available_cores, load_scenario, vocabulary_of

from .panels.evolution_page import EvolutionPage
from .panels.evolution_panel import EvolutionPanel
from .panels.experiments_page import ExperimentsPage
from .panels.inspector_panel import InspectorPanel
from .panels.record_panel import RecordPanel
from .panels.rule_page import RulePage
from .panels.scenario_panel import ScenarioPanel
from .panels.show_panel import ShowPanel
from .panels.swarm_panel import SwarmPanel
from .scene.recorder import Recorder
from .scene.replay import Setting
from .scene.stage import Stage
from .server.access import Access, Name, format_name, machine_address
from .server.gate import open_server
from .server.listening import ServerError
from .state.evolution import EvolutionThread
from .state.journal import Journal, journal_directory
from .state.references import first_rules
from .state.session import Session

FRAME_SECONDS = 1 / 30
_SIMULATION_SHARE = 0.6  # of a frame; the rest is for the display
_LONGEST_FRAME = 1.0  # s: when the machine has slept, or hung, nothing catches up
_PANEL_SECONDS = 0.1  # numbers need not change faster

_PAGES_WIDTH = 600
_CONTROLS_WIDTH = 320
_BRAND, _BRAND_IN_THE_DARK = (15, 98, 214), (59, 130, 246)
_FRAME = (
    '<iframe src="{page}/{page}.html?theme={theme}" title="{title}" '
    'style="display:block;width:100%;height:calc(100vh - 72px);border:0"></iframe>'
)

logger = logging.getLogger(__name__)


class Dashboard:
    """Everything on the screen, over one session.

    Attributes:
        server: viser's server, behind the gate.
        access: Who is let in.
        session: What is shown.
        pages: What talks to each page beside the arena, by its name.
    """

    def __init__(self, session: Session, access: Access, port: int, dark: bool = False) -> None:
        self.session = session
        self.access = access
        self.rule_page = RulePage(session)
        self.evolution_page = EvolutionPage(session)
        self.experiments_page = ExperimentsPage(session)
        self.pages = {
            "rules": self.rule_page.channel,
            "evolution": self.evolution_page.channel,
            "experiments": self.experiments_page.channel,
        }
        made = {"experiments": self.experiments_page.made_file}
        self.server = open_server(access, port, self.pages, "GESwarm", made)
        self.stage = Stage(session)
        self.recorder = Recorder()
        self.swarm_panel = SwarmPanel(session, self.stage.keeper)
        self.inspector_panel = InspectorPanel(session)
        self.show_panel = ShowPanel(session)
        self.scenario_panel = ScenarioPanel(session)
        self.record_panel = RecordPanel(session, self.recorder)
        self.evolution_panel = EvolutionPanel(session)
        self._stop = threading.Event()
        self._build(dark)

    @property
    def address(self) -> str:
        """Where the server is."""
        return f"http://{machine_address(self.server.get_host())}:{self.server.get_port()}"

    @property
    def link(self) -> str:
        """What to open in a browser: the address, with the token if one is demanded."""
        return self.address if self.access.token is None else self._link("/")

    @property
    def page_links(self) -> list[str]:
        """What to open in a browser without WebGL, which the pages beside the arena do not need."""
        return [self._link(f"/{page}/{page}.html") for page in self.pages]

    def _link(self, path: str) -> str:
        token = self.access.token
        return f"{self.address}{path}" if token is None else f"{self.address}{path}?token={token}"

    def _build(self, dark: bool) -> None:
        gui = self.server.gui
        gui.configure_theme(
            show_logo=False,
            show_share_button=False,
            brand_color=_BRAND_IN_THE_DARK if dark else _BRAND,
            dark_mode=dark,
        )
        self.stage.build(self.server)
        with gui.add_folder("Swarm"):
            self.swarm_panel.build(gui)
        self.inspector_panel.build(gui)
        with gui.add_folder("Show", expand_by_default=False):
            self.show_panel.build(gui)
        with gui.add_folder("Scenario", expand_by_default=False):
            self.scenario_panel.build(gui)
        with gui.add_folder("Evolution"):
            self.evolution_panel.build(gui)
        with gui.add_folder("Record", expand_by_default=False):
            self.record_panel.build(gui, self.server)
        gui.main_panel.dock_left()
        gui.main_panel.set_width(_CONTROLS_WIDTH)
        pages = gui.add_panel()
        theme = "dark" if dark else "light"
        with pages.add_tab("Rules", viser.Icon.TABLE):
            gui.add_html(_FRAME.format(page="rules", title="Rule table", theme=theme))
        with pages.add_tab("Evolution", viser.Icon.DNA_2):
            gui.add_html(_FRAME.format(page="evolution", title="Evolution", theme=theme))
        with pages.add_tab("Experiments", viser.Icon.FLASK):
            gui.add_html(_FRAME.format(page="experiments", title="Experiments", theme=theme))
        pages.dock_right()
        pages.set_width(_PAGES_WIDTH)

    def run(self) -> None:
        """Show the session until `stop` is called."""
        last = last_panels = time.perf_counter()
        while not self._stop.is_set():
            now = time.perf_counter()
            try:
                self._frame(min(now - last, _LONGEST_FRAME))
                if now - last_panels >= _PANEL_SECONDS:
                    last_panels = now
                    self._sync_panels()
            except Exception:  # one bad frame or command must not end the session
                logger.exception("a frame failed")
            last = now
            self._stop.wait(max(0.0, FRAME_SECONDS - (time.perf_counter() - now)))

    def stop(self) -> None:
        """End `run`; from any thread."""
        self._stop.set()

    def close(self) -> None:
        """Stop the session's background work and the server."""
        self.session.close()
        self.server.stop()

    def _frame(self, elapsed: float) -> None:
        session = self.session
        before = session.world.time
        session.frame(elapsed, _SIMULATION_SHARE * FRAME_SECONDS)
        if self.recorder.recording:  # what was changed holds from before this frame's steps
            self.recorder.note(Setting.of(session), min(before, session.world.time))
        self.stage.captioned = self.recorder.recording
        self.stage.keeper.frame = self._slowest_frame()
        self.stage.sync(elapsed)
        self.recorder.sync(elapsed)
        self.rule_page.sync(elapsed)
        self.evolution_page.sync(elapsed)
        self.experiments_page.sync(elapsed)

    def _slowest_frame(self) -> float | None:
        """Seconds per frame of the slowest browser, as the pages beside the arena tell."""
        pages = (self.rule_page, self.evolution_page, self.experiments_page)
        told = [page.channel.slowest_frame() for page in pages]
        return max((frame for frame in told if frame is not None), default=None)

    def _sync_panels(self) -> None:
        for panel in (
            self.swarm_panel,
            self.inspector_panel,
            self.show_panel,
            self.scenario_panel,
            self.evolution_panel,
            self.record_panel,
        ):
            panel.sync()


def run_dashboard(options: argparse.Namespace) -> int:
    """Serve the dashboard until Ctrl-C."""
    try:
        scenario = load_scenario(options.scenario or "paper")
        known = vocabulary_of(scenario)
        given = options.rules
        rule_set = load_rule_set(given, known) if given else first_rules(scenario)
    except (ScenarioError, RuleSetError) as error:
        raise UsageError(str(error)) from error
    compile_first("geswarm-ui: stopped", scenario, interactive=True)
    port = 8080 if options.port is None else options.port
    try:
        dashboard = open_dashboard(
            scenario,
            rule_set,
            options.host or "127.0.0.1",
            port,
            options.workers,
            options.dark,
            options.token,
            options.allow_host or (),
        )
    except ServerError as error:
        raise UsageError(str(error)) from error
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: dashboard.stop())
    dashboard.session.post(lambda session: session.play())
    try:
        _announce(dashboard, port)
        dashboard.run()
    finally:
        evolution = dashboard.session.evolution
        if evolution.active:
            hint = f"geswarm-ui --no-ui --resume {evolution.directory}"
            print(f"Evolution stopped; it can go on with: {hint}", file=sys.stderr)
        dashboard.close()
    return 0


def open_dashboard(
    scenario: Scenario,
    rule_set: RuleSet,
    host: str,
    port: int,
    workers: int | None = None,
    dark: bool = False,
    private: bool = False,
    names: Collection[Name] = (),
) -> Dashboard:
    """A dashboard that is served but not yet running.

    Args:
        scenario: Where the swarm starts.
        rule_set: What it runs.
        host: Address to listen on.
        port: Port to listen on; 0 for any.
        workers: Threads for evolution; None leaves one core to the arena.
        dark: Light text on a dark ground.
        private: Demand a token even where only this machine can reach the address.
        names: Under which a proxy reaches it.

    Raises:
        ServerError: It cannot listen there.
    """
    if workers is None:
        workers = max(1, available_cores() - 1)
    journal = Journal(journal_directory())
    session = Session(scenario, rule_set, EvolutionThread(workers), journal=journal)
    return Dashboard(session, Access.to_host(host, private, names), port, dark)


def _announce(dashboard: Dashboard, wanted_port: int) -> None:
    port = dashboard.server.get_port()
    if wanted_port not in (0, port):
        print(f"Port {wanted_port} is busy, using {port} instead.", file=sys.stderr)
    access = dashboard.access
    if not access.loopback:
        print(
            "Warning: whoever has the address below can use the dashboard; nothing is encrypted.",
            file=sys.stderr,
        )
    print(f"GESwarm is at {dashboard.link}  (Ctrl-C ends it)", flush=True)
    print("Its pages that need no WebGL:", *dashboard.page_links, sep="\n  ", flush=True)
    names = ", ".join(map(format_name, access.names))
    if names and access.token is None:
        print(
            f"Warning: whoever can open {names} can use the dashboard, unless the proxy asks who "
            "they are; --token lets in only who has the token.",
            file=sys.stderr,
        )
    elif names:
        print(f"Through a proxy ({names}), add to its address: ?token={access.token}", flush=True)

"""The panel that records a stretch of the arena."""

from __future__ import annotations

from html import escape

import viser

from ..scene.recorder import LONGEST_SECONDS, Recorder, RecorderPhase
from ..state.playback import clock
from ..state.session import Session

_START, _STOP = "Start recording", "Stop and download"


class RecordPanel:
    """One button and a line that tells what is going on."""

    def __init__(self, session: Session, recorder: Recorder) -> None:
        self.session = session
        self.recorder = recorder
        self._shown = ""

    def build(self, gui: viser.GuiApi, server: viser.ViserServer) -> None:
        """Make the widgets in the present container."""
        self._button = gui.add_button(
            _START,
            icon=viser.Icon.PLAYER_RECORD,
            hint="What the arena shows, as one file that any browser plays",
        )
        self._text = gui.add_html("")

        @self._button.on_click
        def _(event: viser.GuiEvent[viser.GuiButtonHandle]) -> None:
            client = event.client
            self.session.post(lambda _: self._start_or_stop(server, client))

    def sync(self) -> None:
        """Show the recorder as it is."""
        recorder = self.recorder
        recording = recorder.phase is RecorderPhase.RECORDING
        self._button.label = _STOP if recording else _START
        self._button.icon = viser.Icon.PLAYER_STOP_FILLED if recording else viser.Icon.PLAYER_RECORD
        self._button.disabled = recorder.phase is RecorderPhase.PACKING
        text = status(recorder)
        if text != self._shown:
            self._shown = text
            self._text.content = (
                f'<div style="padding:.1em .9em .4em;font-size:.85em">{escape(text)}</div>'
            )

    def _start_or_stop(self, server: viser.ViserServer, client: viser.ClientHandle | None) -> None:
        if self.recorder.phase is RecorderPhase.RECORDING:
            self.recorder.stop()
        else:
            self.recorder.start(server, client)


def status(recorder: Recorder) -> str:
    """What is going on, in one line."""
    if recorder.phase is RecorderPhase.RECORDING:
        return f"Recording {clock(recorder.seconds)} of at most {clock(LONGEST_SECONDS)}."
    if recorder.phase is RecorderPhase.PACKING:
        return f"Packing {clock(recorder.seconds)} into one file…"
    if recorder.problem:
        return f"The replay could not be made: {recorder.problem}"
    if recorder.size:
        length, size = clock(recorder.seconds), recorder.size / 1e6
        return f"{recorder.file_name}: {length}, {size:.1f} MB."
    return f"Up to {clock(LONGEST_SECONDS)} minutes, as one HTML file that plays in any browser."

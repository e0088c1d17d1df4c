"""Records what the scene shows and makes one self-contained HTML file of it."""

from __future__ import annotations

import threading
from enum import Enum
from urllib.parse import quote

import viser
from viser.infra import StateSerializer

from ..server.gate import COMMON, static_folder
from ..server.viewer_page import named
from . import replay
from .camera import FARTHEST
from .replay import Passage, Setting

LONGEST_SECONDS = 300.0


class RecorderPhase(Enum):
    """What the recorder is doing."""

    IDLE = "idle"
    RECORDING = "recording"
    PACKING = "packing"


class Recorder:
    """Records from `start` to `stop`, then packs on a thread of its own and sends the file.

    Owned by the loop.

    Attributes:
        phase: What it is doing.
        seconds: Length of the recording.
        passages: Who forages where in it, from when on.
        file_name: Of the last file.
        size: Of the last file, bytes; 0 before the first.
        problem: Why the last file could not be made, else empty.
    """

    def __init__(self) -> None:
        self.phase = RecorderPhase.IDLE
        self.seconds = 0.0
        self.passages: list[Passage] = []
        self.file_name = ""
        self.size = 0
        self.problem = ""
        self._serializer: StateSerializer | None = None
        self._client: viser.ClientHandle | None = None
        self._thread: threading.Thread | None = None

    def start(self, server: viser.ViserServer, client: viser.ClientHandle | None) -> None:
        """Begin with the scene as it is, for the client that shall get the file."""
        if self.phase is RecorderPhase.IDLE:
            camera = server.initial_camera
            hidden, camera.far = camera.far, FARTHEST  # nobody aims the camera of a replay
            self._serializer = server.get_scene_serializer()
            camera.far = hidden
            self._client = client
            self.seconds, self.problem = 0.0, ""
            self.passages = []
            self.phase = RecorderPhase.RECORDING

    @property
    def recording(self) -> bool:
        """True from `start` to `stop`."""
        return self.phase is RecorderPhase.RECORDING

    def note(self, setting: Setting, time: float) -> None:
        """Keep what is to be told in words, if it is another than before.

        Args:
            setting: Who forages where now.
            time: Simulated, since the start of the run (s).
        """
        if not self.passages or self.passages[-1].setting != setting:
            self.passages.append(Passage(time, setting))

    def sync(self, elapsed: float) -> None:
        """Let time go by in the recording; it ends by itself at `LONGEST_SECONDS`."""
        if self.recording and self._serializer is not None:
            self._serializer.insert_sleep(elapsed)
            self.seconds += elapsed
            if self.seconds >= LONGEST_SECONDS:
                self.stop()

    def stop(self) -> None:
        """End the recording; the file follows as soon as it is packed."""
        if self.recording and self._serializer is not None:
            self.phase = RecorderPhase.PACKING
            self._thread = threading.Thread(
                target=self._pack,
                args=(self._serializer, self._client, tuple(self.passages)),
                daemon=True,
            )
            self._thread.start()
            self._serializer = self._client = None

    def join(self, timeout: float = 60.0) -> None:
        """Wait until a file that is being packed is sent."""
        if self._thread is not None:
            self._thread.join(timeout)

    def _pack(
        self,
        serializer: StateSerializer,
        client: viser.ClientHandle | None,
        passages: tuple[Passage, ...],
    ) -> None:
        try:
            content = replay.told(named(serializer.as_html(), _icon()), passages).encode()
            self.file_name, self.size = replay.file_name(passages), len(content)
            if client is not None:
                client.send_file_download(self.file_name, content, save_immediately=True)
        except Exception as error:  # the arena goes on, and the user is told
            self.problem = f"{type(error).__name__}: {error}"
        self.phase = RecorderPhase.IDLE


def _icon() -> str:
    """Our icon as an address that holds it."""
    icon = (static_folder() / COMMON / "icon.svg").read_text(encoding="utf-8")
    return f"data:image/svg+xml,{quote(icon)}"

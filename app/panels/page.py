"""What the Python halves of all pages have in common: a channel, and who carries out what."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any, TypeAlias

from ..protocol.base import Message, NoticeMessage, Request, Watch
from ..protocol.pages import reader_of
from ..server.channel import Channel, Client
from ..state.session import Session

REFRESH_SECONDS = 0.5
WATCHED_SECONDS = 3.0
"""How long a page that said that it is in view is believed."""

Sources: TypeAlias = dict[type[Message], tuple[tuple[object, ...], Callable[[], Message]]]
"""By class of message: what it is made of, and how."""


class RequestError(ValueError):
    """A message of a page that cannot be carried out as it is; says why."""


class Page(ABC):
    """Takes what pages say to the loop, and the answers back.

    Args:
        session: Whose state is shown.
        name: Of the page: a folder of `static`.
        watched: The page says when it is in view.
    """

    def __init__(self, session: Session, name: str, *, watched: bool) -> None:
        self.session = session
        self.channel = Channel(
            reader_of(name, watched=watched),
            on_message=lambda client, message: session.post(
                lambda _: self._receive(client, message)
            ),
            on_refused=lambda client, why: session.post(lambda _: self._refuse(client, why)),
            on_connect=lambda client: session.post(lambda _: self._greet(client)),
        )

    @abstractmethod
    def sync(self, elapsed: float) -> None:
        """Send what has changed to all pages; called by the loop once a frame."""

    @abstractmethod
    def _greet(self, client: Client) -> None:
        """Tell a page that has come how things stand."""

    @abstractmethod
    def _receive(self, client: Client, message: Request) -> None:
        """Carry out what a page asks for."""

    def _refuse(self, client: Client, why: str) -> None:
        """Tell a page that something was not done."""
        self.channel.send(client, NoticeMessage("error", why))


class WatchedPage(Page):
    """A page that is kept up to date while it is in view.

    Attributes:
        refusals: Errors that say why something was not done.
        typed: What is told again then: what was typed or ticked is not what holds.
        carry_out: How each request is carried out; what is returned is told to the page.
    """

    refusals: tuple[type[Exception], ...]
    typed: tuple[type[Message], ...]
    carry_out: dict[type[Request], Callable[[Any], str | None]]

    def __init__(self, session: Session, name: str) -> None:
        super().__init__(session, name, watched=True)
        self._watched = 0.0
        self._since_refresh = REFRESH_SECONDS
        self._seen: dict[type[Message], tuple[object, ...]] = {}

    @abstractmethod
    def refresh(self) -> None:
        """Find out what has changed outside the session."""

    @abstractmethod
    def sources(self) -> Sources:
        """What the page is told, each as soon as what it is made of changes."""

    def sync(self, elapsed: float) -> None:
        """Send what has changed to all pages; called by the loop once a frame."""
        if self._watched <= 0.0:
            return
        self._watched -= elapsed
        self._since_refresh += elapsed
        if self._since_refresh >= REFRESH_SECONDS:
            self._since_refresh = 0.0
            self.refresh()
        for kind, (source, build) in self.sources().items():
            if self._seen.get(kind) != source:
                self._seen[kind] = source
                self.channel.broadcast(build(), live=True)

    def _greet(self, client: Client) -> None:
        for _, build in self.sources().values():
            self.channel.send(client, build(), live=True)
        self.channel.welcome(client)
        self._watch()

    def _watch(self) -> None:
        """A page is in view."""
        if self._watched <= 0.0:
            self._since_refresh = REFRESH_SECONDS
        self._watched = WATCHED_SECONDS

    def _receive(self, client: Client, message: Request) -> None:
        if isinstance(message, Watch):
            self._watch()
            return
        try:
            told = self.carry_out[type(message)](message)
        except self.refusals as error:
            self._refuse(client, str(error))
        else:
            if told:
                self.channel.send(client, NoticeMessage("info", told))

    def _refuse(self, client: Client, why: str) -> None:
        super()._refuse(client, why)
        for kind in self.typed:
            self.channel.send(client, self.sources()[kind][1](), live=True)

"""JSON text that a page sent -> one of the structures that it may send."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Generic, TypeVar, Union

import msgspec

from .base import Structure
from .edits import read_model
from .refusals import explained

MAX_MESSAGE_BYTES = 256 * 1024

T = TypeVar("T", bound=Structure)


class MessageError(ValueError):
    """A message that cannot be read; the text is meant for the page that sent it."""


class Reader(Generic[T]):
    """Reads one of some kinds of structures.

    Args:
        kinds: What may come, by what it is called.
    """

    def __init__(self, kinds: Mapping[str, type[T]]) -> None:
        self._kinds = kinds
        self._decoder: msgspec.json.Decoder[T] = msgspec.json.Decoder(
            Union[tuple(kinds.values())],  # noqa: UP007
            dec_hook=read_model,
        )

    def read(self, raw: str | bytes) -> T:
        """The structure in a websocket message.

        Raises:
            MessageError: Too long, not text, not JSON, or not one of the structures.
        """
        size = len(raw if isinstance(raw, bytes) else raw.encode(errors="replace"))
        if size > MAX_MESSAGE_BYTES:
            raise MessageError(f"message of {size} bytes; expected at most {MAX_MESSAGE_BYTES}")
        if isinstance(raw, bytes):
            raise MessageError("expected a text message with a JSON object, got a binary message")
        try:
            return self._decoder.decode(raw)
        except msgspec.ValidationError as error:
            raise MessageError(explained(error, raw, self._kinds)) from error
        except (ValueError, RecursionError) as error:
            raise MessageError(f"expected a JSON object; this is not readable: {error}") from error


def encode(message: Structure) -> str:
    """JSON text of a message."""
    return msgspec.json.encode(message, enc_hook=_number).decode()


def _number(value: Any) -> Any:
    """NumPy's numbers are numbers."""
    if hasattr(value, "item"):
        return value.item()
    raise NotImplementedError

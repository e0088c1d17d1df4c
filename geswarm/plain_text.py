"""Text from files and standard input: UTF-8, with any line ends, a byte order mark or none."""

from __future__ import annotations

import codecs
from pathlib import Path
from typing import BinaryIO


class NotTextError(ValueError):
    """Bytes are not text in UTF-8; the message says where, or what they are."""


def read_file(path: str | Path, most: int) -> str:
    """The text of a file; see `read_stream`.

    Raises:
        OSError, ValueError: There is no such file, or it cannot be read.
        NotTextError: It is not text in UTF-8.
    """
    with Path(path).open("rb") as file:
        return read_stream(file, most)


def read_stream(stream: BinaryIO, most: int) -> str:
    """All text of a stream, or so much of it that it can be told to be longer than `most`.

    Raises:
        OSError: It cannot be read.
        NotTextError: It is not text in UTF-8.
    """
    enough = 4 * most + 8  # bytes: four for each character, and for a byte order mark
    data = stream.read(enough)
    return decode(data, whole=len(data) < enough)


def decode(data: bytes, whole: bool = True) -> str:
    r"""Text in UTF-8, without byte order mark, with \n at all line ends.

    Args:
        data: The bytes.
        whole: False if they may stop within a character.

    Raises:
        NotTextError: They are something else.
    """
    if name := _other_encoding(data):
        raise NotTextError(f"{name}, expected UTF-8")
    try:
        text = codecs.getincrementaldecoder("utf-8")().decode(data, final=whole)
    except UnicodeDecodeError as error:
        reason = f"not a text file, not UTF-8 at byte {error.start} ({error.reason})"
        raise NotTextError(reason) from error
    return tidy(text)


def tidy(text: str) -> str:
    r"""A text without byte order mark, with \n at all line ends."""
    return text.removeprefix("\ufeff").replace("\r\n", "\n").replace("\r", "\n")


def _other_encoding(data: bytes) -> str | None:
    """What text is in if not in UTF-8: it has a byte order mark, or a zero in its first letter."""
    if data.startswith((codecs.BOM_UTF32_LE, codecs.BOM_UTF32_BE)):
        name = codec = "UTF-32"
    elif data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        name = codec = "UTF-16"
    elif data[:2].count(0) == 1:
        name, codec = "UTF-16", "UTF-16-BE" if data[0] == 0 else "UTF-16-LE"
    else:
        return None
    try:
        data.decode(codec)
    except UnicodeDecodeError:
        return None
    return name

"""Messages as tests write and read them: JSON values."""

import json

import msgspec

from geswarm.app.protocol.edits import AnyEdit, read_model
from geswarm.app.protocol.reading import encode


def typed(edit):
    """An edit, from the JSON value that a page sends."""
    return msgspec.convert(edit, AnyEdit, dec_hook=read_model)


def as_read(message):
    """The JSON value of a message, which is what its structure says that it is."""
    text = encode(message)
    msgspec.json.decode(text, type=type(message), dec_hook=read_model)
    return json.loads(text)

"""What a browser may say to viser: what our widgets and our scene make it say, and nothing else.

viser believes its clients: any of them could change every property of every widget, fill the memory
with uploads for which there is no button, or leave a traceback on the terminal. Messages that are
not known here, or hold something else than they should, are not passed on.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal, TypeAlias

import msgspec

LARGEST = 2.0**53
"""A browser's numbers are whole up to here."""

Text: TypeAlias = Annotated[str, msgspec.Meta(max_length=1000)]
Value: TypeAlias = Annotated[float, msgspec.Meta(ge=-LARGEST, le=LARGEST)]  # no NaN, no infinity
Number: TypeAlias = Annotated[float, msgspec.Meta(ge=-1e9, le=1e9)]
Pair: TypeAlias = tuple[Number, Number]
Point: TypeAlias = tuple[Number, Number, Number]
Instance: TypeAlias = Annotated[int, msgspec.Meta(ge=0, lt=2**31)]


class _Message(msgspec.Struct, tag=True, tag_field="type", forbid_unknown_fields=True):
    """The tag is the name of viser's message."""


class _Updates(msgspec.Struct, forbid_unknown_fields=True):
    value: bool | Value | Text


class GuiUpdateMessage(_Message):
    """Somebody used a widget."""

    uuid: Text
    updates: _Updates


class CommandTriggerMessage(_Message):
    """Somebody pressed a key."""

    uuid: Text


class ViewerCameraMessage(_Message):
    """Somebody moved the camera, or the size of the picture changed."""

    wxyz: tuple[Number, Number, Number, Number]
    position: Point
    fov: Number
    near: Number
    far: Number
    image_height: Number
    image_width: Number
    look_at: Point
    up_direction: Point


class SceneNodeClickMessage(_Message):
    """Somebody clicked a robot."""

    name: Text
    instance_index: Instance | None
    ray_origin: Point
    ray_direction: Point
    screen_pos: Pair
    modifier: Text | None
    owner: Text = ""


class SceneNodeDragMessage(_Message):
    """Somebody drags a robot or an object."""

    phase: Literal["start", "update", "end"]
    name: Text
    instance_index: Instance | None
    start_position: Point
    start_screen_pos: Pair
    end_position: Point
    end_screen_pos: Pair
    button: Literal["left", "middle", "right"]
    modifier: Text | None
    owner: Text = ""


class ScenePointerMessage(_Message):
    """Somebody clicked anywhere."""

    event_type: Literal["click"]
    ray_origin: Point
    ray_direction: Point
    screen_pos: Annotated[tuple[Pair, ...], msgspec.Meta(min_length=1, max_length=2)]
    modifier: Text | None


_DECODER = msgspec.msgpack.Decoder(
    GuiUpdateMessage
    | CommandTriggerMessage
    | ViewerCameraMessage
    | SceneNodeClickMessage
    | SceneNodeDragMessage
    | ScenePointerMessage
)


def is_expected(raw: str | bytes, widgets: Mapping[str, Any]) -> bool:
    """Whether a message of a browser may be passed on to viser.

    Args:
        raw: As it was received.
        widgets: viser's handles of all widgets that can be used, by their name in messages.
    """
    if isinstance(raw, str):
        return False
    try:
        message = _DECODER.decode(raw)
    except (ValueError, RecursionError):  # not MessagePack, not text in UTF-8, not as expected
        return False
    if isinstance(message, GuiUpdateMessage):
        widget = widgets.get(message.uuid)
        return widget is not None and _suits(widget, message.updates.value)
    return True


def _suits(widget: Any, value: bool | float | str) -> bool:
    """Whether a widget could be set to a value in a browser."""
    options = getattr(widget, "options", None)
    if options is not None:
        return value in options
    if isinstance(value, bool) or isinstance(widget.value, bool):
        return isinstance(value, bool) and isinstance(widget.value, bool)
    if isinstance(value, str) or isinstance(widget.value, str):
        return isinstance(value, str) and isinstance(widget.value, str)
    low, high = getattr(widget, "min", None), getattr(widget, "max", None)
    return (low is None or low <= value) and (high is None or value <= high)

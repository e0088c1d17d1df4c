"""Browsers that say to viser what no browser of ours says: nothing of it is done."""

import math
import time

import msgspec
import pytest
import viser
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from geswarm.app.dashboard import open_dashboard
from geswarm.app.server.gate import MAX_FRAME_BYTES
from geswarm.rules import load_preset
from geswarm.sim import load_scenario

PATIENCE = 60


@pytest.fixture
def dashboard(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    dashboard = open_dashboard(load_scenario("paper"), load_preset("evo8"), "127.0.0.1", 0)
    dashboard._frame(0.0)  # draws the arena
    yield dashboard
    dashboard.close()


def open_socket(dashboard):
    """A browser, as far as viser can tell: it counts once it has told its camera."""
    socket = connect(
        dashboard.address.replace("http", "ws"),
        subprotocols=[f"viser-v{viser.__version__}"],
        max_size=None,
        open_timeout=PATIENCE,
    )
    socket.send(packed("ViewerCameraMessage", **CAMERA))
    carried_out(dashboard, dashboard.server.get_clients)
    return socket


def widgets(dashboard):
    return dashboard.server.gui._gui_input_handle_from_uuid


def widget(dashboard, label):
    (found,) = [one for one in widgets(dashboard).values() if getattr(one, "label", "") == label]
    return found


def packed(kind, **values):
    return msgspec.msgpack.encode({"type": kind, **values})


def update(uuid, **updates):
    return packed("GuiUpdateMessage", uuid=uuid, updates=updates)


POINT, PAIR = [0.0, 0.0, 0.0], [0.0, 0.0]
CAMERA = {
    "wxyz": [1.0, 0.0, 0.0, 0.0],
    "position": [0.0, 0.0, 9.0],
    "fov": 0.5,
    "near": 0.1,
    "far": 1000.0,
    "image_height": 600,
    "image_width": 800,
    "look_at": POINT,
    "up_direction": [0.0, 1.0, 0.0],
}
CLICK = {
    "name": "/arena/trims",
    "instance_index": 0,
    "ray_origin": POINT,
    "ray_direction": [0.0, 0.0, -1.0],
    "screen_pos": PAIR,
    "modifier": None,
    "owner": "",
}
DRAG = {
    "phase": "start",
    "name": "/arena/trims",
    "instance_index": 0,
    "start_position": POINT,
    "start_screen_pos": PAIR,
    "end_position": POINT,
    "end_screen_pos": PAIR,
    "button": "left",
    "modifier": None,
    "owner": "",
}


def strange_messages(dashboard):
    """What must not reach viser."""
    seed, scenario = widget(dashboard, "Seed")._impl.uuid, widget(dashboard, "Scenario")._impl.uuid
    trails = widget(dashboard, "Trails")._impl.uuid
    upload = {"source_component_uuid": seed, "transfer_uuid": "t"}
    return {
        "text": "hello",
        "nothing": b"",
        "no MessagePack": b"\xc1\x00\xff",
        "deep": b"\x91" * 100_000,
        "no object": msgspec.msgpack.encode([1, 2]),
        "no type": msgspec.msgpack.encode({"a": 1}),
        "list as type": msgspec.msgpack.encode({"type": [1]}),
        "unknown type": packed("Nonsense"),
        "nothing in it": packed("GuiUpdateMessage"),
        "unknown widget": update("nobody", value=1),
        "another property": update(seed, label="<img src=x onerror=alert(1)>"),
        "callbacks": update(seed, update_cb=[]),
        "text for a number": update(seed, value="x"),
        "switch for a number": update(seed, value=True),
        "number for a switch": update(trails, value=2),
        "nan": update(seed, value=math.nan),
        "negative": update(seed, value=-1),
        "too large": update(seed, value=1e300),
        "a path as scenario": update(scenario, value="/etc/passwd"),
        "share": packed("ShareUrlRequest"),
        "render": packed("GetRenderResponseMessage", payload=b"x", render_uuid="x"),
        "dirty": packed("GuiFormDirtyMessage", uuid="x"),
        "upload": packed(
            "FileTransferStartUpload",
            **upload, filename="x", mime_type="x", part_count=9, size_bytes=10**9,
        ),
        "part": packed("FileTransferPart", **upload, part_index=0, content=b"x" * 100_000),
        "click with more": packed("SceneNodeClickMessage", **CLICK, more=1),
        "half a robot": packed("SceneNodeClickMessage", **CLICK | {"instance_index": 0.5}),
        "nowhere": packed("SceneNodeDragMessage", **DRAG | {"end_position": [math.nan] * 3}),
    }  # fmt: skip


def state(dashboard):
    """What all browsers are shown."""
    values = {
        uuid: (one.value, getattr(one, "label", None), list(one._impl.update_cb))
        for uuid, one in widgets(dashboard).items()
    }
    session = dashboard.session
    return values, session.scenario, session.selected, session.held, session.world.seed


def carried_out(dashboard, condition):
    end = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < end
        dashboard._frame(0.0)
        time.sleep(0.01)


def test_strange_messages_do_nothing(dashboard, caplog, capfd):
    seed = widget(dashboard, "Seed")._impl.uuid
    with open_socket(dashboard) as socket:
        for what, raw in strange_messages(dashboard).items():
            before = state(dashboard)
            socket.send(raw)
            number = before[-1] + 1
            socket.send(update(seed, value=number))  # the next one is heard
            carried_out(dashboard, lambda number=number: dashboard.session.world.seed == number)
            after = state(dashboard)
            assert after[0].pop(seed)[0] == number
            before[0].pop(seed)
            assert after[:-1] == before[:-1], what
        assert not dashboard.server.gui._current_file_upload_states
    assert not caplog.records
    assert capfd.readouterr() == ("", "")


def test_clicks_and_drags_arrive(dashboard, caplog):
    session = dashboard.session
    robots = session.scenario.robots
    with open_socket(dashboard) as socket:
        # There is no such robot: nothing is done, and nothing fails.
        socket.send(packed("SceneNodeDragMessage", **DRAG | {"instance_index": robots}))
        socket.send(packed("SceneNodeClickMessage", **CLICK | {"instance_index": robots}))
        socket.send(packed("SceneNodeClickMessage", **CLICK | {"instance_index": 2}))
        carried_out(dashboard, lambda: session.selected == 2)
    assert not caplog.records


def test_a_message_that_is_too_long_is_not_read(dashboard, caplog):
    with open_socket(dashboard) as socket:
        socket.send(b"\0" * (MAX_FRAME_BYTES + 1))
        with pytest.raises(ConnectionClosed, match="1009"):
            all(socket.recv(timeout=PATIENCE) for _ in iter(int, 1))
    with open_socket(dashboard) as socket:
        socket.recv(timeout=PATIENCE)
    assert not caplog.records

"""Reading the arena of a scenario file: from YAML to shapes, patches and lights."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from geswarm.rules.findings import Place
from geswarm.sim.arena.checks import (
    COORDINATE,
    MOST,
    NUMBERS,
    SIZE,
    area_problem,
    choice_problem,
    point_problem,
    polygon_problem,
)
from geswarm.sim.arena.model import (
    COLOURS,
    SIDES,
    ZONES,
    Arena,
    Band,
    Box,
    Disc,
    HalfPlane,
    Light,
    Outline,
    Patch,
    Point,
    Polygon,
    Shape,
    normalised,
    regular,
)
from geswarm.sim.parameter import Parameter
from geswarm.sim.scenario.yaml_items import Item, ItemReader

_OUTLINES = ("rectangle", "circle", "regular", "polygon")
ARENA_KEYS = (
    "width", "length", *_OUTLINES, "obstacles", "walls", "floor", "patches", "lights", "start",
)  # fmt: skip
_SHAPES = ("disc", "box", "polygon", "half_plane", "band")
_RADII = ("side", "radius", "apothem")
_ANGLE = NUMBERS[Box]["angle"]
_FLOORS = {"nest": "white", "source": "black"}


class Given(NamedTuple):
    """A value and where it is written."""

    value: Any
    place: Place


@dataclass(frozen=True)
class _OfArea:
    """The region of start: that of an area."""

    name: str


class ArenaReader(ItemReader):
    """Reads what a file says of its arena."""

    def read(self, entries: Mapping[str, Item]) -> dict[str, Given]:
        """What is given, by the key of `ARENA_KEYS`; any outline but a rectangle as `outline`."""
        given: dict[str, Given] = {}
        chosen = [key for key in entries if key in _OUTLINES]
        if sides := [key for key in entries if key in ("width", "length")]:
            chosen.append(sides[0])
        for other in chosen[1:]:
            self.wrong(entries[other].place, f"expected one outline, there is {chosen[0]} already")
        for key, item in entries.items():
            value = item.plain if key in ("width", "length") else getattr(self, f"_{key}")(item)
            if key == "rectangle":
                for name, side in zip(("width", "length"), value or (), strict=False):
                    given[name] = Given(side, item.place)
            elif value is not None:
                given["outline" if key in _OUTLINES else key] = Given(value, item.place)
        return given

    def _rectangle(self, item: Item) -> list[Any] | None:
        if isinstance(item.value, list) and len(item.value) == 2:
            sides: list[Any] = item.plain
            return sides
        self.wrong(item.place, "expected two numbers [width, length]")
        return None

    def _circle(self, item: Item) -> Disc | None:
        radius = self.number(item, SIZE)
        return None if radius is None else Disc(0.0, 0.0, radius)

    def _regular(self, item: Item) -> Polygon | None:
        entries = self.keys(item, ("corners", *_RADII, "turn"), ("corners",))
        if entries is None:
            return None
        kinds = [key for key in _RADII if key in entries]
        if len(kinds) != 1:
            self.wrong(item.place, f"expected one of {', '.join(_RADII)}")
            return None
        corners = self.number(entries["corners"], Parameter(int, 3, MOST["corners"]))
        size = self.number(entries[kinds[0]], SIZE)
        turn = self.number(entries["turn"], _ANGLE) if "turn" in entries else None
        if corners is None or size is None:
            return None
        half = math.pi / corners
        ratio = {"side": 0.5 / math.sin(half), "apothem": 1.0 / math.cos(half)}
        return regular(int(corners), size * ratio.get(kinds[0], 1.0), turn)

    def _polygon(self, item: Item) -> Polygon | None:
        if not self.right(item, polygon_problem(item.plain)):
            return None
        return normalised(Polygon(tuple((x, y) for x, y in item.plain)))

    def _obstacles(self, item: Item) -> tuple[Given, ...]:
        parts = self.parts(item, MOST["obstacles"], "obstacles")
        found = [(self._shape(part, ("box", "disc")), part.place) for part in parts]
        return tuple(Given(shape, place) for shape, place in found if shape)

    def _walls(self, item: Item) -> tuple[Given, ...]:
        parts = self.parts(item, MOST["obstacles"], "walls")
        found = [(self._wall(part), part.place) for part in parts]
        return tuple(Given(shape, place) for shape, place in found if shape)

    def _wall(self, item: Item) -> Box | None:
        names = ("from", "to", "thickness")
        entries = self.keys(item, names, names)
        if entries is None:
            return None
        start, end = self._point(entries["from"]), self._point(entries["to"])
        thickness = self.number(entries["thickness"], SIZE)
        if start is None or end is None or thickness is None:
            return None
        along = end[0] - start[0], end[1] - start[1]
        if along == (0.0, 0.0):
            self.wrong(item.place, "expected ends that are not at the same place")
            return None
        centre = start[0] + along[0] / 2.0, start[1] + along[1] / 2.0
        angle = math.degrees(math.atan2(along[1], along[0]))
        return Box(*centre, math.hypot(*along), thickness, angle)

    def _floor(self, item: Item) -> str | None:
        return item.value if self.right(item, choice_problem(item.value, COLOURS)) else None

    def _patches(self, item: Item) -> tuple[Given, ...]:
        found = []
        for part in self.parts(item, MOST["patches"], "patches"):
            shape = self._shape(part, _SHAPES, ("floor", "area"))
            if shape is None:
                continue
            floor, area = part.value.get("floor"), part.value.get("area")
            colour = self._floor(floor) if floor else ""
            if area and not self.right(area, area_problem(area.value)):
                continue
            if not floor and not area:
                self.wrong(part.place, "expected a floor or an area, too")
            patch = Patch(shape, colour or "", area.value if area else "")
            found.append(Given(patch, part.place))
        return tuple(found)

    def _lights(self, item: Item) -> tuple[Given, ...]:
        parts = self.parts(item, MOST["lights"], "lights")
        found = [(self._light(part), part.place) for part in parts]
        return tuple(Given(light, place) for light, place in found if light)

    def _light(self, item: Item) -> Light | None:
        entries = self.keys(item, ("at", "beyond", "x", "height", "intensity"))
        if entries is None:
            return None
        beyond = "beyond" in entries
        if ("at" in entries) == beyond or ("x" in entries and not beyond):
            self.wrong(item.place, "expected either at: [x, y] or beyond: ..., with x: ... or not")
            return None
        names = {"beyond": "y"}
        numbers = {
            names.get(key, key): self.number(part, NUMBERS[Light][names.get(key, key)])
            for key, part in entries.items()
            if key != "at"
        }
        if not beyond:
            numbers["x"], numbers["y"] = self._point(entries["at"]) or (None, None)
        right = {key: number for key, number in numbers.items() if number is not None}
        return Light(**right, beyond=beyond) if len(right) == len(numbers) else None

    def _start(self, item: Item) -> Shape | _OfArea | None:
        if isinstance(item.value, dict) and "area" in item.value:
            entries = self.keys(item, ("area",))
            name = item.value["area"]
            right = entries is not None and self.right(name, area_problem(name.value))
            return _OfArea(name.value) if right else None
        return self._shape(item, _SHAPES, ("area",))

    def _shape(
        self, item: Item, kinds: tuple[str, ...], beside: tuple[str, ...] = ()
    ) -> Shape | None:
        entries = self.keys(item, (*kinds, *beside))
        if entries is None:
            return None
        chosen = [key for key in entries if key in kinds]
        if len(chosen) != 1:
            given = " and ".join(chosen) or "none of them"
            self.wrong(item.place, f"expected one of {', '.join(kinds)}, got {given}")
            return None
        shape: Shape | None = getattr(self, f"_{chosen[0]}")(entries[chosen[0]])
        return shape

    def _disc(self, item: Item) -> Disc | None:
        entries = self.keys(item, ("at", "radius"), ("at", "radius"))
        if entries is None:
            return None
        at, radius = self._point(entries["at"]), self.number(entries["radius"], SIZE)
        return None if at is None or radius is None else Disc(*at, radius)

    def _box(self, item: Item) -> Box | None:
        entries = self.keys(item, ("at", "size", "angle"), ("at", "size"))
        if entries is None:
            return None
        at, size = self._point(entries["at"]), entries["size"]
        angle = self.number(entries["angle"], _ANGLE) if "angle" in entries else 0.0
        if not isinstance(size.value, list) or len(size.value) != 2:
            self.wrong(size.place, "expected two numbers [width, length]")
            return None
        width, length = (self.number(part, SIZE) for part in size.value)
        if at is None or angle is None or width is None or length is None:
            return None
        return Box(*at, width, length, angle)

    def _half_plane(self, item: Item) -> HalfPlane | None:
        found = self._along_side(item, "at", COORDINATE)
        return HalfPlane(*found) if found else None

    def _band(self, item: Item) -> Band | None:
        found = self._along_side(item, "depth", SIZE)
        return Band(*found) if found else None

    def _along_side(self, item: Item, name: str, parameter: Parameter) -> Any:
        entries = self.keys(item, ("side", name), ("side", name))
        if entries is None:
            return None
        side, number = entries["side"], self.number(entries[name], parameter)
        right = self.right(side, choice_problem(side.value, SIDES))
        return (side.value, number) if right and number is not None else None

    def _point(self, item: Item) -> Point | None:
        if not self.right(item, point_problem(item.plain)):
            return None
        x, y = item.plain
        return float(x), float(y)


def inherited(base: Mapping[str, Given], own: Mapping[str, Given]) -> dict[str, Given]:
    """What a file has of another one that it extends: all that it does not replace."""
    areas = {patch.value.area for patch in own["patches"].value} if "patches" in own else set()
    gone = {zone for zone in ZONES if zone in areas} | set(own)
    if "outline" in own:
        gone |= {"width", "length"}
    if "width" in own or "length" in own:
        gone.add("outline")
    if "light" in own or "lights" in own:
        gone |= {"light", "lights"}
    return {key: value for key, value in base.items() if key not in gone}


class ArenaFileError(ValueError):
    """What is given makes no arena; `place` says which part does not fit, None for none."""

    def __init__(self, message: str, place: Place | None = None) -> None:
        super().__init__(message)
        self.place = place


def build(given: Mapping[str, Given]) -> tuple[Arena, dict[str, Place]]:
    """The arena of all that is given, each part being right by itself.

    Returns:
        The arena, and the places of its parts by `outline`, `patches 2` and so on, and those of
        its numbers.

    Raises:
        ArenaFileError: There is no outline, or parts contradict each other.
    """
    outline, place = _outline(given)
    lists = {key: given[key].value if key in given else () for key in _LISTS}
    obstacles = (*lists["obstacles"], *lists["walls"])
    patches = _with_zones(given, lists["patches"])
    lights = lists["lights"]
    if "light" in given:
        lamp = Light(y=given["light"].value, beyond=True)
        lights = (*lights, Given(lamp, given["light"].place))
    places = dict.fromkeys(("outline", "width", "length"), place)
    places |= {patch.value.area: patch.place for patch in patches if patch.value.area in ZONES}
    if lights:
        places["light"] = lights[0].place
    for key, parts in (("obstacles", obstacles), ("patches", patches), ("lights", lights)):
        places |= {f"{key} {at}": part.place for at, part in enumerate(parts, start=1)}
    arena = Arena(
        outline=outline,
        obstacles=tuple(part.value for part in obstacles),
        patches=tuple(part.value for part in patches),
        lights=tuple(part.value for part in lights),
        start=_start(given["start"], patches) if "start" in given else None,
        floor=given["floor"].value if "floor" in given else "grey",
    )
    return arena, places


_LISTS = ("obstacles", "walls", "patches", "lights")


def _outline(given: Mapping[str, Given]) -> tuple[Outline, Place]:
    if "outline" in given:
        return given["outline"]
    sides = [given[key] for key in ("width", "length") if key in given]
    if len(sides) == 2:
        return Box(0.0, 0.0, sides[0].value, sides[1].value), sides[0].place
    if sides:
        raise ArenaFileError("expected both a width and a length", sides[0].place)
    raise ArenaFileError("expected an arena with an outline, such as {width: 4, length: 3}")


def _start(start: Given, patches: tuple[Given, ...]) -> Shape:
    if not isinstance(start.value, _OfArea):
        shape: Shape = start.value
        return shape
    shapes: list[Shape] = [
        patch.value.shape for patch in patches if patch.value.area == start.value.name
    ]
    if len(shapes) != 1:
        message = f"expected an area of one patch, {start.value.name} has {len(shapes)}"
        raise ArenaFileError(message, start.place)
    return shapes[0]


def _with_zones(given: Mapping[str, Given], patches: tuple[Given, ...]) -> tuple[Given, ...]:
    """The patches, with those for which `nest` and `source` stand: changed, or below the others."""
    own: list[Given] = []
    for zone, side in ZONES.items():
        if zone not in given:
            continue
        depth, place = given[zone]
        named = [patch for patch in patches if patch.value.area == zone]
        if not named:
            own.append(Given(Patch(Band(side, depth), _FLOORS[zone], zone), place))
            continue
        shape = named[0].value.shape
        if len(named) != 1 or not (isinstance(shape, Band) and shape.side == side):
            raise ArenaFileError(f"the area {zone} is no band in the {side}", place)
        changed = replace(named[0].value, shape=Band(side, depth))
        patches = tuple(Given(changed, place) if each is named[0] else each for each in patches)
    return (*own, *patches)

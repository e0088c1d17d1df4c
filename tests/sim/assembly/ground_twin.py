"""The arena in plain Python: what robots perceive of it, and how near things are."""

import math

from geswarm.sim.arena.model import Box, Disc, HalfPlane, Polygon


def frame(box, x, y):
    """A place as seen from a box."""
    angle = math.radians(box.angle)
    dx, dy = x - box.x, y - box.y
    cos, sin = math.cos(angle), math.sin(angle)
    return dx * cos + dy * sin, dy * cos - dx * sin


def edge_of(shape, x, y):
    """How far a place is from the edge of a shape, negative within."""
    if isinstance(shape, HalfPlane):
        along = x if shape.side in ("west", "east") else y
        return along - shape.at if shape.side in ("west", "south") else shape.at - along
    if isinstance(shape, Disc):
        return math.hypot(x - shape.x, y - shape.y) - shape.radius
    if isinstance(shape, Polygon):
        sides = list(sides_of(shape))
        gap = min(math.dist(closest(*side, x, y), (x, y)) for side in sides)
        turns = sum(
            math.remainder(
                math.atan2(b[1] - y, b[0] - x) - math.atan2(a[1] - y, a[0] - x), 2 * math.pi
            )
            for a, b in sides
        )
        return -gap if abs(turns) > math.pi else gap
    across, along = frame(shape, x, y)
    out_x, out_y = abs(across) - shape.width / 2, abs(along) - shape.length / 2
    if max(out_x, out_y) < 0:
        return max(out_x, out_y)
    return math.hypot(max(out_x, 0), max(out_y, 0))


def sides_of(polygon):
    points = polygon.points
    return zip(points, (*points[1:], points[0]), strict=True)


def closest(one, other, x, y):
    ax, ay = other[0] - one[0], other[1] - one[1]
    t = ((x - one[0]) * ax + (y - one[1]) * ay) / (ax * ax + ay * ay)
    if not 0 < t < 1:
        return one if t <= 0 else other
    return one[0] + t * ax, one[1] + t * ay


def clearance(arena, x, y):
    """Distance to the nearest wall or obstacle; negative where nobody can be."""
    gaps = [-edge_of(arena.outline, x, y)]
    return min(gaps + [edge_of(obstacle, x, y) for obstacle in arena.obstacles])


def in_area(arena, name, x, y):
    """Whether a place is in an area, and how far from an edge."""
    edges = [edge_of(shape, x, y) for shape in arena.area(name)]
    return min(edges) <= 0, min(map(abs, edges))


def floor(arena, x, y):
    """Number of the colour, and how far from the edge of a patch."""
    colour, doubt = 0, math.inf
    for patch in arena.patches:
        if patch.floor:
            edge = edge_of(arena.resolved(patch.shape), x, y)
            doubt = min(doubt, abs(edge))
            if edge <= 0:
                colour = arena.colours.index(patch.floor)
    return colour, doubt


def points_felt(arena, x, y):
    """The nearest points of all that pushes: each wall, or the corner between two, and obstacles.

    A corner that stands out into the arena is felt once, not as the end of two walls; one that
    does not is felt by none.
    """
    outline = arena.outline
    if isinstance(outline, Disc):
        d = math.hypot(x, y)
        yield (x / d * outline.radius, y / d * outline.radius)
    elif isinstance(outline, Box):
        half_width, half_length = outline.width / 2, outline.length / 2
        yield from ((half_width, y), (-half_width, y), (x, half_length), (x, -half_length))
    else:
        found = set()
        for one, other in sides_of(outline):
            point = closest(one, other, x, y)
            left = (other[0] - one[0]) * (y - one[1]) - (other[1] - one[1]) * (x - one[0])
            if point not in (one, other):
                if left >= 0:
                    yield point
            elif point in found:
                yield point  # the nearest of both of its walls
            else:
                found.add(point)
    for obstacle in arena.obstacles:
        yield nearest_of(obstacle, x, y)


def nearest_of(obstacle, x, y):
    if isinstance(obstacle, Disc):
        d = math.hypot(x - obstacle.x, y - obstacle.y)
        share = obstacle.radius / d
        return obstacle.x + share * (x - obstacle.x), obstacle.y + share * (y - obstacle.y)
    across, along = frame(obstacle, x, y)
    a = min(max(across, -obstacle.width / 2), obstacle.width / 2)
    b = min(max(along, -obstacle.length / 2), obstacle.length / 2)
    angle = math.radians(obstacle.angle)
    cos, sin = math.cos(angle), math.sin(angle)
    return obstacle.x + a * cos - b * sin, obstacle.y + b * cos + a * sin


def push(arena, x, y, sensed):
    px = py = 0.0
    for at_x, at_y in points_felt(arena, x, y):
        d = math.hypot(x - at_x, y - at_y)
        if 0 < d < sensed:
            px += (sensed - d) * (x - at_x) / d
            py += (sensed - d) * (y - at_y) / d
    return px, py


def to_light(arena, x, y):
    sum_x = sum_y = 0.0
    for lamp in arena.lights:
        at_x, at_y = arena.place_of(lamp)
        d = math.hypot(at_x - x, at_y - y)
        weight = lamp.intensity / (d * d + lamp.height**2) / d
        sum_x, sum_y = sum_x + weight * (at_x - x), sum_y + weight * (at_y - y)
    length = math.hypot(sum_x, sum_y)
    return (sum_x / length, sum_y / length) if length else (0.0, 0.0)


def brightness(arena, x, y):
    return sum(
        lamp.intensity / (1 + math.dist((*arena.place_of(lamp), lamp.height), (x, y, 0)) ** 2)
        for lamp in arena.lights
    )

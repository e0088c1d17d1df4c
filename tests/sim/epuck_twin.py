"""The e-puck in plain Python, without noise: what geswarm.sim.kernels has in numbers of lanes."""

import math

RADIUS, AXLE, SPEED = 0.035, 0.053, 0.12
RAYS = [math.radians(11.25 + 45 * ray) for ray in range(8)]
LOOKS = [
    math.remainder(math.pi / part, 2 * math.pi)
    for part in (10.5884, 3.5999, 2, 1.2, 0.8571, 0.6667, 0.5806, 0.5247)
]
LAMP = (0.0, -1.25, 0.75, 5.0)


def distance_on_ray(dx, dy, cos, sin):
    """From the origin to a body on a ray; infinite beside it and within it."""
    along, across = dx * cos + dy * sin, dy * cos - dx * sin
    if abs(across) >= RADIUS:
        return math.inf
    near = along - math.sqrt(RADIUS**2 - across**2)
    return near if near >= 0 else math.inf


class Robot:
    def __init__(self, x, y, heading):
        self.x, self.y, self.heading = x, y, heading
        self.go_x = self.go_y = self.spin = 0.0
        self.left = self.right = 0.0
        self.turns, self.side, self.heard = 0, 0.0, []


class Twin:
    """Robots within walls, each wall (distance, angle of what points at it) from the origin."""

    def __init__(self, walls, robots, behaviour, argument=0, rab_range=0.7):
        self.walls, self.robots, self.pushes = walls, robots, {}
        self.behaviour, self.argument, self.rab_range = behaviour, argument, rab_range

    def step(self):
        self.move()
        for robot in self.robots:
            self.sense_and_act(robot)

    def move(self):
        robots = self.robots
        targets = {}
        for robot in robots:
            speed = (robot.left + robot.right) / 2
            targets[robot] = speed * math.cos(robot.heading), speed * math.sin(robot.heading)
        spins = {robot: (robot.right - robot.left) / AXLE for robot in robots}
        for _ in range(10):
            for robot in robots:
                robot.x += robot.go_x * 0.01
                robot.y += robot.go_y * 0.01
                robot.drive_x = robot.drive_y = 0.0
            touching = {}
            for at, one in enumerate(robots):
                for other in robots[:at]:
                    dx, dy = one.x - other.x, one.y - other.y
                    d = math.hypot(dx, dy)
                    if d < 2 * RADIUS:
                        touching[one, other] = dx / d, dy / d
            self.pushes = {pair: self.pushes.get(pair, (0.0, 0.0)) for pair in touching}
            for pair, normal in touching.items():
                push(*pair, normal, *self.pushes[pair])
            for robot in robots:
                drive(robot, *targets[robot])
            settle(touching, self.pushes, spins, targets, self.stop_at_walls)
            for robot in robots:
                self.stop_at_walls(robot)
        for robot in robots:
            robot.heading += 0.01 * robot.spin + 0.09 * spins[robot]
            robot.spin = spins[robot]

    def stop_at_walls(self, robot):
        for reach, angle in self.walls:
            x, y = math.cos(angle), math.sin(angle)
            into = robot.go_x * x + robot.go_y * y
            if robot.x * x + robot.y * y > reach - RADIUS - 1e-4 and into > 0:
                along = robot.go_y * x - robot.go_x * y
                along -= math.copysign(min(abs(along), 0.07 * into), along)
                robot.go_x, robot.go_y = -along * y, along * x

    def sense_and_act(self, robot):
        prox_x, prox_y = self.proximity(robot)
        robot.heard = [*robot.heard, self.messages(robot)][-11:]
        if self.behaviour == "EXPLORATION":
            self.explore(robot, prox_x, prox_y)
            return
        if "PHOTOTAXIS" in self.behaviour:
            x, y = self.light(robot)
            sign = -1 if self.behaviour.startswith("ANTI") else 1
            target = sign * x - 5 * prox_x, sign * y - 5 * prox_y
        else:
            x, y = (sum(each[along] for each in robot.heard) for along in (0, 1))
            gain, away = self.argument, 6
            if self.behaviour == "REPULSION":
                gain, away = -self.argument * self.argument, 5
            target = gain * x - away * prox_x, gain * y - away * prox_y
        self.follow(robot, *target)

    def follow(self, robot, x, y):
        length = math.hypot(x, y)
        cos = x / length if length >= 0.1 else 1.0
        inner_left = y > 0 and length >= 0.1
        robot.left, robot.right = (cos, 1.0) if inner_left else (1.0, cos)
        robot.left, robot.right = SPEED * robot.left, SPEED * robot.right

    def explore(self, robot, prox_x, prox_y):
        """With rwm = 1: each turn takes one step."""
        if robot.turns:
            robot.turns, robot.left, robot.right = 0, -SPEED * robot.side, SPEED * robot.side
            return
        robot.left = robot.right = SPEED
        if math.hypot(prox_x, prox_y) >= 0.1 and prox_x >= 0:
            robot.turns, robot.side = 1, 1.0 if prox_y < 0 else -1.0

    def proximity(self, robot):
        sum_x = sum_y = 0.0
        for ray, looks in zip(RAYS, LOOKS, strict=True):
            cos, sin = math.cos(robot.heading + ray), math.sin(robot.heading + ray)
            x, y = robot.x + 0.036 * cos, robot.y + 0.036 * sin
            nearest = min(
                distance_on_ray(each.x - x, each.y - y, cos, sin)
                for each in (*self.robots, Robot(9.0, 9.0, 0.0))
                if each is not robot
            )
            for reach, angle in self.walls:
                ahead = cos * math.cos(angle) + sin * math.sin(angle)
                gap = reach - x * math.cos(angle) - y * math.sin(angle)
                if ahead > 1e-9:
                    nearest = min(nearest, max(0.0, gap / ahead))
            reading = 298.701 * nearest**2 - 36.8961 * nearest + 1.08212 if nearest <= 0.05 else 0
            reading = min(1.0, max(0.0, reading))
            sum_x, sum_y = sum_x + reading * math.cos(looks), sum_y + reading * math.sin(looks)
        length = max(1.0, math.hypot(sum_x, sum_y))
        return sum_x / length, sum_y / length

    def light(self, robot):
        dx, dy, height = LAMP[0] - robot.x, LAMP[1] - robot.y, LAMP[2]
        far = math.hypot(dx, dy)
        for other in self.robots:
            near = distance_on_ray(other.x - robot.x, other.y - robot.y, dx / far, dy / far)
            if other is not robot and near * height / far <= 0.076:
                return 0.0, 0.0
        bright = math.exp(-2 * math.hypot(far, height) / LAMP[3])
        readings = []
        for looks in LOOKS:
            apart = abs(math.remainder(math.atan2(dy, dx) - robot.heading - looks, 2 * math.pi))
            readings.append(bright * max(0.0, 1 - 2 * apart / math.pi))
        x = sum(each * math.cos(looks) for each, looks in zip(readings, LOOKS, strict=True))
        y = sum(each * math.sin(looks) for each, looks in zip(readings, LOOKS, strict=True))
        lit = max(readings) > 0.2
        return (x / math.hypot(x, y), y / math.hypot(x, y)) if lit else (0.0, 0.0)

    def messages(self, robot):
        sum_x = sum_y = 0.0
        for other in self.robots:
            dx, dy = other.x - robot.x, other.y - robot.y
            d = math.hypot(dx, dy)
            if other is robot or d >= self.rab_range:
                continue
            between = (
                distance_on_ray(each.x - robot.x, each.y - robot.y, dx / d, dy / d)
                for each in self.robots
                if each not in (robot, other)
            )
            if any(near < d for near in between):
                continue
            weight = 1 / (1 + max(0.0, 100 * d - 7))
            angle = math.atan2(dy, dx) - robot.heading
            sum_x, sum_y = sum_x + weight * math.cos(angle), sum_y + weight * math.sin(angle)
        return sum_x, sum_y


def drive(robot, to_x, to_y):
    """The motors change the velocity by at most 0.0375 m/s in a sub-step."""
    dx, dy = robot.drive_x + to_x - robot.go_x, robot.drive_y + to_y - robot.go_y
    share = min(1.0, 0.0375 / max(math.hypot(dx, dy), 1e-12))
    robot.go_x += share * dx - robot.drive_x
    robot.go_y += share * dy - robot.drive_y
    robot.drive_x, robot.drive_y = share * dx, share * dy


def settle(touching, pushes, spins, targets, stop_at_walls):
    """Pushes and motors are balanced, as Chipmunk does it: pair after pair, some times over."""
    met = {robot for pair in touching for robot in pair}
    for _ in range(10):
        most = 0.0
        for robot in met:
            stop_at_walls(robot)
        for (one, other), (x, y) in touching.items():
            was, rubbed = pushes[one, other]
            go_x, go_y = one.go_x - other.go_x, one.go_y - other.go_y
            now = max(0.0, was - (go_x * x + go_y * y) / 2)
            sliding = go_y * x - go_x * y - RADIUS * (spins[one] + spins[other])
            rub = min(max(rubbed - sliding / 2, -0.49 * now), 0.49 * now)
            push(one, other, (x, y), now - was, rub - rubbed)
            pushes[one, other] = now, rub
            most = max(most, abs(now - was) + abs(rub - rubbed))
        if most <= 0.005:
            return
        for robot in met:
            drive(robot, *targets[robot])


def push(one, other, normal, apart, along):
    x, y = apart * normal[0] - along * normal[1], apart * normal[1] + along * normal[0]
    one.go_x, one.go_y = one.go_x + x, one.go_y + y
    other.go_x, other.go_y = other.go_x - x, other.go_y - y

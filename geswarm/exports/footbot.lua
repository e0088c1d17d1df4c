@HEADER@
-- Objects are virtual: this script never touches one. It shares global variables with the loop
-- functions of the experiment, each true or false:
--
--   read here at the start of every step, if the loop functions have set them
--     HAS_OBJECT  this robot carries an object; false if nobody says so
--     ON_NEST     this robot perceives the nest; otherwise read from the colour of the floor
--     ON_SOURCE   this robot perceives the source; likewise
--   set here during the step, for the loop functions to read after it
--     WANT_OBJECT   the robot wants to pick up an object
--     DROP_OBJECT   the robot drops the object that it carries; false again from the next step on
--     BEHAVIOUR     the name of the behaviour that the robot executes
--
-- Devices: differential_steering, footbot_light, footbot_proximity, range_and_bearing, and
-- footbot_motor_ground if zones are read from the floor (nest white, source black, else grey).

---------------------------------------------------------------------------------------------------
-- Parameters
---------------------------------------------------------------------------------------------------

@PARAMETERS@
local STEPS_PER_SECOND = 10
local BODY_RADIUS = 0.085          -- m
local WHEEL_BASE = 0.14            -- m, between the wheels

---------------------------------------------------------------------------------------------------
-- What the robot remembers
---------------------------------------------------------------------------------------------------

local step_number                  -- control steps since the start
local walk_heading                 -- random walk: angle from the direction of the light
local walk_until                   -- random walk: the step in which a new heading is drawn
local restart_walk                 -- the robot has switched into random walk in this step
local light_angle                  -- direction of the light in the robot's frame
local last_turn                    -- by how much the robot turned in the last step

---------------------------------------------------------------------------------------------------
-- The rules
---------------------------------------------------------------------------------------------------

-- True with probability p. Drawn for every action of every active rule.
local function chance(p)
  return robot.random.uniform() < p
end

-- Takes effect at once: later rules of the same step see the new behaviour.
local function change_to(behaviour)
  if behaviour ~= BEHAVIOUR then
    BEHAVIOUR = behaviour
    restart_walk = behaviour == "RANDOM_WALK"
  end
end

local function apply_rules(on_nest, on_source, has_object)
@RULES@
end

---------------------------------------------------------------------------------------------------
-- Perception
---------------------------------------------------------------------------------------------------

-- Whether the centre of the robot is in a zone: it is if three of the four ground sensors are.
local function on_floor(is_colour)
  local seen = 0
  for _, sensor in ipairs(robot.motor_ground or {}) do
    if is_colour(sensor.value) then seen = seen + 1 end
  end
  return seen >= 3
end

local function is_white(value) return value > 0.9 end
local function is_black(value) return value < 0.1 end

-- What the loop functions say is taken as it is; zones on the floor are missed now and then.
local function perceive()
  local on_nest, on_source = ON_NEST, ON_SOURCE
  if on_nest == nil or on_source == nil then
    local missed = chance(ZONE_MISS)
    if on_nest == nil then on_nest = not missed and on_floor(is_white) end
    if on_source == nil then on_source = not missed and on_floor(is_black) end
  end
  return on_nest, on_source, HAS_OBJECT or false
end

-- The light is so far away that it serves as a compass. In the dark the robot goes by its turns.
local function find_light()
  local x, y = 0, 0
  for _, sensor in ipairs(robot.light) do
    x = x + sensor.value * math.cos(sensor.angle)
    y = y + sensor.value * math.sin(sensor.angle)
  end
  if x * x + y * y > 1e-12 then
    light_angle = (math.atan2 or math.atan)(y, x)
  else
    light_angle = light_angle - last_turn
  end
end

-- Away from every robot nearer than RAB_RANGE (distance of the centres), the more the nearer.
local function away_from_robots()
  local x, y = 0, 0
  for _, other in ipairs(robot.range_and_bearing) do
    local weight = 1 - other.range / 100 / RAB_RANGE  -- the range is in cm
    if weight > 0 then
      x = x - weight * math.cos(other.horizontal_bearing)
      y = y - weight * math.sin(other.horizontal_bearing)
    end
  end
  return x, y
end

-- Whether a proximity sensor looks at another robot instead of a wall.
local function sees_robot(angle)
  for _, other in ipairs(robot.range_and_bearing) do
    local off = angle - other.horizontal_bearing
    if math.cos(off) > 0 and math.abs(math.sin(off)) * other.range / 100 < BODY_RADIUS then
      return true
    end
  end
  return false
end

-- Where each proximity sensor meets a wall: a point in the robot's frame (m), or false.
-- ARGoS' foot-bot reads 0.0100527 / (d + 0.000163144) at the distance d, and at most 1.
local function points_on_walls()
  local points = {}
  for i, sensor in ipairs(robot.proximity) do
    points[i] = false
    if sensor.value > 0 and not sees_robot(sensor.angle) then
      local reach = BODY_RADIUS + 0.0100527 / sensor.value - 0.000163144
      points[i] = {
        reach = reach,
        x = reach * math.cos(sensor.angle),
        y = reach * math.sin(sensor.angle),
      }
    end
  end
  return points
end

-- Unit vector to, and distance from the centre of, the wall through two points that see it.
local function wall_through(one, other)
  local x, y = other.y - one.y, one.x - other.x
  local length = math.sqrt(x * x + y * y)
  if length < 1e-9 then
    return one.x / one.reach, one.y / one.reach, one.reach
  end
  local distance = (x * one.x + y * one.y) / length
  if distance < 0 then x, y, distance = -x, -y, -distance end
  return x / length, y / length, distance
end

-- Away from every wall nearer than PROXIMITY_RANGE (from the body's edge), the more the nearer.
-- A wall is where a sensor, or a row of sensors that read the same, is nearer to it than those to
-- its left and right. Two points that lie on the wall tell where it is: the ends of the row, or the
-- sensor and the nearer one beside it. Sensors closer than 1 cm only say that they are: then the
-- points beside the row are taken.
local function away_from_walls()
  local points, x, y = points_on_walls(), 0, 0
  local count = #robot.proximity
  local function at(i) return points[(i - 1) % count + 1] end
  local function reach(i) return at(i) and at(i).reach or math.huge end
  for first = 1, count do
    if reach(first) < reach(first - 1) - 1e-9 then
      local last = first
      while math.abs(reach(last + 1) - reach(first)) <= 1e-9 do last = last + 1 end
      if reach(first) < reach(last + 1) then
        local one, other = at(first), at(last)
        if robot.proximity[first].value >= 1 then
          one, other = at(first - 1) or one, at(last + 1) or other
        elseif first == last then
          other = at(reach(first - 1) < reach(first + 1) and first - 1 or first + 1) or one
        end
        local nx, ny, distance = wall_through(one, other)
        local weight = 1 - (distance - BODY_RADIUS) / PROXIMITY_RANGE
        x = x - math.max(0, weight) * nx
        y = y - math.max(0, weight) * ny
      end
    end
  end
  return x, y
end

---------------------------------------------------------------------------------------------------
-- Movement
---------------------------------------------------------------------------------------------------

local function draw_walk()
  walk_heading = robot.random.uniform(-math.pi, math.pi)
  walk_until = step_number + robot.random.uniform(WALK_MIN, WALK_MAX) * STEPS_PER_SECOND
end

-- Where the behaviour leads, as an angle in the robot's frame.
local function target_angle()
  if BEHAVIOUR == "PHOTOTAXIS" then return light_angle end
  if BEHAVIOUR == "ANTI-PHOTOTAXIS" then return light_angle + math.pi end
  if step_number >= walk_until then draw_walk() end
  return light_angle + walk_heading
end

-- Turn towards a vector in the robot's frame, the faster the less there is to turn.
local function drive(x, y)
  local alpha = 0
  if x ~= 0 or y ~= 0 then alpha = (math.atan2 or math.atan)(y, x) end
  if alpha < 1e-9 - math.pi then alpha = alpha + 2 * math.pi end
  local speed = MAX_SPEED * math.max(0, math.cos(alpha))
  local turn = TURN_GAIN * alpha
  local left = speed - turn * WHEEL_BASE / 2
  local right = speed + turn * WHEEL_BASE / 2
  local fastest = math.max(math.abs(left), math.abs(right))
  local scale = fastest > MAX_SPEED and MAX_SPEED / fastest or 1
  last_turn = scale * turn / STEPS_PER_SECOND
  robot.wheels.set_velocity(100 * scale * left, 100 * scale * right)  -- cm/s
end

---------------------------------------------------------------------------------------------------
-- What ARGoS calls
---------------------------------------------------------------------------------------------------

function init()
  step_number, light_angle, last_turn, restart_walk = 0, 0, 0, false
@START@
  draw_walk()
end

function step()
  -- The loop functions have seen what the last step set.
@CLEAR@
  find_light()
  restart_walk = false
  apply_rules(perceive())
  if restart_walk then draw_walk() end
  local angle = target_angle()
  local robots_x, robots_y = away_from_robots()
  local walls_x, walls_y = away_from_walls()
  drive(
    math.cos(angle) + AVOIDANCE_GAIN * (robots_x + walls_x),
    math.sin(angle) + AVOIDANCE_GAIN * (robots_y + walls_y)
  )
  step_number = step_number + 1
end

function reset()
  init()
end

function destroy()
end

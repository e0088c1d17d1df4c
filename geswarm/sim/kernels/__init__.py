"""The control step of the foraging model, compiled: sense, decide, act on objects, move, collide."""

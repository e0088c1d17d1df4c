"""The model's control step, compiled: sense, decide, act on objects, move, collide."""

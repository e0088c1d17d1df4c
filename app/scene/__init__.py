"""The 3D view of the arena."""

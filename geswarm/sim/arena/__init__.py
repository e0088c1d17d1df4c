"""Arenas: what they are, how files say it, and where things lie in them."""

"""One port for everything, and who may use it."""

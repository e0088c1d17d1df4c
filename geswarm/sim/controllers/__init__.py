"""Rules as kernels read them: encoded, and tabulated over all that a robot perceives."""

"""From components to kernels: readable source, and the module that it becomes."""

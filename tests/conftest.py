"""Shared by all tests."""

from hypothesis import HealthCheck, settings

# The machines that run the tests are small and noisy: no test is judged by its time.
settings.register_profile(
    "geswarm", deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("geswarm")

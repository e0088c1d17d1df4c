"""The browser of the dashboard's tests opens reports, too."""

from tests.app.conftest import browser, chromium

__all__ = ["browser", "chromium"]

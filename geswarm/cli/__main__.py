"""`python -m geswarm.cli` is `geswarm`."""

import sys

from geswarm.cli import main

sys.exit(main())

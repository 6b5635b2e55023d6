"""``python -m vizlight.cli``."""

import sys

from vizlight.cli.main import main

sys.exit(main())

# SPDX-License-Identifier: GPL-3.0-or-later
"""`python3 -m boba.report RUN`: what `boba report` starts."""
import sys

from .command import main

sys.exit(main())

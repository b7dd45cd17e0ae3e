# SPDX-License-Identifier: GPL-3.0-or-later
"""A report of runs that opens in a browser: `boba report` and `boba watch`."""
from .command import main
from .gather import report_data
from .page import page_of

__all__ = ["main", "page_of", "report_data"]

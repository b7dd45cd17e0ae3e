# SPDX-License-Identifier: GPL-3.0-or-later
"""The version of Boba, in this place alone: CMakeLists.txt and pyproject.toml read it from here."""

__version__ = "0.1.0"

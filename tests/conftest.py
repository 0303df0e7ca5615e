"""Property tests run without a deadline, and with the same examples each time where nobody watches."""

import os

from hypothesis import settings

settings.register_profile("unhurried", deadline=None)
settings.register_profile("repeatable", deadline=None, derandomize=True)
settings.load_profile("repeatable" if os.environ.get("CI") else "unhurried")

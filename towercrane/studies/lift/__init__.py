"""How hard a load pulls as it leaves the ground. Never imports reports."""

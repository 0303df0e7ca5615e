"""Pictures of what studies find, one module for each study. Never imports commands."""

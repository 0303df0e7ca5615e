"""Kinds of cranes, one folder for each family. Never imports cases, runs or reports."""

"""Overhead cranes: a bridge on a runway, a trolley on the bridge. Imports no other family."""

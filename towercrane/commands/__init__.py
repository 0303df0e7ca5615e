"""The command line, one file for each command. Imported by `towercrane.cli` alone, and no command by another."""

"""What drives do over time, and how they are shaped. Imports nothing else of towercrane."""

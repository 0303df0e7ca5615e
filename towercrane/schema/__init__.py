"""What a case file may say: units, fields, tables of numbers, targets, faults. Imports no crane and no solver."""

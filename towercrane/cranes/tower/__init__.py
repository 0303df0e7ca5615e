"""Tower cranes whose tower and jib bend. Imports no other family."""

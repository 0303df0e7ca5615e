"""The load on its rope, for cranes of every family: how it hangs, goes slack, is caught."""

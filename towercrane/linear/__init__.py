"""Small departures of any system from a state. Never imports a crane or a case."""

"""How runs start: at rest in the wind, swinging, turning already. Never imports a crane or a case."""

"""Pictures of a run, one module for each kind of crane. Never imports a crane's model."""

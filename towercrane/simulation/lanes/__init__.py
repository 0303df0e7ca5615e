"""Many runs side by side, in vector lanes and threads. Never imports a crane or a case."""

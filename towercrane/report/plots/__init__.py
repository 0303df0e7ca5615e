"""Pictures that an engineer would print: of runs, of studies, of the benchmark, in one style. Computes no physics."""

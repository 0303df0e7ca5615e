"""Other solvers on the same equations, and work against precision beside them. Never imports bench.runs."""

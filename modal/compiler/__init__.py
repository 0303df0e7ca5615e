"""The compiler's tools: compiled functions, their cache, traced algebra. Imports nothing else of modal."""

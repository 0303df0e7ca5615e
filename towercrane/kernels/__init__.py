"""What equations are written with: the payload, polynomials, numbers of many runs. Imports no crane and no solver."""

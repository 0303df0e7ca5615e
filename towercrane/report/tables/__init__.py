"""Reports as tables on the terminal. Computes no physics; never imports plots."""

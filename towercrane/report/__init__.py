"""Tables, plots, films and folders of results. Computes no physics; never imports commands."""

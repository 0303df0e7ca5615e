"""Pictures that an engineer would print, by kind of crane."""

"""What commands share: the program, the terminal, the skeleton of a command, pictures. Never imports a command."""

"""What cranes of several families share. Imports no family."""

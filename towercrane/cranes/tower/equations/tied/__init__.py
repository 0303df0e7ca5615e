"""Terms of a head with a cat-head and tie bars. Never imports files or outputs."""

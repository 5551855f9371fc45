"""Authentication and authorisation: accounts, tokens, sessions, audit log, TLS, limits of connections."""

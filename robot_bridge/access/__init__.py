"""Who may connect: accounts and tokens, sessions, the audit log, TLS, and the limits of every connection."""

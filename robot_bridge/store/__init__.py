"""The bridge's SQL: the paper's tables RR and SA, and what the gateway keeps for itself."""

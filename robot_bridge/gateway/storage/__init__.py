"""SQL storage: the paper's tables RR and SA, and what the gateway keeps for itself."""

"""SQL storage: the paper's tables RR and SA, and the gateway's own tables."""

"""Administration by a supervisor: operators' accounts and the site that is served."""

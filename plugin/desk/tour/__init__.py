"""The five-minute tour: a practice fleet on the sample site, and a panel that leads through the desk."""

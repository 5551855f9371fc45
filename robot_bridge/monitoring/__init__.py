"""What the gateway says about itself to whoever runs it."""

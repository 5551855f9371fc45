"""What both ends of a WebSocket share: codec, JSON-RPC frames, schemas."""

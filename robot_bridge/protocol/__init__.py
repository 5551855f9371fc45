"""Code shared by both ends of a WebSocket: codec, JSON-RPC frames, schemas."""

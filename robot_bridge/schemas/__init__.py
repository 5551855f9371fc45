"""JSON Schemas of every message and an AsyncAPI document of all endpoints, made from the messages."""

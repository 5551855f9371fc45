"""JSON Schemas of every message and an AsyncAPI document of both endpoints, made from the messages."""

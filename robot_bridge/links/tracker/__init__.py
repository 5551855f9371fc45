"""Phones and GPS receivers: people, cars and tractors that are seen on the map and not commanded."""

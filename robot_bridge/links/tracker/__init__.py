"""Phones and GPS receivers: people, cars and tractors shown on the map and not commanded."""

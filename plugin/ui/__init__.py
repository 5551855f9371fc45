"""Qt helpers: tables, dialogs, steady widgets, actions, colours, glyphs, times and slices of long work."""

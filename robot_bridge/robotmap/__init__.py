"""The robot map: model, builder, and its text and binary formats (paper 1, sections II and III)."""

"""The robot map: model, builder, text and binary formats, checks, import and export (paper 1, II, III)."""

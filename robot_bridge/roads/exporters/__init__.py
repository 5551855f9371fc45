"""The road network as the programs of other robots read it; writers of bytes, without I/O."""

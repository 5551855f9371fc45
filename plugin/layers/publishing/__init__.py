"""Publication of a site to a folder, and a published site as layers."""

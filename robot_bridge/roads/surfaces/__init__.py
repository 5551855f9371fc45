"""Road surfaces: made of centrelines by their widths, and told for any place."""

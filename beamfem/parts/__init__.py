"""What acts on beams, one file each; docs/extending/package.md says where a new part goes."""

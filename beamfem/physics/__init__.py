"""The physics of a beam, each equation written once."""

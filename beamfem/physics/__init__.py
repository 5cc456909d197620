"""The physics of a beam, with each equation written once."""

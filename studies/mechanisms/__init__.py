"""Mechanisms of flexible and stiff parts, each against a closed form or rigid-body equations written independently."""

"""Checks before the first step of a solve: the initial state, mechanisms, memory."""

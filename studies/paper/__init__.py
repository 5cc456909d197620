"""The paper's examples and claims, each against closed forms, shooting or its own limit."""

"""Pictures and pages; imported only when asked for."""

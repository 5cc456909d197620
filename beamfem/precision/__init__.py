"""What guards the last digits of results."""

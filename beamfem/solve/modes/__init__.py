"""Small vibration about an equilibrium."""

"""What every solve asks before its first step: where it starts, whether the model can move freely, whether it fits."""

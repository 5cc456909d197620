"""What is where, and which coordinate is whose; a model knows no solver."""

"""From a model to numbers: the tables that compiled code works on."""

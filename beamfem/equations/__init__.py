"""Assembly: the tables that compiled code needs of a model, and the residual and tangent that it returns."""

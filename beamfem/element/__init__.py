"""A beam element is three independent choices: a field, the nodal coordinates that carry it, the elastic forces."""

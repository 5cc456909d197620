"""Checks of user-defined parts, for the tests of whoever writes them; solvers do not run them.

Each evaluates a part at arbitrary states and raises an AssertionError that names what is wrong with it.
"""

from beamfem.testing.connector_contract import check_connector
from beamfem.testing.field_contract import check_field
from beamfem.testing.law_contract import check_law

__all__ = ["check_connector", "check_field", "check_law"]

"""Reading and writing: an exporter knows only a Solution."""

from beamfem.registry import offer
from beamfem.results.solution import Solution

offer(Solution.save, "beamfem.io.results:save")
offer(Solution.to_vtk, "beamfem.io.vtk:write_vtk")
offer(Solution.to_xarray, "beamfem.io.table:to_xarray")
offer(Solution.to_pandas, "beamfem.io.table:to_pandas")

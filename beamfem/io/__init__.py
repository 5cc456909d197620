"""Reading and writing: an exporter knows only a Solution."""

from beamfem.registry import offer
from beamfem.results.exports import Exports
from beamfem.solve.modes.modes import Modes
from beamfem.solve.stability.buckling import Buckling

offer(Exports.save, "beamfem.io.results:save")
offer(Exports.to_vtk, "beamfem.io.vtk:write_vtk")
offer(Exports.to_xarray, "beamfem.io.table:to_xarray")
offer(Exports.to_pandas, "beamfem.io.table:to_pandas")
offer(Modes.to_xarray, "beamfem.io.mode_table:modes_to_xarray")
offer(Buckling.to_xarray, "beamfem.io.mode_table:buckling_to_xarray")

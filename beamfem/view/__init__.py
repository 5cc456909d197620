"""Pictures and pages; what draws them is imported at the first call."""

from beamfem.model.beam import Beam
from beamfem.model.model import Model
from beamfem.model.model_outputs import ModelOutputs
from beamfem.registry import offer
from beamfem.results.beam_stress import BeamStress
from beamfem.results.energies import Energy
from beamfem.results.pictures import Pictures
from beamfem.results.section_forces import SectionForces
from beamfem.results.solution import Solution, State
from beamfem.solve.modes.modes import Modes
from beamfem.solve.stability.buckling import Buckling

offer(Pictures.plot, "beamfem.view.drawing:plot_shapes")
offer(Pictures.plot_curve, "beamfem.view.curve:plot_curve")
offer(Pictures.plot_history, "beamfem.view.history:plot_history")
offer(Pictures.plot_load_displacement, "beamfem.view.history:plot_load_displacement")
offer(Pictures.animate, "beamfem.view.animation:animate")
offer(Pictures.show, "beamfem.view.body:show")
offer(Pictures.picture, "beamfem.view.body:picture")
offer(Pictures.to_html, "beamfem.view.player:write_player")
offer(Modes.plot, "beamfem.view.mode_shapes:plot_modes")
offer(Buckling.plot, "beamfem.view.mode_shapes:plot_buckling")
offer(ModelOutputs.plot, "beamfem.view.model_drawing:plot_model")
offer(Model._repr_html_, "beamfem.view.summary:model_table")
offer(Solution._repr_html_, "beamfem.view.summary:solution_table")
offer(Modes._repr_html_, "beamfem.view.summary:modes_table")
offer(Buckling._repr_html_, "beamfem.view.summary:buckling_table")
offer(State._repr_html_, "beamfem.view.result_tables:state_table")
offer(Beam._repr_html_, "beamfem.view.result_tables:beam_table")
offer(Energy._repr_html_, "beamfem.view.result_tables:energy_table")
offer(SectionForces._repr_html_, "beamfem.view.result_tables:section_forces_table")
offer(BeamStress._repr_html_, "beamfem.view.result_tables:stress_table")

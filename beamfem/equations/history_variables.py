"""Committed history: history variables of connectors and section laws after an accepted step, as part of a state."""

from dataclasses import dataclass

import numpy as np

from beamfem.cached_properties import cached_property
from beamfem.equations.applied_loads import Loads
from beamfem.equations.bound_connector import Motion
from beamfem.equations.connectors import Connectors
from beamfem.equations.element_group import ElementGroup
from beamfem.equations.stress_resultants import resultants, strain_group
from beamfem.kernels.block import Block
from beamfem.physics.compiled_connections import remembering
from beamfem.section.law import ConstitutiveLaw


@dataclass(frozen=True, eq=False)
class History:
    """History variables of a model; in a state they follow the coordinates, and only accepted steps change them."""

    connectors: Connectors
    blocks: tuple[Block, ...]
    loads: Loads

    @cached_property
    def laws(self) -> tuple[tuple[ConstitutiveLaw, Block], ...]:
        """Section laws with history, each with its block."""
        laws = {mesh.block: mesh.beam.law for mesh in self.connectors.model.meshes}
        return tuple((law, self.blocks[number]) for number, law in laws.items() if law is not None and law.remembers)

    @cached_property
    def numbers(self) -> np.ndarray:
        """Numbers (h,) of all history variables among the coordinates."""
        numbers = [block.history.ravel() for _, block in self.laws]
        return np.concatenate([self.connectors.memory, *numbers]) if numbers else self.connectors.memory

    @cached_property
    def start(self) -> np.ndarray:
        """Initial values (h,) of all history variables."""
        values = [np.broadcast_to(law.start, block.history.shape).ravel() for law, block in self.laws]
        return np.concatenate([self.connectors.start, *values]) if values else self.connectors.start

    @cached_property
    def compiled(self) -> bool:
        """Whether compiled code can update all history variables there are."""
        items = [item.compiled for item in self.connectors.items if len(item.memory)]
        return bool(items) and not self.laws and all(each is not None and remembering(each) for each in items)

    @property
    def holders(self) -> tuple[tuple[str, str], ...]:
        """Kind, in words, and name of each connector or section law with history."""
        connectors = (("connectors", item.name) for item in self.connectors.items if len(item.memory))
        return (*connectors, *(("section laws", law.name) for law, _ in self.laws))

    def committed(self, motion: Motion, time: float, dt: float = 0.0) -> np.ndarray:
        """Return p (n,) with the history variables after an accepted step to this state. Raises InputError.

        dt [s]: time step, 0 in statics.
        """
        p = motion[0]
        if not len(self.numbers):
            return p
        result = p.copy()
        result[self.connectors.memory] = self.connectors.remember(motion, time)
        for (law, block), group in zip(self.laws, self.strains, strict=True):
            strain = resultants(group, np.ascontiguousarray(p), [np.zeros(len(p))], self.loads.imposing(time))[0]
            past = p[block.history]
            flat = strain[:, : past.shape[1], :3].reshape(-1, 3)
            result[block.history] = law.remember(flat, past.reshape(len(flat), -1), dt).reshape(past.shape)
        return result

    def in_equilibrium(self, p: np.ndarray, load_factor: float) -> np.ndarray:
        """Return p (n,) with the history variables after an accepted load step to this equilibrium."""
        if not len(self.numbers):
            return p
        zeros = np.zeros(len(p))
        return self.committed((p, zeros, zeros), load_factor)

    @cached_property
    def strains(self) -> tuple[ElementGroup, ...]:
        """Elements of each law with unit stiffness: their resultants are the strains from the stress-free state."""
        return tuple(strain_group(block, self.connectors.model.size) for _, block in self.laws)

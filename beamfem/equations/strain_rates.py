"""Strains at the quadrature points of a block and their derivatives by the unknowns."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from beamfem.equations.element_group import ElementGroup
from beamfem.equations.stress_resultants import resultants, strain_group
from beamfem.kernels.block import Block


class StrainsAt(NamedTuple):
    """Derivatives by the unknowns, strains (m,), weights times inverse stiffness, number of positive eigenvalues."""

    rates: np.ndarray
    strain: np.ndarray
    flexible: np.ndarray
    positive: int


@dataclass(frozen=True, eq=False)
class StrainRates:
    """A block whose elements share no coordinates, so that one step changes the same coordinate of every element.

    dof: coordinate of the model for each coordinate of the block, -1 for none; coordinates: number per element;
    resists: the measures that have a stiffness at some point; loose (ne, nq, nr): mask of points without a stiffness
    for such a measure; place, point: positions of the derivatives by unknowns among those by all coordinates
    (coordinates, m); column: their unknowns; weight (m,): quadrature weights; flexibility: rows, columns and values of
    weights times inverse stiffness, at zero strain for a section law; block: the block in the model.
    """

    group: ElementGroup
    dof: np.ndarray
    coordinates: int
    resists: np.ndarray
    loose: np.ndarray
    place: np.ndarray
    point: np.ndarray
    column: np.ndarray
    weight: np.ndarray
    flexibility: tuple[np.ndarray, np.ndarray, np.ndarray]
    block: Block

    def at(self, p: np.ndarray, imposing: np.ndarray) -> "StrainsAt":
        """Return strains and derivatives in a state p (n,).

        imposing (k,): factors of imposed strains, which are subtracted. Raises LinAlgError if a section law has a
        singular stiffness.
        """
        at = np.where(self.dof >= 0, p[self.dof], 0.0)
        local = np.arange(len(at)) % self.coordinates
        steps = (1.0 * (local == number) for number in range(self.coordinates + 1))
        *measured, zeros = resultants(self.group, at, steps, imposing)
        strain = np.where(self.loose, 0.0, zeros[:, :, self.resists]).ravel()
        moved = np.where(self.loose, 0.0, np.array(measured)[:, :, :, self.resists]).reshape(len(measured), -1)
        rates = moved[self.place, self.point] - strain[self.point]
        block = self.block
        if block.law is None:
            return StrainsAt(rates, strain, self.flexibility[2], len(strain))
        stress, slope = block.law.linearised(zeros, p[block.history], block.stiffness[block.kind])
        stiffness = slope[:, :, self.resists[:, None], self.resists]
        stiffness = stiffness + self.loose[..., None] * np.eye(len(self.resists))
        inverse = np.linalg.inv(stiffness)
        # strains for which a linear law with the stiffness of this state has the same resultants
        strain = (inverse @ stress[:, :, self.resists, None]).ravel()
        flexible = (self.weight.reshape(*stiffness.shape[:3], 1) * inverse).ravel()
        return StrainsAt(rates, strain, flexible, int(np.sum(np.linalg.eigvalsh(stiffness) > 0.0)))

    @property
    def shape(self) -> tuple[int, int, int]:
        """Numbers of elements, points and strain measures of the stress resultants."""
        own = self.group.record
        return own.elements, own.points, own.measures


def strain_rates(block: Block, free: np.ndarray) -> StrainRates:
    """Return the strain rates of a block; free (n,): equation numbers, negative for prescribed coordinates."""
    (elements, nodes), width = block.node.shape, block.dof.shape[1]
    points = block.reference.shape[1]
    node = block.node.ravel()
    dof = block.dof[node]
    free_elements = block._replace(
        node=np.arange(len(node)).reshape(elements, nodes),
        dof=np.where(dof >= 0, np.arange(dof.size).reshape(dof.shape), -1),
        node_kind=block.node_kind[node],
        frame=block.frame[node],
        home=np.indices((elements, nodes)).reshape(2, -1).T,
    )
    resists = resisting(block)
    count = points * len(resists)
    column = np.where(dof >= 0, free[dof], -1).reshape(elements, -1).T
    place, element = np.nonzero(column >= 0)
    point = (element[:, None] * count + np.arange(count)).ravel()
    loose = (np.abs(block.stiffness).max(axis=3) == 0.0)[:, :, resists]
    weight = block.weight[:, :, None] * np.ones(len(resists))
    # where a point has no stiffness for a measure, its stress is zero
    inverse = np.linalg.inv(block.stiffness[:, :, resists[:, None], resists] + loose[..., None] * np.eye(len(resists)))
    number = np.arange(elements * count).reshape(elements, points, len(resists))
    shape = elements, points, len(resists), len(resists)
    return StrainRates(
        group=strain_group(free_elements, dof.size),
        dof=dof.ravel(),
        coordinates=nodes * width,
        resists=resists,
        loose=loose[block.kind],
        place=np.repeat(place, count),
        point=point,
        column=np.repeat(column[place, element], count),
        weight=weight[block.kind].ravel(),
        block=block,
        flexibility=(
            np.broadcast_to(number[..., :, None], shape).ravel(),
            np.broadcast_to(number[..., None, :], shape).ravel(),
            (weight[..., None] * inverse)[block.kind].ravel(),
        ),
    )


def resisting(block: Block) -> np.ndarray:
    """Return the strain measures of a block that have a stiffness at some point."""
    return np.flatnonzero(np.abs(block.stiffness).max(axis=(0, 1, 3)) > 0.0)

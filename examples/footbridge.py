"""A footbridge hangs from a mast: forces of its stays, its modes, and a walker of 750 N in step with the first mode."""

import numpy as np

import beamfem as bf

timber, steel = bf.Material(1.2e10, 0.3, 500.0), bf.Material(2.1e11, 0.3, 7850.0)
deck = bf.Beam(bf.Line((0, 0), (36, 0)), 6, section=bf.Rectangle(2.0, 0.18), material=timber)
mast = bf.Beam(bf.Line((0, 0), (0, 12)), 2, section=bf.Profile("HEB 300"), material=steel)
stays = [bf.Cable(mast.end, deck.at(place), stiffness=1e7, pretension=3e4) for place in (1 / 3, 2 / 3)]
stays.append(bf.Cable(mast.end, (-12, 0), stiffness=2e7, pretension=7e4))
supports, weight = [bf.Pin(deck.start), bf.Roller(deck.end), bf.Clamp(mast.start)], bf.Gravity((0, -9.81))
bridge = bf.Model([deck, mast], supports, [weight], connectors=stays)
rest = bf.solve_static(bridge)
modes = bf.solve_modes(bridge, 3, about=rest)
pace = 2.0 * np.pi * modes.frequencies[0]
walker = bf.MovingForce(deck, lambda t: 1.5 * t, (0, -750), amplitude=lambda t: 1.0 + 0.4 * np.sin(pace * t))
walk = bf.simulate(bridge.with_loads([weight, walker]), 24.0, step=0.02, start=rest, integrator=bf.Gauss(2))

print("stays carry", [round(float(np.hypot(*rest.connector_force(stay)[-1, 0, :2]))) for stay in stays], "N")
print("frequencies", modes.frequencies.round(3), "Hz")
print(f"the middle moves by {1e3 * np.ptp(walk.displacement(deck.at(0.5))[:, 1]):.2f} mm")
modes.plot("out/examples/footbridge.png", most=1)

"""At which loads an equilibrium becomes unstable."""

"""`python -m beamfem` is the command `beamfem`."""

from beamfem.cli.app import main

if __name__ == "__main__":
    main()

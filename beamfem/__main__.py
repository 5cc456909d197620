"""`python -m beamfem` is the command `beamfem`."""

from beamfem_command import main

if __name__ == "__main__":
    main()

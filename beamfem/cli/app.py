"""The commands of `beamfem`; what they need is imported when they run."""

from typing import Annotated

import typer

from beamfem.cli.bundled import examples, new, study
from beamfem.cli.commands import doctor, export, info, plot, run

app = typer.Typer(
    name="beamfem",
    help="Planar beams under large deflections: run model files and studies, inspect results.",
    epilog="Exit codes: 0 success, 1 a solve failed, 2 the input is wrong.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def _version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version

        print(f"beamfem {version('beamfem')}")
        raise typer.Exit


@app.callback()
def _root(
    version: Annotated[
        bool, typer.Option("--version", help="Print the version and exit.", callback=_version, is_eager=True)
    ] = False,
) -> None:
    pass


for command in (new, run, study, examples, info, export, plot, doctor):
    own = {"allow_interspersed_args": False, "allow_extra_args": True, "ignore_unknown_options": True}
    app.command(context_settings=own if command is study else None)(command)

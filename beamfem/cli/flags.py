"""Commands whose help lists flags without the name of a type: newer versions of typer put "<bool>" behind them."""

from typing import Any

from typer.core import TyperCommand, TyperGroup


class Command(TyperCommand):
    """A command; flags take no value in its help."""

    def get_params(self, ctx: Any) -> list[Any]:
        """Return the parameters, the option --help included."""
        return _without_type(super().get_params(ctx))


class Group(TyperGroup):
    """A group of commands; flags take no value in its help."""

    def get_params(self, ctx: Any) -> list[Any]:
        """Return the parameters, the option --help included."""
        return _without_type(super().get_params(ctx))


def _without_type(parameters: list[Any]) -> list[Any]:
    for parameter in parameters:
        if getattr(parameter, "is_flag", False):
            parameter.metavar = ""
    return parameters

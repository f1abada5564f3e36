"""What there is in the package: ``python -m basemat``."""

from __future__ import annotations

import inspect

import basemat


def main() -> None:
    """Prints the version, first steps, and every class and function with the first line of its text."""
    print(f"basemat {basemat.__version__}: {inspect.getdoc(basemat)}\n")
    print("First steps:")
    print("  python -m basemat.containment     El Centro on a containment: a table of five runs")
    print("  help(basemat.Simulation)          what a simulation is made of")
    for title, belongs in (
        ("Classes", inspect.isclass),
        ("Functions", inspect.isroutine),
    ):
        print(f"\n{title}:")
        for name in basemat.__all__:
            value = getattr(basemat, name)
            if belongs(value):
                text = (inspect.getdoc(value) or "").split("\n\n")[0].replace("\n", " ")
                print(f"  {name:<21} {text if len(text) < 100 else text[:96] + ' …'}")


if __name__ == "__main__":
    main()

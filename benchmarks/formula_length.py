"""How long formulas are as a person reads them: visible marks of LaTeX, one formula a line.

python benchmarks/formula_length.py '(M + m)\\ddot{X} = 0'      the length, and the formula
python benchmarks/formula_length.py < formulas.txt             of each line
"""

from __future__ import annotations

import sys

from eomgen.symbolic.print.length import length_of_latex


def main() -> None:
    for formula in sys.argv[1:] or map(str.strip, sys.stdin):
        if formula:
            print(f"{length_of_latex(formula):5d}  {formula}")


if __name__ == "__main__":
    main()

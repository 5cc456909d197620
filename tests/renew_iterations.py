"""Write the Newton iterations of random models as they are now: `python tests/renew_iterations.py`, some minutes."""

import csv
import warnings
from pathlib import Path

from judged import judged
from random_models import random_recipe

TABLE, SEEDS, STEPS = Path(__file__).with_name("random_models_iterations.csv"), range(500), (1, 10, 100)


def renew() -> None:
    """Write a row for each model that has a reference, whose numbers are empty where it does not end as it must."""
    with open(TABLE, "w", newline="") as lines:
        table = csv.writer(lines, lineterminator="\n")
        table.writerow(["seed", *(f"steps {steps}" for steps in STEPS)])
        for seed in SEEDS:
            if found := judged(random_recipe(seed), STEPS)[1]:
                table.writerow([seed, *(each.iterations if each.right else "" for each in found)])


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    renew()

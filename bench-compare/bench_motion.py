"""Mesh motion: the paper's four sizes, with and without a rigid layer, beside a C loop, SciPy and OpenFOAM."""


def run(record, options):
    print("motion: later")

"""Packages that only some capabilities need: which versions, and what to say where one is missing."""

REQUIREMENTS = {
    "distributed": "distributed>=2024.8",
    "h5py": "h5py>=3.11",
    "asammdf": "asammdf>=8.0",
    "nptdms": "nptdms>=1.9",
    "python_calamine": "python_calamine>=0.2",
    "pyuff": "pyuff>=2.4",
    "xlsxwriter": "xlsxwriter>=3.2",
    "FLife": "FLife>=2.3",
    "fatpack": "fatpack>=0.7.8",
    "pylife": "pylife>=2.1",
    "pyyeti": "pyyeti>=1.4",
}
"""What pip is asked for, by the name that is imported; the same as in the optional dependencies of the project."""


def install_command(package: str) -> str:
    """Command that installs a missing package into any installation of the program, quoted for every shell."""
    return f'pip install "{REQUIREMENTS[package]}"'

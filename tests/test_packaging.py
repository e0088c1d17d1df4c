"""What pyproject.toml lists is what stands in the tree: a missing package is dropped silently."""

from pathlib import Path

import pytest

tomllib = pytest.importorskip("tomllib", reason="tomllib comes with Python 3.11")
ROOT = Path(__file__).parent.parent


def configuration():
    return tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"][
        "setuptools"
    ]


def folder_of(package):
    folders = configuration()["package-dir"]
    for known in sorted(folders, key=len, reverse=True):
        if package == known or package.startswith(known + "."):
            return Path(folders[known], *package[len(known) :].strip(".").split("."))
    raise AssertionError(package)


def test_every_package_in_the_tree_is_listed():
    in_tree = {
        path.parent.relative_to(ROOT)
        for top in ("geswarm", "app", "static")
        for path in (ROOT / top).rglob("__init__.py")
    }
    assert {folder_of(package) for package in configuration()["packages"]} == in_tree


def test_every_data_file_is_listed():
    listed = {
        path
        for package, patterns in configuration()["package-data"].items()
        for pattern in patterns
        for path in (ROOT / folder_of(package)).glob(pattern)
    }
    in_tree = {
        path
        for top in ("geswarm", "app", "static")
        for path in (ROOT / top).rglob("*")
        if path.is_file() and path.suffix != ".py" and (path.parent / "__init__.py").exists()
    }
    assert in_tree == listed

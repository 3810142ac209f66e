"""The shape of the code: small files, small functions, telling names, light imports."""

from __future__ import annotations

import ast
import importlib
import json
import subprocess
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from statistics import median

import pytest

SRC = Path(__file__).resolve().parents[1] / "src"
TESTS = Path(__file__).resolve().parent
MODULES = {path.relative_to(SRC).as_posix(): path for path in sorted(SRC.rglob("*.py"))}
LENGTHS = {
    name: len(path.read_text(encoding="utf-8").splitlines()) for name, path in MODULES.items()
}

EMPTY_WORDS = {"utils", "util", "helpers", "helper", "common", "base", "manager", "handler", "misc"}
HEAVY = {"anthropic", "cv2", "matplotlib", "mujoco", "openai", "pydantic_ai"}
"""Libraries that take long to import: only the functions that need them may."""

EXTRAS = {"inspect_ai"}
"""Libraries of extras, which modules that nothing else imports may rest on."""

Function = ast.FunctionDef | ast.AsyncFunctionDef


@cache
def _trees() -> dict[str, ast.Module]:
    """Each module, parsed."""
    return {name: ast.parse(path.read_text(encoding="utf-8")) for name, path in MODULES.items()}


def _run_at_import(node: ast.AST) -> Iterator[ast.AST]:
    """All nodes that importing a module carries out."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, Function):
            continue
        if isinstance(child, ast.If) and "TYPE_CHECKING" in ast.unparse(child.test):
            continue
        yield child
        yield from _run_at_import(child)


def _imported(node: ast.AST) -> set[str]:
    """Top-level packages that an import statement names."""
    if isinstance(node, ast.Import):
        return {alias.name.split(".")[0] for alias in node.names}
    if isinstance(node, ast.ImportFrom) and not node.level:
        return {str(node.module).split(".")[0]}
    return set()


def _dotted(name: str) -> str:
    return name.removesuffix(".py").removesuffix("/__init__").replace("/", ".")


def test_a_file_can_be_read_in_one_sitting() -> None:
    assert {name: length for name, length in LENGTHS.items() if length > 400} == {}


def test_most_files_are_short() -> None:
    assert median(LENGTHS.values()) < 150


def _first_line(node: ast.FunctionDef | ast.AsyncFunctionDef) -> int:
    """Where a function's own code starts: documentation does not count against it."""
    documented = ast.get_docstring(node) is not None and len(node.body) > 1
    return node.body[1].lineno if documented else node.lineno


def test_a_function_fits_on_one_screen() -> None:
    lengths = {
        f"{name}:{node.lineno} {node.name}": (node.end_lineno or 0) - _first_line(node) + 1
        for name, tree in _trees().items()
        for node in ast.walk(tree)
        if isinstance(node, Function)
    }
    assert {where: length for where, length in lengths.items() if length > 60} == {}


def _parameters(node: Function) -> int:
    named = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]
    return len([item for item in named if item.arg not in ("self", "cls")])


def test_a_call_can_be_read_at_a_glance() -> None:
    counts = {
        f"{name}:{node.lineno} {node.name}": _parameters(node)
        for name, tree in _trees().items()
        if not name.startswith("adamo_vh/cli/")  # There every option of a command is one.
        for node in ast.walk(tree)
        if isinstance(node, Function)
    }
    assert {where: count for where, count in counts.items() if count > 10} == {}


def test_tests_mirror_the_tree() -> None:
    rooms = {path.relative_to(SRC / "adamo_vh").parent for path in MODULES.values()}
    tested = {path.relative_to(TESTS).parent for path in TESTS.rglob("test_*.py")}
    assert {room for room in tested if room.parts[:1] != ("tools",)} - rooms == set()


def test_tests_are_as_long_as_they_need_to_be() -> None:
    lines = sum(len(path.read_text(encoding="utf-8").splitlines()) for path in TESTS.rglob("*.py"))
    assert lines >= 0.6 * sum(LENGTHS.values())


def test_a_module_is_named_after_what_it_holds() -> None:
    assert [n for n in MODULES if EMPTY_WORDS & set(_dotted(n).replace("_", ".").split("."))] == []


def test_a_module_says_what_it_is_for() -> None:
    assert [name for name, tree in _trees().items() if not ast.get_docstring(tree)] == []


def test_importing_a_module_imports_nothing_heavy() -> None:
    named = {
        f"{name}:{getattr(node, 'lineno', 0)}": _imported(node) & HEAVY
        for name, tree in _trees().items()
        for node in _run_at_import(tree)
    }
    assert {where: heavy for where, heavy in named.items() if heavy} == {}


@pytest.mark.parametrize("module", ["adamo_vh", "adamo_vh.cli"])
def test_a_command_starts_without_heavy_libraries(module: str) -> None:
    code = f"import json, sys, {module}; print(json.dumps(sorted(sys.modules)))"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    assert HEAVY & set(json.loads(run.stdout)) == set()


def test_public_names_exist_once() -> None:
    for name in MODULES:
        if name.endswith("__main__.py"):
            continue
        try:
            module = importlib.import_module(_dotted(name))
        except ModuleNotFoundError as error:
            if error.name in EXTRAS:
                continue
            raise
        public = list(getattr(module, "__all__", []))
        assert len(public) == len(set(public)), name
        assert [item for item in public if not hasattr(module, item)] == [], name

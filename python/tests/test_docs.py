"""Texts that a user reads instead of Rust: docstrings, signatures, choices, messages."""

from __future__ import annotations

import ast
import inspect
import re
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import get_args

import pytest

import basemat as bm
import basemat.opensees

ROOT = Path(__file__).parents[1]
STUBS = (ROOT / "python" / "basemat" / "_core.pyi").read_text("utf-8")
EXCEPTIONS = {name for name in bm.__all__ if name.endswith(("Error", "Warning"))}


def public() -> Iterator[tuple[str, object]]:
    """All classes and functions, and what can be called or read of a class."""
    for name in bm.__all__:
        value = getattr(bm, name)
        if not (isinstance(value, type) or inspect.isroutine(value)) or name in EXCEPTIONS:
            continue
        yield name, value
        if isinstance(value, type) and not name.startswith("User"):
            for own, member in vars(value).items():
                if not own.startswith("_") and not isinstance(member, int):
                    yield f"{name}.{own}", getattr(value, own)


PUBLIC = dict(public())
NAMES = [name for name, value in PUBLIC.items() if callable(value) and not name.startswith("User")]
# Python 3.9 knows no signatures of compiled classes.
signatures = pytest.mark.skipif(sys.version_info < (3, 10), reason="no signatures of classes")


def parameters(name: str) -> list[inspect.Parameter]:
    try:
        signature = inspect.signature(PUBLIC[name])  # type: ignore[arg-type]
    except ValueError:
        # Results and base classes are not made by a call.
        assert isinstance(PUBLIC[name], type) and PUBLIC[name].__text_signature__ is None, name
        return []
    own = signature.parameters.values()
    return [own for own in own if own.name != "self"]


@signatures
def test_every_parameter_is_explained() -> None:
    missing = []
    for name in NAMES:
        text = re.sub(r"\s+", " ", inspect.getdoc(PUBLIC[name]) or "")
        for parameter in parameters(name):
            if not re.search(rf"\b{parameter.name}\b", text):
                missing.append(f"{name}: {parameter.name}")
            elif parameter.default is None and not re.search(
                r"unless|if given|None|or neither|none of them|without either", text
            ):
                missing.append(f"{name}: what {parameter.name} is if it is not given")
    assert missing == []


@signatures
def test_every_call_has_a_signature() -> None:
    assert "unit='m/s²'" in str(inspect.signature(bm.Record))
    made = {"DofCombination", "Soil", "Simulation", "Strip", "Load", "PreviousContact", "SolverOptions"}
    assert all(parameters(name) for name in made)
    # Defaults are numbers, not ellipses.
    assert "band=(0.1, 30.0)" in str(inspect.signature(bm.DampingLaw.constant_q))
    assert "yield_displacement=0.0005" in str(inspect.signature(bm.FrictionPendulum))
    assert not re.search(r"= \.\.\.[,)]", STUBS)
    # What static methods make alone has no constructor.
    assert parameters("PlaneWave") == [] != parameters("PlaneWave.sv")
    keywords = parameters("Simulation")
    assert len(keywords) == 14 and keywords[4].kind is inspect.Parameter.KEYWORD_ONLY


UNITS = r"(?<![\w/])(m|s|Hz|rad|Pa|kg|N|J)(?!\w)|/m|1/s|\bunits?\b"
NUMBERS = r"(?i)\b(ratio|fraction|numbers?|factor|coefficient|order|relative|counts?)\b"
VALUES = r"-> (float|list\[float\]|NDArray|Peak|Extremes|tuple\[float)"


def test_every_number_has_a_unit() -> None:
    """Whatever returns real numbers says of which unit, or that they have none."""
    missing = []
    for node in ast.walk(ast.parse(STUBS)):
        if not isinstance(node, ast.ClassDef):
            continue
        for own in node.body:
            if not isinstance(own, ast.FunctionDef) or own.name.startswith("_"):
                continue
            returns = f"-> {ast.unparse(own.returns)}" if own.returns else ""
            text = ast.get_docstring(own) or ""
            if re.match(VALUES, returns) and not (re.search(UNITS, text) or re.search(NUMBERS, text)):
                missing.append(f"{node.name}.{own.name}: {text}")
    assert missing == []


def test_arrays_have_a_shape() -> None:
    missing = []
    for node in ast.walk(ast.parse(STUBS)):
        if isinstance(node, ast.ClassDef):
            for own in node.body:
                text = ast.get_docstring(own) if isinstance(own, ast.FunctionDef) else None
                if text and own.returns and "NDArray" in ast.unparse(own.returns):  # type: ignore[attr-defined]
                    if not re.search(r"shape|n × n|\(frames, n\)", text):
                        missing.append(f"{node.name}.{own.name}")  # type: ignore[attr-defined]
    assert missing == []


def test_docstrings_are_pythons() -> None:
    rust = r"::(?!`)|\bOption\b|\bVec\b|\b[fiu](64|32)\b|\busize\b|&|\bResult\b|\btraits?\b|\bstruct\b|\bunknowns?\b"
    found = {name: re.findall(rust, inspect.getdoc(value) or "") for name, value in PUBLIC.items()}
    assert {name: words for name, words in found.items() if words} == {}
    assert [line for line in STUBS.splitlines() if re.search(rust, line)] == []


def test_references_lead_somewhere() -> None:
    missing = []
    for name, value in PUBLIC.items():
        owner = name.partition(".")[0]
        # A single backtick on either side of a name: what a page makes a link of, and `help()` shows as it is.
        for target in re.findall(r"(?<!`)`([\w.]+)`(?!`)", inspect.getdoc(value) or ""):
            path = target[len("basemat.") :] if target.startswith("basemat.") else target
            found: object = bm if hasattr(bm, path.partition(".")[0]) else getattr(bm, owner)
            for part in path.split("."):
                found = getattr(found, part, None)
            if found is None:
                missing.append(f"{name}: {target}")
    assert missing == []


def test_stubs_have_the_modules_texts() -> None:
    command = [sys.executable, str(ROOT / "tools" / "stubs.py"), "--check"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    simulation = next(
        own
        for own in ast.parse(STUBS).body
        if isinstance(own, ast.ClassDef) and own.name == "Simulation"
    )
    assert ast.get_docstring(simulation) == inspect.getdoc(bm.Simulation)


@pytest.mark.parametrize(
    ("expression", "name", "text"),
    [
        ("bm.Simulation", "Simulation", "Simulation of a structure on a ground"),
        ("bm.el_centro_1940().high_pass", "Record.high_pass", "Record filtered at a ``corner``"),
        ("bm.load('run').floor_spectra", "Run.floor_spectra", "Floor spectra as a pandas frame"),
        ("bm.load('run').base_shear.magnitude", "Extremes.magnitude", "Magnitude of `largest`"),
        ("bm.Soil.from_wave_speeds", "Soil.from_wave_speeds", "Soil from the speeds of ``shear``"),
    ],
)
def test_an_editor_shows_the_texts(expression: str, name: str, text: str) -> None:
    """What hovering shows, by the engine of Python's language server."""
    jedi = pytest.importorskip("jedi")
    source = f"import basemat as bm\n{expression}"
    [found] = jedi.Script(source).help(2, len(expression))
    assert found.is_stub() and found.full_name == f"basemat._core.{name}"
    assert found.docstring(raw=True).startswith(text)


SOIL = bm.Soil(80.0e6, 0.33, 1900.0)
BLOCK = bm.RigidBlock(6.0, 9.0, 1000.0)
START = bm.PreviousContact(bm.ContactState(), "stick", 0.01)
RECORD = bm.Record(0.01, [0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
PROFILE = bm.SoilProfile([bm.SoilLayer(SOIL, 5.0)], SOIL)
WAVE = bm.InclinedWave.sv(PROFILE, 0.1)


def simulation(**options: object) -> bm.Simulation:
    ground = bm.SpringGround.under(BLOCK, 4, 1e8, 5e7)
    return bm.Simulation(0.01, BLOCK, ground, bm.Bonded(), **options)  # type: ignore[arg-type]


MAT = bm.RigidBody.cuboid(2.0, 2.0, 1.0, 2e3)
PLAN_RUN = bm.Simulation(0.01, MAT, bm.SpringGround.under(MAT, 2, 1e8, 5e7), bm.Bonded()).run(1)


def read(word: str) -> object:
    """A file that is not there: a word that is known leads to it."""
    try:
        unit = "g" if word in ("columns", "along_lines") else None
        time_step = 0.01 if word == "along_lines" else None
        return bm.Record.read("not there", format=word, unit=unit, time_step=time_step)  # type: ignore[arg-type]
    except bm.FileError:
        return None


def mesh(direction: str = "x") -> bm.Mesh:
    """A mesh that has this direction."""
    if "z" in direction or "_" in direction:
        return bm.Mesh.in_space([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
    return bm.Mesh.layered_block(0.0, 1.0, 1, [bm.Layer(1.0, 1, bm.Material(1e9, 0.2, 2e3))])


CHOICES: dict[str, Callable[[str], object]] = {
    "Mode": lambda word: bm.PreviousContact(bm.ContactState(), word, 0.01),  # type: ignore[arg-type]
    "_History": lambda word: bm.ElasticGround.under(SOIL, BLOCK, 4, history=word),
    "_Grading": lambda word: bm.Strip(0.0, 1.0, 4, grading=word),
    "_StripContact": lambda word: bm.ElasticGround.under(SOIL, BLOCK, 4).impedances([1.0], contact=word),
    "_FrictionLimit": lambda word: bm.ThinLayer(SOIL, 1.0, 0.4, friction_limit=word),
    "_SlipSense": lambda word: bm.ThinLayer(SOIL, 1.0, 0.4, slip_sense=word),
    "_AccelerationUnit": lambda word: bm.Record(0.01, [1.0, 2.0], unit=word),
    "_RecordFormat": read,
    "_Baseline": lambda word: bm.el_centro_1940().with_baseline(word),
    "_CurveBound": lambda word: bm.StrainCurves.seed_idriss(word),
    "_Wave": lambda word: bm.SoilColumn(PROFILE, word),
    "_ControlPoint": lambda word: bm.SoilColumn(PROFILE).transfer([1.0], control=word),
    "_InclinedControl": lambda word: WAVE.field(RECORD, -5.0, control=word),
    "_Change": lambda word: simulation().resume(simulation().checkpoint(), [word]),  # type: ignore[list-item]
    "_GravityStage": lambda word: simulation(initial=bm.InitialConditions(gravity_stage=word)),
    "_Coordinates": lambda word: simulation(solver=bm.SolverOptions(coordinates=word)),
    "_AbrahamsonModel": lambda word: bm.AbrahamsonCoherence(word),  # type: ignore[arg-type]
    "_SectionUnit": lambda word: bm.SectionRows(0, 0, 0, unit=word),
    "_Face": lambda word: simulation().state.face(word),  # type: ignore[arg-type]
    "_PlanDirection": lambda word: bm.StoreyBuilding(
        MAT,
        [bm.PlanStorey(3.0, 1e3, (2.0, 2.0), (1e6, 1e6, 1e6))],
        laws={(0, word): bm.Bilinear(1e6, 1e3, 0.1)},  # type: ignore[dict-item]
    ),
    "_Mass": lambda word: bm.FemModel(mesh(), mass=word),
    "_Formulation": lambda word: bm.Layer(1.0, 1, bm.Material(1e9, 0.2, 2e3), formulation=word),
    "_Quantity": lambda word: PLAN_RUN.extremes(word),  # type: ignore[arg-type]
    "_Direction": lambda word: bm.FemModel(mesh()).dof_at(0, word),
    "_SpringDirection": lambda word: mesh(word).add_dashpots([[0, 1]], word, 1.0),
}
LITERALS = {
    name: re.findall(r'"([^"]+)"', words)
    for name, words in re.findall(r"^(_\w+): TypeAlias = Literal\[(.*?)\]$", STUBS, re.M | re.S)
}
LITERALS["Mode"] = list(get_args(bm.Mode))
# Words of the core beyond the types: other spellings, and what only makes sense in files.
BEYOND = {"cm/s²", "none", "reduced(tolerance)"}


def plain(word: str) -> str:
    return re.sub(r"\(.*\)", "", word).casefold()


@pytest.mark.parametrize("name", CHOICES)
def test_choices_are_those_that_the_module_takes(name: str) -> None:
    assert LITERALS.keys() == CHOICES.keys()
    for word in LITERALS[name]:
        CHOICES[name](word)
        assert f'"{word}"' in STUBS or word in get_args(bm.Mode)
    with pytest.raises(bm.InputError) as caught:
        CHOICES[name]("misspelt")
    listed = re.split(r"only |must be ", str(caught.value))[-1]
    known = [own.strip(" '") for own in re.split(r", | or ", listed)]
    known = [own for own in known if own not in BEYOND]
    if name == "_SpringDirection":
        known.append("axial")
    assert {plain(own) for own in known} == {plain(own) for own in LITERALS[name]}


def test_messages_are_pythons() -> None:
    """What the core says of its own functions is said in Python's words."""
    layer = bm.SoilLayer(SOIL, 5.0, damping=bm.DampingLaw.hysteretic(0.05))
    ground = bm.ElasticGround.under(bm.SoilProfile([layer], SOIL), BLOCK, 4)
    with pytest.raises(bm.InputError, match="is not causal") as caught:
        bm.Simulation(1e-3, BLOCK, ground, bm.Bonded()).run(10)
    assert "::" not in str(caught.value) and "use DampingLaw.constant_q with" in str(caught.value)


def test_names_of_the_core_in_messages_have_pythons_words() -> None:
    """Texts in the core's sources that name a function of Rust, against the table of Python's words."""
    table = (ROOT / "src" / "error.rs").read_text("utf-8")
    named = set()
    for path in [*ROOT.parent.glob("src/**/*.rs"), *ROOT.parent.glob("crates/*/src/**/*.rs")]:
        code = re.sub(r"^\s*(//|#!?\[(?!error)).*$", "", path.read_text("utf-8"), flags=re.M)
        texts = re.findall(r'"((?:[^"\\\n]|\\.|\\\n)*)"', code, re.S)
        found = (re.findall(r"\w+(?:::\w+)+", own) for own in texts if " " in own)
        named.update(name for names in found for name in names)
    assert len(named) > 5 and {name for name in named if name not in table} == set()


def test_help_has_no_raw_roles() -> None:
    roles = re.compile(r":(?:class|meth|attr|func|data):`")
    assert [name for name, value in PUBLIC.items() if roles.search(inspect.getdoc(value) or "")] == []
    assert not roles.search(STUBS)


def test_the_command_says_what_there_is() -> None:
    done = subprocess.run([sys.executable, "-m", "basemat"], capture_output=True, check=True)
    text = done.stdout.decode("utf-8")
    assert text.startswith(f"basemat {bm.__version__}: ")
    listed = set(re.findall(r"^  (\w+) ", text, re.M))
    assert listed >= {name.partition(".")[0] for name in PUBLIC} | EXCEPTIONS

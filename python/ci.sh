#!/usr/bin/env bash
# The Python package: format, lints, tests, a wheel. From anywhere; `PYTHON` chooses the interpreter.
set -euo pipefail
cd "$(dirname "$0")"

export CARGO_TARGET_DIR="${CARGO_TARGET_DIR:-$PWD/../target/python}"
venv="$CARGO_TARGET_DIR/venv"
# Folder of the environment's programs.
case "$(uname -s)" in MINGW* | MSYS* | CYGWIN*) programs="$venv/Scripts" ;; *) programs="$venv/bin" ;; esac
mkdir -p "$CARGO_TARGET_DIR"
[[ -x "$programs/python" ]] || "${PYTHON:-python3}" -m venv "$venv"

cargo fmt --check
cargo clippy --locked --all-targets -- -D warnings
# No file of the package above 400 lines, but for the stubs, which are generated.
long="$(find src python tests examples tools -name '*.rs' -o -name '*.py' | xargs wc -l | awk '$2 != "total" && $1 > 400')"
[[ -z "$long" ]] || { echo "above 400 lines: $long"; exit 1; }

"$programs/pip" install -q maturin
# On Linux with Zig as the linker, where it can be had: the wheel then runs with the C library of 2014, on any machine.
options=()
if [[ "$(uname -s)" == Linux ]] && "$programs/pip" install -q ziglang; then
    options=(--zig --compatibility manylinux2014)
fi
# One build for the tests and to be given away.
PATH="$programs:$PATH" "$programs/maturin" build --release --locked ${options[@]+"${options[@]}"} --out "$CARGO_TARGET_DIR/wheels" \
    --interpreter "$programs/python"
wheel="$(ls -t "$CARGO_TARGET_DIR"/wheels/basemat-*.whl | head -1)"
"$programs/pip" install -q --force-reinstall --no-deps "$wheel"
"$programs/pip" install -q "$wheel[test]"
# Scenes to turn: VTK needs libraries of the system. Without them the tests of `to_pyvista` are skipped.
"$programs/pip" install -q pyvista || true
"$programs/python" -c "import pyvista" || echo "pyvista cannot be had here: its tests are skipped"
# The stubs are what the tool writes of the module and its Rust sources, cells of the notebook those of the walkthrough.
"$programs/python" tools/stubs.py --check
"$programs/python" tools/notebook.py --check
"$programs/python" -m pytest -q
notebook="$PWD/examples/walkthrough.ipynb"
(cd "$CARGO_TARGET_DIR" && "$programs/jupyter" execute --output="$CARGO_TARGET_DIR/walkthrough.ipynb" "$notebook")
# The site: pages of docs/python, and of all classes and functions from their docstrings. Warnings are errors.
"$programs/python" -m mkdocs build --quiet --site-dir "$CARGO_TARGET_DIR/site"
# The wheel in an environment of its own, without Rust.
clean="$CARGO_TARGET_DIR/clean"
rm -rf "$clean"
"${PYTHON:-python3}" -m venv "$clean"
"${programs/#$venv/$clean}/pip" install -q "$wheel"
clean_python="${programs/#$venv/$clean}/python"
first_program='import pathlib, re, sys; print(re.findall(r"^```python\n(.*?)^```", pathlib.Path(sys.argv[1]).read_text("utf-8"), re.M | re.S)[0])'
"$clean_python" -c "$first_program" README.md >"$clean/first_program.py"
(cd "$clean" && PATH=/usr/bin:/bin "$clean_python" first_program.py)
(cd "$clean" && PATH=/usr/bin:/bin "$clean_python" -m basemat.containment --duration 2)
case "$wheel" in *-cp39-abi3-*) ;; *) echo "no abi3 wheel: $wheel"; exit 1 ;; esac
# The workflow that builds wheels for other systems, against the schema of such files that the linter contains.
if "$programs/pip" install -q check-jsonschema; then
    "$programs/check-jsonschema" --builtin-schema vendor.github-workflows ../.github/workflows/*.yml
fi
# On Linux: the oldest C library that the wheel runs with. Without Zig it depends on the machine that builds it; wheels of a
# release are built in images of manylinux (.github/workflows/wheels.yml).
if [[ "$(uname -s)" == Linux ]] && "$programs/pip" install -q auditwheel; then
    needed=manylinux
    [[ ${#options[@]} -eq 0 ]] || needed=manylinux2014
    case "$wheel" in *"$needed"*) ;; *) echo "no $needed wheel: $wheel"; exit 1 ;; esac
    "$programs/auditwheel" show "$wheel" | grep -A1 "is consistent with"
fi
echo "wheel: $wheel"

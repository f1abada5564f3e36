#!/usr/bin/env bash
# The Python package: format, lints, tests, a wheel. From anywhere; `PYTHON` chooses the interpreter.
set -euo pipefail
cd "$(dirname "$0")"

export CARGO_TARGET_DIR="${CARGO_TARGET_DIR:-$PWD/../target/python}"
venv="$CARGO_TARGET_DIR/venv"
mkdir -p "$CARGO_TARGET_DIR"
[[ -x "$venv/bin/python" ]] || "${PYTHON:-python3}" -m venv "$venv"

cargo fmt --check
cargo clippy --all-targets -- -D warnings
# No file of the package above 400 lines, but for the one stub file of the compiled module.
long="$(find src python tests examples -name '*.rs' -o -name '*.py' | xargs wc -l | awk '$2 != "total" && $1 > 400')"
[[ -z "$long" ]] || { echo "above 400 lines: $long"; exit 1; }

"$venv/bin/pip" install -q maturin
# One build for the tests and to be given away.
"$venv/bin/maturin" build --release --out "$CARGO_TARGET_DIR/wheels" --interpreter "$venv/bin/python"
wheel="$(ls -t "$CARGO_TARGET_DIR"/wheels/basemat-*.whl | head -1)"
"$venv/bin/pip" install -q --force-reinstall --no-deps "$wheel"
"$venv/bin/pip" install -q "$wheel[test]"
"$venv/bin/python" -m pytest -q
walkthrough="$PWD/examples/walkthrough.py"
(cd "$CARGO_TARGET_DIR" && MPLBACKEND=agg "$venv/bin/python" "$walkthrough")
echo "wheel: $wheel"

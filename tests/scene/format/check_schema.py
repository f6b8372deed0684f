"""Holds the published schema against the examples and the fixtures.

Usage: check_schema.py REPOSITORY
Examples, valid fixtures and those whose fault only the parser can see must pass, invalid ones must
not. The parser's side of the same fixtures is in fixtures_test.cpp.
"""

import json
import pathlib
import sys

try:
    from jsonschema import Draft202012Validator
except ImportError:
    print("python3-jsonschema 4 is not installed: skipped")
    sys.exit(77)


def main() -> int:
    root = pathlib.Path(sys.argv[1])
    schema = json.loads((root / "schemas/scene.schema.json").read_text())
    Draft202012Validator.check_schema(schema)
    validator = Draft202012Validator(schema)
    fixtures = root / "tests/scene/fixtures"
    expected = {
        root / "schemas/examples": True,
        fixtures / "valid": True,
        fixtures / "beyond_schema": True,
        fixtures / "invalid": False,
    }
    failures = 0
    for folder, valid in expected.items():
        paths = sorted(path for path in folder.glob("*.json") if not path.name.startswith("study-"))
        if not paths:
            print(f"{folder}: holds no scene")
            failures += 1
        for path in paths:
            errors = [f"{e.json_path}: {e.message[:200]}" for e in
                      validator.iter_errors(json.loads(path.read_text()))]
            if valid != (not errors):
                print(f"{path}: {'refused: ' + errors[0] if errors else 'accepted'}")
                failures += 1
    study = json.loads((root / "schemas/study.schema.json").read_text())
    Draft202012Validator.check_schema(study)
    for path in sorted((root / "schemas/examples").glob("study-*.json")):
        for error in Draft202012Validator(study).iter_errors(json.loads(path.read_text())):
            print(f"{path}: refused: {error.json_path}: {error.message[:200]}")
            failures += 1
    print(f"{failures} failures")
    return 1 if failures else 0


sys.exit(main())

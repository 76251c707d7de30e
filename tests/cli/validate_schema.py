"""validate_schema.py SCHEMA DOCUMENT...: exit 0 valid, 1 not, 77 where python3-jsonschema is missing.

The published schema lets later versions add keys; here every object is closed, so that a key without a description fails.
"""

import json
import sys

try:
    import jsonschema
except ImportError:
    print("python3-jsonschema is not installed")
    sys.exit(77)


def close_objects(node):
    if isinstance(node, dict):
        if "properties" in node and node.get("type") == "object":
            node["additionalProperties"] = False
        for child in node.values():
            close_objects(child)
    elif isinstance(node, list):
        for child in node:
            close_objects(child)


def refuse_constant(text):
    raise ValueError(f"{text} is not JSON")


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        schema = json.load(file)
    jsonschema.Draft202012Validator.check_schema(schema)
    close_objects(schema)
    validator = jsonschema.Draft202012Validator(schema)
    failed = False
    for name in sys.argv[2:]:
        with open(name, encoding="utf-8") as file:
            document = json.load(file, parse_constant=refuse_constant)
        for error in validator.iter_errors(document):
            failed = True
            print(f"{name}: {'/'.join(map(str, error.absolute_path))}: {error.message}")
    sys.exit(1 if failed else 0)


main()

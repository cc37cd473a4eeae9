#!/usr/bin/env python3
"""Validates a .hjif file against the MPEG haptics schemas: validate_hjif.py SCHEMA_FOLDER FILE"""
import json
import pathlib
import sys

import jsonschema

schema_file = pathlib.Path(sys.argv[1]).resolve() / "MPEG_haptics.schema.json"
schema = json.loads(schema_file.read_text())
jsonschema.Draft4Validator.check_schema(schema)
# The schemas name each other by file, relative to their own folder.
resolver = jsonschema.RefResolver(schema_file.as_uri(), schema)
errors = list(jsonschema.Draft4Validator(schema, resolver=resolver).iter_errors(json.load(open(sys.argv[2]))))
for error in errors:
    print(f"{list(error.path)}: {error.message}")
sys.exit(1 if errors else 0)

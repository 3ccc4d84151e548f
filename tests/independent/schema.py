"""The JSON Schemas of `bryant schema`, held against `bryant check` by another validator.

Every bundled model keeps the schema of models. Mutants of them are read by both: what `check` accepts the schema accepts, and keys that are unknown or
missing and values of another shape are found by the schema, too. So are bare numbers of a wrong sign, where a key alone decides the sign.

    python3 schema.py BRYANT [SEED]
"""

import concurrent.futures
import copy
import io
import json
import random
import subprocess
import sys
import tempfile

import jsonschema
import ruamel.yaml

MUTANTS = 500
REVERSED = 150
# what `check` says of shapes; everything else needs more than one value to be seen
SHAPES = ("has no key", "lacks the key", "is needed", "are needed", "none of the words", "has keys")

yaml = ruamel.yaml.YAML(typ="safe")
bryant = sys.argv[1]
seed = int(sys.argv[2]) if len(sys.argv) > 2 else random.randrange(1 << 32)


def run(*arguments):
    return subprocess.run([bryant, *arguments], capture_output=True, text=True)


def printed(*arguments):
    done = run(*arguments)
    assert done.returncode == 0, done.stderr
    return done.stdout


def written(tree):
    out = io.StringIO()
    yaml.dump(tree, out)
    return out.getvalue()


def nodes(tree, path=()):
    """All mappings and lists, and where they are."""
    if isinstance(tree, dict):
        yield path, tree
        for key, value in tree.items():
            yield from nodes(value, (*path, key))
    elif isinstance(tree, list):
        yield path, tree
        for index, value in enumerate(tree):
            yield from nodes(value, (*path, index))


def mutate(tree, chance):
    """One change: a key renamed, a key removed, or a value of another kind; what was done."""
    path, node = chance.choice([(p, n) for p, n in nodes(tree) if n])
    if isinstance(node, list):
        index = chance.randrange(len(node))
        node[index] = chance.choice([True, "xyz", {"xyz": 1}, [1, 2], 3.5])
        return f"{path} [{index}] is {node[index]}"
    key = chance.choice(list(node))
    match chance.randrange(3):
        case 0:
            node[f"{key}_x"] = node.pop(key)
            return f"{path} {key} renamed"
        case 1:
            del node[key]
            return f"{path} {key} removed"
        case _:
            node[key] = chance.choice([True, "xyz", {"xyz": 1}, [1, 2], 3.5])
            return f"{path} {key} is {node[key]}"


def numbers(tree):
    """All bare numbers: what has them, and their keys or indices."""
    for _, node in nodes(tree):
        for key, value in node.items() if isinstance(node, dict) else enumerate(node):
            if isinstance(value, (int, float)) and not isinstance(value, bool):
                yield node, key


def reverse(tree, chance):
    """Changes the sign of a bare number; what was done."""
    node, key = chance.choice(list(numbers(tree)))
    node[key] = -node[key] if node[key] else -1
    return f"{key} is {node[key]}"


def said(text):
    """What `check` reports of a text."""
    with tempfile.NamedTemporaryFile("w", suffix=".yaml", encoding="utf-8") as file:
        file.write(text)
        file.flush()
        done = run("check", file.name)
    return "" if done.returncode == 0 else done.stderr


schema = json.loads(printed("schema"))
jsonschema.Draft7Validator.check_schema(schema)
models = jsonschema.Draft7Validator(schema)
# those that include files cannot be moved
whole = []
for row in json.loads(printed("models", "--json")):
    tree = yaml.load(printed("models", row["name"], "--yaml"))
    problem = jsonschema.exceptions.best_match(models.iter_errors(tree))
    assert problem is None, f"{row['name']}: {problem}"
    if not any("include" in n or "source" in n or "file" in n for _, n in nodes(tree) if isinstance(n, dict)):
        whole.append((row["name"], tree))

for kind in ["included", "study"]:
    jsonschema.Draft7Validator.check_schema(json.loads(printed("schema", kind)))

chance = random.Random(seed)
mutants = []
for _ in range(MUTANTS):
    name, tree = chance.choice(whole)
    tree = copy.deepcopy(tree)
    mutants.append((name, mutate(tree, chance), tree))
for _ in range(REVERSED):
    name, tree = chance.choice([(name, tree) for name, tree in whole if any(numbers(tree))])
    tree = copy.deepcopy(tree)
    mutants.append((name, reverse(tree, chance), tree))
with concurrent.futures.ThreadPoolExecutor(2) as pool:
    answers = list(pool.map(said, [written(tree) for _, _, tree in mutants]))

found = accepted = signs = 0
for (name, what, tree), answer in zip(mutants, answers):
    fits = models.is_valid(tree)
    shape = any(words in answer for words in SHAPES)
    accepted += not answer
    found += not fits
    signs += not fits and ("must be positive, but is" in answer or "must not be negative, but is" in answer)
    assert fits or answer, f"seed {seed}, {name}: the schema refuses what check accepts: {what}"
    assert not (fits and shape), f"seed {seed}, {name}: {what}\n{answer}"
assert found > MUTANTS // 4 and accepted > MUTANTS // 20 and signs, (found, accepted, signs)
print(f"{len(mutants)} mutants, seed {seed}: {found} found by the schema, {signs} of them by their sign, {accepted} right")

"""Commands of the program, in this process."""

import json

from . import _bryant


def words(options):
    """Options of the command line: {"no_files": True, "set": {"a": 1}, "response": ["peak of x"]}."""
    line = []
    for name, value in options.items():
        name = "--" + name.replace("_", "-")
        if value is None or value is False:
            continue
        if value is True:
            line.append(name)
            continue
        if isinstance(value, dict):
            value = [f"{key}={text(one)}" for key, one in value.items()]
        for one in value if isinstance(value, (list, tuple)) else [value]:
            # joined, because a value may begin with a minus
            line.append(f"{name}={text(one)}")
    return line


def text(value):
    """A value as the command reads it: every digit of a number."""
    return repr(float(value)) if isinstance(value, float) else str(value)


def call(*line, **options):
    """Runs a command and returns what it printed. Raises Error with its messages."""
    code, output, messages = _bryant.command([str(word) for word in line] + words(options))
    if code != 0:
        error = _bryant.Error(clean(messages) or clean(output))
        error.code, error.output = code, output
        raise error
    return output, messages


def call_json(*line, **options):
    """Runs a command that prints JSON, and returns that with its messages."""
    output, messages = call(*line, json=True, **options)
    return json.loads(output), messages


def clean(messages):
    """The text of an error without the word that stands before it on a terminal."""
    return messages.strip().removeprefix("error: ")

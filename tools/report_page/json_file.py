"""JSON with demands: whatever a file lacks is named by file and key, with what to do about it."""
import json
import math
from pathlib import Path

from .interval import Interval


class BadFile(Exception):
    pass


REQUIRED = object()


class Node:
    """An object in a file, and where in the file it is. A key may be null where the number is not known, but not missing."""

    def __init__(self, data, file, where="", remedy=""):
        self.data, self.file, self.where, self.remedy = data, file, where, remedy
        if not isinstance(data, dict):
            self.fail(where or "the file", "is no object")

    def fail(self, key, what):
        raise BadFile(f"{self.file}: {key} {what}; {self.remedy}")

    def path(self, key):
        return f"{self.where}.{key}" if self.where else key

    def get(self, key, kinds, kind, default=REQUIRED):
        if key not in self.data:
            if default is REQUIRED:
                self.fail(self.path(key), "is missing")
            return default
        value = self.data[key]
        if value is not None and (not isinstance(value, kinds) or isinstance(value, bool) and bool not in kinds):
            self.fail(self.path(key), f"should be {kind}, and is {json.dumps(value)[:40]}")
        return value

    def text(self, key, default=REQUIRED):
        return self.get(key, (str,), "text", default) or ""

    def truth(self, key, default=REQUIRED):
        return bool(self.get(key, (bool,), "true or false", default))

    def number(self, key, default=REQUIRED):
        value = self.get(key, (int, float), "a number", default)
        return float(value) if value is not None and math.isfinite(value) else None

    def needed(self, key):
        value = self.number(key)
        if value is None:
            self.fail(self.path(key), "is null, and nothing can be shown without it")
        return value

    def numbers(self, key, default=REQUIRED):
        """An object of numbers, as seconds by pass; those that are null are left out."""
        if self.get(key, (dict,), "an object", default) is None:
            return {}
        node = self.object(key)
        return {name: node.number(name) for name in node.data if node.number(name) is not None}

    def interval(self, key, default=REQUIRED):
        if self.get(key, (dict,), "an object with value, low and high", default) is None:
            return Interval(None)
        node = self.object(key)
        return Interval(node.number("value"), node.number("low"), node.number("high"))

    def object(self, key, default=REQUIRED):
        data = self.get(key, (dict,), "an object", default)
        return Node({} if data is None and default is not REQUIRED else data, self.file, self.path(key), self.remedy)

    def objects(self, key, default=REQUIRED):
        data = self.get(key, (list,), "a list", default) or []
        return [Node(item, self.file, f"{self.path(key)}[{i}]", self.remedy) for i, item in enumerate(data)]


def load(file, form, remedy):
    """The root of a file whose format is `form`, version 1."""
    try:
        data = json.loads(Path(file).read_text(encoding="utf-8"))
    except OSError as error:
        raise BadFile(f"{file}: cannot be read: {error.strerror}; {remedy}")
    except (json.JSONDecodeError, UnicodeDecodeError) as error:
        raise BadFile(f"{file}: is no JSON: {error}; {remedy}")
    root = Node(data, file, remedy=remedy)
    if form and root.text("format") != form:
        root.fail("format", f'is "{root.text("format")}" and should be "{form}"')
    if form and root.number("version") != 1:
        root.fail("version", "is not 1, the one that this program reads")
    return root

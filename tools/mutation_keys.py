#!/usr/bin/env python3
"""What a row of tools/mutation_table.txt rests on, as a key, and which rows were not made since it changed.

A row rests on itself, on the code around the error (of its file, what stands between two lines that begin with a closing
brace: a function, a struct), and on the test that caught it, but for comments and line breaks. What else is in those files does not count, as other files
do not: nothing is as sure as to make all errors anew, which takes hours.

    tools/mutation_keys.py SOURCE RESULTS < TABLE       the rows to be made, those that have no result first
    tools/mutation_keys.py SOURCE --key ROW CAUGHT_BY   one row's key
"""

import hashlib
import re
import sys
from functools import cache
from pathlib import Path

TEST = re.compile(r'^\w*TEST_CASE\w*\(\s*((?:"(?:[^"\\]|\\.)*"\s*)+)', re.M)


@cache
def tests_of(source):
    """Pairs of a test's name and its text."""
    tests = []
    for path in sorted(Path(source, "tests").rglob("*_test.cpp")):
        content = path.read_text()
        for match in TEST.finditer(content):
            name = "".join(re.findall(r'"((?:[^"\\]|\\.)*)"', match[1])).replace('\\"', '"')
            tests.append((name, content[match.start():].split("\n}\n")[0]))
    return tests


@cache
def pieces_of(path):
    return re.split(r"(?m)^(?=\})", path.read_text()) if path.exists() else []


def code(text):
    return re.sub(r"\s+", " ", re.sub(r"//[^\n]*", "", text)).strip()


def key(source, row, caught_by):
    _, file, texts = row.split(" ~ ")[:3]
    wanted = texts.split(" ^ ")
    around = [piece for piece in pieces_of(Path(source, file)) if any(text in piece for text in wanted)]
    # Texts of several pieces would be in none.
    around = around or pieces_of(Path(source, file))
    # Long names are cut off in Catch2's output.
    caught = [text for name, text in tests_of(source) if name.startswith(caught_by)]
    return hashlib.sha256("\n".join([row, *map(code, around), *map(code, caught)]).encode()).hexdigest()[:12]


def stale(source, results, rows):
    known = {}
    for line in results:
        fields = [field.strip() for field in line.split(" | ")]
        if len(fields) == 4:
            known[fields[0]] = fields
    never, since = [], []
    for row in rows:
        name = row.split(" ~ ")[0].strip()
        if name not in known:
            never.append(row)
            continue
        _, caught_by, _, made_with = known[name]
        # An error that nothing caught is never done with.
        if re.match("NOTHING|NOT |NO TEST", caught_by) or made_with != key(source, row, caught_by):
            since.append(row)
    return never + since


if __name__ == "__main__":
    if sys.argv[2] == "--key":
        print(key(sys.argv[1], sys.argv[3], sys.argv[4]))
    else:
        lines = Path(sys.argv[2]).read_text().splitlines() if Path(sys.argv[2]).exists() else []
        print("".join(row + "\n" for row in stale(sys.argv[1], lines, sys.stdin.read().splitlines())), end="")

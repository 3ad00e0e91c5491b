#!/usr/bin/env python3
"""Searches for terms that floe does not use (words.toml), and in pages for paths of files that do not exist: prints
file:line: term -> the term to use; exit code 1 where there are any.

Groups of files: docs (pages of the manual, README.md, CONTRIBUTING.md: text without code, links' targets, formulas and
quoted messages), headers (comments of include), strings (literals of src with more than one word, C++ and Python), names (code of include and src, C++, without these).
"""
import argparse
import io
import re
import sys
import tokenize
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
GROUPS = {
    "docs": ["README.md", "CONTRIBUTING.md", "docs/**/*.md", "examples/**/*.md", "tests/**/*notes.md"],
    "headers": ["include/**/*.h"],
    "strings": ["src/**/*.cpp", "src/**/*.h", "src/**/*.py"],
    "names": ["include/**/*.h", "src/**/*.cpp", "src/**/*.h"],
}
NO_TEXT = re.compile(r"^```.*?^```|`[^`\n]*`|\]\([^)\s]*\)|\$\$.*?\$\$|\$[^$\n]+\$|\"[^\"\n|]*\"", re.S | re.M)
PATH = re.compile(r"`((?:[\w.*-]+/)+[\w.*-]+\.(?:cpp|h|py|cmake|toml|txt|md|opts|yaml|css|js))`")
CPP = re.compile(r"(?P<comment>//[^\n]*|/\*.*?\*/)|R\"(?P<mark>\w*)\((?P<raw>.*?)\)(?P=mark)\"|"
                 r"\"(?P<string>(?:\\.|[^\"\\\n])*)\"|'(?:\\.|[^'\\\n])'", re.S)


def blank(text):
    """As long, with the same line breaks."""
    return re.sub(r"[^\n]", " ", text)


def page_text(text):
    return NO_TEXT.sub(lambda found: blank(found.group()), text)


def cpp_text(text, *groups):
    """Comments or string literals at their places, all else blank."""
    parts, end = [], 0
    for found in CPP.finditer(text):
        parts.append(blank(text[end:found.start()]))
        kept = next((found.group(name) for name in groups if found.group(name) is not None), None)
        words = kept is not None and ("comment" in groups or re.search(r"\S\s+\S", kept))
        parts.append(found.group() if words else blank(found.group()))
        end = found.end()
    return "".join(parts)


def code_text(text):
    return CPP.sub(lambda found: blank(found.group()), text)


def python_text(text):
    lines = [" " * len(line) for line in text.split("\n")]
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.STRING and re.search(r"\S\s+\S", token.string):
            for i, part in enumerate(token.string.split("\n")):
                start = token.start[1] if i == 0 else 0
                line = lines[token.start[0] - 1 + i]
                lines[token.start[0] - 1 + i] = line[:start] + part + line[start + len(part):]
    return "\n".join(lines)


def text_of(path, group):
    text = path.read_text(encoding="utf-8")
    if group == "docs":
        return page_text(text)
    if group == "names":
        return code_text(text)
    if path.suffix == ".py":
        return python_text(text)
    return cpp_text(text, "comment") if group == "headers" else cpp_text(text, "raw", "string")


def found_in(text, terms):
    """(line, words, use) of all terms in a text."""
    for term in terms:
        allowed = [range(*one.span()) for pattern in term["allow"] for one in pattern.finditer(text)]
        for one in term["pattern"].finditer(text):
            if not any(one.start() in span for span in allowed):
                yield text.count("\n", 0, one.start()) + 1, " ".join(one.group().split()), term["use"]


def missing_paths(path, root):
    """(line, path) of files of the sources that a page names in backticks, `fem/element.h`, and that do not exist."""
    text = re.sub(r"^```.*?^```", lambda found: blank(found.group()), path.read_text(encoding="utf-8"), flags=re.S | re.M)
    for one in PATH.finditer(text):
        if not any(any(base.glob(one[1])) for base in (root, root / "src", root / "include" / "floe", path.parent)):
            yield text.count("\n", 0, one.start()) + 1, one[1]


def read_terms():
    with open(Path(__file__).with_name("words.toml"), "rb") as file:
        terms = tomllib.load(file)["term"]

    def compiled(pattern):
        return re.compile(pattern.replace(" ", r"\s+"), re.I)

    for term in terms:
        unknown = set(term["in"]) - set(GROUPS)
        if unknown:
            raise SystemExit(f"words.toml: {term['pattern']}: no group {', '.join(sorted(unknown))}")
        term["pattern"] = compiled(term["pattern"])
        term["allow"] = [compiled(pattern) for pattern in term.get("allow", [])]
    return terms


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--count", choices=GROUPS, help="only count every term in one group")
    parser.add_argument("--root", type=Path, default=ROOT, help="tree to search")
    arguments = parser.parse_args()
    terms, count = read_terms(), 0
    for group, patterns in GROUPS.items():
        paths = sorted({path for pattern in patterns for path in arguments.root.glob(pattern)})
        if arguments.count:
            if group == arguments.count:
                texts = [text_of(path, group) for path in paths]
                for term in terms:
                    print(f"{sum(len(list(found_in(text, [term]))) for text in texts):5} {term['pattern'].pattern}")
            continue
        wanted = [term for term in terms if group in term["in"]]
        for path in paths if group == "docs" else []:
            for line, name in missing_paths(path, arguments.root):
                print(f"{path.relative_to(arguments.root)}:{line}: {name} -> a file that exists")
                count += 1
        for path in paths if wanted else []:
            for line, words, use in sorted(found_in(text_of(path, group), wanted)):
                print(f"{path.relative_to(arguments.root)}:{line}: {words} -> {use}")
                count += 1
    return 1 if count else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""No sentence of a comment in core or plugins has more than 25 words, and no line more than 120 columns.

A sentence ends at a full stop, colon, semicolon, question or exclamation mark, or with its paragraph. Lines that are set in by four are formulas,
drawings and examples."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
MOST_WORDS = 25
MOST_COLUMNS = 120
GENERATED = {"core/io/page_asset.c", "core/io/page_asset.h"}
COMMENT = re.compile(r"/\*(.*?)\*/", re.S)
SET_IN = re.compile(r" {4,}\S")
END = re.compile(r"(?<=[.:;!?])\s+")


def sentences(comment):
    text = re.sub(r"\n[ \t]*\*[ \t]?", "\n", comment)
    for paragraph in re.split(r"\n\s*\n", text):
        lines = [line.strip() for line in paragraph.split("\n") if not SET_IN.match(line)]
        yield from END.split(re.sub(r"-{6,}", " . ", " ".join(lines)))


def long_sentences(text):
    for match in COMMENT.finditer(text):
        for sentence in sentences(match.group(1)):
            words = [word for word in sentence.split() if re.search(r"\w", word)]
            if len(words) > MOST_WORDS:
                yield text.count("\n", 0, match.start()) + 1, len(words), " ".join(words[:8])


def long_lines(text):
    for number, line in enumerate(text.split("\n"), 1):
        if len(line) > MOST_COLUMNS:
            yield number, len(line)


def check_samples():
    """What the test is for is found, and what is fine is not."""
    long = "word " * 26
    assert [found[1] for found in long_sentences(f"int a; /* {long}*/")] == [26]
    assert [found[0] for found in long_sentences(f"\n\n/* Short.\n * {long}*/")] == [3]
    assert not list(long_sentences(f"/* {'word ' * 25}*/"))
    assert not list(long_sentences(f"/* Two: {'word ' * 20}. {'word ' * 20}*/"))
    assert list(long_lines("a\n" + 121 * "b")) == [(2, 121)] and not list(long_lines(120 * "b"))
    assert not list(long_sentences(f"/* A formula:\n *\n *     {long}\n */"))


def main():
    check_samples()
    files = faults = 0
    for folder in ("core", "plugins"):
        for path in sorted((ROOT / folder).rglob("*.[ch]")):
            name = path.relative_to(ROOT).as_posix()
            if name in GENERATED:
                continue
            files += 1
            text = path.read_text(encoding="utf-8")
            for line, count in long_lines(text):
                faults += 1
                print(f"{name}:{line}: {count} columns, at most {MOST_COLUMNS}")
            for line, count, begin in long_sentences(text):
                faults += 1
                print(f"{name}:{line}: a sentence of {count} words, at most {MOST_WORDS}: {begin} ...")
    print(f"comments: {files} files, {faults} faults")
    return faults != 0


if __name__ == "__main__":
    sys.exit(main())

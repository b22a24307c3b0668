"""Shortens the names of a script that is put together of modules, for page_asset.py.

A name becomes another one everywhere, whatever its scope, so that no scopes need be known: the new name is used nowhere, and the old
one is declared by every module that uses it, or at the top level of one of them. Properties (`.word`), keys (`word:`), methods, strings and
what a browser defines stay as they are; of a shorthand `{word}` the key stays: `{word:a}`.
"""
import collections
import itertools
import re

TOKEN = re.compile(r"[A-Za-z_$][\w$]*|\d[\w.]*|\.\.\.|=>|\?\.(?!\d)|\s+|.", re.S)
REGULAR = re.compile(r"/(?:[^/\\\n\[]|\\.|\[[^\]\n]*\])+/\w*")
QUOTED = {quote: re.compile(rf"(?:[^\\{quote}]|\\.)*{quote}", re.S) for quote in "'\""}
FIRST = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_$"
BEFORE_REGULAR = "(,=:&|!?;{["
BEFORE_BLOCK = frozenset([")", "=>", ";", "{", "}", "else", "try", "finally", "do", "catch"])  # braces after these hold statements
BEFORE_CONDITION = frozenset(["if", "for", "while", "switch", "with"])
ACCESS = frozenset([".", "?.", "#", "get", "set", "static"])
# Words of the language, and those that a browser defines and a script could use without saying so.
KNOWN = frozenset("""
    arguments as async await break case catch class const continue debugger default delete do else enum eval export extends false finally for
    from function get if implements import in instanceof interface let new null of package private protected public return set static super
    switch this throw true try typeof undefined using var void while with yield NaN Infinity globalThis isNaN isFinite parseFloat parseInt
    decodeURIComponent encodeURIComponent decodeURI encodeURI escape unescape
    alert atob blur btoa caches cancelAnimationFrame clearInterval clearTimeout close closed confirm console cookieStore crypto devicePixelRatio
    document event external fetch find focus frames getComputedStyle getSelection history indexedDB innerHeight innerWidth length localStorage
    location locationbar matchMedia menubar moveBy moveTo name navigation navigator open opener origin outerHeight outerWidth parent performance
    personalbar postMessage print prompt queueMicrotask reportError requestAnimationFrame requestIdleCallback resizeBy resizeTo scheduler screen
    screenLeft screenTop screenX screenY scroll scrollbars scrollBy scrollTo scrollX scrollY self sessionStorage setInterval setTimeout status
    statusbar stop structuredClone talus toolbar top visualViewport window
""".split())


def template_end(code, at):
    """Where a part of a template ends: after its closing quote, or after ${."""
    while code[at] != "`":
        if code.startswith("${", at):
            return at + 2
        at += 2 if code[at] == "\\" else 1
    return at + 1


def tokens(code):
    """The pieces of a script without comments: (kind, text), kind "word", "text" (strings, parts of templates, regular expressions), "sign" or "space"."""
    out, open_, at, before = [], [], 0, ";"
    while at < len(code):
        char = code[at]
        if char in QUOTED:
            kind, end = "text", QUOTED[char].match(code, at + 1).end()
        elif char == "`" or (char == "}" and open_[-1:] == ["${"]):
            kind, end = "text", template_end(code, at + 1)
            if char == "}":
                open_.pop()
            if code[end - 1] == "{":
                open_.append("${")
        elif char == "/" and before[-1] in BEFORE_REGULAR and (found := REGULAR.match(code, at)):
            kind, end = "text", found.end()
        else:
            end = TOKEN.match(code, at).end()
            kind = "word" if char.isalpha() or char in "_$" else "space" if char.isspace() else "sign"
            if char == "{":
                open_.append(char)
            elif char == "}":
                open_.pop()
        out.append((kind, code[at:end]))
        if kind != "space":
            before = out[-1][1]
        at = end
    return out


class Uses:
    """What the words of a script are: `names` has the numbers of the pieces that name something, `short` those among them that are a key as well,
    `declared` the words that are declared."""

    def __init__(self, pieces):
        self.pieces = [(i, kind, text) for i, (kind, text) in enumerate(pieces) if kind != "space"]
        self.names, self.short, self.declared = collections.defaultdict(list), set(), set()
        self.closing = self.pairs()
        # brackets that are open, as (what, whether names directly in it are declared), and how many were open where a let stands
        self.open, self.let, self.of_class = [], [], False
        for k, (i, kind, text) in enumerate(self.pieces):
            if kind == "word":
                self.word(k, i, text)
            elif kind == "text":
                if text[0] == "}":
                    self.open.pop()
                if text.endswith("${"):
                    self.open.append(("${", False))
            elif text in ("(", "[", "{"):
                self.begin(k, text)
            elif text in (")", "]", "}"):
                self.open.pop()
            while self.let and (len(self.open) < self.let[-1] or (text == ";" and len(self.open) == self.let[-1])):
                self.let.pop()

    def text(self, k):
        return self.pieces[k][2] if 0 <= k < len(self.pieces) else ";"

    def pairs(self):
        """Of each opening bracket ( the closing one."""
        out, begun = {}, []
        for k, (_i, kind, text) in enumerate(self.pieces):
            if kind == "sign" and text == "(":
                begun.append(k)
            elif kind == "sign" and text == ")":
                out[begun.pop()] = k
        return out

    def declares(self, k):
        """Whether a name or pattern at this place is declared there."""
        last, (around, inner) = self.text(k - 1), self.open[-1] if self.open else ("block", False)
        if last in ("let", "const", "var") or (last == "," and self.let and self.let[-1] == len(self.open)):
            return True
        return inner and (last in ("(", "[", "{", ",", "...") or (last == ":" and around == "{"))

    def begin(self, k, text):
        last, inner = self.text(k - 1), self.declares(k)
        if text == "(":
            after = self.text(self.closing[k] + 1)
            inner = after == "=>" or (after == "{" and last not in BEFORE_CONDITION)
        elif text == "{":
            text = "class" if self.of_class else "block" if last in BEFORE_BLOCK else text
            self.of_class = False
        self.open.append((text, inner))

    def word(self, k, i, text):
        last, after, around = self.text(k - 1), self.text(k + 1), self.open[-1][0] if self.open else "block"
        self.of_class |= text == "class"
        if text in ("let", "const", "var"):
            self.let.append(len(self.open))
        entry = around == "{" and last in ("{", ",")
        method = after == "(" and self.text(self.closing[k + 1] + 1) == "{" and last not in ("function", "*")
        if last in ACCESS or around == "class" or method or (entry and after == ":"):
            return
        if entry and after in (",", "}", "="):
            self.short.add(i)
        if self.declares(k) or last in ("function", "class", "*") or after == "=>":
            self.declared.add(text)
        self.names[text].append(i)


def shortened(code, modules, top):
    """The script with shorter names. `modules` are its parts as they were, and `top` the names at their top level."""
    pieces = tokens(code)
    uses = Uses(pieces)
    own = uses.declared - KNOWN
    for module in modules:
        of = Uses(tokens(module))
        own -= set(of.names) - of.declared - set(top)
    fresh = (name for size in itertools.count(1) for name in map("".join, itertools.product(FIRST, repeat=size)) if name not in uses.names and name not in KNOWN)
    texts = [text for _kind, text in pieces]
    for word in sorted(own, key=lambda word: (-len(uses.names[word]) * (len(word) - 2), word)):
        places = uses.names[word]
        new = next(fresh)
        if (len(word) - len(new)) * len(places) <= sum(len(word) + 1 for i in places if i in uses.short):
            fresh = itertools.chain([new], fresh)
            continue
        for i in places:
            texts[i] = f"{word}:{new}" if i in uses.short else new
    return "".join(texts)

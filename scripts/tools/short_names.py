"""Shortens the names of a script that is put together of modules, for page_asset.py.

No scopes need be known: a name of the top level becomes another one everywhere, whatever it names, and one that is declared within a function or class
of the top level becomes another one in the whole of that, where the new name names nothing else. Properties (`.word`), keys (`word:`), methods, strings and
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
# Whose functions and numbers need not know whose they are, and what has them: of gl only the numbers, in capitals.
OWNERS = {"Math": "Math", "Number": "Number", "Object": "Object", "gl": "globalThis.WebGL2RenderingContext??{}"}
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
    `declared` the words that are declared, and `top` those among them that may be at the top level."""

    def __init__(self, pieces):
        self.pieces = [(i, kind, text) for i, (kind, text) in enumerate(pieces) if kind != "space"]
        self.names, self.short, self.declared, self.top = collections.defaultdict(list), set(), set(), set()
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
        named = last in ("function", "class") or (last == "*" and self.text(k - 2) == "function")
        method = after == "(" and self.text(self.closing[k + 1] + 1) == "{" and not named
        if last in ACCESS or around == "class" or method or (entry and after == ":"):
            return
        if entry and after in (",", "}", "="):
            self.short.add(i)
        if self.declares(k) or named or after == "=>":
            self.declared.add(text)
            if not self.open or self.let[:1] == [0]:
                self.top.add(text)
        self.names[text].append(i)


def parts_of(pieces):
    """Of each piece the number of the part it is in: a part is a function, a class or another statement at the top level."""
    out, depth, part, last = [], 0, 0, ";"
    for i, (kind, text) in enumerate(pieces):
        if depth == 0 and ((kind == "word" and last in (";", "}") and text in ("function", "class", "async", "let", "const")) or last == ";"):
            part += 1
        out.append(part)
        if kind == "text":
            depth += text.endswith("${") - (text[0] == "}")
        elif kind == "sign":
            depth += (text in "([{") - (text in ")]}")
        if kind != "space":
            last = text
    return out


def groups(parts):
    """The numbers of the pieces of each part."""
    return [[i for i, _part in group] for _number, group in itertools.groupby(enumerate(parts), key=lambda pair: pair[1])]


def fresh_names(taken, least):
    return (name for size in itertools.count(least) for name in map("".join, itertools.product(FIRST, repeat=size)) if name not in taken and name not in KNOWN)


class Renaming:
    """Words of some pieces that become others; places: word to the numbers of its pieces."""

    def __init__(self, texts, short, places):
        self.texts, self.short, self.places = texts, short, places
        self.new = {}

    def gain(self, word, length):
        """Characters that a name of this length saves: a shorthand needs its key besides."""
        return sum(len(word) - length - (len(word) + 1 if i in self.short else 0) for i in self.places[word])

    def choose(self, words, names, length):
        """Gives other names to the words for which that pays, to the most frequent first."""
        for word in sorted(words, key=lambda word: (-len(self.places[word]), word)):
            if self.gain(word, length) > 0 or (length == len(word) == 1 and self.gain(word, 1) == 0):
                self.new[word] = next(names)

    def apply(self):
        for word, new in self.new.items():
            for i in self.places[word]:
                self.texts[i] = f"{word}:{new}" if i in self.short else new


def plain_words(code, used):
    """A script with `!0`, `!1` and `1/0` for true, false and Infinity, and names of its own (Math_max) for those functions and numbers in `used`, as ("Math", "max")."""
    pieces = [[kind, text] for kind, text in tokens(code)]
    for i, (kind, text) in enumerate(pieces):
        last, after = pieces[i - 1][1] if i else ";", pieces[i + 1][1] if i + 1 < len(pieces) else ";"
        if kind != "word" or last in ACCESS:
            continue
        if text in ("true", "false") and after not in (":", "(", "="):
            pieces[i][1] = "!0" if text == "true" else "!1"
            if last == " " and i > 1:
                pieces[i - 1][1] = ""
        elif text == "Infinity" and last not in ("*", "/", "%") and after not in (":", "(", "=", "*", "/", "%", "."):
            pieces[i][1] = "1/0"
        elif after == "." and (text, pieces[i + 2][1]) in used:
            pieces[i][1], pieces[i + 1][1], pieces[i + 2][1] = f"{text}_{pieces[i + 2][1]}", "", ""
    return "".join(text for _kind, text in pieces)


def often_used(code, owner):
    """Functions and numbers of Math, say, that a script names so often that names of its own for them make it shorter."""
    counts = collections.Counter(re.findall(rf"\b{owner}\.({'[A-Z][A-Z0-9_]+' if owner == 'gl' else '[A-Za-z]+'})\b", code))
    gains = {name: (len(owner) + len(name) - 1) * count - len(name) - 4 for name, count in counts.items()}
    used = sorted(name for name, gain in gains.items() if gain > 0)
    return [(owner, name) for name in used] if sum(gains[name] for name in used) > len(f"let{{}}={OWNERS[owner]};") else []


def short_in_programs(code):
    """A script with other names for what its programs for the picture call u_..., v_..., a_... and o_...: such names have a number, which none of the script's has."""
    counts = collections.Counter(re.findall(r"\b[uvao]_[a-z]\w*", code))
    new = {word: f"_{number}" for number, (word, _count) in enumerate(sorted(counts.items(), key=lambda item: (-item[1], item[0])))}
    if re.search(r"\b_\d", code):
        return code
    return re.sub(r"\b[uvao]_[a-z]\w*", lambda match: new[match.group(0)], code)


def shortened(code, modules, given):
    """The script with shorter names. `modules` are its modules as they were, and `given` the names at their top level. These become other names of two
    letters or more, the same ones everywhere. Those that are declared within a function or class at the top level become others in it."""
    lists = {owner: often_used(code, owner) for owner in OWNERS}
    used = {pair for pairs in lists.values() for pair in pairs}
    code, modules = plain_words(code, used), [plain_words(module, used) for module in modules]
    for owner, pairs in lists.items():
        if pairs:
            code = f"let{{{','.join(f'{name}:{owner}_{name}' for _owner, name in pairs)}}}={OWNERS[owner]};{code}"
    given = {*given, *(f"{owner}_{name}" for owner, name in used)}
    pieces = tokens(code)
    uses, parts = Uses(pieces), parts_of(pieces)
    top, own = (set(given) | uses.top) & uses.declared, uses.declared - KNOWN
    inside = [(list(group), Uses([pieces[i] for i in group])) for group in groups(parts)]
    for module in modules:
        of = Uses(tokens(module))
        own -= set(of.names) - of.declared - set(given)
    for _group, of in inside:
        own -= set(of.names) - of.declared - top
    texts = [text for _kind, text in pieces]
    whole = Renaming(texts, uses.short, uses.names)
    whole.choose(own & top, fresh_names(uses.names, 2), 2)
    for group, of in inside:
        local = (own - top) & set(of.names)
        part = Renaming(texts, uses.short, {word: [group[i] for i in of.names[word]] for word in local})
        kept = {word for word in local if part.gain(word, 1) <= 0 and (len(word) > 1 or part.gain(word, 1) < 0)}
        taken = {whole.new.get(word, word) for word in set(of.names) - local} | kept
        part.choose(local - kept, fresh_names(taken, 1), 1)
        part.apply()
    whole.apply()
    return short_in_programs("".join(texts))

"""One-token mutants of C++ sources: where they may stand and what they put there.

Not mutated: comments, strings, preprocessor lines, declarations' angle brackets and ampersands, what stands in the call
of a message (MESSAGES), and statements that delete or rename files or start programs (DANGEROUS): the tests run as the
user who started them.
"""
import dataclasses
import re

TOKEN = re.compile(r"""
  (?P<comment>//[^\n]*|/\*.*?\*/)
| (?P<include>^[ \t]*\#(?:\\\n|[^\n])*)
| (?P<raw>R"(?P<end>[^()\\\s]*)\(.*?\)(?P=end)")
| (?P<string>"(?:\\.|[^"\\\n])*")
| (?P<number>(?:0x[\da-f']+|(?:\d[\d']*\.?\d*|\.\d+)(?:e[+-]?\d+)?)[ful]*)
| (?P<char>'(?:\\.|[^'\\\n])*')
| (?P<word>[a-z_]\w*)
| (?P<operator><=>|<<=|>>=|->\*|\.\.\.|::|->|\+\+|--|<<|>>|<=|>=|==|!=|&&|\|\||[-+*/%&|^]=|[-+*/%<>=!&|^~?:;,.(){}\[\]])
| (?P<space>\s+)
""", re.X | re.S | re.M | re.I)

SPACED = {  # binary operators, which clang-format sets between spaces
    "<": ("<=", ">="), ">": (">=", "<="), "<=": ("<", ">"), ">=": (">", "<"), "==": ("!=",), "!=": ("==",),
    "&&": ("||",), "||": ("&&",), "+": ("-",), "-": ("+",), "*": ("/",), "/": ("*",), "%": ("*",),
    "+=": ("-=",), "-=": ("+=",), "*=": ("/=",), "/=": ("*=",)}
STEPS = {"++": ("--",), "--": ("++",)}
WORDS = {"true": ("false",), "false": ("true",), "break": ("continue",), "continue": ("break",)}
EXTREMES = {"min": ("max",), "max": ("min",)}
MESSAGES = {"format", "format_to", "print", "println", "fault", "refuse", "warn", "InputError", "RunError", "static_assert",
            "NotConverged", "runtime_error", "logic_error"}
DANGEROUS = {"remove", "remove_all", "rename", "unlink", "kill", "system", "execvp", "fork"}
NO_STATEMENT = {"if", "for", "while", "do", "else", "switch", "case", "default", "return", "const", "auto", "static", "constexpr",
                "using", "namespace", "template", "struct", "class", "enum", "throw", "try", "catch", "public", "private",
                "explicit", "virtual", "inline", "extern", "typedef", "break", "continue", "goto", "int", "double", "bool",
                "void", "char", "unsigned", "long", "delete", "new", "co_return", "friend", "operator", "mutable"}


@dataclasses.dataclass(frozen=True)
class Token:
    kind: str
    text: str
    start: int

    @property
    def end(self):
        return self.start + len(self.text)


@dataclasses.dataclass(frozen=True)
class Mutant:
    start: int  # offsets in the file
    end: int
    put: str
    what: str  # kind of the change

    def of(self, text):
        return text[:self.start] + self.put + text[self.end:]


def tokens_of(text):
    at, tokens = 0, []
    while at < len(text):
        found = TOKEN.match(text, at)
        if not found:  # a character of no token: by itself
            at += 1
            continue
        kind = next(name for name, value in found.groupdict().items() if value is not None and name != "end")
        tokens.append(Token(kind, found.group(), at))
        at = found.end()
    return tokens


def closing(tokens, at):
    """The index of the token that closes the bracket at `at`; None: it is not closed."""
    pairs, depth = {"(": ")", "[": "]", "{": "}"}, []
    for i in range(at, len(tokens)):
        if tokens[i].kind != "operator":
            continue
        if tokens[i].text in pairs:
            depth.append(pairs[tokens[i].text])
        elif depth and tokens[i].text == depth[-1]:
            depth.pop()
            if not depth:
                return i
    return None


def spared(tokens):
    """Indices of the tokens inside messages' calls, and in statements with a dangerous call."""
    inside = set()
    for i, token in enumerate(tokens[:-1]):
        if token.kind != "word" or tokens[i + 1].text != "(":
            continue
        if token.text in MESSAGES:
            inside.update(range(i, (closing(tokens, i + 1) or i) + 1))
        if token.text in DANGEROUS:
            begin, end = i, i
            while begin > 0 and tokens[begin - 1].text not in (";", "{", "}"):
                begin -= 1
            while end < len(tokens) - 1 and tokens[end].text not in (";", "}"):
                end += 1
            inside.update(range(begin, end + 1))
    return inside


def of_type(text, tokens, i):
    """Whether the number at token i is a template's argument or the length of an array that is declared."""
    begin, end = text.rfind("\n", 0, tokens[i].start) + 1, text.find("\n", tokens[i].end)
    if re.search(r"\w<[\w:\s,]*$", text[begin:tokens[i].start]) and re.match(r"[\w:\s,]*>", text[tokens[i].end:end]):
        return True
    around = [t.text for t in tokens[i - 1:i + 2:2]]
    return (around == ["[", "]"] and i > 2 and tokens[i - 2].kind == tokens[i - 3].kind == "word"
            and tokens[i - 3].text not in ("return", "case", "throw"))


def overwritten(text, mutant):
    """Whether it changes the initial value of a variable that a getter of MPI or PETSc sets before it is used."""
    name = re.search(r"(\w+) = $", text[:mutant.start])
    if mutant.what != "constant" or not name or text[mutant.end] not in ",;":
        return False
    use = re.compile(rf"\b{name[1]}\b").search(text, mutant.end)
    call = text[text.rfind(";", 0, use.start()) + 1:use.start()] if use else ""
    return re.match(r"\s*(check\(|PetscCall(MPI)?\()?\b(MPI_Comm_(rank|size)|[A-Z]\w*Get[A-Z]\w*|PetscObjectTypeCompare\w*)\([^;()]*(\([^;()]*\)[^;()]*)*&$", call) is not None


def blank(text):
    return re.sub(r"[^\n]", " ", text)


def whole_number(text):
    if not re.fullmatch(r"\d+", text):
        return {"0.": ("1.",), "0.0": ("1.",), "1.": ("0.",), "1.0": ("0.",)}.get(text, ())
    value = int(text)
    return ("1",) if value == 0 else ("0", "2") if value == 1 else (str(value - 1), str(value + 1))


def condition(text, tokens, i):
    """`if (c)` -> `if (!(c))`."""
    end = closing(tokens, i + 1)
    if end is None:
        return None
    inner = tokens[i + 2:end]
    if not inner or any(t.text in (";", "auto", "const") for t in inner):
        return None
    start, stop = inner[0].start, inner[-1].end
    return Mutant(start, stop, f"!({text[start:stop]})", "negated condition")


def dropped(text, tokens, i):
    """An expression's statement that begins at token i, left out; the lines stay as many."""
    first = tokens[i]
    if first.kind != "word" or first.text in NO_STATEMENT or i + 1 == len(tokens):
        return None
    depth = 0
    for j in range(i, len(tokens)):
        word = tokens[j].text if tokens[j].kind == "operator" else ""
        if word in ("(", "[", "{"):
            depth += 1
        if word in (")", "]", "}"):
            depth -= 1
        if depth < 0 or (word == "{" and depth == 1 and tokens[j - 1].text == ")"):  # a function's body, or no statement
            return None
        if word == ";" and depth == 0:
            head = [t for t in tokens[i:j]]
            after = 1  # a name: a, a.b, a->b, a::b
            while after + 1 < len(head) and head[after].text in (".", "->", "::") and head[after + 1].kind == "word":
                after += 2
            if after == len(head) or head[after].text not in ("(", "[", "=", "+=", "-=", "*=", "/=", "++", "--", "<<", "."):
                return None
            start, stop = first.start, tokens[j - 1].end
            return Mutant(start, stop, blank(text[start:stop]), "dropped statement")
    return None


def mutants_of(text):
    """Places of a source, each with the mutants that may be put there: a list of lists."""
    everything = tokens_of(text)
    tokens = [t for t in everything if t.kind not in ("space", "comment", "include")]
    skip = spared(tokens)
    places = []
    for i, token in enumerate(tokens):
        if i in skip:
            continue
        before = tokens[i - 1] if i else None
        after = tokens[i + 1] if i + 1 < len(tokens) else None
        spaced = text[token.start - 1:token.start].isspace() and text[token.end:token.end + 1].isspace()
        choices = []
        if token.kind == "operator" and after and before:
            beside_text = "string" in (before.kind, after.kind)
            if token.text in SPACED and spaced and not beside_text:
                choices = [Mutant(token.start, token.end, put, "operator") for put in SPACED[token.text]]
            elif token.text in STEPS:
                choices = [Mutant(token.start, token.end, put, "step") for put in STEPS[token.text]]
            elif token.text == "!" and after.text != "=":
                choices = [Mutant(token.start, token.end, "", "dropped !")]
            elif token.text == "-" and not text[token.end:token.end + 1].isspace() and (
                    before.text == "return" or before.kind == "operator" and before.text not in (")", "]")):
                choices = [Mutant(token.start, token.end, "", "sign")]
        elif token.kind == "number" and not of_type(text, tokens, i):
            choices = [Mutant(token.start, token.end, put, "constant") for put in whole_number(token.text)]
        elif token.kind == "word" and token.text in WORDS:
            choices = [Mutant(token.start, token.end, put, "word") for put in WORDS[token.text]]
        elif token.kind == "word" and token.text in EXTREMES and before and before.text == "::" and after and after.text == "(":
            choices = [Mutant(token.start, token.end, put, "min and max") for put in EXTREMES[token.text]]
        elif token.kind == "word" and token.text == "if" and after and after.text == "(":
            choices = [condition(text, tokens, i)]
        if before is None or before.text in (";", "{", "}", ")", "else"):
            choices = choices + [dropped(text, tokens, i)]
        choices = [c for c in choices if c]
        if choices:
            places.append(choices)
    return places

"""Bad input: random bytes, valid examples with something wrong, values of the wrong shape."""

import copy
import math
import re

from hypothesis import strategies as st

_WORDS = re.compile(r"\w+|\s+|.", re.DOTALL)
NASTY_WORDS = (
    "", " ", "\n", "\t", "\0", "\x1b[31m", "\r", "\x85", "\u2028", "\ud800", "\U0010ffff",
    "\ufeff", "é", "nan", ".nan", "inf", ".inf", "-.inf", "NaN", "-Infinity", "1e999", "-1", "0",
    "1e-320", "-0.0", "9" * 400, "9" * 5000, "0x" + "f" * 5000, "0b2", "1_000", "1:60",
    "2020-13-45", "true", "null", "~", "{", "}", "[", "]", "(", ")", "<", ">", "::=", "|", ":",
    ",", '"', "'", "\\", "#", "- ", "? ", "&a", "*a", "<<", "!!int", "!!float ''",
    "!!timestamp x", "!!python/object:os.system", "!!binary", "%YAML 9.9", "---", "...",
    '"\\ud800"', '"\\UFFFFFFFF"', "[" * 3000, '"' + '\\"' * 3000, "x" * 20_000, "rule", "if",
    "while", "do", "and", "or", "name", "origin", "off", "p = 2,", "extends", "../../x", "<a>",
    "<s> ::=", "GE_RANGE:3", "ON_NEST == maybe", "__class__", "</script>", "[/red]", "{0}",
    "<1st>", "<ü>", "<a b>", "'\\n'", "'\\d'", '"\\""', "# c\n", '"rules": 1,', "\r\n",
)  # fmt: skip

PYTHON_WORDS = (
    "", " ", "\n", "    ", "\0", "(", ")", ":", ",", ".", "@", "...", "=", "*", "**", "-", "//",
    "%", "<", "if d2:", "return", "raise SystemExit", "raise ValueError('x')", "1 / 0", "None",
    "True", "nan", "float('nan')", "-1", "0", "1.5", "9" * 400, "10**400", "import os",
    "import nowhere", "lambda: 0", "yield", "async ", "global d2", "def", "class A: pass",
    "assert", "del d2", "print(d2)", "I(", "F(", "I", "F", "d2", "dx", "beside", "rab_range",
    "nowhere", "k", "pace", "step", "elbow_room", "values=1", "values=0", "values=-1",
    "values=10**9", "values='x'", "Whole('k', 5, 1)", "Whole('k', 1, 9**9)",
    "Number('pace', 0, 0, 0)", "Number('pace', 1, 0, 0.1)", "Choice('c', ())", "sensor", "percept",
    "behaviour", "measure", "count", "total", "vector_sum", "crowd", "approach", "alone",
    '"PACKED"', '"STOP"', '"crowded"', '""', '"\\ud800"', "unit=1", "at='never'", "kind=str",
    "holds='{nowhere}'", "holds='{'", "truth=None", "truth=lambda *x: 1 / 0", "[]", "{}", '"' * 3,
    "#", "\\", "\t", "é", "\ufeff",
)  # fmt: skip

NASTY_VALUES = (
    None, True, False, -1, 0, 1, 10**400, 2**31, 2**63, -(2**63), 0.5, -0.5, 1e308, 1e-320,
    math.nan, math.inf, -math.inf, "", "\ud800", "\0", "</script>", "x" * 20_000, "9" * 400, [],
    {}, [[]], [None], {"": {}}, [1, 2], {"name": "x"}, "rule do p = 1, PHOTOTAXIS",
)  # fmt: skip


def random_bytes(rng):
    """Anything at all, printable or not, of any length up to a few hundred."""
    length = rng.choice((0, 1, 2, 10, 100, 500))
    if rng.random() < 0.3:
        return "".join(rng.choices(NASTY_WORDS, k=length // 20 + 1)).encode("utf-8", "replace")
    return rng.randbytes(length)


def random_text(rng):
    """Text of random code points, surrogates and control characters included."""
    top = rng.choice((0x7F, 0x7F, 0xFF, 0x2FFF, 0x10FFFF))
    return "".join(chr(rng.randint(0, top)) for _ in range(rng.choice((0, 1, 5, 50, 500))))


def mutated_text(rng, examples, nasty=NASTY_WORDS):
    """A valid example with a few words taken out, put in, moved or exchanged."""
    words = _WORDS.findall(rng.choice(examples))
    for _ in range(rng.choice((1, 1, 2, 3, 8))):
        at, to = (rng.randrange(len(words) + 1) for _ in range(2))
        change = rng.randrange(6)
        if change == 0:
            words[at:at] = [rng.choice(nasty)]
        elif change == 1:
            words[at : at + 1] = [rng.choice(nasty)]
        elif change == 2:
            del words[min(at, to) : min(max(at, to), min(at, to) + 5)]
        elif change == 3:
            words[to:to] = words[at : at + rng.randint(1, 20)]
        elif change == 4:
            words = words[:at] + _WORDS.findall(rng.choice(examples))[to:]
        else:
            words[at:at] = [rng.choice(words or [" "])] * rng.choice((2, 50, 500))
    return "".join(words)


def mutated_bytes(rng, example):
    """Bytes of a file with bits turned, a stretch overwritten, cut out or doubled, or cut off."""
    data = bytearray(example)
    for _ in range(rng.choice((1, 1, 3, 20))):
        if not data:
            break
        at, length = rng.randrange(len(data)), rng.choice((1, 2, 100, 4096))
        change = rng.randrange(6)
        if change <= 1:
            data[at] ^= 1 << rng.randrange(8)
        elif change == 2:
            data[at : at + length] = rng.randbytes(length)
        elif change == 3:
            del data[at : at + length]
        elif change == 4:
            data[at:at] = data[at : at + length]
        else:
            del data[at:]
    return bytes(data)


ENCODINGS = ("utf-8", "utf-8-sig", "utf-16", "utf-16-be", "utf-32", "latin-1", "cp1252")


def saved_text(rng, text):
    """A text as an editor saves it, now and then with something wrong in its bytes."""
    text = text.replace("\n", rng.choice(("\n", "\r\n", "\r")))
    data = text.encode(rng.choice(ENCODINGS), "replace")
    return data if rng.random() < 0.7 else mutated_bytes(rng, data)


def mutated_value(rng, value):
    """A JSON value with a few of its parts replaced, removed, doubled or wrapped."""
    value = copy.deepcopy(value)
    for _ in range(rng.choice((1, 1, 2, 5))):
        places = list(_places(value))
        if not places:
            return _nasty(rng)
        inside, key = rng.choice(places)
        change = rng.randrange(6)
        if change <= 2:
            inside[key] = _nasty(rng)
        elif change == 3:
            del inside[key]
        elif change == 4:
            inside[key] = [inside[key], _nasty(rng)]
        elif isinstance(inside, list):
            inside[key:key] = [inside[key]] * rng.choice((1, 3, 300))
        else:
            inside[rng.choice(NASTY_WORDS)] = inside[key]
    return value


def _nasty(rng):
    return copy.deepcopy(rng.choice(NASTY_VALUES))  # it may be changed next


def _places(value):
    """(container, key) of every part of a JSON value."""
    if isinstance(value, dict | list):
        for key in list(value) if isinstance(value, dict) else range(len(value)):
            yield value, key
            yield from _places(value[key])


json_values = st.recursive(
    st.sampled_from(NASTY_VALUES) | st.text(max_size=8) | st.floats() | st.integers(),
    lambda inner: (
        st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=8), inner, max_size=4)
    ),
    max_leaves=12,
)


def json_objects(keys):
    """Objects with known keys and values of any shape."""
    return st.dictionaries(st.sampled_from(list(keys)), json_values, max_size=8)

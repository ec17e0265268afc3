# SPDX-License-Identifier: GPL-3.0-or-later
"""Random damage to the bytes of a file: cut, flipped, repeated, swapped, with numbers of all sizes."""

import re
from collections.abc import Callable
from random import Random

NUMBER = re.compile(rb"-?\d+(?:\.\d*)?(?:[eE][-+]?\d+)?")
# numbers as text: of other kinds, signs and sizes than what is there
TEXT_NUMBERS = (
    *(b"0", b"-1", b"1", b"0.5", b"-0.0", b"1e-320", b"1e308", b"-1e308", b"1e999", b"nan", b"inf"),
    *(b"2147483647", b"-2147483649", b"9223372036854775807", b"18446744073709551616", b"1" + b"0" * 30),
    *(b"9" * 400, b"0700", b"1:30", b"1_000", b"0x10", b"null", b'"a"', b"[]", b"{}", b"", b"1e5", b"123456"),
)
# numbers of a binary header: least, largest and odd ones, and doubles that are no number
BINARY_NUMBERS = tuple(
    [value.to_bytes(size, "little", signed=True) for size in (2, 4, 8) for value in (0, 1, -1)]
    + [(2 ** (8 * size - 1) - 1).to_bytes(size, "little") for size in (2, 4, 8)]
    + [(2**bits).to_bytes(8, "little") for bits in (20, 31, 33, 40, 62)]
    + [bytes.fromhex(double) for double in ("000000000000f87f", "000000000000f07f", "c9fc11de7e9ae37f")]
)
LONGEST_BLOCK = 64
MOST_CHANGES = 3


def mutated(content: bytes, random: Random) -> bytes:
    """The content with one to three random changes."""
    for _ in range(random.randint(1, MOST_CHANGES)):
        content = random.choice(CHANGES)(content, random)
    return content


def _block(content: bytes, random: Random) -> slice:
    """A short stretch, near the start, where headers are, as often as anywhere."""
    end = min(len(content), 128) if random.random() < 0.5 else len(content)
    start = random.randint(0, end)
    return slice(start, start + random.randint(1, LONGEST_BLOCK))


def _cut_off(content: bytes, random: Random) -> bytes:
    return content[: random.randint(0, len(content))]


def _flip(content: bytes, random: Random) -> bytes:
    changed = bytearray(content)
    for _ in range(random.randint(1, 4) if content else 0):
        changed[random.randrange(len(changed))] ^= 1 << random.randrange(8)
    return bytes(changed)


def _remove(content: bytes, random: Random) -> bytes:
    block = _block(content, random)
    return content[: block.start] + content[block.stop :]


def _repeat(content: bytes, random: Random) -> bytes:
    block = _block(content, random)
    return content[: block.stop] + content[block] * random.choice((1, 1, 2, 50)) + content[block.stop :]


def _swap(content: bytes, random: Random) -> bytes:
    first, second = sorted((_block(content, random) for _ in range(2)), key=lambda block: block.start)
    stop = min(first.stop, second.start)
    middle = content[stop : second.start]
    return (
        content[: first.start]
        + content[second]
        + middle
        + content[first.start : stop]
        + content[second.stop :]
    )


def _noise(content: bytes, random: Random) -> bytes:
    block = _block(content, random)
    return content[: block.start] + random.randbytes(random.randint(1, 8)) + content[block.stop :]


def _text_number(content: bytes, random: Random) -> bytes:
    """Another number in the place of a number that is there as text."""
    numbers = list(NUMBER.finditer(content, _block(content, random).start))[:20]
    if not numbers:
        return content
    place = random.choice(numbers)
    return content[: place.start()] + random.choice(TEXT_NUMBERS) + content[place.end() :]


def _binary_number(content: bytes, random: Random) -> bytes:
    number = random.choice(BINARY_NUMBERS)
    start = _block(content, random).start // 4 * 4
    return content[:start] + number + content[start + len(number) :]


def _swap_words(content: bytes, random: Random) -> bytes:
    """Two words change places, or one takes the place of the other too."""
    words = list(re.finditer(rb"\w+", content))
    if len(words) < 2:
        return content
    first, second = sorted(random.sample(words, 2), key=lambda word: word.start())
    last = first if random.random() < 0.5 else second
    return (
        content[: first.start()]
        + second[0]
        + content[first.end() : second.start()]
        + last[0]
        + content[second.end() :]
    )


CHANGES: tuple[Callable[[bytes, Random], bytes], ...] = (
    *(_cut_off, _flip, _remove, _repeat, _swap, _noise),
    *(_text_number, _text_number, _binary_number, _binary_number, _swap_words),
)

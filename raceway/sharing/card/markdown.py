"""Text of strangers without Markdown."""


def plain_text(text: object) -> str:
    """Text from a stranger as one line without Markdown: no tag, link, picture, code or table cell.

    >>> plain_text("a|b <script> [x](http://y)  `z` ")
    "a/b (script) [x] (http://y) 'z'"
    """
    shown = " ".join(str(text).translate(_HARMLESS).split())
    shown = "".join(letter if letter.isprintable() else "?" for letter in shown)
    for link in ("](", "][", "]:"):
        shown = shown.replace(link, f"] {link[1]}")
    return shown


def code_text(text: object) -> str:
    """Text from a stranger as one line of a code block, which ends at the first line of back ticks.

    >>> code_text("fault == 'inner' and load < 5 ```")
    "fault == 'inner' and load < 5 '''"
    """
    shown = " ".join(str(text).replace("`", "'").split())
    return "".join(letter if letter.isprintable() else "?" for letter in shown)


_HARMLESS = str.maketrans({"|": "/", "<": "(", ">": ")", "`": "'", "\\": "/"})

"""The guide as the dashboard serves it."""

import re
from html.parser import HTMLParser

import pytest

from geswarm.app.server.gate import static_folder, static_response
from geswarm.app.server.guide import guide_page

FOLDER = static_folder() / "guide"
NAMES = sorted(page.stem for page in FOLDER.glob("*.md"))
VOID = {"meta", "link", "br", "img"}


class Tree(HTMLParser):
    """Collects elements and text, and that all elements are closed."""

    def __init__(self):
        super().__init__()
        self.open, self.found, self.text = [], [], ""

    def handle_starttag(self, tag, attrs):
        self.found.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.text += data


def read(page):
    tree = Tree()
    tree.feed(page)
    assert tree.open == []
    return tree


@pytest.mark.parametrize("name", NAMES)
def test_pages_show_all_that_is_written(name):
    written = (FOLDER / f"{name}.md").read_text(encoding="utf-8")
    tree = read(guide_page(FOLDER, name))
    tables = len(re.findall(r"^\| ---", written, re.MULTILINE))
    assert [tag for tag, _ in tree.found].count("table") == tables
    pictures = re.findall(r"!\[[^]]+\]\(([^)]+)\)", written)
    assert [attrs["src"] for tag, attrs in tree.found if tag == "img"] == pictures
    for picture in pictures:
        assert static_response(FOLDER, f"/guide/{picture}", "localhost").status_code == 200
    plain = re.sub(r"!\[[^]]+\]\([^)]+\)", "", written)
    plain = re.sub(r"\[([^]]+)\]\([^)]+\)", r"\1", plain).replace("\\|", "|")
    for word in re.findall(r"[\w.()-]{3,}", plain.replace("<br>", " ")):
        if not set(word) <= {"-"}:
            assert word in tree.text, word
    assert "`" not in tree.text
    for attrs in (attrs for tag, attrs in tree.found if tag == "a"):
        assert guide_page(FOLDER, attrs["href"].removesuffix(".html"))


def test_code_keeps_its_empty_lines():
    page = guide_page(FOLDER, "own-terms")
    (code,) = re.findall(r"<pre>(.*?)</pre>", page, re.DOTALL)
    assert "\n\n@condition\ndef is_due" in code


def test_what_is_written_cannot_become_elements(tmp_path):
    text = "# <b>\n\n| `<i>` | & |\n| --- | --- |\n| <a href=x> | `a` |\n\n    <script>\n"
    (tmp_path / "terms.md").write_text(text)
    tree = read(guide_page(tmp_path, "terms"))
    assert not {"i", "script"} & {tag for tag, attrs in tree.found if attrs == {}}
    for word in ("<b>", "<i>", "<a href=x>", "<script>"):
        assert word in tree.text


@pytest.mark.parametrize(
    ("path", "status"),
    [
        *((f"/guide/{name}.html", 200) for name in NAMES),
        ("/guide/guide.css", 200),
        ("/guide/terms.md", 404),
        ("/guide/__init__.py", 404),
        ("/guide/../rules/rules.html", 404),
        ("/guide/.html", 404),
    ],
)
def test_only_the_guide_is_served(path, status):
    answer = static_response(FOLDER, path, "localhost:1")
    assert answer.status_code == status
    if path.endswith(".html") and status == 200:
        assert answer.headers["Content-Type"] == "text/html; charset=utf-8"
        assert "unsafe" not in answer.headers["Content-Security-Policy"]

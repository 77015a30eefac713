# SPDX-License-Identifier: BSD-3-Clause
"""The finished site asks no network and leads nowhere that is not there. Standard library only.

    check_site.py FOLDER       every page: what it loads is on the site, links and their anchors resolve
    check_site.py --controls   small sites with one fault each, every one of which must be found

Links that a reader may follow to other sites are none of these.
"""
import html.parser
import pathlib
import re
import sys
import tempfile
import urllib.parse

LOADS = {("script", "src"), ("img", "src"), ("iframe", "src"), ("source", "src"), ("link", "href"), ("object", "data"),
         ("video", "src"), ("audio", "src"), ("embed", "src"), ("img", "srcset"), ("source", "srcset"), ("div", "data-page")}
PASSIVE = {"canonical", "next", "prev", "index", "search", "author", "license"}   # links that no browser loads


class Page(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.loads, self.links, self.anchors, self.styles = [], [], set(), []
        self.in_style = False
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.anchors |= {values[name] for name in ("id", "name") if values.get(name)}
        self.in_style = tag == "style"
        for name, value in attributes:
            if not value:
                continue
            if (tag, name) in LOADS and not (tag == "link" and values.get("rel") in PASSIVE):
                self.loads.append(value.split()[0] if name == "srcset" else value)
            if tag == "a" and name == "href":
                self.links.append(value)
            if name == "style":
                self.styles.append(value)

    def handle_data(self, data):
        if self.in_style:
            self.styles.append(data)


def from_styles(text):
    for _, url in re.findall(r"url\(\s*(['\"]?)(.*?)\1\s*\)", text):
        yield url
    yield from re.findall(r"@import\s+['\"]([^'\"]+)", text)


def is_foreign(url):
    return re.match(r"(?i)[a-z][a-z0-9+.-]*:|//", url) is not None and not url.startswith(("data:", "mailto:"))


def faults_of(root):
    pages = {path: Page(path.read_text(encoding="utf-8", errors="replace")) for path in sorted(root.rglob("*.html"))}
    if not pages:
        yield f"{root}: no pages"
    for path, page in pages.items():
        where = path.relative_to(root)
        loads = [*page.loads, *(url for style in page.styles for url in from_styles(style))]
        for url in loads:
            if is_foreign(url):
                yield f"{where}: loads {url}"
        if "_reports" in where.parts:
            continue   # pages of their own, which have tests of their own
        for url in [*loads, *page.links]:
            if is_foreign(url) or url.startswith(("data:", "mailto:", "javascript:")):
                continue
            target, _, anchor = url.partition("#")
            target = urllib.parse.unquote(target.partition("?")[0])
            file = (path.parent / target).resolve() if target else path
            if file.is_dir():
                file /= "index.html"
            if not file.is_file():
                yield f"{where}: no {url}"
            elif anchor and file in pages and urllib.parse.unquote(anchor) not in pages[file].anchors:
                yield f"{where}: no anchor {url}"
    for path in sorted(root.rglob("*.css")):
        for url in from_styles(path.read_text(encoding="utf-8", errors="replace")):
            if is_foreign(url):
                yield f"{path.relative_to(root)}: loads {url}"
            elif not url.startswith(("data:", "#")) and not (path.parent / url.split("?")[0].split("#")[0]).is_file():
                yield f"{path.relative_to(root)}: no {url}"


GOOD = {"index.html": '<a id="x" href="b.html#y">b</a> <a href="https://example.org">o</a><img src="i.svg"><style>a{}</style>',
        "b.html": '<p id="y"><a href="index.html#x">i</a></p><link rel="stylesheet" href="s.css">', "i.svg": "",
        "s.css": "a { background: url(i.svg) } @import 'i.svg';"}
CONTROLS = [{"b.html": '<script src="https://cdn.example.org/a.js"></script>'}, {"b.html": '<p id="y"><img src="//example.org/a.png">'},
            {"b.html": '<p id="y"><img src="gone.png">'}, {"b.html": "<p>no anchor</p>"}, {"s.css": "a { background: url('http://example.org') }"},
            {"s.css": "@import url(https://example.org/x.css);"}, {"index.html": '<a id="x" href="gone.html">g</a>'},
            {"index.html": '<style>@font-face { src: url(https://example.org/f.woff2) }</style><a id="x">'},
            {"index.html": '<a id="x"></a><iframe src="https://example.org"></iframe>'},
            {"index.html": '<a id="x"></a><link rel="preconnect" href="https://example.org">'}]


def faults_of_files(files):
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            pathlib.Path(folder, name).write_text(text, encoding="utf-8")
        return list(faults_of(pathlib.Path(folder).resolve()))


def main():
    if sys.argv[1:] == ["--controls"]:
        missed = [control for control in CONTROLS if not faults_of_files({**GOOD, **control})]
        wrong = faults_of_files(GOOD)
        print("\n".join([*(f"not found: {control}" for control in missed), *wrong]) or f"all {len(CONTROLS)} faults were found")
        return 1 if missed or wrong else 0
    root = pathlib.Path(sys.argv[1]).resolve()
    faults = list(faults_of(root))
    print("\n".join(faults) or f"{len(list(root.rglob('*.html')))} pages: all they load and lead to is there")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())

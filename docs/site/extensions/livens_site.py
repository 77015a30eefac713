# SPDX-License-Identifier: BSD-3-Clause
"""What Sphinx is taught: formulas become HTML while the pages are built, by KaTeX, whose style and fonts are copied to the
site; docstrings of livens; one sidebar for all pages of codes."""
import json
import os
import pathlib
import re
import shutil
import subprocess

HERE = pathlib.Path(__file__).resolve().parents[1]
SCRIPT = """
import katex from "katex";
import { createInterface } from "node:readline";
for await (const line of createInterface({ input: process.stdin })) {
  const { text, display } = JSON.parse(line);
  let answer;
  try { answer = { html: katex.renderToString(text, { displayMode: display, strict: "error" }) }; }
  catch (error) { answer = { error: String(error.message) }; }
  console.log(JSON.stringify(answer));
}
"""


class Katex:
    def __init__(self):
        self.process, self.owner = None, 0

    def html(self, text, display):
        if self.owner != os.getpid():   # Sphinx writes in several processes, each of which has a pipe of its own
            self.owner = os.getpid()
            self.process = subprocess.Popen(["node", "--input-type=module", "-e", SCRIPT], cwd=HERE, text=True,
                                            stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.process.stdin.write(json.dumps({"text": text, "display": display}) + "\n")
        self.process.stdin.flush()
        answer = json.loads(self.process.stdout.readline())
        if "error" in answer:
            raise ValueError(f"formula {text!r}: {answer['error']}")
        return answer["html"]


katex = Katex()


def inline(self, node):
    import docutils.nodes
    html = katex.html(node.astext(), False)
    tail = node.get("tail", "")
    self.body.append(f'<span class="kept">{html}{tail}</span>' if tail else html)
    raise docutils.nodes.SkipNode


def block(self, node):
    import docutils.nodes
    self.body.append(f'<div class="formula">{katex.html(node.astext(), True)}</div>\n')
    raise docutils.nodes.SkipNode


def copy_style(app, exception):
    if exception is None and app.builder.format == "html":
        source = HERE / "node_modules" / "katex" / "dist"
        target = pathlib.Path(app.outdir) / "_static" / "katex"
        (target / "fonts").mkdir(parents=True, exist_ok=True)
        # Every browser that runs the reports knows WOFF2.
        style = (source / "katex.min.css").read_text(encoding="utf-8")
        style = re.sub(r',url\([^)]*\.(?:woff|ttf)\) format\("[a-z]+"\)', "", style)
        (target / "katex.min.css").write_text(style, encoding="utf-8")
        for font in (source / "fonts").glob("*.woff2"):
            shutil.copyfile(font, target / "fonts" / font.name)


def keep_marks(app, doctree, name):
    """A mark behind a short formula stays on its line."""
    import docutils.nodes
    for node in list(doctree.findall(docutils.nodes.math)):
        behind = node.next_node(descend=False, siblings=True)
        marks = re.match(r"[).,;:]+", behind) if isinstance(behind, docutils.nodes.Text) else None
        if marks and len(node.astext()) <= 16:
            node["tail"] = marks.group(0)
            behind.parent.replace(behind, docutils.nodes.Text(behind[marks.end():]))


def as_text(app, what, name, obj, options, lines):
    """|v| is a length in livens' docstrings, no substitution."""
    lines[:] = [line.replace("|v|", r"\|v\|") for line in lines]


def share_sidebars():
    """Pages of diagnostic codes are in no tree, so all have the same sidebar; making it anew was two thirds of all time."""
    import furo
    made, original = {}, furo._compute_navigation_tree

    def tree(context):
        folder, _, name = context["pagename"].rpartition("/")
        if folder != "diagnostics" or name == "index":
            return original(context)
        if folder not in made:
            made[folder] = original(context)
        return made[folder]

    furo._compute_navigation_tree = tree


def setup(app):
    share_sidebars()
    app.connect("autodoc-process-docstring", as_text)
    app.connect("doctree-resolved", keep_marks)
    app.add_html_math_renderer("livens", inline_renderers=(inline, None), block_renderers=(block, None))
    app.add_css_file("katex/katex.min.css")
    app.connect("build-finished", copy_style)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
